// Names for what decides the bits of a reference: two runs with the same names make the same sums.
//
// Texts rather than hashes, so that whoever keeps references can show what they are of. Floats stand in hexadecimal:
// cameras that differ in the last bit are two cameras.
#pragma once

#include <string>

#include "pathtracer/reference.h"

namespace plumb {

// All that decides which rays belong to which pixels.
std::string view_identity(const View& view);

// All that decides what a sample brings, but for the scene and the view: the quantities, every setting that touches a
// sample, and the time that `span`, the path tracer's, lasts. Not how many samples there are, nor the target error.
std::string sampling_identity(const ReferenceSettings& settings, const TimeSpan& span);

}  // namespace plumb
