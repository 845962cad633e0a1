// Values of many paths side by side (structure of arrays), so that the compiler computes several at once.
#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace plumb {

// How many paths are followed together: enough to keep packets of sixteen rays full when many paths have ended, few
// enough for their whole state to stay in the nearest caches.
constexpr int most_lanes = 128;

// What a vector register holds. Loops of plain arithmetic run to the end of the last group that is in use, lanes
// without a path included: what they compute there nobody reads, and none is left over to be computed by itself.
constexpr int lane_group = 8;
constexpr int whole_groups(int count) { return (count + lane_group - 1) & -lane_group; }

// For functions that loops over lanes call: a call that stays a call is not computed several at once.
#define PLUMBLINE_INLINE inline __attribute__((always_inline))
// Before a loop whose lanes do not depend on each other, where the compiler cannot know: it looks up what may be
// anywhere.
#ifdef __clang__
#define PLUMBLINE_INDEPENDENT_LANES _Pragma("clang loop vectorize(assume_safety)")
#else
#define PLUMBLINE_INDEPENDENT_LANES _Pragma("GCC ivdep")
#endif

// Before the definition of a function that is nothing but loops over lanes: compiled for AVX-512 too, which has twice
// the registers, and taken where the machine has it, as Embree does. The same bits: nothing is contracted or reordered.
// Clang takes the attribute at a function's first declaration alone.
#if defined(PLUMBLINE_DISPATCHES) && !defined(__clang__)
#define PLUMBLINE_FOR_EACH_MACHINE __attribute__((target_clones("default", "arch=x86-64-v4")))
#else
#define PLUMBLINE_FOR_EACH_MACHINE
#endif

// With a group more than is ever in use, for fill().
template <typename T>
struct alignas(64) Lanes : std::array<T, most_lanes + lane_group> {
    // Group by group, which costs a store each: what stood up to a group behind `end` is lost.
    PLUMBLINE_INLINE void fill(int begin, int end, T value) {
        for (int first = begin; first < end; first += lane_group) {
            for (int i = 0; i < lane_group; ++i) (*this)[first + i] = value;
        }
    }
};

struct VectorLanes {
    Lanes<float> x, y, z;

    PLUMBLINE_INLINE glm::vec3 get(int lane) const { return {x[lane], y[lane], z[lane]}; }
    PLUMBLINE_INLINE void set(int lane, const glm::vec3& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
    PLUMBLINE_INLINE void add(int lane, const glm::vec3& v) { x[lane] += v.x, y[lane] += v.y, z[lane] += v.z; }

    PLUMBLINE_INLINE void fill(int begin, int end, const glm::vec3& v) {
        x.fill(begin, end, v.x), y.fill(begin, end, v.y), z.fill(begin, end, v.z);
    }
};

}  // namespace plumb
