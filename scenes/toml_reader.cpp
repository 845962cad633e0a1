#include "scenes/toml_reader.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/scene_error.h"

namespace plumb {
namespace {

const toml::table& empty_table() {
    static const toml::table table;
    return table;
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        const auto& begin = error.source().begin;
        throw SceneError(fmt::format("{}:{}:{}: {}", file, begin.line, begin.column, error.description()));
    }
}

const toml::node* TomlReader::node(std::string_view key) {
    known_.emplace(key);
    return table_.get(key);
}

void TomlReader::complain(std::string_view key, const std::string& message) const {
    const toml::node* at = table_.get(key);
    const auto line = (at ? at->source() : table_.source()).begin.line;
    throw SceneError(fmt::format("{}:{}: {} {}", file_, line, what_, message));
}

void TomlReader::fail(std::string_view message, std::string_view key) const {
    complain(key, fmt::format(fmt::runtime(message), key));
}

bool TomlReader::read(std::string_view key, float& value) {
    const toml::node* found = node(key);
    if (!found) return false;
    const auto number = found->value<double>();
    if (!number || found->is_boolean()) fail("'{}' must be a number", key);
    value = static_cast<float>(*number);
    return true;
}

bool TomlReader::read(std::string_view key, bool& value) {
    const toml::node* found = node(key);
    if (!found) return false;
    if (!found->is_boolean()) fail("'{}' must be true or false", key);
    value = **found->as_boolean();
    return true;
}

bool TomlReader::read(std::string_view key, std::string& value) {
    const toml::node* found = node(key);
    if (!found) return false;
    if (!found->is_string()) fail("'{}' must be a text in quotes", key);
    value = **found->as_string();
    return true;
}

bool TomlReader::read(std::string_view key, glm::vec3& value) {
    const toml::node* found = node(key);
    if (!found) return false;
    const toml::array* list = found->as_array();
    if (!list) {
        if (!found->is_number()) fail("'{}' must be three numbers", key);
        value = glm::vec3(static_cast<float>(*found->value<double>()));
        return true;
    }
    if (list->size() != 3) fail("'{}' must be three numbers", key);
    for (int i = 0; i < 3; ++i) {
        const toml::node& item = (*list)[static_cast<std::size_t>(i)];
        if (!item.is_number()) fail("'{}' must be three numbers", key);
        value[i] = static_cast<float>(*item.value<double>());
    }
    return true;
}

bool TomlReader::read(std::string_view key, std::vector<std::string>& value) {
    const toml::node* found = node(key);
    if (!found) return false;
    const toml::array* list = found->as_array();
    if (!list) fail("'{}' must be a list of texts", key);
    value.clear();
    for (const toml::node& item : *list) {
        if (!item.is_string()) fail("'{}' must be a list of texts", key);
        value.push_back(**item.as_string());
    }
    return true;
}

std::vector<TomlReader> TomlReader::tables(std::string_view key) {
    std::vector<TomlReader> readers;
    const toml::node* found = node(key);
    if (!found) return readers;
    const toml::array* list = found->as_array();
    if (!list) fail("'{}' must be a list of tables: [[{0}]]", key);
    for (const toml::node& item : *list) {
        if (!item.is_table()) fail("'{}' must be a list of tables: [[{0}]]", key);
        readers.emplace_back(*item.as_table(), file_, fmt::format("[[{}]]", key));
    }
    return readers;
}

TomlReader TomlReader::table(std::string_view key) {
    const toml::node* found = node(key);
    if (found && !found->is_table()) fail("'{}' must be a table: [{0}]", key);
    return {found ? *found->as_table() : empty_table(), file_, fmt::format("[{}]", key)};
}

std::vector<std::string> TomlReader::names() const {
    std::vector<std::string> names;
    for (const auto& [key, value] : table_) names.emplace_back(key.str());
    return names;
}

void TomlReader::finish() const {
    for (const auto& [key, value] : table_) {
        if (known_.contains(key.str())) continue;
        const std::vector<std::string> known(known_.begin(), known_.end());
        const std::string nearest = nearest_word(key.str(), known);
        complain(key.str(), nearest.empty()
                                ? fmt::format("has no key '{}'; its keys are {}", key.str(), fmt::join(known, ", "))
                                : fmt::format("has no key '{}'; did you mean '{}'?", key.str(), nearest));
    }
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
    std::string nearest;
    std::size_t best = 1 + word.size() / 3;  // farther away than a third of the word is another word
    for (const std::string& candidate : candidates) {
        std::vector<std::size_t> row(candidate.size() + 1);  // Levenshtein distance, row by row
        std::iota(row.begin(), row.end(), std::size_t{0});
        for (std::size_t i = 1; i <= word.size(); ++i) {
            std::size_t diagonal = row[0];
            row[0] = i;
            for (std::size_t j = 1; j <= candidate.size(); ++j) {
                const std::size_t changed = diagonal + (word[i - 1] == candidate[j - 1] ? 0 : 1);
                diagonal = row[j];
                row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
            }
        }
        if (row.back() <= best) {
            if (row.back() == best && !nearest.empty()) continue;
            best = row.back();
            nearest = candidate;
        }
    }
    return nearest;
}

}  // namespace plumb
