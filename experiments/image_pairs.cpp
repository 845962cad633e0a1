#include "experiments/image_pairs.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

std::string extension_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

bool is_one_of(std::string_view extension, std::initializer_list<std::string_view> list) {
    return std::ranges::find(list, extension) != list.end();
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Numbers within names by their values, all else letter by letter.
bool comes_before(std::string_view a, std::string_view b) {
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (is_digit(a[i]) && is_digit(b[j])) {
            const auto number = [](std::string_view text, std::size_t& at) {
                while (at < text.size() && text[at] == '0') ++at;
                const std::size_t begin = at;
                while (at < text.size() && is_digit(text[at])) ++at;
                return text.substr(begin, at - begin);
            };
            const std::string_view of_a = number(a, i), of_b = number(b, j);
            if (of_a.size() != of_b.size()) return of_a.size() < of_b.size();
            if (of_a != of_b) return of_a < of_b;
        } else {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i, ++j;
        }
    }
    // Also tells 1 from 01, which are the same number.
    return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

}  // namespace

bool is_image_name(const std::filesystem::path& file) {
    return is_displayed_name(file) || is_one_of(extension_of(file), {".exr", ".hdr", ".tif", ".tiff", ".pfm"});
}

bool is_displayed_name(const std::filesystem::path& file) {
    return is_one_of(extension_of(file), {".png", ".jpg", ".jpeg", ".bmp", ".tga"});
}

std::vector<std::filesystem::path> images_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.is_regular_file() && is_image_name(entry.path())) files.push_back(entry.path());
    }
    if (files.empty()) {
        throw ImageError(fmt::format("folder '{}' holds no image (.exr, .png, .hdr, .tif...)", folder.string()));
    }
    std::ranges::sort(
        files, [](const auto& a, const auto& b) { return comes_before(a.filename().string(), b.filename().string()); });
    return files;
}

ImagePairs find_pairs(const std::filesystem::path& test, const std::filesystem::path& reference) {
    const bool folders = std::filesystem::is_directory(test);
    if (folders != std::filesystem::is_directory(reference)) {
        throw ImageError(fmt::format("'{}' is a folder and '{}' is not; name two images, or two folders of them",
                                     (folders ? test : reference).string(), (folders ? reference : test).string()));
    }
    if (!folders) return {{{test.filename().string(), test, reference}}, {}, {}};
    ImagePairs result;
    std::map<std::string, std::filesystem::path> references;
    for (const auto& file : images_in(reference)) references.emplace(file.filename().string(), file);
    for (const auto& file : images_in(test)) {
        const std::string name = file.filename().string();
        if (const auto partner = references.find(name); partner != references.end()) {
            result.pairs.push_back({name, file, partner->second});
            references.erase(partner);
        } else {
            result.only_in_test.push_back(name);
        }
    }
    for (const auto& [name, file] : references) result.only_in_reference.push_back(name);
    if (result.pairs.empty()) {
        throw ImageError(fmt::format("no image of folder '{}' has the name of one in '{}' ('{}' and '{}', for example)",
                                     test.string(), reference.string(), result.only_in_test.front(),
                                     result.only_in_reference.front()));
    }
    return result;
}

}  // namespace plumb
