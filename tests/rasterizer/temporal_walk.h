// Frame by frame along a path through a scene in which things move, each frame told of its neighbours.
#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include "random_views.h"
#include "rasterizer/one_pass_gbuffer.h"
#include "rasterizer/pipeline.h"
#include "rasterizer/scene_reach.h"
#include "scenes/builtin.h"
#include "scenes/scene_file.h"
#include "temporal_counterpart.h"

namespace plumb {

// Shadow maps that do not take up all of a test's time.
inline Method with_small_shadows(Method method) {
    method.direct.shadow.cube_size = 64;
    method.direct.shadow.map_size = 128;
    method.direct.shadow.emitter_size = 64;
    return method;
}

struct TemporalWalk {
    TemporalWalk(int width_in, int height_in) : width(width_in), height(height_in) {}

    Scene scene = load_scene("clutter-moving", {});
    int width, height;
    double step = 1.0 / 30.0, start = 0.3;  // seconds

    Moment at(int frame) const {
        const double time = start + step * frame;
        return {View(scene.path("strafe").at(static_cast<float>(time)), width, height), time};
    }
    FrameRequest frame(int i) const { return {.now = at(i), .previous = at(i - 1), .next = at(i + 1)}; }
};

// The same scene along a way from a random view on: a step and a turn of a random size and direction each frame.
struct RandomWalk {
    RandomWalk(unsigned seed, int pixels) : first(random_view(seed, bounds_over_time(scene), pixels)) {
        std::mt19937 generator(seed + 1000);
        std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
        for (int c = 0; c < 3; ++c) step[c] = 0.04f * uniform(generator), turn[c] = 0.02f * uniform(generator);
    }

    Scene scene = load_scene("clutter-moving", {});
    RandomView first;
    glm::vec3 step{0.0f}, turn{0.0f};             // metres and radians a frame, camera space
    double start = 0.3, frame_time = 1.0 / 30.0;  // seconds

    Moment at(int frame) const {
        Camera camera = first.view.camera();
        const auto times = static_cast<float>(frame);
        const float angle = glm::length(turn);
        camera.world_from_camera = camera.world_from_camera * glm::translate(glm::mat4(1.0f), times * step) *
                                   glm::rotate(glm::mat4(1.0f), times * angle, turn / angle);
        return {View(camera, first.view.width(), first.view.height()), start + frame_time * frame};
    }
    FrameRequest frame(int i) const { return {.now = at(i), .previous = at(i - 1), .next = at(i + 1)}; }
};

}  // namespace plumb
