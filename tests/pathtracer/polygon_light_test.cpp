// Direct light of emissive polygons against Lambert's formula, by every way of sampling, at several points of a floor.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

struct PolygonLight {
    const char* name;
    closed_form::Polygon corners;
};

const std::vector<PolygonLight> lights = {
    {"Triangle", {{-0.8, 0.9, -0.6}, {0.9, 0.9, -0.7}, {0.1, 0.9, 1.0}}},
    {"TiltedTriangle", {{-0.9, 0.6, -0.5}, {0.8, 1.1, -0.8}, {0.2, 1.3, 0.9}}},
    {"Square", {{-0.7, 0.8, -0.7}, {0.7, 0.8, -0.7}, {0.7, 0.8, 0.7}, {-0.7, 0.8, 0.7}}},
    {"Hexagon", {{1, 0.9, 0}, {0.5, 0.9, 0.8}, {-0.5, 0.9, 0.8}, {-1, 0.9, 0}, {-0.5, 0.9, -0.8}, {0.5, 0.9, -0.8}}},
    // What is below the floor's plane must not count, though it is sampled.
    {"UprightSquarePartlyBelowTheHorizon", {{-0.7, -0.5, -1}, {-0.7, 1, -1}, {-0.7, 1, 1}, {-0.7, -0.5, 1}}},
    {"SlantedTrianglePartlyBelowTheHorizon", {{-1.1, -0.5, -0.9}, {0.3, 1.2, -0.8}, {-0.7, 0.9, 1.2}}},
};
const glm::vec3 receivers[] = {{0, 0, 0}, {0.3f, 0, -0.2f}, {-0.1f, 0, 0.3f}};

using Parameters = std::tuple<int, EmitterSampling>;
class PolygonLights : public testing::TestWithParam<Parameters> {};

TEST_P(PolygonLights, FollowLambertsFormula) {
    const auto& light = lights[static_cast<std::size_t>(std::get<0>(GetParam()))];
    constexpr float albedo = 0.6f, emission = 4.0f;
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(albedo)), {floor_quad(10.0f)});
    const glm::vec3 colour(1.0f, 0.5f, 2.0f);
    add_polygon(scene, add_material(scene, glm::vec3(0.0f), emission * colour), light.corners);
    // Enough for four standard errors below 1 % also where directions seldom meet the light, or most of it lies where
    // it does not count.
    auto settings = settings_for({"direct", "position"}, 1024);
    settings.emitter_sampling = std::get<1>(GetParam());
    const PathTracer tracer(scene);
    for (const glm::vec3& receiver : receivers) {
        const View view = view_of(receiver + glm::vec3(0.1f, 0.25f, 0.15f), receiver, 0.2f);
        const Frame frame = tracer.render(view, settings).frame;
        expect_mean(
            frame, "direct",
            [&](int x, int y) {
                const glm::dvec3 position(colour_at(frame.plane("position"), x, y));
                return albedo / closed_form::pi * emission *
                       closed_form::polygon_irradiance(position, {0, 1, 0}, light.corners);
            },
            fmt::format("receiver {}, {}", receiver.x, receiver.z), 0.0, 0.01, glm::dvec3(colour));
    }
}

class MaskedEmitters : public testing::TestWithParam<EmitterSampling> {};

// A square with a hole in its half at x < 0, cut by the alpha of its base colour or by a mask of its own, shines as its
// other half alone. Between the two texels the mask is bilinear and passes its threshold in the middle.
TEST_P(MaskedEmitters, ShineAsWhatTheMaskLeaves) {
    for (const bool own_mask : {false, true}) {
        constexpr float albedo = 0.6f, emission = 4.0f;
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(albedo)), {floor_quad(10.0f)});
        const int glowing = add_material(scene, glm::vec3(0.3f), glm::vec3(emission));
        Texture mask;
        mask.width = 2, mask.height = 1, mask.wrap_u = mask.wrap_v = TextureWrap::clamp;
        // The channels that must not be asked say the opposite.
        const half in_green = own_mask ? 1.0f : 0.0f, in_alpha = 1.0f - in_green;
        const half none_in_green = 1.0f - in_green, none_in_alpha = 1.0f - in_alpha;
        mask.texels = {half(1.0f), none_in_green, half(1.0f), none_in_alpha,
                       half(1.0f), in_green,      half(1.0f), in_alpha};
        scene.textures.push_back(mask);
        Material& material = scene.materials[static_cast<std::size_t>(glowing)];
        material.alpha_mask = true;
        if (own_mask) {
            material.alpha_texture = 0, material.alpha_channel = 1;
        } else {
            material.base_colour_texture = 0;
        }
        add_quads(scene, glowing, {floor_quad(0.8f, 0.9f)});  // u grows with x
        auto settings = settings_for({"direct", "position"}, 4096, 0);
        settings.emitter_sampling = GetParam();
        const View view = view_of({0.2f, 0.4f, 0.5f}, {0.1f, 0, 0.1f}, 0.5f);
        const Frame frame = PathTracer(scene).render(view, settings).frame;
        const closed_form::Polygon left_over = {{0, 0.9, 0.8}, {0.8, 0.9, 0.8}, {0.8, 0.9, -0.8}, {0, 0.9, -0.8}};
        expect_mean(
            frame, "direct",
            [&](int x, int y) {
                const glm::dvec3 position(colour_at(frame.plane("position"), x, y));
                return albedo / closed_form::pi * emission *
                       closed_form::polygon_irradiance(position, {0, 1, 0}, left_over);
            },
            own_mask ? "a mask of its own" : "the base colour's alpha");
    }
}

constexpr const char* sampling_names[] = {"Lights", "Directions", "Both"};

INSTANTIATE_TEST_SUITE_P(All, PolygonLights,
                         testing::Combine(testing::Range(0, static_cast<int>(lights.size())),
                                          testing::Values(EmitterSampling::lights, EmitterSampling::directions,
                                                          EmitterSampling::both)),
                         [](const testing::TestParamInfo<Parameters>& test) {
                             return fmt::format("{}By{}",
                                                lights[static_cast<std::size_t>(std::get<0>(test.param))].name,
                                                sampling_names[static_cast<int>(std::get<1>(test.param))]);
                         });

INSTANTIATE_TEST_SUITE_P(All, MaskedEmitters,
                         testing::Values(EmitterSampling::lights, EmitterSampling::directions, EmitterSampling::both),
                         [](const auto& test) { return sampling_names[static_cast<int>(test.param)]; });

}  // namespace
}  // namespace plumb
