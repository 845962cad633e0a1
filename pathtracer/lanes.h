// Values of many paths side by side (structure of arrays), so that the compiler computes several at once.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace plumb {

// How many paths are followed together: enough to keep packets of sixteen shadow rays full when some paths have ended,
// few enough for their whole state to stay in the first-level cache.
constexpr int most_lanes = 64;

// For functions that loops over lanes call: a call that stays a call is not computed several at once.
#define PLUMBLINE_INLINE inline __attribute__((always_inline))
// Before a loop whose lanes do not depend on each other, where the compiler cannot know: it looks up what may be
// anywhere.
#ifdef __clang__
#define PLUMBLINE_INDEPENDENT_LANES _Pragma("clang loop vectorize(assume_safety)")
#else
#define PLUMBLINE_INDEPENDENT_LANES _Pragma("GCC ivdep")
#endif

template <typename T>
struct alignas(64) Lanes : std::array<T, most_lanes> {};

struct VectorLanes {
    Lanes<float> x, y, z;

    PLUMBLINE_INLINE glm::vec3 get(int lane) const { return {x[lane], y[lane], z[lane]}; }
    PLUMBLINE_INLINE void set(int lane, const glm::vec3& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }

    void fill(int begin, int end, const glm::vec3& v) {
        std::fill(x.begin() + begin, x.begin() + end, v.x);
        std::fill(y.begin() + begin, y.begin() + end, v.y);
        std::fill(z.begin() + begin, z.begin() + end, v.z);
    }
};

}  // namespace plumb
