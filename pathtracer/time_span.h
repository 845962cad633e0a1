// An interval of scene time, in seconds.
#pragma once

namespace plumb {

// While a shutter is open, or from one frame to the next.
struct TimeSpan {
    double begin = 0.0, end = 0.0;
};

}  // namespace plumb
