// Values of many paths side by side (structure of arrays), so that the compiler computes several at once.
#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace plumb {

// How many paths are followed together: enough to keep packets of sixteen shadow rays full when some paths have ended,
// few enough for their whole state to stay in the first-level cache.
constexpr int most_lanes = 64;

template <typename T>
struct alignas(64) Lanes : std::array<T, most_lanes> {};

struct VectorLanes {
    Lanes<float> x, y, z;

    glm::vec3 get(int lane) const { return {x[lane], y[lane], z[lane]}; }
    void set(int lane, const glm::vec3& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
};

}  // namespace plumb
