// Images to compare: two files, or the files of two folders that have the same names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace plumb {

// Whether a file is an image by its name: EXR, PNG, HDR, TIFF, JPEG, BMP, TGA, PFM.
bool is_image_name(const std::filesystem::path& file);
// Whether a file holds what a screen shows, not radiance, by its name.
bool is_displayed_name(const std::filesystem::path& file);

// The images of a folder in order of their names, numbers in them compared as numbers: frame_9 before frame_10. Throws
// ImageError where there is none.
std::vector<std::filesystem::path> images_in(const std::filesystem::path& folder);

struct ImagePair {
    std::string name;  // of the file
    std::filesystem::path test, reference;
};

struct ImagePairs {
    std::vector<ImagePair> pairs;
    std::vector<std::string> only_in_test, only_in_reference;  // files without a partner
};

// Two files are a pair whatever their names. Throws ImageError where one is a folder and the other is not, and for
// folders that have no name in common.
ImagePairs find_pairs(const std::filesystem::path& test, const std::filesystem::path& reference);

}  // namespace plumb
