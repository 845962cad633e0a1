#include "experiments/config.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace plumb {
namespace {

ConfigValue convert(const toml::node& node, const std::string& source) {
    ConfigValue result;
    result.line = static_cast<int>(node.source().begin.line);
    if (const auto* table = node.as_table()) {
        ConfigMembers members;
        for (const auto& [key, value] : *table) members.push_back({std::string(key.str()), convert(value, source)});
        // toml++ sorts by name; the file's order is the one that a reader of results expects.
        std::ranges::stable_sort(members, {}, [](const auto& member) { return member.value.line; });
        if (result.line == 0 && !members.empty()) result.line = members.front().value.line;
        result.value = std::move(members);
    } else if (const auto* array = node.as_array()) {
        ConfigArray values;
        for (const toml::node& value : *array) values.push_back(convert(value, source));
        result.value = std::move(values);
    } else if (const auto* text = node.as_string()) {
        result.value = text->get();
    } else if (const auto* integer = node.as_integer()) {
        result.value = integer->get();
    } else if (const auto* number = node.as_floating_point()) {
        result.value = number->get();
    } else if (const auto* boolean = node.as_boolean()) {
        result.value = boolean->get();
    } else {
        throw ConfigError(fmt::format("{}:{}: dates and times are not used here", source, result.line));
    }
    return result;
}

// Insertions, deletions, substitutions and swaps of neighbours that turn one text into the other (optimal string
// alignment).
int edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<int>> cost(a.size() + 1, std::vector<int>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = static_cast<int>(i);
    for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int substituted = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            cost[i][j] = std::min({substituted, cost[i - 1][j] + 1, cost[i][j - 1] + 1});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
        }
    }
    return cost[a.size()][b.size()];
}

}  // namespace

std::string_view ConfigValue::type_name() const {
    constexpr std::string_view names[] = {"true or false", "a whole number", "a number",
                                          "a text",        "an array",       "a table"};
    return names[value.index()];
}

ConfigValue parse_config(std::string_view text, const std::string& source) {
    try {
        return convert(toml::parse(text, source), source);
    } catch (const toml::parse_error& error) {
        throw ConfigError(
            fmt::format("{}:{}: not valid TOML: {}", source, error.source().begin.line, error.description()));
    }
}

std::string read_config_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    if (!std::filesystem::is_regular_file(file) || !stream || !(text << stream.rdbuf())) {
        throw ConfigError(fmt::format("'{}': no such file, or it is empty or cannot be read", file.string()));
    }
    return text.str();
}

ConfigValue read_config(const std::filesystem::path& file) {
    return parse_config(read_config_text(file), file.string());
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
    std::string best;
    int best_distance = std::max(2, static_cast<int>(name.size()) / 2);  // beyond half the letters it is another word
    for (const std::string& candidate : candidates) {
        const int distance = edit_distance(name, candidate);
        if (distance < best_distance) best = candidate, best_distance = distance;
    }
    return best;
}

std::string name_hint(std::string_view name, const std::vector<std::string>& candidates) {
    const std::string nearest = nearest_name(name, candidates);
    if (!nearest.empty()) return fmt::format("did you mean '{}'?", nearest);
    return candidates.empty() ? "nothing is understood here"
                              : fmt::format("there are: {}", fmt::join(candidates, ", "));
}

ConfigReader::ConfigReader(const ConfigValue& table, std::string source, std::string prefix)
    : members_(std::get_if<ConfigMembers>(&table.value)),
      source_(std::move(source)),
      prefix_(std::move(prefix)),
      line_(table.line) {
    if (!members_) {
        throw ConfigError(
            fmt::format("{}:{}: {} must be a table, but is {}", source_, line_, prefix_, table.type_name()));
    }
}

const ConfigValue* ConfigReader::find(std::string_view key) const {
    const auto found = std::ranges::find_if(*members_, [&](const auto& member) { return member.key == key; });
    return found == members_->end() ? nullptr : &found->value;
}

bool ConfigReader::has(std::string_view key) const { return find(key) != nullptr; }

const ConfigValue* ConfigReader::value(std::string_view key) {
    known_.emplace(key);
    return find(key);
}

void ConfigReader::fail(std::string_view key, std::string_view message) const {
    const ConfigValue* value = find(key);
    std::string name = prefix_;
    if (!name.empty() && !key.empty()) name += '.';
    name += key;
    throw ConfigError(
        fmt::format("{}:{}: {}{}{}", source_, value ? value->line : line_, name, name.empty() ? "" : ": ", message));
}

bool ConfigReader::boolean(std::string_view key, bool fallback) {
    const ConfigValue* found = value(key);
    if (!found) return fallback;
    if (const bool* boolean = std::get_if<bool>(&found->value)) return *boolean;
    fail(key, fmt::format("must be true or false, but is {}", found->type_name()));
}

int ConfigReader::integer(std::string_view key, int fallback, int least, int most) {
    const ConfigValue* found = value(key);
    if (!found) return fallback;
    const auto* integer = std::get_if<std::int64_t>(&found->value);
    if (!integer) fail(key, fmt::format("must be a whole number, but is {}", found->type_name()));
    if (*integer < least || *integer > most)
        fail(key, fmt::format("is {}, but must be {} to {}", *integer, least, most));
    return static_cast<int>(*integer);
}

double ConfigReader::number(std::string_view key, double fallback, double least, double most) {
    const ConfigValue* found = value(key);
    if (!found) return fallback;
    double number = 0.0;
    if (const auto* integer = std::get_if<std::int64_t>(&found->value)) {
        number = static_cast<double>(*integer);
    } else if (const auto* floating = std::get_if<double>(&found->value)) {
        number = *floating;
    } else {
        fail(key, fmt::format("must be a number, but is {}", found->type_name()));
    }
    // Written so that NaN fails as well.
    if (!(number >= least && number <= most))
        fail(key, fmt::format("is {}, but must be {} to {}", number, least, most));
    return number;
}

std::string ConfigReader::text(std::string_view key, std::string fallback) {
    const ConfigValue* found = value(key);
    if (!found) return fallback;
    if (const auto* text = std::get_if<std::string>(&found->value)) return *text;
    fail(key, fmt::format("must be a text in quotes, but is {}", found->type_name()));
}

std::string ConfigReader::required_text(std::string_view key) {
    if (!value(key)) fail("", fmt::format("'{}' is missing", key));
    return text(key, "");
}

std::vector<std::string> ConfigReader::texts(std::string_view key, std::vector<std::string> fallback) {
    const ConfigValue* found = value(key);
    if (!found) return fallback;
    const auto* array = std::get_if<ConfigArray>(&found->value);
    if (!array) fail(key, fmt::format("must be an array of texts, but is {}", found->type_name()));
    std::vector<std::string> result;
    for (const ConfigValue& element : *array) {
        const auto* text = std::get_if<std::string>(&element.value);
        if (!text) fail(key, fmt::format("must hold texts only, but holds {}", element.type_name()));
        result.push_back(*text);
    }
    return result;
}

std::vector<int> ConfigReader::integers(std::string_view key, std::vector<int> fallback, int least, int most) {
    const ConfigValue* found = value(key);
    if (!found) return fallback;
    const auto* array = std::get_if<ConfigArray>(&found->value);
    if (!array) fail(key, fmt::format("must be an array of whole numbers, but is {}", found->type_name()));
    std::vector<int> result;
    for (const ConfigValue& element : *array) {
        const auto* integer = std::get_if<std::int64_t>(&element.value);
        if (!integer) fail(key, fmt::format("must hold whole numbers only, but holds {}", element.type_name()));
        if (*integer < least || *integer > most)
            fail(key, fmt::format("holds {}, but must hold {} to {}", *integer, least, most));
        result.push_back(static_cast<int>(*integer));
    }
    return result;
}

ConfigReader ConfigReader::table(std::string_view key) {
    static const ConfigValue empty{ConfigMembers{}, 0};
    const ConfigValue* found = value(key);
    ConfigReader reader(found ? *found : empty, source_,
                        prefix_.empty() ? std::string(key) : fmt::format("{}.{}", prefix_, key));
    if (!found) reader.line_ = line_;
    return reader;
}

std::vector<ConfigReader> ConfigReader::tables(std::string_view key) {
    std::vector<ConfigReader> readers;
    const ConfigValue* found = value(key);
    if (!found) return readers;
    if (const auto* array = std::get_if<ConfigArray>(&found->value)) {
        for (std::size_t i = 0; i < array->size(); ++i) {
            readers.emplace_back((*array)[i], source_, fmt::format("{}[{}]", key, i + 1));
        }
    } else {
        readers.emplace_back(*found, source_, std::string(key));
    }
    return readers;
}

void ConfigReader::finish(const std::vector<std::string>& more_names) const {
    std::vector<std::string> names(known_.begin(), known_.end());
    names.insert(names.end(), more_names.begin(), more_names.end());
    for (const auto& [key, value] : *members_) {
        if (std::ranges::find(names, key) == names.end()) fail(key, "unknown key; " + name_hint(key, names));
    }
}

}  // namespace plumb
