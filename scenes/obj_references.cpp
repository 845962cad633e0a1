#include "scenes/obj_references.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "scenes/scene_error.h"

namespace plumb {
namespace {

std::string trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

// The rest of a line that begins with `keyword` and a blank.
bool starts_with_word(const std::string& line, std::string_view keyword, std::string& rest) {
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string::npos || line.compare(first, keyword.size(), keyword) != 0) return false;
    const std::size_t end = first + keyword.size();
    if (end >= line.size() || (line[end] != ' ' && line[end] != '\t')) return false;
    rest = trimmed(std::string_view(line).substr(end));
    return true;
}

std::set<std::string> materials_of(const std::filesystem::path& mtl) {
    std::set<std::string> names;
    std::ifstream input(mtl);
    std::string line, name;
    while (std::getline(input, line)) {
        if (starts_with_word(line, "newmtl", name)) names.insert(name);
    }
    return names;
}

// Zero-based index of the vertex that `text` (one-based, or negative from the end) refers to, or a fault.
std::string index_fault(std::string_view text, std::size_t count, const char* what) {
    long index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc() || end != text.data() + text.size()) return fmt::format("'{}' is no {} index", text, what);
    const long limit = static_cast<long>(count);
    if (index == 0 || index > limit || index < -limit) {
        return fmt::format("{} index {} is out of range ({} are defined above it)", what, index, count);
    }
    return {};
}

}  // namespace

std::vector<std::string> missing_obj_references(const std::filesystem::path& file) {
    std::ifstream input(file);
    std::set<std::string> used, defined;
    std::vector<std::string> missing;
    std::string line, rest;
    bool any_library = false;
    while (std::getline(input, line)) {
        if (starts_with_word(line, "usemtl", rest)) used.insert(rest);
        if (!starts_with_word(line, "mtllib", rest)) continue;
        any_library = true;
        for (char& c : rest) c = c == '\\' ? '/' : c;
        const std::filesystem::path mtl = file.parent_path() / rest;
        if (std::filesystem::exists(mtl)) {
            defined.merge(materials_of(mtl));
        } else {
            missing.push_back(
                fmt::format("material library '{}' not found; its materials are grey. Put it beside the OBJ file "
                            "or correct the mtllib line",
                            mtl.string()));
        }
    }
    if (!any_library && !used.empty()) {
        missing.push_back(fmt::format("no mtllib line: its {} materials are grey", used.size()));
    } else if (missing.empty()) {
        for (const std::string& name : used) {
            if (!defined.contains(name))
                missing.push_back(fmt::format("material '{}' is not defined; it is grey", name));
        }
    }
    return missing;
}

std::string first_obj_fault(const std::filesystem::path& file) {
    std::ifstream input(file);
    std::string line, word;
    std::size_t positions = 0, uvs = 0, normals = 0, number = 0;
    while (std::getline(input, line)) {
        ++number;
        std::istringstream words(line);
        if (!(words >> word)) continue;
        if (word == "v" || word == "vt" || word == "vn") {
            const int wanted = word == "vt" ? 1 : 3;
            for (int i = 0; i < wanted; ++i) {
                std::string text;
                words >> text;
                char* end = nullptr;
                const double value = std::strtod(text.c_str(), &end);
                if (text.empty() || *end != '\0' || !std::isfinite(value)) {
                    return fmt::format("line {}: '{}' is not a finite coordinate", number, text);
                }
            }
            ++(word == "v" ? positions : word == "vt" ? uvs : normals);
        } else if (word == "f") {
            int corners = 0;
            for (std::string corner; words >> corner && corner[0] != '#'; ++corners) {
                const std::size_t counts[3] = {positions, uvs, normals};
                const char* const names[3] = {"vertex", "UV", "normal"};
                std::string_view rest = corner;
                for (int i = 0; i < 3; ++i) {
                    const auto slash = rest.find('/');
                    const std::string_view index = rest.substr(0, slash);
                    if (!index.empty()) {
                        const std::string fault = index_fault(index, counts[i], names[i]);
                        if (!fault.empty()) return fmt::format("line {}: {}", number, fault);
                    }
                    if (slash == std::string_view::npos) break;
                    rest = rest.substr(slash + 1);
                }
            }
            if (corners < 3) return fmt::format("line {}: a face of {} corners", number, corners);
        }
    }
    return {};
}

}  // namespace plumb
