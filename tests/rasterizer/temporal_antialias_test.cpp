#include "rasterizer/temporal_antialias.h"

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "gl_test.h"
#include "rasterizer/gl_error.h"
#include "temporal_walk.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using TemporalAntialiasTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(TemporalAntialiasTest);

constexpr int width = 72, height = 54;

bool same_bits(const Image& a, const Image& b) { return std::ranges::equal(a.values(), b.values()); }

Method plain_method() {
    Method method = with_small_shadows({});
    method.gbuffer.minimum_separation = 0.05f;
    method.radiosity.enabled = false;  // for speed
    return method;
}

Method method_with(AntialiasSettings settings) {
    Method method = plain_method();
    settings.temporal = true;
    method.antialias = settings;
    return method;
}

double root_mean_square(const Image& a, const Image& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.values().size(); ++i)
        sum += std::pow(static_cast<double>(a.values()[i]) - b.values()[i], 2.0);
    return std::sqrt(sum / static_cast<double>(a.values().size()));
}

TEST(JitterOffsets, AreSpreadOverThePixelAboutItsCentre) {
    for (const int length : {1, 2, 8, 16, 100}) {
        const std::vector<glm::vec2> offsets = jitter_offsets({.temporal = true, .jitter_length = length});
        ASSERT_EQ(offsets.size(), static_cast<std::size_t>(length));
        glm::vec2 sum(0.0f);
        for (const glm::vec2& offset : offsets) {
            sum += offset;
            EXPECT_LT(std::max(std::abs(offset.x), std::abs(offset.y)), 0.75f);
        }
        EXPECT_LT(glm::length(sum), 1e-5f * static_cast<float>(length)) << length;  // rounding to float
    }
    // Halves, quarters and eighths; thirds and ninths: each once, in the order of mirrored digits.
    const std::vector<glm::vec2> offsets = jitter_offsets({.jitter_length = 3});
    EXPECT_NEAR(offsets[1].x - offsets[0].x, 0.25f - 0.5f, 1e-6f);
    EXPECT_NEAR(offsets[2].x - offsets[0].x, 0.75f - 0.5f, 1e-6f);
    EXPECT_NEAR(offsets[1].y - offsets[0].y, 2.0f / 3.0f - 1.0f / 3.0f, 1e-6f);
    EXPECT_NEAR(offsets[2].y - offsets[0].y, 1.0f / 9.0f - 1.0f / 3.0f, 1e-6f);
}

// All planes of a frame but `total` are those of the view with the frame's offset, whatever renders them.
TEST_P(TemporalAntialiasTest, EverythingIsRenderedWithTheMovedView) {
    const std::vector<std::string> planes{"depth", "normal",     "albedo",   "layer2.depth",  "position", "direct",
                                          "ao",    "irradiance", "indirect", "layer2.direct", "motion"};
    std::vector<std::string> with_total = planes;
    with_total.emplace_back("total");
    const Scene scene = make_clutter();
    const View view(scene.cameras[1], width, height);
    for (const auto& [guard_band, lights] :
         {std::pair{0, LocalLights::fullscreen}, std::pair{16, LocalLights::volume_stencil}}) {
        const AntialiasSettings settings{.temporal = true, .jitter_length = 3};
        Method moved = method_with(settings), plain = plain_method();
        for (Method* method : {&moved, &plain})
            method->gbuffer.guard_band = guard_band, method->direct.local_lights = lights,
            method->radiosity.enabled = true;
        Pipeline antialiased(context(), scene, moved, {.planes = with_total}, width, height);
        Pipeline pipeline(context(), scene, plain, {.planes = planes}, width, height);
        const std::vector<glm::vec2> offsets = jitter_offsets(settings);
        for (std::size_t i = 0; i < 4; ++i) {
            const Frame frame = antialiased.render(view).frame;
            const Frame expected = pipeline.render(view.with_offset(offsets[i % 3])).frame;
            for (const std::string& plane : planes) {
                // Motion is that of the surfaces and of the offset.
                if (plane == "motion" && i > 0) continue;
                EXPECT_TRUE(same_bits(frame.plane(plane), expected.plane(plane)))
                    << plane << ", frame " << i << ", guard band " << guard_band;
            }
            const glm::vec2 step = i == 0 ? glm::vec2(0.0f) : offsets[(i - 1) % 3] - offsets[i % 3];
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    // What stands still was seen at other pixel coordinates. 1e-4: rounding of coordinates to 100.
                    ASSERT_NEAR(frame.plane("motion").at(x, y, 0), -step.x, 1e-4f) << i;
                    ASSERT_NEAR(frame.plane("motion").at(x, y, 1), -step.y, 1e-4f) << i;
                }
            }
        }
    }
}

TEST_P(TemporalAntialiasTest, AStillViewConvergesToTheMeanOfItsMovedFrames) {
    const Scene scene = make_clutter();
    const View view(scene.cameras[1], width, height);
    const AntialiasSettings settings{.temporal = true, .jitter_length = 16, .alpha = 0.99f, .clamp = false};
    Pipeline antialiased(context(), scene, method_with(settings), {.planes = {"total"}}, width, height);
    Pipeline plain(context(), scene, plain_method(), {.planes = {"total"}}, width, height);
    Image mean(width, height, 3), resolved;
    for (const glm::vec2& offset : jitter_offsets(settings)) {
        resolved = antialiased.render(view).frame.plane("total");
        const Image single = plain.render(view.with_offset(offset)).frame.plane("total");
        for (std::size_t i = 0; i < mean.values().size(); ++i) mean.values()[i] += single.values()[i] / 16.0f;
    }
    // What is kept is looked up some 1e-5 pixels off, 15 times: 1e-4 of the difference of neighbouring pixels.
    double largest = 0.0;
    for (const float value : mean.values()) largest = std::max<double>(largest, value);
    for (std::size_t i = 0; i < mean.values().size(); ++i)
        ASSERT_NEAR(resolved.values()[i], mean.values()[i], 5e-4 * largest) << i;

    // And that is what many frames with all kinds of offsets give: within what 16 points leave of 1 point's error, a
    // quarter for points chosen at random.
    Image truth(width, height, 3);
    for (const glm::vec2& offset : jitter_offsets({.jitter_length = 64})) {
        const Image single = plain.render(view.with_offset(offset)).frame.plane("total");
        for (std::size_t i = 0; i < truth.values().size(); ++i) truth.values()[i] += single.values()[i] / 64.0f;
    }
    const Image aliased = plain.render(view).frame.plane("total");
    const double of_one = root_mean_square(aliased, truth), of_many = root_mean_square(resolved, truth);
    fmt::print("error of one frame {:.5f}, of the resolved image {:.5f}\n", of_one, of_many);
    EXPECT_LT(of_many, of_one / 4.0);
}

TEST_P(TemporalAntialiasTest, AStillViewIsSmootherThanOneFrameWithClampAndShortMemoryToo) {
    const Scene scene = make_clutter();
    const View view(scene.cameras[1], width, height);
    Pipeline plain(context(), scene, plain_method(), {.planes = {"total"}}, width, height);
    Image truth(width, height, 3);
    for (const glm::vec2& offset : jitter_offsets({.jitter_length = 48})) {
        const Image single = plain.render(view.with_offset(offset)).frame.plane("total");
        for (std::size_t i = 0; i < truth.values().size(); ++i) truth.values()[i] += single.values()[i] / 48.0f;
    }
    const double of_one = root_mean_square(plain.render(view).frame.plane("total"), truth);
    Pipeline antialiased(context(), scene, method_with({}), {.planes = {"total"}}, width, height);
    Image resolved;
    for (int i = 0; i < 40; ++i) resolved = antialiased.render(view).frame.plane("total");
    const double of_resolved = root_mean_square(resolved, truth);
    fmt::print("error of one frame {:.5f}, of the resolved image {:.5f}\n", of_one, of_resolved);
    // Eight offsets of unequal weight, and what the clamp takes off at thin things in frames that miss them.
    EXPECT_LT(of_resolved, 0.75 * of_one);
}

// Four frames of a walk, each against what the formula makes of the image before.
template <class Walk>
void expect_agreement(GlContext& context, const Walk& walk, const AntialiasSettings& settings) {
    const int columns = walk.at(0).view.width(), rows = walk.at(0).view.height();
    Pipeline pipeline(context, walk.scene, method_with(settings),
                      {.planes = {"total", "total.aliased", "depth", "moving_instance"}}, columns, rows);
    std::optional<counterpart::RenderedFrame> before;
    std::optional<counterpart::Resolved> history;
    const std::vector<glm::vec2> offsets = jitter_offsets(settings);
    for (std::size_t i = 0; i < 4; ++i) {
        const FrameRequest request = walk.frame(static_cast<int>(i));
        counterpart::RenderedFrame now{request.now.view.with_offset(offsets[i % offsets.size()]),
                                       pipeline.render(request).frame,
                                       counterpart::motions_between(walk.scene, request.now, *request.previous)};
        const counterpart::ResolvedRange expected =
            counterpart::resolved_range(now, before ? &*before : nullptr, history ? &*history : nullptr, settings);
        const Image& actual = now.planes.plane("total");
        int wrong = 0;
        for (std::size_t k = 0; k < actual.values().size(); ++k) {
            // The weights of sixteen pixels, in float, and the number of frames, looked up as well.
            const float rounding = 1e-4f * std::max(1.0f, actual.values()[k]);
            wrong += !(actual.values()[k] >= expected.least.values()[k] - rounding &&
                       actual.values()[k] <= expected.most.values()[k] + rounding);
        }
        EXPECT_EQ(wrong, 0) << "frame " << i;
        // What the pass kept of the colours, so that its rounding is not held against it twice.
        history = counterpart::Resolved{actual, expected.exact.frames};
        before = std::move(now);
    }
}

const std::vector<AntialiasSettings> antialiasings = {
    {.temporal = true},
    {.temporal = true, .alpha = 0.7f, .clamp = false},
    {.temporal = true, .jitter_length = 3, .dilate = false, .lookup = HistoryLookup::bilinear},
    {.temporal = true, .reprojection = false},
    {.temporal = true, .reprojection = false, .clamp = false}};

TEST_P(TemporalAntialiasTest, AgreesWithItsCounterpartWhileCameraAndObjectsMove) {
    for (const AntialiasSettings& settings : antialiasings)
        expect_agreement(context(), TemporalWalk(width, height), settings);
}

TEST_P(TemporalAntialiasTest, AgreesWithItsCounterpartAlongRandomWalks) {
    for (unsigned seed = 900; seed < 900 + 2 * antialiasings.size(); ++seed) {
        const RandomWalk walk(seed, 3000);
        SCOPED_TRACE(testing::Message() << walk.first);
        expect_agreement(context(), walk, antialiasings[seed % antialiasings.size()]);
    }
}

// A room past which the camera turns by some pixels and a third a frame, which no lookup finds in a pixel's centre.
class TurningView {
public:
    explicit TurningView(GlContext& context) : context_(context) {
        Pipeline plain(context, scene_, plain_method(), {.planes = {"total"}}, width, height);
        for (const glm::vec2& offset : jitter_offsets({.jitter_length = 32})) {
            const Image single = plain.render(at(last_frame).view.with_offset(offset)).frame.plane("total");
            for (std::size_t i = 0; i < truth_.values().size(); ++i) truth_.values()[i] += single.values()[i] / 32.0f;
        }
        aliased_error_ = root_mean_square(plain.render(at(last_frame).view).frame.plane("total"), truth_);
    }

    double error_of(const AntialiasSettings& settings) const {
        Pipeline pipeline(context_, scene_, method_with(settings), {.planes = {"total"}}, width, height);
        Image resolved;
        for (int i = 1; i <= last_frame; ++i)
            resolved = pipeline.render({.now = at(i), .previous = at(i - 1)}).frame.plane("total");
        return root_mean_square(resolved, truth_);
    }
    double aliased_error() const { return aliased_error_; }

private:
    static constexpr int last_frame = 20;

    Moment at(int frame) const {
        Camera camera = scene_.cameras[1];
        const float angle = 0.0037f * static_cast<float>(frame), c = std::cos(angle), s = std::sin(angle);
        const glm::mat4 turn(glm::vec4(c, 0, -s, 0), glm::vec4(0, 1, 0, 0), glm::vec4(s, 0, c, 0),
                             glm::vec4(0, 0, 0, 1));
        camera.world_from_camera = camera.world_from_camera * turn;
        return Moment{View(camera, width, height)};
    }

    GlContext& context_;
    Scene scene_ = make_clutter();
    Image truth_{width, height, 3};
    double aliased_error_ = 0.0;
};

TEST_P(TemporalAntialiasTest, CatmullRomKeepsMoreOfAMovingImageThanBilinearLookup) {
    const TurningView turning(context());
    const double bilinear = turning.error_of({.lookup = HistoryLookup::bilinear});
    const double catmull_rom = turning.error_of({.lookup = HistoryLookup::catmull_rom});
    fmt::print("error of a turning view: bilinear {:.5f}, Catmull-Rom {:.5f}\n", bilinear, catmull_rom);
    EXPECT_LT(catmull_rom, bilinear);
}

// What is averaged at the same pixel is smeared over all that passed there, so that it is worse than no average.
TEST_P(TemporalAntialiasTest, WithoutReprojectionAMovingImageSmears) {
    const TurningView turning(context());
    const double followed = turning.error_of({.clamp = false});
    const double smeared = turning.error_of({.reprojection = false, .clamp = false});
    fmt::print("error of a turning view: one frame {:.5f}, reprojected {:.5f}, not reprojected {:.5f}\n",
               turning.aliased_error(), followed, smeared);
    EXPECT_LT(followed, turning.aliased_error());
    EXPECT_GT(smeared, turning.aliased_error());
}

TEST_P(TemporalAntialiasTest, WithoutReprojectionNothingIsKeptOfTheMotionOfThings) {
    const TemporalWalk walk(width, height);
    const auto bytes = [&](const Method& method) {
        return Pipeline(context(), walk.scene, method, {.planes = {"total"}}, width, height).gbuffer_bytes_per_pixel();
    };
    EXPECT_EQ(bytes(method_with({.reprojection = false})), bytes(plain_method()));
    EXPECT_GT(bytes(method_with({})), bytes(plain_method()));
}

TEST_P(TemporalAntialiasTest, AfterACutTheFrameIsThatOfAFreshPipelineBitForBit) {
    const TemporalWalk walk(width, height);
    const Method method = method_with({});
    const Quantities quantities{.planes = {"total", "motion", "depth"}};
    Pipeline pipeline(context(), walk.scene, method, quantities, width, height);
    for (int i = 0; i < 3; ++i) pipeline.render(walk.frame(i));
    Pipeline fresh(context(), walk.scene, method, quantities, width, height);
    const Frame after = pipeline.render(walk.frame(20)).frame, first = fresh.render(walk.frame(20)).frame;
    for (const std::string& plane : quantities.planes)
        EXPECT_TRUE(same_bits(after.plane(plane), first.plane(plane))) << plane;
}

// The second layer is compared with a depth that the frame before drew: with this frame's offset, for those that look
// ahead.
TEST_P(TemporalAntialiasTest, DelayStaysExactWithMovedViews) {
    const TemporalWalk walk(width, height);
    Method delayed = method_with({}), peeled = delayed;
    delayed.gbuffer.generation = LayerGeneration::delay;
    delayed.gbuffer.layer_selection = LayerSelection::vertex_shader;
    const Quantities quantities{.planes = {"total", "layer2.depth"}};
    if (!context().info().has_extension("GL_ARB_shader_viewport_layer_array"))
        GTEST_SKIP() << "this OpenGL lacks GL_ARB_shader_viewport_layer_array";
    Pipeline delay(context(), walk.scene, delayed, quantities, width, height);
    Pipeline peel(context(), walk.scene, peeled, quantities, width, height);
    for (const int i : {0, 1, 2, 10, 11}) {
        const Image a = delay.render(walk.frame(i)).frame.plane("layer2.depth");
        const Image b = peel.render(walk.frame(i)).frame.plane("layer2.depth");
        int wrong = 0;
        for (std::size_t k = 0; k < a.values().size(); ++k) wrong += !(a.values()[k] == b.values()[k]);
        // A GPU may round positions of another program otherwise.
        EXPECT_LE(wrong, context().info().software ? 0 : width * height / 1000) << "frame " << i;
    }
}

TEST_P(TemporalAntialiasTest, NothingIsMovedWhereNobodyReadsTheResolvedImage) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[0], width, height);
    Pipeline pipeline(context(), scene, method_with({}), {.planes = {"ao", "depth"}}, width, height);
    Pipeline plain(context(), scene, plain_method(), {.planes = {"ao", "depth"}}, width, height);
    const Frame expected = plain.render(view).frame;
    for (int i = 0; i < 3; ++i) {
        const Frame frame = pipeline.render(view).frame;
        for (const char* plane : {"ao", "depth"}) EXPECT_TRUE(same_bits(frame.plane(plane), expected.plane(plane)));
    }
}

TEST_P(TemporalAntialiasTest, NothingIsAllocatedAfterTheFirstFrame) {
    const TemporalWalk walk(width, height);
    Pipeline pipeline(context(), walk.scene, method_with({}), {.planes = {"total"}}, width, height);
    pipeline.time_passes(walk.frame(0));
    const std::size_t bytes = context().allocated_bytes();
    for (int i = 1; i < 4; ++i) pipeline.time_passes(walk.frame(i));
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

TEST_P(TemporalAntialiasTest, ParametersThatCannotBeCombinedAreRefused) {
    const Scene scene = make_cornell();
    const auto message = [&](const Method& method) -> std::string {
        try {
            Pipeline(context(), scene, method, {.planes = {"total"}}, 32, 32);
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(message(method_with({.jitter_length = 0})), HasSubstr("antialias.jitter_length is 0"));
    EXPECT_THAT(message(method_with({.alpha = 1.0f})), HasSubstr("antialias.alpha is 1"));
    Method true_direct = method_with({});
    true_direct.direct.source = SourceOfStage::truth;
    EXPECT_THAT(message(true_direct), HasSubstr("antialias.temporal moves the view"));
}

// The maps of a view with an offset are those of the view without one, displaced.
TEST(ViewOffset, MovesPixelsOverTheImagePlane) {
    const View view(Camera::look_at("slanted", {1.0f, 2.0f, 3.0f}, {-2.0f, 0.5f, 1.0f}, 0.9f), 64, 48);
    const glm::vec2 offset(0.3f, -0.4f);
    for (const int guard_band : {0, 7}) {
        const View plain = view.with_guard_band(guard_band),
                   moved = view.with_offset(offset).with_guard_band(guard_band);
        EXPECT_EQ(moved.offset(), offset);
        for (const glm::vec2 p : {glm::vec2(0.5f, 0.5f), glm::vec2(30.5f, 12.5f), glm::vec2(63.0f, 47.0f)}) {
            const glm::vec3 expected = plain.camera_space_point(p.x + offset.x, p.y + offset.y, 2.5f);
            const glm::vec3 point = moved.camera_space_point(p.x, p.y, 2.5f);
            EXPECT_LT(glm::length(point - expected), 1e-6f);
            const glm::vec3 world(moved.camera().world_from_camera * glm::vec4(point, 1.0f));
            // Pixel coordinates up to 80 are good to 1e-5.
            EXPECT_LT(glm::length(glm::vec2(moved.project(world)) - p), 5e-5f);
            const glm::vec4 clip = moved.clip_from_camera() * glm::vec4(point, 1.0f);
            const glm::vec2 size(static_cast<float>(moved.width()), static_cast<float>(moved.height()));
            const glm::vec2 ndc = glm::vec2(clip) / clip.w;
            EXPECT_NEAR(0.5f * (ndc.x + 1.0f) * size.x, p.x, 5e-5f);
            EXPECT_NEAR(0.5f * (1.0f - ndc.y) * size.y, p.y, 5e-5f);
        }
    }
}

}  // namespace
}  // namespace plumb
