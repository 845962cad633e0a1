// Tells machines apart on which Embree does not find the same hits, or the C library's functions do not have the same
// values, to the last bit.
//
// Embree picks the widest instructions that a processor has, and works with their approximate reciprocals, which also
// differ between makers: AVX2 and AVX-512 disagree in the last bits of one hit in ten. The C library picks other code
// where a processor has fused multiply-adds. So some thousand rays are traced against a few triangles, still and moving
// ones, in each of the ways that TracedScene traces them; and what they find is hashed, with some values of the
// functions that a reference is computed with.
#pragma once

#include <cstdint>

#include "pathtracer/embree_api.h"

namespace plumb {

// The same for devices that give the same bits, but for what so many rays do not show. Takes a few milliseconds.
std::uint64_t embree_fingerprint(RTCDevice device);

}  // namespace plumb
