// The choices among shadow maps: cubes made in one pass, of linear distances, paraboloids, percentage-closer filtering.
#include <functional>

#include <fmt/format.h>

#include "gl_test.h"
#include "rasterizer/light_set.h"
#include "shadow_rays.h"

namespace plumb {
namespace {

using ShadowAlternativesTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(ShadowAlternativesTest);

Scene make_lamp_scene() {
    Scene scene = make_shadow_scene();
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    return scene;
}

ShadowCount count_lamp_shadows(GlContext& context, const Scene& scene, const Method& method, double blur = 0.03) {
    return count_shadows(context, scene, near_view(), glm::dvec3(scene.point_lights[0].position), false, -1, blur,
                         method);
}

TEST_P(ShadowAlternativesTest, EveryKindOfCubeCastsShadowsWhereRaysSay) {
    const Scene scene = make_lamp_scene();
    for (const CubeGeneration generation : {CubeGeneration::six_views, CubeGeneration::one_pass}) {
        for (const CubeDistance distance : {CubeDistance::reciprocal, CubeDistance::linear}) {
            SCOPED_TRACE(
                fmt::format("generation {}, distance {}", static_cast<int>(generation), static_cast<int>(distance)));
            Method method = plain_method();
            method.direct.shadow.cube_generation = generation;
            method.direct.shadow.cube_distance = distance;
            expect_shadows(context(), scene, near_view(), glm::dvec3(scene.point_lights[0].position), false, -1, 0.03,
                           method);
        }
    }
}

// The same projection of the same triangles: only rounding may tell the two ways apart.
TEST_P(ShadowAlternativesTest, OnePassAndSixViewsGiveTheSamePicture) {
    Scene scene = make_lamp_scene();
    Material glow;  // one-sided and flat: its cube clips what lies behind it
    glow.emission = {20.0f, 20.0f, 20.0f};
    glow.two_sided = false;
    scene.materials.push_back(glow);
    add_quad(scene, 2, {-0.9f, 1.5f, -0.2f}, {0, 0, -0.3f}, {0.3f, 0, 0});
    const View view = near_view();
    Method method = plain_method();
    const Image six = render(context(), scene, view, {"direct"}, method).plane("direct");
    method.direct.shadow.cube_generation = CubeGeneration::one_pass;
    const Image one = render(context(), scene, view, {"direct"}, method).plane("direct");
    int different = 0;
    for (std::size_t i = 0; i < six.values().size(); ++i) {
        different += std::abs(six.values()[i] - one.values()[i]) > 1e-3f * six.values()[i];
    }
    // A vertex that rounds to the neighbouring 256th of a texel can change a texel at a silhouette.
    EXPECT_LE(different, static_cast<int>(six.values().size() / 500));
}

// Cut finely enough a paraboloid is as good as a cube; as published, a floor of two triangles goes far astray.
TEST_P(ShadowAlternativesTest, ParaboloidsNeedTessellation) {
    const Scene scene = make_lamp_scene();
    Method method = plain_method();
    const int cube = count_lamp_shadows(context(), scene, method).wrong;
    method.direct.shadow.point_map = PointShadowMap::dual_paraboloid;
    int wrong[3], index = 0;
    for (const int segments : {1, 8, 64}) {
        method.direct.shadow.paraboloid_tessellation = segments;
        const ShadowCount count = count_lamp_shadows(context(), scene, method);
        wrong[index++] = count.wrong;
        RecordProperty(fmt::format("wrong_of_{}_with_{}_segments", count.lit + count.dark, segments), count.wrong);
    }
    RecordProperty("wrong_with_cube", cube);
    EXPECT_GT(wrong[0], 20 * (wrong[2] + 1)) << wrong[0] << ", " << wrong[1] << ", " << wrong[2];
    EXPECT_LE(wrong[1], wrong[0]);
    EXPECT_LE(wrong[2], 4) << "a part in a thousand of 4800 pixels, as for the cube";
}

// Of more vertices than 16 bits can number: Mesa's software rasterisers would join wrong ones within one draw.
TEST_P(ShadowAlternativesTest, ParaboloidsOfManyFinelyCutTrianglesCastNoOtherShadows) {
    Scene scene = make_shadow_scene();
    scene.point_lights.push_back({"lamp", {0.4f, 0.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    Method method = plain_method();
    method.direct.shadow.point_map = PointShadowMap::dual_paraboloid;
    method.direct.shadow.paraboloid_size = 1024;
    const Image once = render(context(), scene, near_view(), {"direct"}, method).plane("direct");
    for (Mesh& mesh : scene.meshes) {
        const std::vector<glm::uvec3> triangles = mesh.triangles;
        const std::size_t copies = 600 / triangles.size() + 1;
        for (std::size_t i = 1; i < copies; ++i) {
            mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
        }
    }
    const Image many_times = render(context(), scene, near_view(), {"direct"}, method).plane("direct");
    int different = 0;
    for (std::size_t i = 0; i < once.values().size(); ++i) different += once.values()[i] != many_times.values()[i];
    EXPECT_EQ(different, 0) << "of " << once.values().size() << " values";
}

TEST_P(ShadowAlternativesTest, ParaboloidsTakeAThirdOfTheMemoryOfACube) {
    const Scene scene = make_lamp_scene();
    Method method = plain_method();
    method.direct.shadow.cube_size = method.direct.shadow.paraboloid_size = 128;
    Quantities quantities;
    quantities.planes = {"direct"};
    const auto bytes = [&] { return Pipeline(context(), scene, method, quantities, 32, 32).shadow_map_bytes(); };
    EXPECT_EQ(bytes(), 6u * 128u * 128u * 4u);
    method.direct.shadow.point_map = PointShadowMap::dual_paraboloid;
    EXPECT_EQ(bytes(), 2u * 128u * 128u * 4u);
    method.direct.shadow.lamps = false;
    EXPECT_EQ(bytes(), 0u);
}

// A spot light too wide for a flat map takes the paraboloids as well.
TEST_P(ShadowAlternativesTest, WideSpotLightsUseParaboloids) {
    Scene scene = make_shadow_scene();
    scene.spot_lights.push_back(
        {"spot", {0.4f, 2.6f, 0.9f}, glm::normalize(glm::vec3(-0.3f, -1.0f, -0.5f)), {9, 7, 5}, 0.5f, 1.5f});
    Method method = plain_method();
    method.direct.shadow.point_map = PointShadowMap::dual_paraboloid;
    method.direct.shadow.paraboloid_tessellation = 64;
    expect_shadows(context(), scene, near_view(), glm::dvec3(scene.spot_lights[0].position), false, -1, 0.03, method);
}

TEST_P(ShadowAlternativesTest, LampsWithoutShadowsShineThroughEverything) {
    Scene scene = make_lamp_scene();
    scene.spot_lights.push_back(
        {"spot", {0.4f, 2.6f, 0.9f}, glm::normalize(glm::vec3(-0.3f, -1.0f, -0.5f)), {9, 7, 5}, 0.5f, 1.0f});
    Method method = plain_method();
    method.direct.shadow.lamps = false;
    EXPECT_GT(count_lamp_shadows(context(), scene, method).wrong, 100);
    EXPECT_TRUE(LightSet(scene, method.direct).any_shadows() == false);
}

// The maps of suns and the ranges of lamps hold what moves wherever it comes.
TEST(LightSet, MapsCoverMovingObjectsWhereverTheyCome) {
    Scene scene = make_shadow_scene();
    scene.point_lights.push_back({"lamp", {0.0f, 1.0f, 0.0f}, {1, 1, 1}});
    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(-0.4f, -1.0f, -0.6f)), {3, 2, 1}});
    Instance& ball = scene.instances.back();
    ball.motion.rest = ball.world_from_object;
    ball.motion.keys = {{0.0f, {0, 0, 0}}, {1.0f, {6, 9, 0}}, {2.0f, {-3, 2, 8}}};
    DirectSettings direct;
    direct.shadow.cube_distance = CubeDistance::linear;
    const LightSet lights(scene, direct);
    const glm::vec3 centre = glm::vec3(0.7f, 0.3f, -0.8f);
    for (int i = 0; i <= 100; ++i) {
        const glm::vec3 at(ball.pose(0.02 * i) * glm::vec4(centre, 1.0f));
        EXPECT_GT(lights.point_cubes[0].range, glm::length(at - scene.point_lights[0].position) + 0.3f) << i;
        const glm::vec4 clip = lights.maps[0].clip_from_world * glm::vec4(at, 1.0f);
        EXPECT_LT(std::max(std::abs(clip.x), std::abs(clip.y)), 1.0f) << i;
        EXPECT_LT(std::abs(clip.z - 0.5f), 0.5f) << i;
    }
}

// A flat map as rays see it: depth as the map's projection has it, larger nearer to the light, 0 where nothing is; row
// 0 at the bottom.
struct TracedMap {
    TracedMap(const Scene& scene, const glm::dmat4& clip_from_world, int size_in)
        : size(size_in), depth(static_cast<std::size_t>(size_in) * size_in, 0.0) {
        const RayCaster caster(scene);
        const glm::dmat4 world_from_clip = glm::inverse(clip_from_world);
        const auto unproject = [&](double x, double y, double z) {
            const glm::dvec4 p = world_from_clip * glm::dvec4(x, y, z, 1.0);
            return glm::dvec3(p) / p.w;
        };
        for (int j = 0; j < size; ++j) {
            for (int i = 0; i < size; ++i) {
                const double x = 2.0 * (i + 0.5) / size - 1.0, y = 2.0 * (j + 0.5) / size - 1.0;
                // From the near plane on; 0 would be infinitely far away on a spot light's.
                const glm::dvec3 from = unproject(x, y, 1.0), beyond = unproject(x, y, 0.5);
                const CastHit hit = caster.cast(from, glm::normalize(beyond - from), 0.0, 100.0);
                if (!hit.hit) continue;
                const glm::dvec4 clip = clip_from_world * glm::dvec4(hit.point, 1.0);
                depth[static_cast<std::size_t>(j) * size + i] = clip.z / clip.w;
            }
        }
    }
    double lit(int i, int j, double z) const {
        i = std::clamp(i, 0, size - 1), j = std::clamp(j, 0, size - 1);
        return z >= depth[static_cast<std::size_t>(j) * size + i] ? 1.0 : 0.0;
    }
    // One bilinear comparison.
    double compare(double u, double v, double z) const {
        const double x = u * size - 0.5, y = v * size - 0.5;
        const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
        const double a = x - i, b = y - j;
        return (1 - a) * (1 - b) * lit(i, j, z) + a * (1 - b) * lit(i + 1, j, z) + (1 - a) * b * lit(i, j + 1, z) +
               a * b * lit(i + 1, j + 1, z);
    }
    // The mean of those around a world-space point.
    double filter(const glm::dmat4& clip_from_world, const glm::dvec3& p, int radius) const {
        const glm::dvec4 clip = clip_from_world * glm::dvec4(p, 1.0);
        const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
        double sum = 0.0;
        for (int dy = -radius; dy <= radius; ++dy) {
            for (int dx = -radius; dx <= radius; ++dx) {
                sum += compare(0.5 + 0.5 * ndc.x + static_cast<double>(dx) / size,
                               0.5 + 0.5 * ndc.y + static_cast<double>(dy) / size, ndc.z);
            }
        }
        return sum / ((2 * radius + 1) * (2 * radius + 1));
    }
    int size;
    std::vector<double> depth;
};

// What a light sends to a surface that nothing shades, in red, and where its flat map is looked up for it.
struct Lookup {
    double irradiance;
    glm::dvec3 raised;
};

// Percentage-closer filtering as it is written down, over a map that rays have made.
void expect_filtered_shadows(GlContext& context, const Scene& scene, const Method& method,
                             const glm::dmat4& clip_from_world,
                             const std::function<Lookup(const glm::dvec3&, const glm::dvec3&)>& lookup,
                             int fewest_compared) {
    const View view = near_view();
    const int radius = method.direct.shadow.pcf_radius;
    const TracedMap map(scene, clip_from_world, method.direct.shadow.map_size);
    const Frame frame = render(context, scene, view, {"position", "normal", "albedo", "direct", "depth"}, method);
    int compared = 0, different = 0, partly = 0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (std::isinf(frame.plane("depth").at(x, y))) continue;
            const auto [irradiance, raised] =
                lookup(vector_at(frame.plane("position"), x, y), vector_at(frame.plane("normal"), x, y));
            if (irradiance == 0.0) continue;
            const double expected = map.filter(clip_from_world, raised, radius);
            const double unshadowed = frame.plane("albedo").at(x, y) / glm::pi<double>() * irradiance;
            const double visibility = frame.plane("direct").at(x, y) / unshadowed;
            ++compared;
            partly += expected > 0.05 && expected < 0.95;
            // Half floats, and filter weights of 8 bits.
            different += std::abs(visibility - expected) > 0.012;
        }
    }
    EXPECT_GT(compared, fewest_compared);
    EXPECT_GT(partly, 100);
    // Texels at silhouettes, whose centre the rasterizer's grid of 1/256 texel sees on the other side.
    EXPECT_LE(different, compared / 100) << "radius " << radius << ": " << different << " of " << compared;
}

TEST_P(ShadowAlternativesTest, PercentageCloserFilteringAveragesComparisonsOfSuns) {
    Scene scene = make_shadow_scene();
    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(-0.4f, -1.0f, -0.6f)), {3, 2, 1}});
    for (const int radius : {0, 1, 3}) {
        Method method = plain_method();
        method.direct.shadow.map_size = 128;
        method.direct.shadow.pcf_radius = radius;
        const DirectionalRecord sun = LightSet(scene, method.direct).directionals[0];
        expect_filtered_shadows(
            context(), scene, method, glm::dmat4(sun.clip_from_world),
            [&](const glm::dvec3& p, const glm::dvec3& n) -> Lookup {
                const double cosine = -glm::dot(n, glm::dvec3(sun.direction));
                if (cosine < 0.05) return {0.0, p};
                const double slope =
                    std::abs(glm::dot(n, glm::dvec3(sun.right))) + std::abs(glm::dot(n, glm::dvec3(sun.up)));
                return {3.0 * cosine, p + n * (method.direct.shadow.bias + (radius + 1.0) * sun.texel_size * slope)};
            },
            3000);
    }
}

TEST_P(ShadowAlternativesTest, PercentageCloserFilteringAveragesComparisonsOfSpotLights) {
    Scene scene = make_shadow_scene();
    scene.spot_lights.push_back(
        {"spot", {0.6f, 2.4f, 1.2f}, glm::normalize(glm::vec3(-0.4f, -1.0f, -0.6f)), {9, 7, 5}, 0.3f, 0.8f});
    const SpotLight& light = scene.spot_lights[0];
    for (const int radius : {0, 1, 3}) {
        Method method = plain_method();
        method.direct.shadow.map_size = 128;
        method.direct.shadow.pcf_radius = radius;
        const SpotRecord spot = LightSet(scene, method.direct).spots[0];
        ASSERT_EQ(spot.map, 0);
        expect_filtered_shadows(
            context(), scene, method, glm::dmat4(spot.clip_from_world),
            [&](const glm::dvec3& p, const glm::dvec3& n) -> Lookup {
                const glm::dvec3 from_light = p - glm::dvec3(light.position), axis(light.direction);
                const double d = glm::length(from_light), cosine = -glm::dot(n, from_light) / d;
                const double along = glm::dot(from_light, axis) / d, outer = std::cos(0.8), inner = std::cos(0.3);
                const double cone = std::clamp((along - outer) / (inner - outer), 0.0, 1.0);
                // Little is left at the cone's rim to tell visibility by.
                if (cosine < 0.05 || cone < 0.05) return {0.0, p};
                const double n_axis = glm::dot(n, axis), texel = spot.texel_size * glm::dot(from_light, axis);
                const double slope = std::sqrt(2.0 * (1.0 - n_axis * n_axis));
                return {9.0 * cosine * cone * cone / (d * d),
                        p + n * (method.direct.shadow.bias + (radius + 1.0) * texel * slope)};
            },
            2000);
    }
}

}  // namespace
}  // namespace plumb
