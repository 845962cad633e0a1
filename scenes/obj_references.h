// What an OBJ file refers to and whether it exists: the reader itself passes over a missing MTL in silence and gives no
// line number for a bad index.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace plumb {

// One line for each MTL file that is missing and each material that none of them defines.
std::vector<std::string> missing_obj_references(const std::filesystem::path& file);

// The first line of an OBJ file that cannot be right, as "line 12: ..."; empty where none is found: an index out of
// range, a coordinate that is not a number, a face of fewer than three corners.
std::string first_obj_fault(const std::filesystem::path& file);

}  // namespace plumb
