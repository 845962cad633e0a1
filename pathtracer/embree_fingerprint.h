// Tells machines apart on which Embree does not find the same hits to the last bit.
//
// Embree picks the widest instructions that a processor has, and works with their approximate reciprocals, which also
// differ between makers: AVX2 and AVX-512 disagree in the last bits of one hit in ten. So some thousand rays are traced
// against a few triangles, and what they find is hashed.
#pragma once

#include <cstdint>

#include "pathtracer/embree_api.h"

namespace plumb {

// The same for devices that give the same bits, but for what so many rays do not show. Takes about a millisecond.
std::uint64_t embree_fingerprint(RTCDevice device);

}  // namespace plumb
