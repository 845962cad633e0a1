// Images of any file: EXR frames, and PNG, TIFF, HDR... through OpenImageIO.
#pragma once

#include <filesystem>

#include "frames/frame.h"

namespace plumb {

// Reads any image file as a frame. OpenEXR files (told by their first bytes, not by their names) go to read_exr. Of
// others the colour becomes plane `total` with 3 channels (1 where the file is grey) and coverage plane `alpha`. Values
// become linear: 8- and 16-bit formats are taken as sRGB-encoded 0..1 unless the file declares itself linear or names a
// gamma; float formats are linear already. Colours are not multiplied by alpha. Throws ImageError that names the file
// and what to do about it.
Frame read_frame(const std::filesystem::path& path);

// The transfer curve of IEC 61966-2-1 and its inverse; odd around zero, not clamped.
float srgb_to_linear(float encoded);
float linear_to_srgb(float linear);

}  // namespace plumb
