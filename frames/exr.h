// Frames as multi-layer OpenEXR files.
//
// Written: one part, scan lines, 32-bit float, ZIP (lossless: every bit comes back, infinities and NaNs included);
// planes and channels named as channel_names.h says; each fact of the frame as a string attribute "plumbline:<key>".
// Read: these, and files of other programs: half, float and integer channels (all become float), tiles (the full
// resolution), several parts (a channel without a layer takes its part's name as layer, except in the first part).
//
// A frame holds the part of the display window that the file has data for: pixels rendered beyond the display window
// are left away, and of a crop render only the crop is there; fact "data_window" then says which part it is. Deep data
// and subsampled (luminance and chroma) channels are rejected.
#pragma once

#include <filesystem>

#include "frames/frame.h"

namespace plumb {

// The file appears whole or not at all (atomic_file.h). Throws ImageError that names the file, or the plane that a file
// cannot hold.
void write_exr(const std::filesystem::path& path, const Frame& frame);

// Throws ImageError that names the file and what to do about it.
Frame read_exr(const std::filesystem::path& path);

}  // namespace plumb
