#include "rasterizer/pipeline.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "gl_test.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/passes.h"
#include "scenes/builtin.h"
#include "tests/busy_scene.h"

namespace plumb {
namespace {

using testing::HasSubstr;
using PipelineTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(PipelineTest);

Quantities planes(std::vector<std::string> names) {
    Quantities quantities;
    quantities.planes = std::move(names);
    return quantities;
}

Method small_method() {
    Method method;
    method.direct.shadow.emitter_size = 256;
    return method;
}

const PassDecision& decision(const std::vector<PassDecision>& decisions, const std::string& pass) {
    const auto found = std::ranges::find(decisions, pass, &PassDecision::pass);
    if (found == decisions.end()) throw std::out_of_range("no decision about " + pass);
    return *found;
}

// Small maps, few taps, and all that takes planes: each method by what is special about it.
std::vector<std::pair<const char*, Method>> methods_of_many_planes() {
    Method everything;
    ShadowSettings& shadow = everything.direct.shadow;
    shadow.cube_size = shadow.emitter_size = shadow.paraboloid_size = 32;
    shadow.map_size = 64;
    everything.environment = {.size = 32, .samples = 4};
    everything.probe = {.y = 1.0f, .size = 32};
    everything.ao.samples = everything.radiosity.samples = 5;
    everything.ao.temporal.alpha = everything.radiosity.temporal.alpha = 0.85f;
    everything.ao.blur.depth_key_bits = 16;
    everything.radiosity.bounces = 3;
    everything.radiosity.second_layer = SecondLayerIndirect::gather;
    everything.radiosity.mip_normals_and_radiance = true;
    everything.radiosity.fill = AmbientSource::probe;
    everything.reflections = {.enabled = true, .fallback = ReflectionFallback::probe};
    everything.direct.local_lights = LocalLights::volume_stencil;
    everything.direct.environment = EnvironmentIrradiance::cube;
    everything.antialias.temporal = true;
    std::vector<std::pair<const char*, Method>> methods = {{"everything", everything}};
    const auto add = [&](const char* name, const auto& change) {
        methods.emplace_back(name, everything);
        change(methods.back().second);
    };
    add("a guard band around stored positions", [](Method& m) {
        m.gbuffer.guard_band = 9;
        m.gbuffer.position = PositionSource::stored;
        m.ao.temporal.layers = m.radiosity.temporal.layers = 2;
        m.reflections.roughness = ReflectionRoughness::samples;
        m.reflections.samples = 3;
    });
    add("light carried on, one pass", [](Method& m) {
        m.gbuffer.guard_band = 5;
        m.gbuffer.generation = LayerGeneration::reproject;
        m.radiosity.bounces = 1;
        m.radiosity.carry = true;
        m.radiosity.blur.radius = 0;
        m.radiosity.temporal.alpha = 0.0f;
        m.radiosity.fill = AmbientSource::none;
        m.composite = {.kind = CompositeKind::demo, .fill = AmbientSource::environment};
    });
    add("wide formats", [](Method& m) {
        m.gbuffer.normal_format = NormalFormat::rgb32f;
        m.gbuffer.radiance_format = RadianceFormat::rgba32f;
        m.gbuffer.generation = LayerGeneration::delay;
        m.ao.temporal.alpha = 0.0f;
    });
    add("narrow formats, no chains", [](Method& m) {
        m.gbuffer.normal_format = NormalFormat::xy8;
        m.gbuffer.radiance_format = RadianceFormat::r11g11b10f;
        m.ao.use_mip_chain = m.radiosity.use_mip_chain = m.radiosity.mip_normals_and_radiance = false;
        m.radiosity.blur.kind = BlurKind::gaussian_2015;
        m.radiosity.second_layer = SecondLayerIndirect::reuse;
        m.antialias.temporal = false;
    });
    return methods;
}

template <typename Action>
std::string method_error(const Action& action) {
    try {
        action();
    } catch (const MethodError& error) {
        return error.what();
    }
    return "no error";
}

TEST_P(PipelineTest, PassesThatNobodyReadsDoNotRunAndDoNotAllocate) {
    const Scene scene = make_cornell();
    const std::size_t before = context().allocated_bytes();
    std::size_t for_depth = 0, for_total = 0;
    {
        Pipeline pipeline(context(), scene, small_method(), planes({"depth"}), 64, 64);
        for_depth = context().allocated_bytes() - before;
        for (const PassDecision& pass : pipeline.decisions()) {
            EXPECT_EQ(pass.runs, pass.pass == "gbuffer") << pass.pass << ": " << pass.reason;
            EXPECT_FALSE(pass.reason.empty()) << pass.pass;
        }
        const RasterResult result = pipeline.render(View(scene.cameras[0], 64, 64));
        ASSERT_EQ(result.timings.size(), 1u);
        EXPECT_EQ(result.timings[0].pass, "gbuffer");
        EXPECT_EQ(result.frame.plane_names(), std::vector<std::string>{"depth"});
    }
    EXPECT_EQ(context().allocated_bytes(), before) << "a pipeline gives back all it took";
    {
        Pipeline pipeline(context(), scene, small_method(), planes({"total"}), 64, 64);
        for_total = context().allocated_bytes() - before;
        EXPECT_TRUE(decision(pipeline.decisions(), "shadows").runs);
        EXPECT_TRUE(decision(pipeline.decisions(), "radiosity").runs);
        EXPECT_FALSE(decision(pipeline.decisions(), "motion").runs);
        EXPECT_FALSE(decision(pipeline.decisions(), "ambient obscurance").runs);
        EXPECT_THAT(decision(pipeline.decisions(), "motion").reason, HasSubstr("nobody reads motion"));
        EXPECT_THAT(decision(pipeline.decisions(), "gbuffer.truth").reason, HasSubstr("gbuffer.source is \"method\""));
    }
    EXPECT_LT(for_depth, 40'000u);  // depth and depth buffer of 64 x 64: 32 KiB, and the scene's 32 triangles
    EXPECT_GT(for_total, 10 * for_depth);
}

TEST_P(PipelineTest, OneLayerIsEnoughWhereNobodyReadsTheSecond) {
    const Scene scene = make_cornell();
    Method method = small_method();
    method.ao.layers = 1;
    Pipeline pipeline(context(), scene, method, planes({"ao", "direct"}), 32, 32);
    EXPECT_FALSE(decision(pipeline.decisions(), "gbuffer.layer2").runs);
    EXPECT_FALSE(decision(pipeline.decisions(), "direct.layer2").runs);
}

TEST_P(PipelineTest, FramesAllocateNothingAndRepeatBitForBit) {
    const Scene scene = make_cornell();
    Pipeline pipeline(context(), scene, small_method(), planes({"total", "ao", "motion", "layer2.direct"}), 48, 48);
    const View view(scene.cameras[0], 48, 48), other(scene.cameras[1], 48, 48);
    const RasterResult first = pipeline.render(view);
    const std::size_t bytes = context().allocated_bytes();
    pipeline.render(other, &view);
    const RasterResult again = pipeline.render(view);
    EXPECT_EQ(context().allocated_bytes(), bytes);
    for (const std::string& plane : first.frame.plane_names()) {
        EXPECT_TRUE(std::ranges::equal(first.frame.plane(plane).values(), again.frame.plane(plane).values())) << plane;
    }
}

TEST_P(PipelineTest, TwoLayersAt720LinesStayBelow400MebibytesWithEveryStageOn) {
    const Scene scene = make_builtin_scene("colonnade");
    const std::size_t before = context().allocated_bytes();
    const auto mebibytes = [&](const Method& method, std::vector<std::string> names) {
        const Pipeline pipeline(context(), scene, method, planes(std::move(names)), 1280, 720);
        return static_cast<double>(context().allocated_bytes() - before) / (1024.0 * 1024.0);
    };
    EXPECT_LT(mebibytes(Method(), {"total", "ao"}), 400.0);

    Method everything;
    everything.ao.temporal.alpha = everything.radiosity.temporal.alpha = 0.85f;
    everything.radiosity.bounces = 2;
    everything.reflections.enabled = true;
    everything.antialias.temporal = true;
    EXPECT_LT(mebibytes(everything, {"total", "ao", "motion"}), 400.0);
}

TEST_P(PipelineTest, PipelinesOfSeveralSizesLiveSideBySide) {
    const Scene scene = make_cornell();
    Pipeline small(context(), scene, small_method(), planes({"depth", "direct"}), 32, 24);
    Pipeline large(context(), scene, small_method(), planes({"depth", "direct"}), 96, 72);
    const Image a = small.render(View(scene.cameras[0], 32, 24)).frame.plane("depth");
    const Image b = large.render(View(scene.cameras[0], 96, 72)).frame.plane("depth");
    // The centre of pixel (i, j) is that of pixel (3 i + 1, 3 j + 1) at three times the size; depth agrees but for
    // rounding.
    int different = 0;
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 32; ++x) {
            const float small_depth = a.at(x, y), large_depth = b.at(3 * x + 1, 3 * y + 1);
            different += !(small_depth == large_depth || std::abs(small_depth - large_depth) < 1e-4f * small_depth);
        }
    }
    EXPECT_LE(different, 4);  // pixels whose centre lies on an edge
    EXPECT_THAT(method_error([&] { small.render(View(scene.cameras[0], 96, 72)); }), HasSubstr("32x24"));
}

TEST_P(PipelineTest, TotalIsTheSumOfItsTerms) {
    const Scene scene = make_cornell();
    Pipeline pipeline(context(), scene, small_method(), planes({"total", "emission", "direct", "indirect"}), 64, 64);
    const Frame frame = pipeline.render(View(scene.cameras[0], 64, 64)).frame;
    double brightest_emission = 0.0;
    for (std::size_t i = 0; i < frame.plane("total").values().size(); ++i) {
        const float sum = frame.plane("emission").values()[i] + frame.plane("direct").values()[i] +
                          frame.plane("indirect").values()[i];
        // The sum becomes a half float; Mesa's software rasteriser cuts where others round: 2^-10 of it.
        ASSERT_NEAR(frame.plane("total").values()[i], sum, 1e-3f * sum + 1e-6f);
        brightest_emission = std::max(brightest_emission, static_cast<double>(frame.plane("emission").values()[i]));
    }
    EXPECT_NEAR(brightest_emission, 18.4, 0.01);
}

TEST_P(PipelineTest, TrueGBufferGivesTheSameLightAsTheRenderedOne) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[0], 64, 64);
    Method method = small_method();
    method.gbuffer.minimum_separation = 0.1f;
    Pipeline rendered(context(), scene, method,
                      planes({"depth", "normal", "albedo", "emission", "layer2.depth", "layer2.normal", "layer2.albedo",
                              "direct", "total", "layer2.direct", "ao"}),
                      64, 64);
    const Frame own = rendered.render(view).frame;
    method.gbuffer.source = SourceOfStage::truth;
    Pipeline fed(context(), scene, method, planes({"direct", "total", "layer2.direct", "ao"}), 64, 64);
    EXPECT_FALSE(decision(fed.decisions(), "gbuffer").runs);
    EXPECT_TRUE(decision(fed.decisions(), "gbuffer.truth").runs);
    const Frame from_truth = fed.render(view, nullptr, &own).frame;
    for (const std::string& plane : from_truth.plane_names()) {
        const auto a = own.plane(plane).values(), b = from_truth.plane(plane).values();
        int different = 0;
        for (std::size_t i = 0; i < a.size(); ++i) different += std::abs(a[i] - b[i]) > 2e-3f * std::max(1.0f, a[i]);
        // Normals are encoded twice, which may move a tap or a shadow's edge by a rounding.
        EXPECT_LE(different, static_cast<int>(a.size() / 500)) << plane;
    }
}

TEST_P(PipelineTest, TrueDirectLightFeedsTheRadiosity) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[0], 48, 48);
    Method method = small_method();
    method.direct.source = SourceOfStage::truth;
    method.radiosity.layers = 1;
    Pipeline pipeline(context(), scene, method, planes({"indirect", "direct"}), 48, 48);
    EXPECT_FALSE(decision(pipeline.decisions(), "direct").runs);
    EXPECT_FALSE(decision(pipeline.decisions(), "shadows").runs);
    Frame truth(48, 48);
    truth.set("direct", Image(48, 48, 3, 2.0f));
    const Frame bright = pipeline.render(view, nullptr, &truth).frame;
    truth.set("direct", Image(48, 48, 3, 1.0f));
    const Frame half_as_bright = pipeline.render(view, nullptr, &truth).frame;
    double sum = 0.0, half_sum = 0.0;
    for (const float value : bright.plane("indirect").values()) sum += value;
    for (const float value : half_as_bright.plane("indirect").values()) half_sum += value;
    EXPECT_GT(sum, 0.0);
    EXPECT_NEAR(half_sum / sum, 0.5, 1e-3);  // bounce light is linear; half floats round
    EXPECT_EQ(bright.plane("direct").at(24, 24), 2.0f);
}

TEST_P(PipelineTest, MissingTruthSaysWhichPlane) {
    const Scene scene = make_cornell();
    Method method = small_method();
    method.direct.source = SourceOfStage::truth;
    Pipeline pipeline(context(), scene, method, planes({"direct"}), 16, 16);
    EXPECT_THAT(method_error([&] { pipeline.render(View(scene.cameras[0], 16, 16)); }), HasSubstr("'direct'"));
    Frame wrong_size(8, 8);
    wrong_size.set("direct", Image(8, 8, 3));
    EXPECT_THAT(method_error([&] { pipeline.render(View(scene.cameras[0], 16, 16), nullptr, &wrong_size); }),
                HasSubstr("8x8"));
}

TEST_P(PipelineTest, ImpossibleMethodsSayWhatToChange) {
    const Scene scene = make_cornell();
    const auto make = [&](const Method& method, std::vector<std::string> wanted) {
        return method_error([&] { Pipeline(context(), scene, method, planes(std::move(wanted)), 16, 16); });
    };
    Method method = small_method();
    EXPECT_THAT(make(method, {"reflection"}), HasSubstr("'reflection'"));
    EXPECT_THAT(make(method, {"reflection"}), HasSubstr("depth, normal"));  // what there is
    method.ao.enabled = false;
    EXPECT_THAT(make(method, {"ao"}), HasSubstr("ao.enabled is false"));
    method = small_method();
    method.gbuffer.layers = 1;
    EXPECT_THAT(make(method, {"layer2.depth"}), HasSubstr("gbuffer.layers is 1"));
    EXPECT_THAT(make(method, {"ao"}), HasSubstr("gbuffer.layers is 1"));  // ao.layers is 2
    method.gbuffer.layers = 5;
    EXPECT_THAT(make(method, {"depth"}), HasSubstr("gbuffer.layers is 5"));
    method = small_method();
    method.gbuffer.source = SourceOfStage::truth;
    method.gbuffer.guard_band = 8;
    EXPECT_THAT(make(method, {"depth"}), HasSubstr("guard_band"));
    method = small_method();
    method.direct.shadow.emitter_samples = 64;
    method.direct.shadow.emitter_size = 4096;
    EXPECT_THAT(make(method, {"direct"}), HasSubstr("GiB"));

    GLint most = 0;  // OpenGL guarantees 8
    context().make_current();
    context().gl.GetIntegerv(GL_MAX_DRAW_BUFFERS, &most);
    if (most > 8) return;
    method = small_method();
    method.gbuffer.position = PositionSource::stored;
    EXPECT_THAT(make(method, {"depth", "normal", "albedo", "diffuse_albedo", "specular", "roughness", "emission",
                              "moving_instance", "camera_position"}),
                HasSubstr("9 planes at once"));
}

// Every screen-sized plane that some pass of the method reads.
std::vector<std::string> planes_within(const Scene& scene, const Method& method,
                                       const std::vector<std::string>& wanted) {
    const PassPlan plan = plan_passes(declare_passes(scene, method, planes(wanted)), wanted);
    std::vector<std::string> names;
    for (const std::string& plane : plan.read) {
        const bool is_map = plane.find("shadow") != std::string::npos || plane.starts_with("environment.") ||
                            plane.starts_with("probe.");
        if (!is_map) names.push_back(plane);
    }
    return names;
}

// Planes whose contents matter only within a frame share their memory; one that is asked for is alone in its own. So a
// frame of which everything is asked for is what a pipeline that shares nothing gives, in each that follows as well.
TEST_P(PipelineTest, PlanesThatShareTheirMemoryGiveTheSameBitsInLessOfIt) {
    constexpr int width = 60, height = 44, frames = 3;
    const Scene scene = make_busy_scene();
    const std::vector<std::string> wanted = {"total", "ao"};
    bool is_skipped = GetParam() == GlBackend::egl;
    for (const auto& [name, method] : methods_of_many_planes()) {
        SCOPED_TRACE(name);
        is_skipped = !is_skipped;  // the other one through the other kind of context: shaders take seconds to compile
        if (is_skipped) continue;
        const std::size_t before = context().allocated_bytes();
        Pipeline sharing(context(), scene, method, planes(wanted), width, height);
        const std::size_t shared = context().allocated_bytes() - before;
        Pipeline alone(context(), scene, method, planes(planes_within(scene, method, wanted)), width, height);
        const std::size_t unshared = context().allocated_bytes() - before - shared;
        EXPECT_LT(shared, unshared);
        for (int frame = 0; frame < frames; ++frame) {
            const Frame a = sharing.render(busy_frame(frame, width, height)).frame;
            const Frame b = alone.render(busy_frame(frame, width, height)).frame;
            for (const std::string& plane : wanted) {
                EXPECT_TRUE(std::ranges::equal(a.plane(plane).values(), b.plane(plane).values()))
                    << plane << ", frame " << frame;
            }
        }
    }
}

// The third and fourth layer are for those who ask for them; what reads two reads the same ones.
TEST_P(PipelineTest, FurtherLayersChangeNothingOfWhatTwoLayersGive) {
    constexpr int width = 60, height = 44;
    const Scene scene = make_busy_scene();
    const std::vector<std::string> compared = {"total", "ao", "indirect", "reflection", "layer2.depth"};
    for (const auto& [name, method] : methods_of_many_planes()) {
        SCOPED_TRACE(name);
        std::vector<std::string> all = compared;
        Pipeline two(context(), scene, method, planes(compared), width, height);
        std::vector<Frame> expected;
        expected.reserve(3);
        for (int frame = 0; frame < 3; ++frame) expected.push_back(two.render(busy_frame(frame, width, height)).frame);
        for (const int layers : {3, 4}) {
            Method deeper = method;
            deeper.gbuffer.layers = layers;
            all.push_back(fmt::format("layer{}.albedo", layers));
            const auto make = [&] {
                return std::make_unique<Pipeline>(context(), scene, deeper, planes(all), width, height);
            };
            if (method.gbuffer.generation != LayerGeneration::peel) {
                EXPECT_THAT(method_error(make), HasSubstr("which draws 2 layers"));
                continue;
            }
            const std::unique_ptr<Pipeline> pipeline = make();
            for (int i = 0; i < 3; ++i) {
                const Frame frame = pipeline->render(busy_frame(i, width, height)).frame;
                for (const std::string& plane : compared) {
                    EXPECT_TRUE(std::ranges::equal(frame.plane(plane).values(),
                                                   expected[static_cast<std::size_t>(i)].plane(plane).values()))
                        << plane << " of " << layers << " layers, frame " << i;
                }
            }
        }
    }
}

TEST(PassPlan, FollowsReadersBackwards) {
    const auto pass = [](std::string name, std::vector<std::string> inputs, std::vector<std::string> outputs) {
        PassDeclaration declaration;
        declaration.name = std::move(name);
        declaration.inputs = std::move(inputs);
        declaration.outputs = std::move(outputs);
        return declaration;
    };
    std::vector<PassDeclaration> passes{pass("a", {}, {"x"}), pass("b", {"x"}, {"y"}), pass("c", {"x"}, {"z"}),
                                        pass("d", {"y", "z"}, {"w"})};
    PassPlan plan = plan_passes(passes, {"z"});
    EXPECT_EQ(plan.order, (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(plan.decisions[0].reason, "pass 'c' reads x");
    EXPECT_EQ(plan.decisions[1].reason, "nobody reads y");
    EXPECT_EQ(plan.decisions[2].reason, "the experiment reads z");
    EXPECT_TRUE(plan.read.contains("x"));
    EXPECT_FALSE(plan.read.contains("y"));
    passes[1].disabled = "switched off";
    EXPECT_THAT(method_error([&] { plan_passes(passes, {"w"}); }),
                HasSubstr("pass 'b' would give it, but switched off"));
}

TEST(Pipelines, EglAndOsMesaAgreeOnEveryPlane) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[1], 96, 64);
    const std::vector<std::string> all{"depth", "normal",   "albedo", "direct",
                                       "ao",    "indirect", "total",  "layer2.direct"};
    std::vector<Frame> frames;
    for (const GlBackend backend : {GlBackend::egl, GlBackend::osmesa}) {
        Pipeline pipeline(test_context(backend), scene, small_method(), planes(all), 96, 64);
        frames.push_back(pipeline.render(view).frame);
    }
    for (const std::string& plane : all) {
        const auto a = frames[0].plane(plane).values(), b = frames[1].plane(plane).values();
        int different = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            different += !(a[i] == b[i] || std::abs(a[i] - b[i]) <= 1e-3f * std::max(1.0f, std::abs(a[i])));
        }
        // The same bits on Mesa; on a GPU silhouettes and shadow edges fall on other pixels.
        const bool same_renderer = test_context(GlBackend::egl).info().software;
        EXPECT_LE(different, same_renderer ? 0 : static_cast<int>(a.size() / 50)) << plane;
    }
}

}  // namespace
}  // namespace plumb
