// The temporal filter and the second layer: history that only the second layer of the frame before holds, and the
// filter of what the second layer itself receives.
#include <fmt/format.h>

#include "gl_test.h"
#include "temporal_walk.h"

namespace plumb {
namespace {

using TemporalFilterLayersTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(TemporalFilterLayersTest);

constexpr int width = 120, height = 90;

// What the walk shows at a frame rate at which something comes to light behind each object.
TemporalWalk fast_walk() {
    TemporalWalk walk(width, height);
    walk.step = 0.1;
    return walk;
}

// Weights of the frame before, of the walk's second to fourth frame.
std::vector<Frame> frames_of(GlContext& context, LayerGeneration generation, int layers) {
    const TemporalWalk walk = fast_walk();
    Method method = with_small_shadows({});
    method.gbuffer.minimum_separation = 0.05f;
    method.gbuffer.generation = generation;
    method.ao.temporal = {.alpha = 0.85f, .layers = layers};
    Pipeline pipeline(context, walk.scene, method, {.planes = {"ao.history_weight", "depth", "motion"}}, width, height);
    std::vector<Frame> frames;
    for (int i = 0; i < 4; ++i) {
        Frame frame = pipeline.render(walk.frame(i)).frame;
        if (i > 0) frames.push_back(std::move(frame));
    }
    return frames;
}

// Pixels whose point lay within the frame before, but not in its first layer, and those of them that find it in the
// second layer.
struct Disoccluded {
    int pixels = 0, found = 0;
    double share() const { return static_cast<double>(found) / pixels; }
};

Disoccluded count_disoccluded(GlContext& context, LayerGeneration generation) {
    const std::vector<Frame> one = frames_of(context, generation, 1), two = frames_of(context, generation, 2);
    Disoccluded count;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const Image &motion = one[i].plane("motion"), &depth = one[i].plane("depth");
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                if (std::isinf(depth.at(x, y))) continue;
                const double then_x = x + 0.5 + motion.at(x, y, 0), then_y = y + 0.5 + motion.at(x, y, 1);
                // A pixel from the border all four neighbours are in the image.
                const bool inside = then_x > 1.0 && then_y > 1.0 && then_x < width - 1.0 && then_y < height - 1.0;
                if (!inside || one[i].plane("ao.history_weight").at(x, y) > 0.1f * 0.85f) continue;
                ++count.pixels;
                count.found += two[i].plane("ao.history_weight").at(x, y) > 0.5f * 0.85f;
            }
        }
    }
    return count;
}

TEST_P(TemporalFilterLayersTest, WhatComesToLightIsFoundInTheSecondLayerHoweverItIsGenerated) {
    for (const LayerGeneration generation :
         {LayerGeneration::peel, LayerGeneration::predict, LayerGeneration::reproject}) {
        const Disoccluded count = count_disoccluded(context(), generation);
        fmt::print("{}: {} of {} pixels that come to light find their history in the second layer\n",
                   to_string(generation), count.found, count.pixels);
        EXPECT_GT(count.pixels, 200) << to_string(generation);
        // The rest hid behind two surfaces, or turned into view.
        EXPECT_GT(count.share(), 0.4) << to_string(generation);
    }
}

// What the second layer receives, for later bounces to gather, is filtered by its own points and history.
TEST_P(TemporalFilterLayersTest, TheSecondLayersLightAgreesWithItsCounterpart) {
    const std::vector<std::string> planes{"depth",
                                          "layer2.depth",
                                          "moving_instance",
                                          "layer2.moving_instance",
                                          "normal",
                                          "layer2.normal",
                                          "layer2.radiosity.of_frame",
                                          "layer2.radiosity",
                                          "layer2.radiosity.history_weight",
                                          "irradiance"};
    for (const int layers : {1, 2}) {
        SCOPED_TRACE(testing::Message() << layers << " layers of the frame before");
        const TemporalFilterSettings settings{
            .alpha = 0.85f, .reject_from = 0.02f, .reject_to = 0.2f, .layers = layers};
        const TemporalWalk walk = fast_walk();
        Method method = with_small_shadows({});
        method.gbuffer.minimum_separation = 0.05f;
        method.radiosity.bounces = 2;
        method.radiosity.samples = 8;
        method.radiosity.second_layer = SecondLayerIndirect::gather;
        method.radiosity.temporal = settings;
        Pipeline pipeline(context(), walk.scene, method, {.planes = planes}, width, height);
        std::optional<counterpart::RenderedFrame> before;
        for (int i = 0; i < 3; ++i) {
            const FrameRequest request = walk.frame(i);
            counterpart::RenderedFrame now{request.now.view, pipeline.render(request).frame,
                                           counterpart::motions_between(walk.scene, request.now, *request.previous)};
            const Image &result = now.planes.plane("layer2.radiosity"),
                        &of_frame = now.planes.plane("layer2.radiosity.of_frame"),
                        &weight = now.planes.plane("layer2.radiosity.history_weight");
            int surfaces = 0, with_history = 0, wrong = 0;
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    if (std::isinf(now.planes.plane("layer2.depth").at(x, y))) continue;
                    ++surfaces;
                    // The red channel stands for all.
                    counterpart::AccumulatedRange expected{{of_frame.at(x, y), 0.0}, {of_frame.at(x, y), 0.0}};
                    if (before) {
                        expected = accumulated_range(now, *before, of_frame, before->planes.plane("layer2.radiosity"),
                                                     settings, x, y, 1);
                    }
                    with_history += weight.at(x, y) > 0.0f;
                    // As for the first layer (temporal_filter_test.cpp).
                    wrong += !expected.holds(result.at(x, y), weight.at(x, y),
                                             1e-5 * std::max(1.0f, std::abs(result.at(x, y))));
                }
            }
            EXPECT_GT(surfaces, 1000);
            EXPECT_EQ(wrong, 0) << "frame " << i << ", of " << surfaces;
            if (i > 0) {
                EXPECT_GT(with_history, surfaces / 3) << "frame " << i;
            }
            before = std::move(now);
        }
    }
}

}  // namespace
}  // namespace plumb
