// How far light has to be followed: the box of all surfaces, and its farthest point.
#pragma once

#include "scenes/scene.h"

namespace plumb {

// All instances where they stand, and moving ones wherever they come. A moving instance counts by the corners of its
// own box at 16 moments between two keys, and a fiftieth of their size besides, for what lies between them.
Bounds bounds_over_time(const Scene& scene);

// From `point` to the box's farthest corner, with room for receivers that are lifted off their surface.
float reach(const Bounds& box, const glm::vec3& point);

}  // namespace plumb
