// TOML read strictly: every value is asked for by name and range, and whatever nobody asked for is an error that names
// the file, the line and the nearest name that would have been understood.
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "experiments/config_error.h"

namespace plumb {

// For numbers without a largest value.
inline constexpr double no_limit = std::numeric_limits<double>::infinity();

struct ConfigValue;
struct ConfigMember;
using ConfigArray = std::vector<ConfigValue>;
using ConfigMembers = std::vector<ConfigMember>;  // in the file's order

// One value of a file, with the place where it stands.
struct ConfigValue {
    std::variant<bool, std::int64_t, double, std::string, ConfigArray, ConfigMembers> value;
    int line = 0;

    std::string_view type_name() const;
};

struct ConfigMember {
    std::string key;
    ConfigValue value;
};

// `source` is what errors call the text. Throws ConfigError with the line where the text is not TOML.
ConfigValue parse_config(std::string_view text, const std::string& source);
// The text of a file. Throws ConfigError where there is none, or it is empty.
std::string read_config_text(const std::filesystem::path& file);
ConfigValue read_config(const std::filesystem::path& file);

// The candidate that differs from `name` by the fewest single-letter edits, or nothing where all differ a lot.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);
// ", did you mean 'x'?" or a list of all candidates.
std::string name_hint(std::string_view name, const std::vector<std::string>& candidates);

// A table being read. `finish` throws for the members that were never asked for. The table must outlive the reader.
class ConfigReader {
public:
    // Throws ConfigError unless `table` is a table.
    ConfigReader(const ConfigValue& table, std::string source, std::string prefix = "");

    const std::string& source() const { return source_; }
    int line() const { return line_; }
    bool has(std::string_view key) const;

    bool boolean(std::string_view key, bool fallback);
    int integer(std::string_view key, int fallback, int least, int most);
    // A number; TOML's `inf` is one.
    double number(std::string_view key, double fallback, double least, double most);
    std::string text(std::string_view key, std::string fallback);
    std::string required_text(std::string_view key);
    std::vector<std::string> texts(std::string_view key, std::vector<std::string> fallback);
    std::vector<int> integers(std::string_view key, std::vector<int> fallback, int least, int most);

    // Null where the key is absent.
    const ConfigValue* value(std::string_view key);
    // Table `key`; an empty one where it is absent.
    ConfigReader table(std::string_view key);
    // The tables of array `key`; a single table counts as an array of one.
    std::vector<ConfigReader> tables(std::string_view key);

    // Throws ConfigError for a member that was not asked for; `more_names` are names that other readers understand.
    void finish(const std::vector<std::string>& more_names = {}) const;
    // "file.toml:12: prefix.key: message"
    [[noreturn]] void fail(std::string_view key, std::string_view message) const;

private:
    const ConfigValue* find(std::string_view key) const;

    const ConfigMembers* members_;
    std::string source_, prefix_;
    int line_ = 0;
    std::set<std::string, std::less<>> known_;
};

}  // namespace plumb
