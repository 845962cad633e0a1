#include <algorithm>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "gl_test.h"
#include "rasterizer/gl_error.h"
#include "temporal_filter_run.h"
#include "temporal_walk.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using TemporalFilterTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(TemporalFilterTest);

constexpr int width = 120, height = 90;

Method method_with(const TemporalFilterSettings& settings) {
    Method method = with_small_shadows({});
    method.gbuffer.minimum_separation = 0.05f;
    method.ao.temporal = settings;
    return method;
}

const std::vector<std::string> planes_of_filter{
    "ao", "ao.of_frame", "ao.history_weight", "depth", "layer2.depth", "moving_instance", "normal"};

bool same_bits(const Image& a, const Image& b) { return std::ranges::equal(a.values(), b.values()); }

View slanted_view(int size) {
    return View(Camera::look_at("slanted", {1.0f, 2.0f, 3.0f}, {-2.0f, 0.5f, 1.0f}, 0.9f), size, size);
}

double variance(const std::vector<double>& values) {
    double sum = 0.0, squares = 0.0;
    for (const double value : values) sum += value;
    const double mean = sum / static_cast<double>(values.size());
    for (const double value : values) squares += (value - mean) * (value - mean);
    return squares / static_cast<double>(values.size() - 1);
}

TEST_P(TemporalFilterTest, VarianceOfIndependentNoiseFallsToTheGeometricSumOfSquares) {
    for (const float alpha : {0.5f, 0.85f, 0.95f}) {
        const View view = slanted_view(64);
        FilterRun run(context(), view, {.alpha = alpha});
        std::mt19937 generator(3);
        std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
        // After k frames the first one still has alpha^k: 1e-3 of it is left.
        const int settling = static_cast<int>(std::ceil(std::log(1e-3) / std::log(alpha)));
        std::vector<double> noisy, smooth;
        Image noise(64, 64, 1);
        for (int frame = 0; frame < settling + 60; ++frame) {
            for (float& value : noise.values()) value = uniform(generator);
            const Image result = run.next(noise);
            if (frame < settling || frame % 20 != 0) continue;
            for (const float value : noise.values()) noisy.push_back(value);
            for (const float value : result.values()) smooth.push_back(value);
        }
        const double expected = (1.0 - alpha) / (1.0 + alpha);
        // 3 frames of 4096 pixels: a variance is good to sqrt(2 / 12288) = 1.3 %, but for what is left of one frame in
        // another 20 later (0.36 at alpha = 0.95, in the mean and not across pixels); three of those and the bilinear
        // shares, which are 1e-4 off.
        EXPECT_NEAR(variance(smooth) / variance(noisy), expected, 0.05 * expected) << "alpha " << alpha;
    }
}

// Four frames of a walk, each against what the formula makes of the planes of the one before.
template <class Walk>
void expect_agreement(GlContext& context, const Walk& walk, const TemporalFilterSettings& settings) {
    const int columns = walk.at(0).view.width(), rows = walk.at(0).view.height();
    Pipeline pipeline(context, walk.scene, method_with(settings), {.planes = planes_of_filter}, columns, rows);
    std::optional<counterpart::RenderedFrame> before;
    for (int i = 0; i < 4; ++i) {
        const FrameRequest request = walk.frame(i);
        counterpart::RenderedFrame now{request.now.view, pipeline.render(request).frame,
                                       counterpart::motions_between(walk.scene, request.now, *request.previous)};
        const Image &result = now.planes.plane("ao"), &weight = now.planes.plane("ao.history_weight");
        const Image& of_frame = now.planes.plane("ao.of_frame");
        int with_history = 0, wrong = 0;
        for (int y = 0; y < rows; ++y) {
            for (int x = 0; x < columns; ++x) {
                counterpart::AccumulatedRange expected{{of_frame.at(x, y), 0.0}, {of_frame.at(x, y), 0.0}};
                if (before) {
                    expected = accumulated_range(now, *before, of_frame, before->planes.plane("ao"), settings, x, y);
                }
                with_history += weight.at(x, y) > 0.0f;
                if (i == 0) {
                    ASSERT_EQ(result.at(x, y), of_frame.at(x, y)) << x << ", " << y;
                }
                // Bilinear shares of places good to 3e-4 pixels, and sums of four products: within the range but for
                // float's last bits.
                if (expected.holds(result.at(x, y), weight.at(x, y), 1e-5) || ++wrong > 4) continue;
                ADD_FAILURE() << "frame " << i << ", pixel (" << x << ", " << y << "): " << result.at(x, y)
                              << " with weight " << weight.at(x, y) << ", expected " << expected.least.value << " to "
                              << expected.most.value << " with " << expected.least.weight << " to "
                              << expected.most.weight;
            }
        }
        EXPECT_EQ(wrong, 0) << "frame " << i;
        if (i == 0) {
            EXPECT_EQ(with_history, 0);
        } else {
            EXPECT_GT(with_history, columns * rows / 2) << "frame " << i;
        }
        before = std::move(now);
    }
}

const std::vector<TemporalFilterSettings> filters = {
    {.alpha = 0.85f},
    {.alpha = 0.95f, .layers = 2},
    {.alpha = 0.5f, .reject_from = 0.0f, .reject_to = 0.5f},
    {.alpha = 0.85f, .reject_from = 0.01f, .reject_to = 0.01f, .layers = 2},
    {.alpha = 0.92f, .rejection = HistoryRejection::mara2016},
    {.alpha = 0.85f, .rejection = HistoryRejection::mara2016, .reject_from = 0.04f, .reject_to = 0.04f, .layers = 2}};

TEST_P(TemporalFilterTest, AgreesWithItsCounterpartWhileCameraAndObjectsMove) {
    for (const TemporalFilterSettings& settings : filters)
        expect_agreement(context(), TemporalWalk(width, height), settings);
}

TEST_P(TemporalFilterTest, AgreesWithItsCounterpartAlongRandomWalks) {
    for (unsigned seed = 800; seed < 806; ++seed) {
        const RandomWalk walk(seed, 3000);
        SCOPED_TRACE(testing::Message() << walk.first);
        expect_agreement(context(), walk, filters[seed % filters.size()]);
    }
}

// A board that turns by 15 degrees a frame: the plane through a point of it is that of the frame before only with the
// normal of then. A point half a pixel (7 mm) aside would else be taken to be up to 2 mm off, ten times the limit here.
TEST_P(TemporalFilterTest, TurningSurfacesAreFoundWithTheNormalsThatTheyHad) {
    Scene scene;
    scene.materials.resize(1);
    Mesh board;
    board.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
    board.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes = {board};
    scene.instances.push_back({"board", 0, glm::mat4(1.0f)});
    Motion& motion = scene.instances[0].motion;
    motion.interpolation = MotionInterpolation::linear;
    const glm::vec3 axis(0.0f, 1.0f, 0.0f);
    motion.keys = {{.time = 0.0f, .rotation = glm::angleAxis(-0.8f, axis)},
                   {.time = 1.0f, .rotation = glm::angleAxis(0.8f, axis)}};
    const View view(Camera::look_at("front", {0.0f, 0.0f, 1.5f}, {0.0f, 0.0f, 0.0f}, 0.8f), width, height);
    const TemporalFilterSettings settings{.alpha = 0.85f, .reject_from = 0.0001f, .reject_to = 0.0003f};
    Method method = method_with(settings);
    method.gbuffer.layers = method.ao.layers = 1;
    Pipeline pipeline(context(), scene, method,
                      {.planes = {"ao", "ao.of_frame", "ao.history_weight", "depth", "moving_instance", "normal"}},
                      width, height);
    std::optional<counterpart::RenderedFrame> before;
    for (int i = 0; i < 4; ++i) {
        const Moment previous{view, 0.2 + 0.16 * (i - 1)}, moment{view, 0.2 + 0.16 * i};
        counterpart::RenderedFrame now{view, pipeline.render({.now = moment, .previous = previous}).frame,
                                       counterpart::motions_between(scene, moment, previous)};
        int found = 0, kept = 0, wrong = 0;
        for (int y = 0; y < height && before; ++y) {
            for (int x = 0; x < width; ++x) {
                const double weight = now.planes.plane("ao.history_weight").at(x, y);
                const counterpart::AccumulatedRange expected = accumulated_range(
                    now, *before, now.planes.plane("ao.of_frame"), before->planes.plane("ao"), settings, x, y);
                found += expected.most.weight > 0.0;
                kept += weight > 0.84;
                wrong += !expected.holds(now.planes.plane("ao").at(x, y), weight, 1e-5);
            }
        }
        if (before) {
            EXPECT_EQ(wrong, 0) << "frame " << i;
            EXPECT_GT(found, width * height / 2) << "frame " << i;
            EXPECT_GT(kept, found * 9 / 10) << "frame " << i;
        }
        before = std::move(now);
    }
}

TEST_P(TemporalFilterTest, RadiosityIsFilteredByTheSameRule) {
    TemporalFilterSettings settings{.alpha = 0.85f};
    Method method = method_with({});
    method.radiosity.temporal = settings;
    const TemporalWalk walk(width, height);
    Pipeline pipeline(context(), walk.scene, method,
                      {.planes = {"irradiance", "radiosity.of_frame", "radiosity.history_weight", "depth",
                                  "moving_instance", "normal"}},
                      width, height);
    std::optional<counterpart::RenderedFrame> before;
    for (int i = 0; i < 3; ++i) {
        const FrameRequest request = walk.frame(i);
        counterpart::RenderedFrame now{request.now.view, pipeline.render(request).frame,
                                       counterpart::motions_between(walk.scene, request.now, *request.previous)};
        int wrong = 0;
        for (int y = 0; y < height && before; ++y) {
            for (int x = 0; x < width; ++x) {
                // The red channel stands for all.
                const counterpart::AccumulatedRange expected =
                    accumulated_range(now, *before, now.planes.plane("radiosity.of_frame"),
                                      before->planes.plane("irradiance"), settings, x, y);
                const float irradiance = now.planes.plane("irradiance").at(x, y);
                wrong += !expected.holds(irradiance, now.planes.plane("radiosity.history_weight").at(x, y),
                                         1e-5 * std::max(1.0f, irradiance));
            }
        }
        EXPECT_EQ(wrong, 0) << "frame " << i;
        before = std::move(now);
    }
}

// Taps that stay the same bring the same light in every frame, of which any average is that light: through every bounce
// of both layers, and where light is carried from frame to frame.
TEST_P(TemporalFilterTest, FilteringWhatStaysTheSameChangesNothing) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[0], 64, 48);
    for (const bool carry : {false, true}) {
        Method plain = method_with({});
        plain.gbuffer.guard_band = 8;
        plain.radiosity.samples = 8;
        plain.radiosity.carry = carry;
        if (carry) plain.radiosity.damping = 0.5f;
        plain.radiosity.bounces = carry ? 1 : 2;
        plain.radiosity.second_layer = SecondLayerIndirect::gather;
        Method filtered = plain;
        filtered.radiosity.temporal = {.alpha = 0.5f, .layers = 2, .vary_taps = false};
        Pipeline expected(context(), scene, plain, {.planes = {"irradiance"}}, 64, 48);
        Pipeline pipeline(context(), scene, filtered, {.planes = {"irradiance"}}, 64, 48);
        // Of what is carried and of what is filtered less than half comes anew with every frame: after 14 frames
        // neither changes by a thousandth any more.
        const int frames = carry ? 14 : 3;
        Image a, b;
        for (int i = 0; i < frames; ++i) {
            a = expected.render(view).frame.plane("irradiance");
            b = pipeline.render(view).frame.plane("irradiance");
        }
        double largest = 0.0, difference = 0.0;
        for (std::size_t i = 0; i < a.values().size(); ++i) {
            largest = std::max<double>(largest, a.values()[i]);
            difference = std::max<double>(difference, std::abs(a.values()[i] - b.values()[i]));
        }
        EXPECT_GT(largest, 0.0);
        // Places are 1e-4 pixels off, of the light of neighbours.
        EXPECT_LT(difference, 2e-3 * largest) << "carry " << carry;
    }
}

TEST_P(TemporalFilterTest, AfterACutTheFrameIsThatOfAFreshPipelineBitForBit) {
    const TemporalWalk walk(width, height);
    Method method = method_with({.alpha = 0.9f});
    method.radiosity.temporal.alpha = 0.9f;
    const Quantities quantities{.planes = {"ao", "irradiance"}};
    Pipeline pipeline(context(), walk.scene, method, quantities, width, height);
    for (int i = 0; i < 3; ++i) pipeline.render(walk.frame(i));
    for (const FrameRequest& cut : {walk.frame(20), FrameRequest{.now = walk.at(5)}}) {
        Pipeline fresh(context(), walk.scene, method, quantities, width, height);
        const Frame after = pipeline.render(cut).frame, first = fresh.render(cut).frame;
        for (const std::string& plane : quantities.planes)
            EXPECT_TRUE(same_bits(after.plane(plane), first.plane(plane))) << plane;
    }
}

TEST_P(TemporalFilterTest, TapsVaryFromFrameToFrameAndRepeatAfterACut) {
    const Scene scene = make_clutter();
    const View view(scene.cameras[0], width, height), other(scene.cameras[1], width, height);
    const Quantities quantities{.planes = {"ao.of_frame"}};
    const auto frames = [&](Pipeline& pipeline) {
        std::vector<Image> images;
        images.reserve(3);
        for (int i = 0; i < 3; ++i) images.push_back(pipeline.render(view).frame.plane("ao.of_frame"));
        return images;
    };
    for (const bool vary : {true, false}) {
        Method method = method_with({.alpha = 0.85f, .vary_taps = vary});
        // Noise as it is.
        method.ao.blur.radius = 0;
        Pipeline pipeline(context(), scene, method, quantities, width, height);
        const std::vector<Image> first = frames(pipeline);
        pipeline.render(other);
        const std::vector<Image> again = frames(pipeline);
        EXPECT_EQ(same_bits(first[0], first[1]), !vary);
        EXPECT_EQ(same_bits(first[1], first[2]), !vary);
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(same_bits(first[i], again[i])) << "frame " << i;
    }
    // The first frame is that of a method without a filter.
    Method plain = method_with({});
    plain.ao.blur.radius = 0;
    Method varying = method_with({.alpha = 0.85f});
    varying.ao.blur.radius = 0;
    const Image unfiltered =
        Pipeline(context(), scene, plain, {.planes = {"ao"}}, width, height).render(view).frame.plane("ao");
    EXPECT_TRUE(same_bits(
        unfiltered,
        Pipeline(context(), scene, varying, {.planes = {"ao"}}, width, height).render(view).frame.plane("ao")));
}

// Turns by the golden ratio are spread more evenly than independent ones, so that the variance falls further.
TEST_P(TemporalFilterTest, InAStillViewTheVarianceOfAoFallsAtLeastAsForIndependentFrames) {
    const Scene scene = make_clutter();
    const View view(scene.cameras[0], width, height);
    Method method = method_with({.alpha = 0.85f});
    method.ao.blur.radius = 0;
    Pipeline pipeline(context(), scene, method, {.planes = {"ao", "ao.of_frame"}}, width, height);
    constexpr int settling = 43, counted = 30;  // 0.85^43 = 1e-3
    std::vector<std::vector<double>> noisy(std::size_t{width} * height), smooth(std::size_t{width} * height);
    for (int i = 0; i < settling + counted; ++i) {
        const Frame frame = pipeline.render(view).frame;
        if (i < settling) continue;
        for (std::size_t pixel = 0; pixel < noisy.size(); ++pixel) {
            noisy[pixel].push_back(frame.plane("ao.of_frame").pixel(pixel % width, pixel / width)[0]);
            smooth[pixel].push_back(frame.plane("ao").values()[pixel]);
        }
    }
    double of_noisy = 0.0, of_smooth = 0.0;
    for (std::size_t pixel = 0; pixel < noisy.size(); ++pixel)
        of_noisy += variance(noisy[pixel]), of_smooth += variance(smooth[pixel]);
    const double ratio = of_smooth / of_noisy, independent = 0.15 / 1.85;
    fmt::print("variance over time falls to {:.4f}; of independent frames to {:.4f}\n", ratio, independent);
    RecordProperty("ratio", fmt::format("{:.4f}", ratio));
    EXPECT_GT(of_noisy, 0.0);
    // 10 000 pixels with some 3 independent values each: good to 1 %.
    EXPECT_LT(ratio, 1.05 * independent);
}

// What moves is found again: the pixels that show the turning object, but for its outline and what has just come to
// light.
TEST_P(TemporalFilterTest, MovingObjectsKeepTheirHistoryHoweverTheLayersAreGenerated) {
    for (const LayerGeneration generation : {LayerGeneration::peel, LayerGeneration::delay, LayerGeneration::previous,
                                             LayerGeneration::predict, LayerGeneration::reproject}) {
        const bool is_default = generation == LayerGeneration::peel;
        for (const int layers : is_default ? std::vector{1, 2} : std::vector{2}) {
            const TemporalWalk walk(width, height);
            Method method = method_with({.alpha = 0.85f, .layers = layers});
            method.gbuffer.generation = generation;
            Pipeline pipeline(context(), walk.scene, method, {.planes = planes_of_filter}, width, height);
            int on_object = 0, kept = 0;
            for (int i = 0; i < 4; ++i) {
                const Frame frame = pipeline.render(walk.frame(i)).frame;
                if (i == 0) continue;
                for (int y = 0; y < height; ++y) {
                    for (int x = 0; x < width; ++x) {
                        if (frame.plane("moving_instance").at(x, y) == 0.0f) continue;
                        ++on_object;
                        kept += frame.plane("ao.history_weight").at(x, y) > 0.5f * 0.85f;
                    }
                }
            }
            const double share = static_cast<double>(kept) / on_object;
            fmt::print("{}, {} layers: {:.3f} of {} pixels on moving objects keep their history\n",
                       to_string(generation), layers, share, on_object);
            EXPECT_GT(on_object, 300);
            // The rest: outlines, one pixel wide in objects of some 30, and sides that turn into view.
            EXPECT_GT(share, 0.75) << to_string(generation);
        }
    }
}

TEST_P(TemporalFilterTest, NothingIsAllocatedAfterTheFirstFrame) {
    const TemporalWalk walk(width, height);
    Method method = method_with({.alpha = 0.9f, .layers = 2});
    method.radiosity.temporal.alpha = 0.9f;
    Pipeline pipeline(context(), walk.scene, method, {.planes = {"ao", "irradiance"}}, width, height);
    pipeline.time_passes(walk.frame(0));
    const std::size_t bytes = context().allocated_bytes();
    for (int i = 1; i < 4; ++i) pipeline.time_passes(walk.frame(i));
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

// The history reaches as far as the plane was made: to the image's border with a guard band that ao is not made in, and
// as well where direct light reads it there.
TEST_P(TemporalFilterTest, AGuardBandChangesNothingInAStillView) {
    const Scene scene = make_clutter();
    const View view(scene.cameras[0], width, height);
    for (const bool whole : {false, true}) {
        Method banded = method_with({.alpha = 0.85f});
        banded.gbuffer.guard_band = 20;
        Pipeline pipeline(context(), scene, banded,
                          {.planes = whole ? std::vector<std::string>{"ao.history_weight", "direct", "ao"}
                                           : std::vector<std::string>{"ao.history_weight", "ao"}},
                          width, height);
        pipeline.render(view);
        const Frame frame = pipeline.render(view).frame;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const float weight = frame.plane("ao.history_weight").at(x, y);
                // Background has none. 1e-3: rounding of the place between pixels.
                if (weight != 0.0f) {
                    ASSERT_NEAR(weight, 0.85f, 1e-3f) << x << ", " << y;
                }
            }
        }
    }
}

// Layers that are handed in keep what they held, too.
TEST_P(TemporalFilterTest, LayersFromTheTruthHaveAHistory) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[0], 64, 48);
    const Quantities planes_of_truth{.planes = {"depth", "normal", "layer2.depth", "layer2.normal"}};
    Pipeline rendering(context(), scene, method_with({}), planes_of_truth, 64, 48);
    const Frame truth = rendering.render(view).frame;
    for (const int layers : {1, 2}) {
        Method method = method_with({.alpha = 0.85f, .layers = layers});
        method.gbuffer.source = SourceOfStage::truth;
        Pipeline pipeline(context(), scene, method, {.planes = {"ao", "ao.history_weight"}}, 64, 48);
        const Frame first = pipeline.render(view, nullptr, &truth).frame;
        const Frame second = pipeline.render(view, nullptr, &truth).frame;
        for (std::size_t i = 0; i < std::size_t{64} * 48; ++i) {
            ASSERT_EQ(first.plane("ao.history_weight").values()[i], 0.0f);
            const bool background = std::isinf(truth.plane("depth").values()[i]);
            // 1e-3: rounding of the place between pixels.
            ASSERT_NEAR(second.plane("ao.history_weight").values()[i], background ? 0.0f : 0.85f, 1e-3f) << i;
        }
    }
}

TEST_P(TemporalFilterTest, ParametersOutOfRangeAreRefused) {
    const Scene scene = make_cornell();
    const auto message = [&](const Method& method, const std::string& plane = "ao") -> std::string {
        try {
            Pipeline(context(), scene, method, {.planes = {plane}}, 32, 32);
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(message(method_with({.alpha = 1.0f})), HasSubstr("ao.temporal.alpha is 1"));
    EXPECT_THAT(message(method_with({.alpha = 0.5f, .reject_from = 0.1f, .reject_to = 0.05f})),
                HasSubstr("ao.temporal.reject_from is 0.1"));
    EXPECT_THAT(message(method_with({.alpha = 0.5f, .layers = 3})), HasSubstr("ao.temporal.layers is 3"));
    EXPECT_THAT(message(method_with({}), "ao.history_weight"), HasSubstr("ao.temporal.alpha is 0"));
    Method one_layer = method_with({.alpha = 0.5f, .layers = 2});
    one_layer.gbuffer.layers = 1, one_layer.ao.layers = 1;
    EXPECT_THAT(message(one_layer), HasSubstr("gbuffer.layers is 1"));
}

}  // namespace
}  // namespace plumb
