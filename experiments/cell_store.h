// What a run has rendered and timed so far, kept beside its results: the same run, killed and started again, goes on
// where it stopped.
//
// A cell is what is rendered side by side: all methods for one plane of one view, say. Its key is a text that names all
// that decides pixels and times, this program's own file included, so that another program's cells are never met.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/plane_image.h"

namespace plumb {

class CellStore {
public:
    explicit CellStore(std::filesystem::path folder);

    // The images kept under `key`, or nothing where there are none or the file is damaged.
    std::optional<std::vector<PlaneImage>> load(const std::string& key) const;
    // Whole or not at all. Throws ImageError where the folder cannot be written.
    void save(const std::string& key, const std::vector<PlaneImage>& images) const;
    // Removes all cells: once the results are written nobody needs them.
    void clear() const;

private:
    std::filesystem::path file_of(const std::string& key) const;

    std::filesystem::path folder_;
    std::string program_;  // checksum of this program's file
};

}  // namespace plumb
