// Light through the specular lobe, in both renderers: highlights of lamps, what the diffuse lobe keeps, and reflections
// of what the view shows.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pathtracer/reference.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"

namespace plumb::test {
namespace {

void add_quad(Scene& scene, int material, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
    Mesh mesh;
    mesh.material = material;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.instances.push_back({"quad", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(mesh);
}

Material material_of(const glm::vec3& base_colour, float metallic, float reflectance, float roughness) {
    Material material;
    material.base_colour = base_colour;
    material.metallic = metallic;
    material.dielectric_reflectance = reflectance;
    material.roughness = roughness;
    return material;
}

// A glossy floor, a wall of three colours behind it, one of which glows, and a lamp that nothing is in the way of.
Scene make_room(const Material& floor) {
    Scene scene;
    scene.materials = {floor, material_of({0.8f, 0.2f, 0.1f}, 0, 0, 1), material_of({0.1f, 0.3f, 0.8f}, 0, 0, 1),
                       material_of({0.3f, 0.6f, 0.3f}, 0, 0, 1)};
    scene.materials[3].emission = {0.5f, 0.6f, 0.2f};
    add_quad(scene, 0, {-3, 0, 3}, {6, 0, 0}, {0, 0, -5});
    add_quad(scene, 1, {-3, 0, -2}, {2.5f, 0, 0}, {0, 2.5f, 0});
    add_quad(scene, 3, {-0.5f, 0, -2}, {1, 0, 0}, {0, 2.5f, 0});
    add_quad(scene, 2, {0.5f, 0, -2}, {2.5f, 0, 0}, {0, 2.5f, 0});
    scene.point_lights.push_back({"lamp", {0.3f, 2.2f, 0.5f}, {9.0f, 8.0f, 7.0f}});
    return scene;
}

View room_view(int width) {
    return View(Camera::look_at("room", {0.2f, 1.3f, 2.8f}, {0.0f, 0.55f, -2.0f}, 0.8f), width, width * 3 / 4);
}

Frame truth_of(const Scene& scene, const View& view, std::vector<std::string> planes, int samples) {
    ReferenceSettings settings;
    settings.quantities.planes = std::move(planes);
    settings.quantities.bounces = 1;
    settings.samples = samples;
    return PathTracer(scene).render(view, settings).frame;
}

Method glossy_method(ReflectionSettings settings = {}) {
    Method method;
    method.ao.enabled = method.radiosity.enabled = false;
    method.reflections = settings;
    method.reflections.enabled = true;
    return method;
}

Frame raster_of(GlContext& context, const Scene& scene, const View& view, const Method& method,
                std::vector<std::string> planes) {
    Quantities quantities;
    quantities.planes = std::move(planes);
    return Pipeline(context, scene, method, quantities, view.width(), view.height()).render(view).frame;
}

struct Difference {
    int pixels = 0, far_off = 0;
    double relative_rms = 0.0;  // over all pixels: RMS of the difference over RMS of the truth
};

// Of the pixels that `chosen` takes, by their world point.
template <typename Chosen>
Difference compare(const Image& found, const Image& truth, const Frame& gbuffer, double tolerance, Chosen chosen) {
    Difference result;
    double difference = 0.0, whole = 0.0;
    for (int y = 0; y < truth.height(); ++y) {
        for (int x = 0; x < truth.width(); ++x) {
            const auto p = gbuffer.plane("position").pixel(x, y);
            if (std::isinf(gbuffer.plane("depth").at(x, y)) || !chosen(glm::vec3(p[0], p[1], p[2]))) continue;
            ++result.pixels;
            double off = 0.0, size = 0.0;
            for (int c = 0; c < 3; ++c) {
                const double d = found.at(x, y, c) - truth.at(x, y, c);
                difference += d * d, whole += std::pow(truth.at(x, y, c), 2.0);
                off = std::max(off, std::abs(d)),
                size = std::max(size, std::abs(static_cast<double>(truth.at(x, y, c))));
            }
            result.far_off += off > tolerance * size;
        }
    }
    result.relative_rms = std::sqrt(difference / whole);
    return result;
}

class ReflectionAgreement : public testing::TestWithParam<GlBackend> {
protected:
    const std::unique_ptr<GlContext> context_ = GlContext::create(GetParam());
};

TEST_P(ReflectionAgreement, HighlightsOfLampsAreTheTruths) {
    Scene floor;
    floor.materials = {material_of({0.5f, 0.4f, 0.3f}, 0.3f, 0.04f, 0.35f)};
    add_quad(floor, 0, {-3, 0, 3}, {6, 0, 0}, {0, 0, -5});
    std::vector<Scene> scenes(3, floor);
    scenes[0].point_lights.push_back({"lamp", {0.3f, 1.2f, -0.5f}, {9.0f, 8.0f, 7.0f}});
    SpotLight spot;
    spot.position = {0.0f, 2.0f, -1.0f};
    spot.direction = glm::normalize(glm::vec3(0.1f, -1.0f, 0.3f));
    spot.intensity = {5.0f, 5.0f, 9.0f};
    spot.inner_angle = 0.4f, spot.outer_angle = 0.7f;
    scenes[1].spot_lights.push_back(spot);
    DirectionalLight sun;
    sun.direction = glm::normalize(glm::vec3(0.1f, -0.6f, 1.0f));
    sun.irradiance = {3.0f, 2.8f, 2.5f};
    scenes[2].directional_lights.push_back(sun);
    const View view = room_view(96);
    for (const Scene& scene : scenes) {
        const Frame truth = truth_of(scene, view, {"reflection", "direct", "depth", "position"}, 4);
        const Frame found = raster_of(*context_, scene, view, glossy_method(), {"reflection", "direct", "total"});
        for (const char* plane : {"reflection", "direct"}) {
            const Difference difference =
                compare(found.plane(plane), truth.plane(plane), truth, 0.01, [](const glm::vec3&) { return true; });
            EXPECT_GT(difference.pixels, 2000);
            // Half floats of albedo and roughness, 16-bit normals against a lobe of 0.12 radians: some 3e-3 each.
            EXPECT_LT(difference.relative_rms, 0.005) << plane;
            EXPECT_LT(difference.far_off, difference.pixels / 50) << plane;
        }
    }
}

// Where the wall that is mirrored lies in the view.
bool mirrors_the_wall(const View& view, const glm::vec3& p, float edge = 0.06f) {
    if (p.y > 1e-3f) return false;
    const glm::vec3 eye = view.camera().position();
    const float ahead = (p.z + 2.0f) / (eye.z - p.z);
    const glm::vec3 wall = p + ahead * glm::vec3(p.x - eye.x, eye.y, 0.0f);
    const glm::vec3 pixel = view.project({wall.x, wall.y, -2.0f});
    // Where two colours meet a pixel may show the other one.
    if (std::abs(std::abs(wall.x) - 0.5f) < edge) return false;
    constexpr float border = 3.0f;
    return wall.y < 2.45f && std::abs(wall.x) < 2.9f && pixel.x > border && pixel.y > border &&
           pixel.x < static_cast<float>(view.width()) - border;
}

TEST_P(ReflectionAgreement, AMirrorFloorShowsTheWallAsTheTruthDoes) {
    const Scene scene = make_room(material_of({0.9f, 0.7f, 0.5f}, 1.0f, 0.0f, 0.0f));
    const View view = room_view(160);
    const Frame truth = truth_of(scene, view, {"reflection", "total", "depth", "position"}, 64);
    for (const ReflectionRoughness roughness :
         {ReflectionRoughness::mirror, ReflectionRoughness::mip, ReflectionRoughness::samples}) {
        const Method method = glossy_method({.roughness = roughness, .border_fade = 0});
        const Frame found = raster_of(*context_, scene, view, method, {"reflection", "total"});
        const Difference difference = compare(found.plane("reflection"), truth.plane("reflection"), truth, 0.05,
                                              [&](const glm::vec3& p) { return mirrors_the_wall(view, p); });
        EXPECT_GT(difference.pixels, 3000);
        // The glowing strip's light is sampled with 64 points; rays end half a pixel off.
        EXPECT_LT(difference.relative_rms, 0.04) << static_cast<int>(roughness);
        EXPECT_LT(difference.far_off, difference.pixels / 20) << static_cast<int>(roughness);
        const Difference total = compare(found.plane("total"), truth.plane("total"), truth, 0.05,
                                         [&](const glm::vec3& p) { return mirrors_the_wall(view, p); });
        EXPECT_LT(total.relative_rms, 0.04);
    }
}

// A lobe of 0.09 radians: mirrored by one ray its image is too sharp; spread rays and the MIP chain come closer.
TEST_P(ReflectionAgreement, ARoughFloorBlursTheWallAsTheTruthDoes) {
    const Scene scene = make_room(material_of({0.9f, 0.9f, 0.9f}, 1.0f, 0.0f, 0.3f));
    const View view = room_view(128);
    const Frame truth = truth_of(scene, view, {"reflection", "depth", "position"}, 512);
    const auto error = [&](ReflectionSettings settings) {
        settings.border_fade = 0;
        const Frame found = raster_of(*context_, scene, view, glossy_method(settings), {"reflection"});
        // Within half a metre the lobe sees hardly anything but the wall.
        return compare(found.plane("reflection"), truth.plane("reflection"), truth, 0.1, [&](const glm::vec3& p) {
            return mirrors_the_wall(view, p, 0.0f) && p.z < -0.5f && p.z > -1.9f && std::abs(p.x) < 1.2f;
        });
    };
    const Difference samples = error({.roughness = ReflectionRoughness::samples, .samples = 256}),
                     mip = error({.roughness = ReflectionRoughness::mip}),
                     mirror = error({.roughness = ReflectionRoughness::mirror});
    EXPECT_GT(samples.pixels, 800);
    // What the lobe's tail sees outside the view is missing.
    EXPECT_LT(samples.relative_rms, 0.06);
    EXPECT_LT(mip.relative_rms, mirror.relative_rms);
    EXPECT_LT(samples.relative_rms, mip.relative_rms);
    for (const auto& [name, difference] : {std::pair{"samples", samples}, {"mip", mip}, {"mirror", mirror}})
        std::printf("relative RMS error with %s: %.4f\n", name, difference.relative_rms);
}

TEST_P(ReflectionAgreement, WithoutSpecularLobesNothingIsReflected) {
    const Scene scene = make_room(material_of({0.5f, 0.5f, 0.5f}, 0, 0, 0.2f));
    const View view = room_view(48);
    const Frame found = raster_of(*context_, scene, view, glossy_method(), {"reflection"});
    for (const float value : found.plane("reflection").values()) ASSERT_EQ(value, 0.0f);
}

INSTANTIATE_TEST_SUITE_P(Backend, ReflectionAgreement, testing::Values(GlBackend::egl, GlBackend::osmesa),
                         [](const auto& parameter) { return std::string(to_string(parameter.param)); });

}  // namespace
}  // namespace plumb::test
