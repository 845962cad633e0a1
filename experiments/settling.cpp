#include "experiments/settling.h"

#include <cmath>

namespace plumb {
namespace {

constexpr double negligible = 0.01;
// Of what is carried on from bounce to bounce; more than most scenes reflect.
constexpr double albedo = 0.8;

// Until `share` to the power of the frames is negligible.
int frames_of(double share) {
    return share > 0.0 ? static_cast<int>(std::ceil(std::log(negligible) / std::log(share))) : 0;
}

}  // namespace

int frames_to_settle(const Method& method) {
    int frames = 1;
    // Each waits for what it is fed with.
    if (method.ao.enabled) frames += frames_of(method.ao.temporal.alpha);
    if (method.radiosity.enabled) {
        // What is carried on is what the filter gave: a frame's share goes through both in each frame.
        const double alpha = method.radiosity.temporal.alpha;
        const double carried = method.radiosity.carry ? albedo * (1.0 - method.radiosity.damping) : 0.0;
        frames += frames_of(alpha + (1.0 - alpha) * carried);
    }
    if (method.antialias.temporal) frames += frames_of(method.antialias.alpha);
    return frames;
}

}  // namespace plumb
