// Reads TOML tables strictly: a key that is not known, or a value of the wrong kind, is an error with file and line.
//   Only for .cpp files: toml++ is a heavy header.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>
#include <toml++/toml.h>

namespace plumb {

// Throws SceneError with file, line and column where `text` is not TOML.
toml::table parse_toml(std::string_view text, const std::string& file);

// One table, read key by key; finish() complains about what was never asked for.
class TomlReader {
public:
    TomlReader(const toml::table& table, std::string file, std::string what)
        : table_(table), file_(std::move(file)), what_(std::move(what)) {}

    bool has(std::string_view key) const { return table_.contains(key); }
    // Leaves `value` as it was where the key is absent; returns whether it was there.
    bool read(std::string_view key, float& value);
    bool read(std::string_view key, bool& value);
    bool read(std::string_view key, std::string& value);
    bool read(std::string_view key, glm::vec3& value);  // [r, g, b]; a single number stands for three equal ones
    bool read(std::string_view key, std::vector<std::string>& value);
    template <typename Value>
    void require(std::string_view key, Value& value) {
        if (!read(key, value)) fail("needs a key '{}'", key);
    }
    // The tables in [[key]] or key = [{...}, ...].
    std::vector<TomlReader> tables(std::string_view key);
    // The table [key], or an empty one.
    TomlReader table(std::string_view key);
    // The names in this table, whose values are tables.
    std::vector<std::string> names() const;

    // Throws for the first key that none of the calls above asked for, with the nearest one that some did.
    void finish() const;

    // Throws SceneError "file:line: what ...", for the line of `key` where it is there.
    [[noreturn]] void complain(std::string_view key, const std::string& message) const;

private:
    const toml::node* node(std::string_view key);
    [[noreturn]] void fail(std::string_view message, std::string_view key) const;

    const toml::table& table_;
    std::string file_, what_;
    std::set<std::string, std::less<>> known_;
};

// The candidate with the fewest single-letter changes from `word`; empty where none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace plumb
