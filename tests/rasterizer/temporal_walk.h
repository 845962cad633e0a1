// Frame by frame along a path through a scene in which things move, each frame told of its neighbours.
#pragma once

#include "rasterizer/one_pass_gbuffer.h"
#include "rasterizer/pipeline.h"
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

}  // namespace plumb
