#include "pathtracer/motion_poses.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

namespace plumb {

double poses_over(const Instance& instance, const TimeSpan& span) {
    if (!instance.moves() || !(span.end > span.begin)) return 1.0;
    constexpr double largest_turn = glm::two_pi<double>() / poses_per_turn;
    constexpr double fewest = 9.0;           // for paths that are curved otherwise
    constexpr double rounding = 1.0 - 1e-5;  // a quarter turn is eight steps, though keys are in float
    const double turn = instance.motion.fastest_turn(span.begin, span.end) * (span.end - span.begin);
    return std::max(fewest, std::ceil(rounding * turn / largest_turn) + 1.0);
}

}  // namespace plumb
