// Light carried on from frame to frame, against the CPU and against bounces within a frame.
#include <array>
#include <limits>
#include <string>

#include <gmock/gmock.h>

#include "gl_test.h"
#include "radiosity_counterpart.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

using RadiosityCarryTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(RadiosityCarryTest);

constexpr int width = 80, height = 60;

Quantities wanted(std::vector<std::string> planes) { return {.planes = std::move(planes)}; }

// Nothing is rounded between bounces, so that sums can be compared.
Method exact(const RadiositySettings& radiosity) {
    Method method;
    method.ao.enabled = false;
    method.direct.shadow.emitter_size = 128;
    method.gbuffer.radiance_format = RadianceFormat::rgba32f;
    method.radiosity = radiosity;
    method.radiosity.samples = 16;
    return method;
}

View first_view(const Scene& scene) { return View(scene.cameras.front(), width, height); }

// The last of so many frames in a still view.
Frame rendered_after(GlContext& context, const Scene& scene, const Method& method, int frames,
                     std::vector<std::string> planes) {
    Pipeline pipeline(context, scene, method, wanted(std::move(planes)), width, height);
    const View view = first_view(scene);
    for (int frame = 1; frame < frames; ++frame) pipeline.time_passes(view);
    return pipeline.render(view).frame;
}

void expect_same(const Image& actual, const Image& expected, double tolerance) {
    double largest = 0.0;
    for (std::size_t i = 0; i < actual.values().size(); ++i) {
        ASSERT_NEAR(actual.values()[i], expected.values()[i], tolerance * (1.0 + expected.values()[i]))
            << "value " << i;
        largest = std::max(largest, static_cast<double>(expected.values()[i]));
    }
    EXPECT_GT(largest, 0.05) << "nothing was compared";
}

struct Way {
    const char* name;
    RadiositySettings settings;
};
// Where what taps send adds up.
const std::vector<Way> linear_ways = {
    {"one layer", {.layers = 1}},
    {"both layers, reused", {.estimator = RadiosityEstimator::nielsen2015}},
    {"both layers, gathered",
     {.estimator = RadiosityEstimator::nielsen2015, .second_layer = SecondLayerIndirect::gather}},
    {"both layers, the second without",
     {.estimator = RadiosityEstimator::nielsen2015, .second_layer = SecondLayerIndirect::none}}};

TEST_P(RadiosityCarryTest, InAStillViewApproachesTheSumOfTheBouncesWithinAFrame) {
    const Scene scene = make_cornell();
    for (const Way& way : linear_ways) {
        SCOPED_TRACE(way.name);
        RadiositySettings within = way.settings, carried = way.settings;
        within.bounces = 5;
        carried.carry = true;
        const Image expected = rendered_after(context(), scene, exact(within), 1, {"indirect"}).plane("indirect");
        // After n frames E is the sum of n bounces: exactly, but for the float rounding of sums in another order, which
        // the blur's normalisation multiplies a little.
        expect_same(rendered_after(context(), scene, exact(carried), 5, {"indirect"}).plane("indirect"), expected,
                    1e-5);
        const Image fewer = rendered_after(context(), scene, exact(carried), 4, {"indirect"}).plane("indirect");
        double missing = 0.0, sum = 0.0;
        for (std::size_t i = 0; i < fewer.values().size(); ++i) {
            missing += expected.values()[i] - fewer.values()[i];
            sum += expected.values()[i];
        }
        EXPECT_GT(missing, 1e-4 * sum) << "the fifth bounce still counts";
    }
}

TEST_P(RadiosityCarryTest, DampingTakesItsFractionFromEachFurtherBounce) {
    const Scene scene = make_cornell();
    RadiositySettings settings{.layers = 1, .bounces = 4};
    const Frame bounces =
        rendered_after(context(), scene, exact(settings), 1, {"indirect.1", "indirect.2", "indirect.3", "indirect.4"});
    Image expected(width, height, 3);
    for (int k = 1; k <= 4; ++k) {
        const Image& one = bounces.plane("indirect." + std::to_string(k));
        const double left = std::pow(1.0 - 0.3, k - 1);
        for (std::size_t i = 0; i < expected.values().size(); ++i)
            expected.values()[i] += static_cast<float>(left * one.values()[i]);
    }
    settings.bounces = 1;
    settings.carry = true;
    settings.damping = 0.3f;
    const Image actual = rendered_after(context(), scene, exact(settings), 4, {"indirect"}).plane("indirect");
    expect_same(actual, expected, 1e-5);  // float rounding, as above
    settings.damping = 1.0f;
    const Image none = rendered_after(context(), scene, exact(settings), 4, {"indirect"}).plane("indirect");
    EXPECT_TRUE(std::ranges::equal(
        none.values(),
        rendered_after(context(), scene, exact({.layers = 1}), 1, {"indirect"}).plane("indirect").values()))
        << "damping 1 leaves one bounce, bit for bit";
}

TEST_P(RadiosityCarryTest, NothingIsCarriedOverCuts) {
    const Scene scene = make_cornell();
    Method method = exact({.carry = true});
    method.radiosity.second_layer = SecondLayerIndirect::gather;
    const View view = first_view(scene);
    Camera other_camera = view.camera();
    other_camera.world_from_camera[3].x += 0.1f;
    const View other(other_camera, width, height);
    Pipeline pipeline(context(), scene, method, wanted({"indirect"}), width, height);
    const Image first = pipeline.render(view).frame.plane("indirect");
    const Image second = pipeline.render(view).frame.plane("indirect");
    EXPECT_FALSE(std::ranges::equal(first.values(), second.values())) << "the second frame has two bounces";
    // The camera was elsewhere: what the request says of the frame before is not what was rendered.
    pipeline.render(other);
    const Image after_cut = pipeline.render(view).frame.plane("indirect");
    EXPECT_TRUE(std::ranges::equal(first.values(), after_cut.values()));
    const std::size_t bytes = context().allocated_bytes();
    pipeline.render(view);
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

// A floor and a wall, and a block that slides before them.
Scene sliding_block() {
    Scene scene;
    scene.name = "sliding block";
    scene.materials.resize(2);
    scene.materials[0].base_colour = {0.8f, 0.5f, 0.3f};
    scene.materials[1].base_colour = {0.4f, 0.7f, 0.6f};
    const auto add = [&](int material, const std::vector<glm::vec3>& corners, const Motion& motion) {
        Mesh mesh;
        mesh.material = material;
        mesh.positions = corners;
        for (unsigned i = 0; i + 3 < corners.size(); i += 4) {
            mesh.triangles.push_back({i, i + 1, i + 2});
            mesh.triangles.push_back({i, i + 2, i + 3});
        }
        scene.instances.push_back({"part", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f), motion});
        scene.meshes.push_back(mesh);
    };
    add(0, {{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}, {});
    add(0, {{-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}}, {});
    Motion slide;
    slide.interpolation = MotionInterpolation::linear;
    slide.keys = {{.time = 0.0f}, {.time = 1.0f, .translation = {0.5f, 0.0f, 0.2f}}};
    add(1,
        {{-0.6f, 0, 0},
         {0, 0, 0},
         {0, 0.8f, 0},
         {-0.6f, 0.8f, 0},  // front
         {-0.6f, 0.8f, 0},
         {0, 0.8f, 0},
         {0, 0.8f, -0.6f},
         {-0.6f, 0.8f, -0.6f}},  // top
        slide);
    scene.point_lights.push_back({"lamp", {0.5f, 2.5f, 1.5f}, {12.0f, 10.0f, 8.0f}});
    return scene;
}

// What is sent besides direct light, from the formula; ambiguous where rounding may choose another pixel.
struct Carried {
    glm::dvec3 radiance{0.0};
    bool ambiguous = false;
    int from = 0;  // the layer of the frame before that it comes from
};

glm::dvec3 colour_at(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// Of the point that `layer` shows, which any of the first `kept_layers` may have held, and reflected by `reflecting`.
Carried carried_on(const Frame& now, const Frame& before, const View& view, const View& previous,
                   const RadiositySettings& settings, const glm::mat4& moved_back, int x, int y, int layer = 0,
                   int kept_layers = 1, int reflecting = 0) {
    const std::array<std::string, 2> prefixes{"", "layer2."};
    const std::string& prefix = prefixes.at(static_cast<std::size_t>(layer));
    const float depth = now.plane(prefix + "depth").at(x, y);
    if (std::isinf(depth)) return {};
    glm::vec4 world =
        view.camera().world_from_camera * glm::vec4(view.camera_space_point(x + 0.5f, y + 0.5f, depth), 1.0f);
    if (now.plane(prefix + "moving_instance").at(x, y) > 0.0f) world = moved_back * world;
    const glm::vec3 then = previous.project(glm::vec3(world));
    Carried result;
    for (const float coordinate : {then.x, then.y})
        result.ambiguous |= std::abs(coordinate - std::round(coordinate)) < 1e-3f;
    const int px = static_cast<int>(std::floor(then.x)), py = static_cast<int>(std::floor(then.y));
    if (px < 0 || py < 0 || px >= width || py >= height || then.z <= 0.0f) return result;
    double nearest = std::numeric_limits<double>::infinity();
    glm::dvec3 light(0.0);
    for (int kept = 0; kept < kept_layers; ++kept) {
        const std::string& held = prefixes.at(static_cast<std::size_t>(kept));
        const float depth_then = before.plane(held + "depth").at(px, py);
        if (std::isinf(depth_then)) continue;
        const glm::vec4 found = previous.camera().world_from_camera *
                                glm::vec4(previous.camera_space_point(px + 0.5f, py + 0.5f, depth_then), 1.0f);
        const double distance = glm::length(glm::dvec3(found) - glm::dvec3(world));
        result.ambiguous |= std::abs(distance - nearest) < 1e-5;
        if (distance >= nearest) continue;
        nearest = distance;
        light = colour_at(before.plane(held + "radiosity"), px, py);
        result.from = kept;
    }
    const double t = std::clamp((nearest - settings.carry_from) / (settings.carry_to - settings.carry_from), 0.0, 1.0);
    const double weight = (1.0 - settings.damping) * (1.0 - t * t * (3.0 - 2.0 * t));
    const Image& albedo = now.plane(prefixes.at(static_cast<std::size_t>(reflecting)) + "albedo");
    result.radiance = weight / std::numbers::pi * colour_at(albedo, x, y) * counterpart::boosted(settings, light);
    return result;
}

TEST_P(RadiosityCarryTest, FindsPointsAgainThatTheCameraAndObjectsMoved) {
    const Scene scene = sliding_block();
    // Distances at which some pixels are found again wholly, some in part, some not.
    RadiositySettings settings{.layers = 1,
                               .carry = true,
                               .damping = 0.1f,
                               .carry_from = 0.01f,
                               .carry_to = 0.05f,
                               .saturated_boost = 2.0f,
                               .unsaturated_boost = 1.5f};
    const Camera from = Camera::look_at("from", {1.2f, 1.6f, 3.2f}, {-0.1f, 0.6f, -0.4f}, 0.8f);
    const Camera to = Camera::look_at("to", {1.3f, 1.65f, 3.1f}, {-0.08f, 0.62f, -0.4f}, 0.8f);
    const Moment then{View(from, width, height), 0.2}, now{View(to, width, height), 0.4};
    Pipeline pipeline(context(), scene, exact(settings),
                      wanted({"depth", "albedo", "direct", "moving_instance", "radiosity", "radiosity.sent"}), width,
                      height);
    const Frame before = pipeline.render({.now = then}).frame;
    const Frame after = pipeline.render({.now = now, .previous = then}).frame;
    const glm::mat4 moved_back = scene.instances.back().pose(0.2) * glm::inverse(scene.instances.back().pose(0.4));
    int found = 0, lost = 0, moving = 0, ambiguous = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Carried expected = carried_on(after, before, now.view, then.view, settings, moved_back, x, y);
            ambiguous += expected.ambiguous;
            if (expected.ambiguous || std::isinf(after.plane("depth").at(x, y))) continue;
            const glm::dvec3 actual =
                colour_at(after.plane("radiosity.sent"), x, y) - colour_at(after.plane("direct"), x, y);
            // Positions 4 m away are good to 1e-6 m, so the weight to 1e-4; albedo passes through half floats alike.
            ASSERT_LT(glm::length(actual - expected.radiance), 2e-4 * (0.1 + glm::length(expected.radiance)))
                << "pixel (" << x << ", " << y << "): " << actual.x << ", expected " << expected.radiance.x;
            const bool is_found = glm::length(expected.radiance) > 0.0;
            (is_found ? found : lost) += 1;
            moving += is_found && after.plane("moving_instance").at(x, y) > 0.0f;
        }
    }
    EXPECT_LT(ambiguous, width * height / 50);
    EXPECT_GT(lost, 50) << "come to light, or seen at another slant";
    EXPECT_GT(found, 1000);
    EXPECT_GT(moving, 50) << "found again on the block";
}

// What both layers send, whose light each layer's own points held, or the first one's.
TEST_P(RadiosityCarryTest, BothLayersFindPointsAgainInEitherLayer) {
    const Scene scene = sliding_block();
    const Camera from = Camera::look_at("from", {0.1f, 1.2f, 3.2f}, {-0.1f, 0.5f, -0.4f}, 0.8f);
    const Camera to = Camera::look_at("to", {0.2f, 1.25f, 3.1f}, {-0.08f, 0.52f, -0.4f}, 0.8f);
    const Moment then{View(from, width, height), 0.2}, now{View(to, width, height), 0.5};
    const glm::mat4 moved_back = scene.instances.back().pose(0.2) * glm::inverse(scene.instances.back().pose(0.5));
    std::vector<std::string> planes;
    for (const std::string prefix : {"", "layer2."}) {
        for (const char* plane : {"depth", "albedo", "direct", "moving_instance", "radiosity.sent"})
            planes.push_back(prefix + plane);
    }
    planes.insert(planes.end(), {"radiosity", "irradiance"});
    for (const SecondLayerIndirect second_layer :
         {SecondLayerIndirect::gather, SecondLayerIndirect::reuse, SecondLayerIndirect::none}) {
        SCOPED_TRACE(testing::Message() << "second layer: " << static_cast<int>(second_layer));
        const RadiositySettings settings{
            .second_layer = second_layer, .carry = true, .damping = 0.2f, .carry_from = 0.01f, .carry_to = 0.08f};
        const bool gathers = second_layer == SecondLayerIndirect::gather;
        std::vector<std::string> asked = planes;
        if (gathers) asked.emplace_back("layer2.radiosity");
        Pipeline pipeline(context(), scene, exact(settings), wanted(asked), width, height);
        const Frame before = pipeline.render({.now = then}).frame;
        const Frame after = pipeline.render({.now = now, .previous = then}).frame;
        std::array<int, 2> found{}, from_the_other{};
        for (int layer = 0; layer < 2; ++layer) {
            const std::string prefix = layer == 0 ? "" : "layer2.";
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    if (std::isinf(after.plane(prefix + "depth").at(x, y))) continue;
                    Carried expected = carried_on(after, before, now.view, then.view, settings, moved_back, x, y,
                                                  gathers ? layer : 0, gathers ? 2 : 1, layer);
                    if (layer == 1 && second_layer == SecondLayerIndirect::none) expected.radiance = glm::dvec3(0.0);
                    if (expected.ambiguous) continue;
                    const glm::dvec3 actual = colour_at(after.plane(prefix + "radiosity.sent"), x, y) -
                                              colour_at(after.plane(prefix + "direct"), x, y);
                    // As for one layer above.
                    ASSERT_LT(glm::length(actual - expected.radiance), 2e-4 * (0.1 + glm::length(expected.radiance)))
                        << "layer " << layer << ", pixel (" << x << ", " << y << "): " << actual.x << ", expected "
                        << expected.radiance.x;
                    const bool is_found = glm::length(expected.radiance) > 0.0;
                    found[static_cast<std::size_t>(layer)] += is_found;
                    from_the_other[static_cast<std::size_t>(layer)] += is_found && expected.from != layer;
                }
            }
        }
        EXPECT_GT(found[0], 1000);
        if (second_layer == SecondLayerIndirect::none) continue;
        EXPECT_GT(found[1], 50);
        if (!gathers) continue;
        EXPECT_GT(from_the_other[0], 10) << "came to light";
        EXPECT_GT(from_the_other[1], 5) << "went behind the block";
    }
}

// What turns into view was in the guard band before.
TEST_P(RadiosityCarryTest, TheGuardBandIsCarriedOnToo) {
    const Scene scene = sliding_block();
    const auto seen_from = [](float target) {
        return Moment{View(Camera::look_at("turning", {0.0f, 1.2f, 3.0f}, {target, 0.6f, -0.4f}, 0.5f), width, height)};
    };
    const Moment then = seen_from(0.0f), now = seen_from(0.3f);
    const auto carried_at_the_border = [&](int guard_band) {
        Method method = exact({.carry = true, .carry_from = 0.2f, .carry_to = 0.3f});  // slants do not matter here
        method.gbuffer.guard_band = guard_band;
        Pipeline pipeline(context(), scene, method, wanted({"depth", "direct", "irradiance", "radiosity.sent"}), width,
                          height);
        pipeline.render({.now = then});
        const Frame after = pipeline.render({.now = now, .previous = then}).frame;
        int found = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = width - 8; x < width; ++x)
                found += colour_at(after.plane("radiosity.sent"), x, y) != colour_at(after.plane("direct"), x, y);
        }
        return found;
    };
    EXPECT_EQ(carried_at_the_border(0), 0);
    EXPECT_GT(carried_at_the_border(24), 8 * height / 4) << "of eight columns";
}

// What hides in the second layer of one frame comes to light in the next, and keeps the light that it gathered there.
TEST_P(RadiosityCarryTest, AGatheredSecondLayerIsFoundAgainWhenItComesToLight) {
    const Scene scene = sliding_block();
    const View view(Camera::look_at("front", {0.0f, 1.0f, 3.0f}, {-0.1f, 0.5f, -0.4f}, 0.8f), width, height);
    const Moment then{view, 0.0}, now{view, 0.8};
    const auto newly_lit = [&](SecondLayerIndirect second_layer) {
        Method method = exact({.carry = true});
        method.radiosity.second_layer = second_layer;
        Pipeline pipeline(context(), scene, method, wanted({"depth", "direct", "irradiance", "radiosity.sent"}), width,
                          height);
        const Frame before = pipeline.render({.now = then}).frame;
        const Frame after = pipeline.render({.now = now, .previous = then}).frame;
        int found = 0, uncovered = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                // The camera stands still: deeper than before is what the block hid.
                if (!(after.plane("depth").at(x, y) > before.plane("depth").at(x, y) + 0.2f)) continue;
                if (std::isinf(after.plane("depth").at(x, y))) continue;
                ++uncovered;
                found += colour_at(after.plane("radiosity.sent"), x, y) != colour_at(after.plane("direct"), x, y);
            }
        }
        EXPECT_GT(uncovered, 50);
        return static_cast<double>(found) / uncovered;
    };
    EXPECT_GT(newly_lit(SecondLayerIndirect::gather), 0.9);
    EXPECT_EQ(newly_lit(SecondLayerIndirect::reuse), 0.0);
}

TEST_P(RadiosityCarryTest, ParametersOutOfRangeAreRefusedWithTheRemedy) {
    const Scene scene = make_cornell();
    const auto error_of = [&](const RadiositySettings& settings) -> std::string {
        try {
            Pipeline pipeline(context(), scene, exact(settings), wanted({"indirect"}), width, height);
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(error_of({.carry = true, .damping = 1.5f}), testing::HasSubstr("radiosity.damping is 1.5"));
    EXPECT_THAT(error_of({.carry = true, .carry_from = 0.07f}), testing::HasSubstr("carry_to not below carry_from"));
    EXPECT_EQ(error_of({.carry = true, .carry_from = 0.05f, .carry_to = 0.05f}), "no error") << "a hard cut";
}

}  // namespace
}  // namespace plumb
