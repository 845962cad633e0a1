// Batches are what single paths are: packets of rays find the single ray's hits, and no picture depends on which paths
// were followed together, nor on how samples were split over runs and threads.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "pathtracer/direction_sampling.h"
#include "pathtracer/oracle_layers.h"
#include "pathtracer/traced_scene.h"
#include "scenes/builtin.h"
#include "scenes/import.h"
#include "tests/pathtracer/chi_square.h"
#include "tests/pathtracer/effects_scenes.h"

namespace plumb {
namespace {

// Rays within the scene's bounds: from points inside in all directions, some along the axes, some short; and along
// them, as bounce rays have it, from surface points that earlier rays found.
std::vector<RayBatch> rays_within(const TracedScene& scene, int batches) {
    const Bounds bounds = scene.scene().bounds();
    std::vector<RayBatch> result(static_cast<std::size_t>(batches));
    int index = 0;
    for (RayBatch& batch : result) {
        // Also batches that are not full, and packets with one lane.
        const int count = 1 + (index * 7 + 63) % most_lanes;
        while (batch.count < count) {
            const IndependentNumbers first(5, index), second(6, index), third(7, index);
            ++index;
            const glm::vec3 from = glm::mix(bounds.lower, bounds.upper, glm::vec3(first.u, second.u.x));
            glm::vec3 direction = sample_cosine_hemisphere({0, second.u.y < 0.5f ? 1.0f : -1.0f, 0}, third.u);
            if (index % 16 == 0) direction = {0, 0, 1};
            const float reach = index % 3 == 0 ? 0.2f * bounds.diagonal() : infinite_distance;
            const float time = first.thinning.x;
            batch.add(from, direction, reach, time);
            const SurfaceHit hit =
                scene.intersect(from, direction, positive_distance, infinite_distance, RayCoherence::incoherent, time);
            if (hit.missed() || batch.count == count) continue;
            const SurfacePoint point = scene.surface_point(hit, direction, time);
            batch.add(point.ray_origin, sample_cosine_hemisphere(point.shading_normal, second.thinning), reach, time);
        }
    }
    return result;
}

bool same(const SurfaceHit& a, const SurfaceHit& b) {
    return a.instance == b.instance && a.triangle == b.triangle && a.u == b.u && a.v == b.v && a.distance == b.distance;
}

void expect_single_rays_hits(const Scene& scene, const TimeSpan& span = {}) {
    const TracedScene traced(scene, span);
    std::optional<OracleLayers> layers;
    if (!scene.cameras.empty()) layers.emplace(traced, View(scene.cameras[0], 64, 48), 2, 0.1f);
    std::vector<const OracleLayers*> known = {nullptr};
    if (layers) known.push_back(&*layers);
    int met = 0, rays_in_all = 0, different = 0, differently_blocked = 0, different_points = 0;
    for (const RayBatch& rays : rays_within(traced, 300)) {
        for (const OracleLayers* oracle : known) {
            HitBatch hits;
            Lanes<int> blocked;
            traced.intersect(rays, hits, oracle);
            traced.occluded(rays, blocked, oracle);
            for (int i = 0; i < rays.count; ++i, ++rays_in_all) {
                const glm::vec3 origin = rays.origin.get(i), direction = rays.direction.get(i);
                const SurfaceHit single = traced.intersect(origin, direction, rays.nearest[i], rays.farthest[i],
                                                           RayCoherence::incoherent, rays.time[i], oracle);
                met += single.missed() ? 0 : 1;
                different += same(single, hits.get(i)) ? 0 : 1;
                differently_blocked += (blocked[i] != 0) == !single.missed() ? 0 : 1;
            }
            if (oracle) continue;
            // What lies there, side by side and one by one.
            MetRays listed;
            for (int i = rays.count - 1; i >= 0; --i) {
                if (!hits.missed(i)) listed.ray[listed.count++] = i;
            }
            listed.complete_group();
            SurfaceLanes points;
            traced.surface_points(rays, hits, listed, points);
            for (int j = 0; j < listed.count; ++j) {
                const int i = listed.ray[j];
                const SurfacePoint point = traced.surface_point(hits.get(i), rays.direction.get(i), rays.time[i]);
                const bool equal = points.ray_origin.get(j) == point.ray_origin &&
                                   points.geometric_normal.get(j) == point.geometric_normal &&
                                   points.shading_normal.get(j) == point.shading_normal &&
                                   points.albedo.get(j) == point.albedo && points.emission.get(j) == point.emission;
                different_points += equal ? 0 : 1;
            }
        }
    }
    EXPECT_EQ(different, 0) << scene.name << ": hits of " << rays_in_all;
    EXPECT_EQ(differently_blocked, 0) << scene.name << ": of " << rays_in_all;
    EXPECT_EQ(different_points, 0) << scene.name << ": surface points";
    EXPECT_GT(met, rays_in_all / 10) << scene.name;
}

// The rays of neighbouring pixels in packets of different company, which is a matter of how fast a run gets on.
void expect_company_makes_no_difference(const Scene& scene) {
    const TracedScene traced(scene);
    const Bounds bounds = scene.bounds();
    int different = 0, met = 0;
    for (const float turn : {0.1f, 1.7f, 3.4f, 4.9f}) {
        const glm::vec3 eye = glm::mix(bounds.lower, bounds.upper, glm::vec3(0.5f, 0.25f, 0.5f));
        const View view = view_of(eye, eye + glm::vec3(std::cos(turn), 0.2f, std::sin(turn)), 1.0f, 64);
        std::vector<Ray> rays;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                rays.push_back(view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
            }
        }
        const auto hits_in_batches = [&](std::size_t first_batch, std::size_t size) {
            std::vector<SurfaceHit> hits;
            while (hits.size() < rays.size()) {
                const std::size_t wanted = hits.empty() ? first_batch : size;
                RayBatch batch;
                for (std::size_t i = hits.size(); i < std::min(hits.size() + wanted, rays.size()); ++i) {
                    batch.add(rays[i].origin, rays[i].direction, infinite_distance, now);
                }
                HitBatch found;
                traced.intersect(batch, found);
                for (int i = 0; i < batch.count; ++i) hits.push_back(found.get(i));
            }
            return hits;
        };
        const std::vector<SurfaceHit> alone = hits_in_batches(1, 1);
        for (const auto& others : {hits_in_batches(64, 64), hits_in_batches(3, 64), hits_in_batches(5, 6)}) {
            for (std::size_t i = 0; i < rays.size(); ++i) different += same(alone[i], others[i]) ? 0 : 1;
        }
        for (const SurfaceHit& hit : alone) met += hit.missed() ? 0 : 1;
    }
    EXPECT_EQ(different, 0) << scene.name;
    EXPECT_GT(met, 2000) << scene.name;
}

class Packets : public testing::TestWithParam<std::string> {};

TEST_P(Packets, FindTheSingleRaysBits) { expect_single_rays_hits(make_builtin_scene(GetParam())); }

TEST_P(Packets, OfPrimaryRaysDoNotDependOnTheirCompany) {
    expect_company_makes_no_difference(make_builtin_scene(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Packets, testing::ValuesIn(builtin_scene_names()),
                         [](const auto& test) { return test.param; });

TEST(PacketsInMotion, FindTheSingleRaysBits) {
    Scene scene = make_cornell();
    for (std::size_t i = 0; i < scene.instances.size(); i += 2) {
        Motion& motion = scene.instances[i].motion;
        motion.rest = scene.instances[i].world_from_object;
        motion.keys = {{.time = 0.0f}, {.time = 1.0f, .translation = {0.1f, 0.05f, -0.1f}}};
    }
    expect_single_rays_hits(scene, {0.0, 1.0});
}

// Every surface there three times, cut into squares of different sizes: whatever is met, others lie at that very place.
TEST(PacketsAmongCoincidentSurfaces, DoNotDependOnTheirCompany) {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    for (const int cells : {24, 25, 7}) {
        std::vector<std::vector<glm::vec3>> quads;
        const float size = 4.0f / static_cast<float>(cells);
        for (const float y : {-1.0f, 1.0f}) {
            for (int i = 0; i < cells * cells; ++i) {
                const int column = i % cells, row = i / cells;
                const float x = -2.0f + size * static_cast<float>(column), z = -2.0f + size * static_cast<float>(row);
                quads.push_back({{x, y, z + size}, {x + size, y, z + size}, {x + size, y, z}, {x, y, z}});
            }
        }
        add_quads(scene, grey, quads);
    }
    expect_company_makes_no_difference(scene);
    expect_single_rays_hits(scene);
}

// Some of its triangles are there twice.
TEST(PacketsInSponza, FindTheSingleRaysBitsInAnyCompany) {
    const char* folder = std::getenv("PLUMBLINE_SCENES");
    if (!folder) GTEST_SKIP() << "PLUMBLINE_SCENES is unset: no meshes to read";
    const std::filesystem::path file = std::filesystem::path(folder) / "crytek-sponza/sponza.obj";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene scene = import_scene_file(file);
    expect_single_rays_hits(scene);
    expect_company_makes_no_difference(scene);
}

// Gloss, mirrors, panes, an environment image, a panel, a sun, lamps, motion: everything that a batch may hold.
Scene everything_at_once() {
    Scene scene;
    add_quads(scene, add_dielectric(scene, {0.6f, 0.5f, 0.4f}, 0.4f), {floor_quad(2.0f)});
    add_quads(scene, add_metal(scene, {0.9f, 0.7f, 0.4f}, 0.3f), {{{-1, 0, -1}, {0, 0, -1}, {0, 1, -1}, {-1, 1, -1}}});
    add_quads(scene, add_metal(scene, glm::vec3(0.9f), 0.0f), {{{0, 0, -1}, {1, 0, -1}, {1, 1, -1}, {0, 1, -1}}});
    add_quads(scene, add_pane(scene, {0.7f, 0.5f, 0.3f}, glm::vec3(0.2f)),
              {{{-0.5f, 0, 0.2f}, {0.2f, 0, 0.2f}, {0.2f, 0.6f, 0.2f}, {-0.5f, 0.6f, 0.2f}}});
    scene.materials.back().dielectric_reflectance = 0.04f, scene.materials.back().roughness = 0.1f;
    add_quads(scene, add_material(scene, glm::vec3(0.3f), {4.0f, 3.0f, 2.0f}, false),
              {{{-0.3f, 1.2f, -0.3f}, {0.3f, 1.2f, -0.3f}, {0.3f, 1.2f, 0.3f}, {-0.3f, 1.2f, 0.3f}}});
    Motion& motion = scene.instances.back().motion;
    motion.keys = {{.time = 0.0f}, {.time = 1.0f, .translation = {0.2f, 0.1f, 0.0f}}};
    add_uneven_sky(scene);
    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(0.4f, -1, -0.5f)), glm::vec3(1.0f), 0.05f});
    scene.point_lights.push_back({"lamp", {0.5f, 0.7f, 0.5f}, glm::vec3(0.3f)});
    scene.point_lights.push_back({"lamp", {-0.5f, 0.9f, 0.5f}, glm::vec3(0.2f, 0.3f, 0.4f)});
    return scene;
}

// The tile size is 16: several tiles, the last ones cut.
View everything_view(bool lens) {
    Camera camera = Camera::look_at("all", {0.3f, 0.9f, 2.2f}, {0, 0.3f, 0}, 0.8f);
    camera.near_plane = 1e-3f, camera.far_plane = 1e3f;
    if (lens) camera.aperture_radius = 0.05f, camera.focus_distance = 2.0f;
    return View(camera, 21, 19);
}
ReferenceSettings everything_settings(bool spread) {
    auto settings = settings_for(
        {"ao", "direct", "indirect", "indirect.2", "irradiance", "reflection", "emission", "total", "depth"}, 32, 3);
    settings.roulette_after = 1;
    settings.antialias = spread;
    if (spread) settings.view_at_shutter_opening = everything_view(true);
    return settings;
}

class Splitting : public testing::TestWithParam<bool> {};  // whether primary rays are spread

TEST_P(Splitting, OfSamplesOverShardsKeepsEveryBit) {
    const Scene scene = everything_at_once();
    const PathTracer tracer(scene, {0.0, 1.0});
    const View view = everything_view(GetParam());
    ReferenceSettings settings = everything_settings(GetParam());
    const ReferenceResult whole = tracer.render(view, settings);
    EXPECT_TRUE(whole.exact);
    const auto folder =
        std::filesystem::temp_directory_path() / fmt::format("plumbline_effects_{}_{}", ::getpid(), GetParam());
    std::filesystem::create_directories(folder);
    std::vector<std::filesystem::path> shards;
    // No pixel's samples of the first and the last fill a batch; each has another number of threads.
    constexpr int cuts[] = {0, 2, 30, 32};
    for (int i = 2; i >= 0; --i) {
        ReferenceSettings part = settings;
        part.first_sample = cuts[i], part.samples = cuts[i + 1];
        shards.push_back(folder / fmt::format("{}.shard", i));
        ASSERT_TRUE(tracer.render_shard(view, part, shards.back(), {.threads = i + 1}));
    }
    const ReferenceResult merged = tracer.merge(view, settings, shards).result();
    std::filesystem::remove_all(folder);
    expect_same_bits(merged.frame, whole.frame);
    EXPECT_EQ(merged.samples, 32);
}

TEST_P(Splitting, OfPixelsOverThreadsKeepsEveryBit) {
    const Scene scene = everything_at_once();
    const PathTracer tracer(scene, {0.0, 1.0});
    const View view = everything_view(GetParam());
    const ReferenceSettings settings = everything_settings(GetParam());
    const Frame one = tracer.render(view, settings, {.threads = 1}).frame;
    for (const int threads : {2, 3}) {
        expect_same_bits(tracer.render(view, settings, {.threads = threads}).frame, one);
    }
}

// A dim scene under which ambient visibilities are summed as well: those are far larger than its radiances.
TEST_P(Splitting, OfADimScenesSamplesIsExact) {
    Scene scene = everything_at_once();
    for (Material& material : scene.materials) material.emission *= 1e-7f;
    scene.point_lights.clear(), scene.directional_lights.clear();
    scene.environment.radiance *= 1e-7f;
    const PathTracer tracer(scene, {0.0, 1.0});
    EXPECT_TRUE(tracer.render(everything_view(GetParam()), everything_settings(GetParam())).exact);
}

INSTANTIATE_TEST_SUITE_P(All, Splitting, testing::Bool(),
                         [](const auto& test) { return test.param ? "SpreadPrimaryRays" : "PixelCentres"; });

}  // namespace
}  // namespace plumb
