// Both layers in one geometry pass, held against peeling, whose layers the ray caster and Embree confirm.
#include <cmath>
#include <functional>
#include <string>
#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "gl_test.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"
#include "scenes/scene_file.h"

namespace plumb {
namespace {

using testing::HasSubstr;

const std::vector<std::string> planes{"depth",         "normal",        "albedo",          "emission",
                                      "layer2.depth",  "layer2.normal", "layer2.emission", "layer2.albedo",
                                      "layer2.motion", "motion"};
constexpr int width = 120, height = 90;
constexpr float separation = 0.05f;

Quantities quantities_of(std::vector<std::string> names) {
    Quantities quantities;
    quantities.planes = std::move(names);
    return quantities;
}

Method method_with(LayerGeneration generation, LayerSelection selection = LayerSelection::geometry_shader) {
    Method method;
    method.gbuffer.generation = generation;
    method.gbuffer.layer_selection = selection;
    method.gbuffer.minimum_separation = separation;
    return method;
}

// Values of a plane that differ by more than `tolerance`, relative where they are above 1. NaN equals nothing.
std::size_t differences(const Frame& a, const Frame& b, const std::string& plane, float tolerance = 0.0f) {
    const auto x = a.plane(plane).values(), y = b.plane(plane).values();
    std::size_t count = x.size() == y.size() ? 0 : std::max(x.size(), y.size());
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
        count += !(x[i] == y[i] || std::abs(x[i] - y[i]) <= tolerance * std::max(1.0f, std::abs(y[i])));
    return count;
}

std::string name_of(LayerGeneration generation) {
    constexpr std::array<const char*, 5> names{"peel", "delay", "previous", "predict", "reproject"};
    return names.at(static_cast<std::size_t>(generation));
}

using Case = std::tuple<GlBackend, LayerGeneration, LayerSelection>;

class LayerGenerationTest : public testing::TestWithParam<Case> {
protected:
    void SetUp() override {
        if (selection() == LayerSelection::vertex_shader &&
            !context().info().has_extension("GL_ARB_shader_viewport_layer_array")) {
            GTEST_SKIP() << "this OpenGL lacks GL_ARB_shader_viewport_layer_array";
        }
    }
    GlContext& context() { return test_context(std::get<0>(GetParam())); }
    LayerGeneration generation() const { return std::get<1>(GetParam()); }
    LayerSelection selection() const { return std::get<2>(GetParam()); }
    Method method() const { return method_with(generation(), selection()); }
    // The very bits, where Mesa draws without a geometry shader. With one it clips triangles in another order, and on a
    // GPU another program may round positions otherwise: then interpolated depths differ by some 1e-6, what hangs on a
    // pixel's displacement by some 1e-4 of one, and a pixel in a thousand at an edge shows the other surface.
    void expect_same(const Frame& frame, const Frame& peeled, const std::vector<std::string>& names,
                     const std::string& where) {
        const bool same_bits = context().info().software && selection() == LayerSelection::vertex_shader;
        for (const std::string& plane : names) {
            const std::size_t allowed = same_bits ? 0 : peeled.plane(plane).values().size() / 1000;
            EXPECT_LE(differences(frame, peeled, plane, same_bits ? 0.0f : 1e-3f), allowed) << plane << ", " << where;
        }
    }
};

INSTANTIATE_TEST_SUITE_P(
    Variants, LayerGenerationTest,
    testing::Combine(testing::Values(GlBackend::egl, GlBackend::osmesa),
                     testing::Values(LayerGeneration::delay, LayerGeneration::previous, LayerGeneration::predict,
                                     LayerGeneration::reproject),
                     testing::Values(LayerSelection::geometry_shader, LayerSelection::vertex_shader)),
    [](const auto& parameter) {
        return fmt::format("{}_{}_{}", to_string(std::get<0>(parameter.param)), name_of(std::get<1>(parameter.param)),
                           std::get<2>(parameter.param) == LayerSelection::geometry_shader ? "geometry" : "vertex");
    });

// The guard band and the depth mapping change nothing of that.
TEST_P(LayerGenerationTest, GivesThePeeledLayersWhereNothingMoves) {
    const Scene scene = make_clutter();
    const View view(scene.cameras[1], width, height);
    for (const auto& [guard_band, mapping] :
         {std::pair{0, DepthMapping::reversed}, std::pair{21, DepthMapping::standard}}) {
        Method one_pass = method(), peeling = method_with(LayerGeneration::peel);
        for (Method* m : {&one_pass, &peeling}) m->gbuffer.guard_band = guard_band, m->gbuffer.depth_mapping = mapping;
        const Frame peeled =
            Pipeline(context(), scene, peeling, quantities_of(planes), width, height).render(view).frame;
        Pipeline pipeline(context(), scene, one_pass, quantities_of(planes), width, height);
        for (int i = 0; i < 4; ++i)
            expect_same(pipeline.render(view).frame, peeled, planes, fmt::format("guard {}, frame {}", guard_band, i));
    }
}

TEST_P(LayerGenerationTest, AfterACutTheFrameIsExact) {
    const Scene scene = make_clutter();
    Pipeline pipeline(context(), scene, method(), quantities_of(planes), width, height);
    Pipeline peeling(context(), scene, method_with(LayerGeneration::peel), quantities_of(planes), width, height);
    for (const int camera : {0, 1, 2, 0}) {
        const View view(scene.cameras[camera], width, height);
        expect_same(pipeline.render(view).frame, peeling.render(view).frame, planes, scene.cameras[camera].name);
    }
}

// Frame by frame along a path while things move, each frame told of its neighbours.
struct Walk {
    Scene scene = load_scene("clutter-moving", {});
    double step = 0.15;  // a slow frame rate: motions of many pixels
    double start = 0.3;

    Moment at(int frame) const {
        const double time = start + step * frame;
        return {View(scene.path("strafe").at(static_cast<float>(time)), width, height), time};
    }
    FrameRequest frame(int i) const { return {.now = at(i), .previous = at(i - 1), .next = at(i + 1)}; }
};

TEST_P(LayerGenerationTest, DelayIsExactAndTheOthersAreNearlySoInMotion) {
    const Walk walk;
    Pipeline pipeline(context(), walk.scene, method(), quantities_of(planes), width, height);
    Pipeline peeling(context(), walk.scene, method_with(LayerGeneration::peel), quantities_of(planes), width, height);
    std::size_t wrong = 0, frames = 4;
    for (std::size_t i = 0; i < frames; ++i) {
        const FrameRequest request = walk.frame(static_cast<int>(i));
        const Frame frame = pipeline.render(request).frame, peeled = peeling.render(request).frame;
        expect_same(frame, peeled, {"depth", "normal", "albedo", "emission", "motion"}, fmt::format("frame {}", i));
        if (generation() == LayerGeneration::delay || i == 0) {
            expect_same(frame, peeled, planes, fmt::format("frame {}", i));
        } else {
            wrong += differences(frame, peeled, "layer2.depth", 1e-3f);
        }
    }
    if (generation() == LayerGeneration::delay) return;
    const double fraction = static_cast<double>(wrong) / static_cast<double>((frames - 1) * width * height);
    fmt::print("wrong in the second layer: {:.4f}\n", fraction);
    // Some pixels at every edge, of which this view is full; that something is wrong shows that the comparison really
    // is that of another frame.
    EXPECT_GT(fraction, 0.0);
    EXPECT_LT(fraction, generation() == LayerGeneration::predict ? 0.02 : 0.3);
}

TEST_P(LayerGenerationTest, NothingIsAllocatedAfterTheFirstFrame) {
    const Walk walk;
    Pipeline pipeline(context(), walk.scene, method(), quantities_of(planes), width, height);
    pipeline.time_passes(walk.frame(0));
    const std::size_t bytes = context().allocated_bytes();
    for (int i = 1; i < 4; ++i) pipeline.time_passes(walk.frame(i));
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

TEST_P(LayerGenerationTest, OneLayerAloneIsDrawnWhereNobodyReadsTheSecond) {
    const Scene scene = make_cornell();
    Pipeline pipeline(context(), scene, method(), quantities_of({"depth"}), width, height);
    EXPECT_EQ(pipeline.gbuffer_bytes_per_pixel(), 8u);  // the plane and the hardware's depth
}

using LayersTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(LayersTest);

// A camera that slides and an object that turns at constant speed: what predict foretells is what comes, but for the
// rounding of extrapolated matrices, which moves edges by some 1e-4 pixels.
TEST_P(LayersTest, PredictIsExactForConstantVelocity) {
    Scene scene = load_scene("clutter-moving", {});
    for (Instance& instance : scene.instances) {
        if (instance.moves()) instance.motion.interpolation = MotionInterpolation::linear;
    }
    Pipeline predicting(context(), scene, method_with(LayerGeneration::predict), quantities_of(planes), width, height);
    Pipeline peeling(context(), scene, method_with(LayerGeneration::peel), quantities_of(planes), width, height);
    const auto at = [&](int frame) {
        Camera camera = scene.cameras[1];
        const double time = 0.2 + 0.1 * frame;
        camera.world_from_camera[3] += glm::vec4(0.05f * static_cast<float>(frame), 0.0f, 0.0f, 0.0f);
        return Moment{View(camera, width, height), time};
    };
    predicting.render({.now = at(1), .previous = at(0)});
    for (int frame = 2; frame < 5; ++frame) {
        const FrameRequest request{.now = at(frame), .previous = at(frame - 1)};
        const std::size_t wrong =
            differences(predicting.render(request).frame, peeling.render(request).frame, "layer2.depth", 1e-3f);
        EXPECT_LE(wrong, width * height / 500) << "frame " << frame;
    }
}

// Two walls that recede by more than the separation between frames, either because they move or because the camera
// does. The previous frame's depth at the same pixel is that far before the front wall, which previous takes for a
// second layer; reproject knows where the fragment was.
TEST_P(LayersTest, ReprojectFollowsCamerasAndInstancesWherePreviousRepeatsTheFirstLayer) {
    for (const bool instances_move : {false, true}) {
        Scene scene;
        scene.materials.emplace_back();
        for (const float z : {-2.0f, -4.0f}) {
            Mesh mesh;
            mesh.positions = {{-50, -50, z}, {50, -50, z}, {50, 50, z}, {-50, 50, z}};
            mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
            Instance wall{"wall", static_cast<int>(scene.meshes.size())};
            if (instances_move) {
                wall.motion.interpolation = MotionInterpolation::linear;
                wall.motion.keys = {{.time = 0.0f}, {.time = 10.0f, .translation = {0, 0, -10.0f}}};
            }
            scene.instances.push_back(wall);
            scene.meshes.push_back(mesh);
        }
        const auto at = [&](int frame) {
            Camera camera = Camera::look_at("camera", {0, 0, 0}, {0, 0, -1}, 0.8f);
            const double time = 0.6 * frame;
            if (!instances_move) camera.world_from_camera[3].z = static_cast<float>(time);
            return Moment{View(camera, width, height), time};
        };
        for (const LayerGeneration generation : {LayerGeneration::reproject, LayerGeneration::previous}) {
            Method method = method_with(generation);
            method.gbuffer.minimum_separation = 0.5f;
            Pipeline pipeline(context(), scene, method, quantities_of({"depth", "layer2.depth"}), width, height);
            pipeline.render({.now = at(1), .previous = at(0)});
            const Frame frame = pipeline.render({.now = at(2), .previous = at(1)}).frame;
            // Farther out the camera sees more than in the frame before: 5.2 / 4.6 of the back wall.
            for (int y = height / 10; y < height * 9 / 10; ++y) {
                for (int x = width / 10; x < width * 9 / 10; ++x) {
                    const float second = generation == LayerGeneration::reproject ? 5.2f : 3.2f;
                    ASSERT_NEAR(frame.plane("depth").at(x, y), 3.2f, 1e-5f);
                    ASSERT_NEAR(frame.plane("layer2.depth").at(x, y), second, 1e-5f)
                        << name_of(generation) << ", " << (instances_move ? "instances" : "camera");
                }
            }
        }
    }
}

TEST_P(LayersTest, AFractionOfTheFrustumIsThatManyMetres) {
    const Scene scene = make_clutter();
    const View view(scene.cameras[0], width, height);
    const float depth_range = scene.cameras[0].far_plane - scene.cameras[0].near_plane;
    Method metres = method_with(LayerGeneration::peel), fraction = metres;
    metres.gbuffer.minimum_separation = 0.004f * depth_range;
    fraction.gbuffer.minimum_separation = 0.004f;
    fraction.gbuffer.separation_unit = SeparationUnit::frustum;
    const auto render = [&](const Method& method) {
        return Pipeline(context(), scene, method, quantities_of({"layer2.depth"}), width, height).render(view).frame;
    };
    EXPECT_EQ(differences(render(metres), render(fraction), "layer2.depth"), 0u);
}

// Four layers, each behind the one before by more than the minimum; the second is that of two layers.
TEST_P(LayersTest, FurtherLayersArePeeledOneByOne) {
    const Scene scene = make_clutter();
    const View view(scene.cameras[0], width, height);
    Method four = method_with(LayerGeneration::peel);
    four.gbuffer.layers = 4;
    const Frame frame = Pipeline(context(), scene, four,
                                 quantities_of({"depth", "layer2.depth", "layer3.depth", "layer4.depth",
                                                "layer4.albedo", "layer3.normal", "layer4.position"}),
                                 width, height)
                            .render(view)
                            .frame;
    const Frame two =
        Pipeline(context(), scene, method_with(LayerGeneration::peel), quantities_of({"layer2.depth"}), width, height)
            .render(view)
            .frame;
    EXPECT_EQ(differences(frame, two, "layer2.depth"), 0u);
    for (int layer = 1; layer < 4; ++layer) {
        const Image& front = frame.plane(layer == 1 ? "depth" : fmt::format("layer{}.depth", layer));
        const Image& back = frame.plane(fmt::format("layer{}.depth", layer + 1));
        int found = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const float depth = back.at(x, y);
                ASSERT_TRUE(std::isinf(depth) || depth > front.at(x, y) + separation) << layer << ": " << x << "," << y;
                found += !std::isinf(depth);
            }
        }
        EXPECT_GT(found, 100) << layer;
    }
}

TEST_P(LayersTest, LayersThatAVariantCannotDrawAreRefused) {
    const Scene scene = make_cornell();
    const auto message = [&](const Method& method) -> std::string {
        try {
            Pipeline(context(), scene, method, quantities_of({"depth"}), width, height);
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    Method method = method_with(LayerGeneration::reproject);
    method.gbuffer.layers = 3;
    EXPECT_THAT(message(method), HasSubstr("gbuffer.generation is \"reproject\", which draws 2 layers"));
    method = method_with(LayerGeneration::peel);
    method.gbuffer.layers = 5;
    EXPECT_THAT(message(method), HasSubstr("it can be 1 to 4"));
    method = method_with(LayerGeneration::peel);
    method.gbuffer.separation_unit = SeparationUnit::frustum;
    method.gbuffer.minimum_separation = 1.5f;
    EXPECT_THAT(message(method), HasSubstr("1.5 of the frustum"));
}

// A view that looks past its camera's axis is foreseen past it, too.
TEST(Extrapolation, TheNextViewKeepsTheOffsetOfItsPixels) {
    const auto at = [](float x) {
        return View(Camera::look_at("walk", {x, 1.0f, 3.0f}, {x, 1.0f, 0.0f}, 0.9f), 40, 30).with_offset({3.5f, -2.0f});
    };
    const View next = extrapolate(at(0.0f), at(0.25f));
    EXPECT_EQ(next.offset(), at(0.0f).offset());
    EXPECT_NEAR(next.camera().position().x, 0.5f, 1e-6f);  // a rounding of the inverse and of the product
}

}  // namespace
}  // namespace plumb
