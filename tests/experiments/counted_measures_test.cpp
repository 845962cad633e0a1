// What is counted beside a run: on geometry whose answers can be told beforehand, and for cells of a small experiment.
#include "experiments/counted_measures.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/depth_normals.h"
#include "experiments/exact_surfaces.h"
#include "pathtracer/reference.h"
#include "scenes/mesh_maker.h"

namespace plumb {
namespace {

// Two boxes a metre deep, one metre of air between them, seen from the front by a narrow camera, which looks through
// both everywhere.
Scene two_boxes() {
    Scene scene;
    scene.materials.emplace_back();
    Mesh mesh = make_mesh("boxes", 0);
    append_box(mesh, {-1, -1, -3}, {1, 1, -2});
    append_box(mesh, {-1, -1, -5}, {1, 1, -4});
    add_object(scene, mesh);
    return scene;
}

View narrow_view() { return View(Camera::look_at("front", {0, 0, 0}, {0, 0, -1}, 0.1f), 16, 16); }

TEST(ExactSurfaces, AreCountedAlongEveryRay) {
    const Scene scene = two_boxes();
    EXPECT_DOUBLE_EQ(surfaces_per_pixel(TracedScene(scene), narrow_view()), 4.0);
    // From beside the boxes nothing is seen.
    const View away(Camera::look_at("away", {0, 0, 0}, {0, 0, 1}, 0.1f), 16, 16);
    EXPECT_TRUE(std::isnan(surfaces_per_pixel(TracedScene(scene), away)));
}

TEST(ExactSurfaces, TheSecondLayerShowsABackUntilTheSeparationPassesTheFirstThing) {
    const Scene scene = two_boxes();
    const TracedScene traced(scene);
    EXPECT_DOUBLE_EQ(back_face_share(traced, narrow_view(), 0.1f), 1.0);  // the back of the first box
    EXPECT_DOUBLE_EQ(back_face_share(traced, narrow_view(), 1.5f), 0.0);  // the front of the second
    EXPECT_DOUBLE_EQ(back_face_share(traced, narrow_view(), 2.5f), 1.0);  // its back
    EXPECT_TRUE(std::isnan(back_face_share(traced, narrow_view(), 3.5f)));
}

TEST(DepthNormals, AreThoseOfTheSurfaceWhereDepthIsExactAndOffAsFarAsDepthIsTilted) {
    Scene scene;
    scene.materials.emplace_back();
    Mesh mesh = make_mesh("slope", 0);
    // Rises by 30 degrees away from the camera.
    const float rise = std::tan(glm::radians(30.0f));
    append_quad(mesh, {-4, -4 * rise, -2}, {8, 0, 0}, {0, 8 * rise, -8});
    add_object(scene, mesh);
    const View view(Camera::look_at("front", {0, 2, 0}, {0, 0, -5}, 0.5f), 32, 32);
    const Frame exact = PathTracer(scene).gbuffer(view, {});
    // Floats at six metres resolve 5e-7 m, pixels are a centimetre apart: 0.003 degrees at the very most.
    EXPECT_LT(depth_normal_degrees(exact.plane("depth"), exact, view), 0.003);
    Image frontal(32, 32, 1);
    for (float& depth : frontal.values()) depth = 6.0f;
    const glm::vec3 normal(exact.plane("normal").at(16, 16, 0), exact.plane("normal").at(16, 16, 1),
                           exact.plane("normal").at(16, 16, 2));
    const double tilt = glm::degrees(std::acos(glm::dot(normal, glm::vec3(view.camera().world_from_camera[2]))));
    EXPECT_NEAR(depth_normal_degrees(frontal, exact, view), tilt, 0.01);
}

TEST(CountedMeasures, AreAddedToCellsOfViewsAndMethodsWhereTheyAreAskedFor) {
    Experiment experiment;
    experiment.file = "trial.toml";
    experiment.planes = {"total"};
    experiment.width = 64, experiment.height = 36;
    experiment.methods.resize(2);
    experiment.methods[0].name = "radiosity", experiment.methods[1].name = "none";
    experiment.methods[1].radiosity.enabled = false;
    experiment.scenes.resize(1);
    experiment.scenes[0].scene = "cornell";
    const SceneFinder finder({});
    LoadedScenes scenes(finder);
    std::vector<Cell> cells = {{"cornell", "front", "total", "full", "radiosity", ""},
                               {"cornell", "front", "total", "full", "none", ""},
                               {"cornell", "orbit", "total", "full", "radiosity", ""},
                               {"cornell", "front", "total", "full", "path tracer, 2 spp", ""}};
    const auto asked = [](std::string_view measure) {
        return measure == "confidence" || measure == "shadow map bytes" || measure == "depth complexity";
    };
    add_counted_measures(experiment, scenes, GlBackend::automatic, asked, cells);
    const double confidence = measure_of(cells[0], "confidence");
    EXPECT_GT(confidence, 0.0);
    EXPECT_LT(confidence, 1.0);
    // Half of the surfaces lie on either side of the median: the whole is the mean of the halves, up to a pixel of
    // 2304.
    EXPECT_NEAR(
        (measure_of(cells[0], "confidence in near_half") + measure_of(cells[0], "confidence in far_half")) / 2.0,
        confidence, 1e-3);
    EXPECT_GT(measure_of(cells[0], "confidence in border"), 0.0);
    // A cube of six faces of 512 texels of 4 bytes: of the lamp, whose one point all see.
    EXPECT_EQ(measure_of(cells[0], "shadow map bytes"), 6.0 * 512 * 512 * 4);
    EXPECT_GT(measure_of(cells[0], "depth complexity"), 1.0);
    EXPECT_TRUE(std::isnan(measure_of(cells[0], "back faces"))) << "nobody asked";
    EXPECT_TRUE(std::isnan(measure_of(cells[1], "confidence"))) << "it has no taps";
    EXPECT_EQ(measure_of(cells[1], "depth complexity"), measure_of(cells[0], "depth complexity"));
    EXPECT_TRUE(cells[2].values.empty()) << "of a path";
    EXPECT_TRUE(cells[3].values.empty()) << "of no method";
}

}  // namespace
}  // namespace plumb
