// How all pictures of a run look: exposure, the scale and colours of error maps, the names of files.
#pragma once

#include <string>
#include <string_view>

#include "frames/colour_map.h"

namespace plumb {

// The colour map of all error maps.
inline constexpr ColourMap error_colour_map = ColourMap::inferno;

// Stops that bring radiance of `range` (metrics/comparison.h, default_data_range) just below white.
float exposure_for(double range);
// How values became a picture, in words; empty for planes that are shown as they are.
std::string exposure_note(std::string_view plane, float exposure);

// Rounded up to one or two leading digits, so that legends read well; 1e-6 for what is not positive.
double round_up_scale(double value);

// A name as part of a file's name: everything but letters, digits, '-' and '_' becomes '_'.
std::string file_name_of(std::string_view name);

}  // namespace plumb
