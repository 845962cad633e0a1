// Emissive surfaces that move light the scene from where they are.
#include <algorithm>
#include <cmath>

#include "gl_test.h"
#include "light_scenes.h"

namespace plumb {
namespace {

using MovingEmittersTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(MovingEmittersTest);

// A corner with a screen that throws a shadow, and an emitter that drops, turns and grows.
Scene make_moving_light(Mesh emitter, bool two_sided) {
    Scene scene = make_corner();
    add_quad(scene, 1, {-0.4f, 0.5f, -0.6f}, {0.9f, 0.0f, 0.0f}, {0.0f, 0.2f, 0.8f});
    Material glow;
    glow.base_colour = {0.0f, 0.0f, 0.0f};
    glow.emission = {9.0f, 6.0f, 3.0f};
    glow.two_sided = two_sided;
    emitter.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(glow);
    Instance instance{"emitter", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)};
    instance.motion.interpolation = MotionInterpolation::linear;
    instance.motion.pivot = {0.0f, 2.3f, 0.0f};
    instance.motion.keys = {{.time = 0.0f},
                            {.time = 1.0f,
                             .translation = {0.9f, -0.6f, 0.5f},
                             .rotation = glm::angleAxis(0.8f, glm::normalize(glm::vec3(1.0f, 2.0f, 3.0f))),
                             .scale = glm::vec3(1.5f)}};
    scene.instances.push_back(instance);
    scene.meshes.push_back(std::move(emitter));
    return scene;
}

Mesh make_panel() {
    Mesh mesh;
    mesh.positions = {{-0.3f, 2.3f, -0.3f}, {0.3f, 2.3f, -0.3f}, {0.3f, 2.3f, 0.3f}, {-0.3f, 2.3f, 0.3f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

// The same scene with all that moves put where it is at `time`, for good.
Scene frozen(Scene scene, double time) {
    for (Instance& instance : scene.instances) {
        instance.world_from_object = instance.pose(time);
        instance.motion = {};
    }
    return scene;
}

TEST_P(MovingEmittersTest, LightIsThatOfAnEmitterThatStandsThere) {
    struct Case {
        const char* name;
        Scene scene;
        // Corners are carried in double precision and rounded once, as poses are; half floats cut at 1e-3.
        float tolerance = 2e-3f;
        int samples = 4;  // none of them on the border of two triangles, where a rounding moves it far
        CubeGeneration generation = CubeGeneration::six_views;
        CubeDistance distance = CubeDistance::reciprocal;
    };
    const View view = corner_view();
    for (const Case& c :
         {Case{"a panel", make_moving_light(make_panel(), false)},
          Case{"of two sides, one-pass cubes", make_moving_light(make_panel(), true), 2e-3f, 4,
               CubeGeneration::one_pass},
          Case{"linear distances", make_moving_light(make_panel(), false), 2e-3f, 4, CubeGeneration::one_pass,
               CubeDistance::linear},
          // Its facets are gathered anew where it stands, into other clusters, each as wide as a fifth of the ball.
          Case{"a fine mesh", make_moving_light(make_ball(10, 0.3f, {0.0f, 2.3f, 0.0f}), false), 0.1f, 3}}) {
        SCOPED_TRACE(c.name);
        Method method = plain_method();
        method.direct.shadow.emitter_size = 128;
        method.direct.shadow.emitter_samples = c.samples;
        method.direct.shadow.cube_generation = c.generation;
        method.direct.shadow.cube_distance = c.distance;
        const Quantities quantities{.planes = {"direct"}};
        Pipeline pipeline(context(), c.scene, method, quantities, view.width(), view.height());
        const auto at = [&](double time) { return FrameRequest{.now = {view, time}}; };
        const Image first = pipeline.render(at(0.0)).frame.plane("direct");
        for (const double time : {0.4, 1.0, 0.0}) {
            const Image found = pipeline.render(at(time)).frame.plane("direct");
            const Image expected = render(context(), frozen(c.scene, time), view, {"direct"}, method).plane("direct");
            int different = 0, lit = 0, changed = 0;
            for (std::size_t i = 0; i < found.values().size(); ++i) {
                const float e = expected.values()[i];
                different += !(std::abs(found.values()[i] - e) <= c.tolerance * e + 1e-4f);
                lit += e > 0.0f;
                changed += std::abs(found.values()[i] - first.values()[i]) > 0.05f * first.values()[i];
            }
            // Roundings move a shadow's edge by a texel here and there.
            EXPECT_LE(different, lit / 200) << "at " << time;
            EXPECT_GT(lit, static_cast<int>(found.values().size() / 4));
            if (time > 0.0) {
                EXPECT_GT(changed, lit / 2) << "at " << time;
            }
        }
    }
}

}  // namespace
}  // namespace plumb
