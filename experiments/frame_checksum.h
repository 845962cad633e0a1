// A frame's planes as one number: tells a damaged file from a whole one.
#pragma once

#include <string>

#include "frames/frame.h"

namespace plumb {

// 32 hexadecimal digits over names, shapes and bits of all planes (XXH3); not over the facts.
std::string frame_checksum(const Frame& frame);

}  // namespace plumb
