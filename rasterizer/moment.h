// The scene at a moment, and a frame between its neighbours in time.
#pragma once

#include <cstdint>
#include <optional>

#include "frames/frame.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

// Where the camera is, and what time it is for the instances that move.
struct Moment {
    View view;
    std::optional<double> time = {};  // seconds; none: every instance is where the scene has it

    glm::mat4 pose(const Instance& instance) const { return time ? instance.pose(*time) : instance.world_from_object; }
    bool operator==(const Moment& other) const;
};

// One frame to render. Who renders a sequence says what came before, so that points can be found again there, and, if
// it is known, what comes after.
struct FrameRequest {
    Moment now;
    std::optional<Moment> previous = {};  // none: nothing has moved
    std::optional<Moment> next = {};      // none: unknown; all is taken to go on as it moved since `previous`
    const Frame* truth = nullptr;         // its planes feed the stages that the method takes from the truth
    // Of all patterns of samples: pictures with different seeds have independent noise. 0: the patterns as their
    // sources have them.
    std::uint32_t seed = 0;
};

// A rigid motion or an affine one that takes `previous` to `now`, applied once more: constant velocity, also of
// turning.
glm::mat4 extrapolate(const glm::mat4& previous, const glm::mat4& now);
// The camera goes on as it moved; field of view, planes and the offset of the pixels stay.
View extrapolate(const View& previous, const View& now);

}  // namespace plumb
