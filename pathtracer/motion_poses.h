// In how many poses a moving instance is handed to Embree, which moves its vertices straight from one to the next.
//
// What turns moves on a circle. Of radius r and at constant angular velocity, a straight way over an angle a is off the
// circle's point of the same time by at most a^2 / 8 times r: linear interpolation is off by at most an eighth of the
// squared step times the second derivative, which is r for a position over the angle. Between two poses an instance
// turns by a 32nd of a turn at most, so that it is off by less than a 200th of its distance from the axis.
#pragma once

#include "pathtracer/embree_api.h"
#include "pathtracer/time_span.h"
#include "scenes/scene.h"

namespace plumb {

constexpr int poses_per_turn = 32;
constexpr int most_poses = RTC_MAX_TIME_STEP_COUNT;  // enough for four turns

// Evenly over the time span, its ends included; 1 for what stands still. May be more than most_poses, which then do not
// show how it turns, but where it is at the ends.
double poses_over(const Instance& instance, const TimeSpan& span);

}  // namespace plumb
