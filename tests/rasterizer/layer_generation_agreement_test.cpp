// Both layers in one geometry pass, held per pixel against what the rule says of rays through a moving scene.
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gl_test.h"
#include "layer_generation_counterpart.h"
#include "rasterizer/one_pass_gbuffer.h"
#include "rasterizer/pipeline.h"
#include "tests/busy_scene.h"

namespace plumb {
namespace {

using LayerGenerationAgreementTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(LayerGenerationAgreementTest);

constexpr int width = 90, height = 68;
constexpr float separation = 0.08f;

// The busy scene behind a fence that slides and turns.
Scene make_fenced_scene() {
    Scene scene = make_busy_scene();
    Mesh fence;
    fence.material = 1;
    for (int i = 0; i < 6; ++i) {
        const glm::vec3 foot(-1.2f + 0.45f * static_cast<float>(i), 0.0f, 0.9f - 0.1f * static_cast<float>(i));
        const auto first = static_cast<unsigned>(fence.positions.size());
        for (const glm::vec3& corner :
             {glm::vec3(0.0f), glm::vec3(0.12f, 0.0f, 0.0f), glm::vec3(0.12f, 1.3f, 0.1f), glm::vec3(0.0f, 1.3f, 0.1f)})
            fence.positions.push_back(foot + corner);
        fence.triangles.insert(fence.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
    }
    Instance instance{"fence", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)};
    instance.motion.keys = {{.time = 0.0f},
                            {.time = 0.4f,
                             .translation = {0.5f, 0.1f, -0.2f},
                             .rotation = glm::angleAxis(0.5f, glm::vec3(0.0f, 1.0f, 0.0f))},
                            {.time = 1.0f, .translation = {-0.3f, 0.0f, 0.0f}}};
    scene.instances.push_back(instance);
    scene.meshes.push_back(std::move(fence));
    return scene;
}

// Frames far apart, so that the comparison is another one at many pixels; the camera comes nearer in steps that grow.
Moment moment_of(int frame) {
    const double time = 0.1 * frame;
    const float nearer = 0.9f * static_cast<float>(time * time);
    const Camera camera = Camera::look_at("walk", {1.7f - nearer, 1.5f, 2.6f - 0.5f * nearer},
                                          {-0.3f + 0.4f * static_cast<float>(time), 0.8f, -0.6f}, 0.9f);
    return {View(camera, width, height), time};
}

// Both ways of selecting layers, as far as this OpenGL has them.
std::vector<LayerSelection> selections(const GlContext& context) {
    std::vector<LayerSelection> result = {LayerSelection::geometry_shader};
    if (context.info().has_extension("GL_ARB_shader_viewport_layer_array"))
        result.push_back(LayerSelection::vertex_shader);
    return result;
}

TEST_P(LayerGenerationAgreementTest, TheSecondLayerIsWhatTheRuleFindsAlongEveryRay) {
    const Scene scene = make_fenced_scene();
    constexpr int first = 2, frames = 4;
    for (const LayerGeneration generation :
         {LayerGeneration::delay, LayerGeneration::predict, LayerGeneration::previous, LayerGeneration::reproject}) {
        std::vector<std::vector<counterpart::SecondLayer>> expected;
        int exact = 0, ambiguous = 0, other_than_peeled = 0;
        for (int i = first; i < first + frames; ++i) {
            using counterpart::Snapshot;
            const Snapshot now = Snapshot::at(scene, moment_of(i)), before = Snapshot::at(scene, moment_of(i - 1)),
                           earlier = Snapshot::at(scene, moment_of(i - 2)),
                           foreseen = Snapshot::foreseen(scene, earlier, before);
            const bool is_first = i == first;  // which nothing came before
            const bool of_now = is_first || generation == LayerGeneration::delay;
            const counterpart::Comparison comparison{of_now                                   ? now
                                                     : generation == LayerGeneration::predict ? foreseen
                                                                                              : before,
                                                     !of_now && generation == LayerGeneration::reproject};
            std::vector<counterpart::SecondLayer>& layer = expected.emplace_back();
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    layer.push_back(counterpart::second_layer(now, comparison, separation, {x, y}));
                    ambiguous += layer.back().ambiguous;
                    exact += !layer.back().ambiguous;
                    if (layer.back().ambiguous) continue;
                    const counterpart::SecondLayer peeled =
                        counterpart::second_layer(now, {now}, separation, {x, y}, glm::dvec2(0.0));
                    other_than_peeled += peeled.instance != layer.back().instance;
                }
            }
        }
        fmt::print("{}: {} pixels at edges left out, {} compared, of which {} show another surface than peeling\n",
                   to_string(generation), ambiguous, exact, other_than_peeled);
        EXPECT_LT(ambiguous, 0.02 * (ambiguous + exact)) << to_string(generation);
        if (generation == LayerGeneration::delay) {
            EXPECT_EQ(other_than_peeled, 0);
        } else {
            EXPECT_GT(other_than_peeled, 20) << to_string(generation) << ": the comparison must matter";
        }

        for (const LayerSelection selection : selections(context())) {
            Method method;
            method.gbuffer.generation = generation;
            method.gbuffer.layer_selection = selection;
            method.gbuffer.minimum_separation = separation;
            Pipeline pipeline(context(), scene, method, {.planes = {"layer2.depth"}}, width, height);
            int wrong = 0;
            for (int i = 0; i < frames; ++i) {
                const Frame frame = pipeline
                                        .render({.now = moment_of(first + i),
                                                 .previous = moment_of(first + i - 1),
                                                 .next = moment_of(first + i + 1)})
                                        .frame;
                for (int y = 0; y < height; ++y) {
                    for (int x = 0; x < width; ++x) {
                        const counterpart::SecondLayer& rule =
                            expected[static_cast<std::size_t>(i)][static_cast<std::size_t>(y) * width + x];
                        if (rule.ambiguous) continue;
                        const double depth = frame.plane("layer2.depth").at(x, y);
                        // Depth interpolated in float is good to 1e-5; a surface at 80 degrees makes five times that of
                        // the sub-pixel grid.
                        const bool right =
                            rule.instance < 0 ? std::isinf(depth) : std::abs(depth - rule.depth) < 1e-3 * rule.depth;
                        if (right || ++wrong > 5) continue;
                        ADD_FAILURE() << to_string(generation) << ", frame " << i << ", pixel (" << x << ", " << y
                                      << "): depth " << depth << " instead of " << rule.depth;
                    }
                }
            }
            EXPECT_EQ(wrong, 0) << to_string(generation);
        }
    }
}

}  // namespace
}  // namespace plumb
