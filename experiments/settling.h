// Methods that keep something from frame to frame show a still view as it is after some frames, not as the first one
// is.
#pragma once

#include "rasterizer/method.h"

namespace plumb {

// Frames of a still view until what the first ones brought has less than a hundredth of the weight; 1 where nothing is
// kept.
int frames_to_settle(const Method& method);

}  // namespace plumb
