// What writing flat and deep OpenEXR files shares.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>

#include "frames/frame.h"

namespace plumb {

inline constexpr std::string_view exr_fact_prefix = "plumbline:";
inline constexpr std::size_t longest_exr_name = 255;  // of channels and attributes, by the format

// OpenEXR compresses on its own pool of threads, which is empty until somebody sizes it.
void use_all_exr_threads();

// The frame's facts as string attributes. Throws ImageError for a name that the format cannot hold.
void add_facts(const std::filesystem::path& path, const Frame& frame, Imf::Header& header);

// Calls `write` with a stream; the file appears whole or not at all. Throws ImageError that names the file, also where
// the disk is full, which OpenEXR itself, completing a file in a destructor, cannot report.
void write_exr_atomically(const std::filesystem::path& path, const std::function<void(Imf::OStream& stream)>& write);

}  // namespace plumb
