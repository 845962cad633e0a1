// What a method, the path tracer or the oracle made of one plane of one view, and what it took.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/results.h"
#include "frames/image.h"

namespace plumb {

// Independent halves of an image that is itself noisy; the image is their mean.
struct ImageHalves {
    Image a, b;
};

struct PlaneImage {
    std::string view, plane, method;
    Image image;
    int path_tracer_samples = 0;
    OracleLimits oracle = {};  // as ResultRow has it
    Timing timing = {};
    int gbuffer_bytes_per_pixel = 0;
    std::optional<ImageHalves> halves = {};  // of the oracle
    std::vector<Image> other_seeds = {};     // of a method: the same with other patterns of taps
};

}  // namespace plumb
