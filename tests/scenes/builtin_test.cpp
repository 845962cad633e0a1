#include "scenes/builtin.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "scenes/scene_error.h"
#include "scenes/validate.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

struct Hit {
    float distance = std::numeric_limits<float>::infinity();
    bool back = false;   // the triangle was met on its back
    bool sheet = false;  // of a mesh that is a sheet, which has no inside
};

bool is_sheet(const std::string& mesh) {
    return mesh.find("curtain") != std::string::npos || mesh == "plant" || mesh == "grilles";
}

// Nearest hit by brute force, Moeller and Trumbore 1997.
Hit trace(const Scene& scene, const Ray& ray) {
    Hit nearest;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const glm::mat4 object_from_world = glm::inverse(instance.world_from_object);
        const glm::vec3 origin(object_from_world * glm::vec4(ray.origin, 1.0f));
        const glm::vec3 direction(object_from_world * glm::vec4(ray.direction, 0.0f));
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec3 a = mesh.positions[t.x], e1 = mesh.positions[t.y] - a, e2 = mesh.positions[t.z] - a;
            const glm::vec3 p = glm::cross(direction, e2);
            const float determinant = glm::dot(e1, p);
            if (determinant == 0.0f) continue;
            const glm::vec3 s = origin - a, q = glm::cross(s, e1);
            const float u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
            const float distance = glm::dot(e2, q) / determinant;
            if (u < 0.0f || v < 0.0f || u + v > 1.0f || distance <= 0.0f || distance >= nearest.distance) continue;
            nearest = {distance, determinant < 0.0f, is_sheet(mesh.name)};
        }
    }
    return nearest;
}

// Free space: nothing within the near plane, and no closed thing seen from its inside.
void expect_free(const Scene& scene, const Camera& camera, const std::string& what) {
    const View view(camera, 6, 4);
    int inside = 0;
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 6; ++x) {
            const Hit hit = trace(scene, view.pixel_ray(x + 0.5f, y + 0.5f));
            EXPECT_GT(hit.distance, 1.5f * camera.near_plane) << scene.name << " " << what;
            inside += hit.back && !hit.sheet ? 1 : 0;
        }
    }
    EXPECT_EQ(inside, 0) << scene.name << " " << what << ": of 24 rays met the back of a closed surface first";
}

class BuiltinScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, BuiltinScene, testing::ValuesIn(builtin_scene_names()),
                         [](const auto& scene) { return scene.param; });

TEST_P(BuiltinScene, IsValid) { EXPECT_NO_THROW(validate(make_builtin_scene(GetParam()))); }

TEST_P(BuiltinScene, HasNoTriangleThinnerThanATenthOfAMillimetre) {
    const Scene scene = make_builtin_scene(GetParam());
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
            const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
            const float height = glm::length(glm::cross(b - a, c - a)) / longest;
            EXPECT_GT(height, 1e-4f) << mesh.name;
        }
    }
}

TEST_P(BuiltinScene, HasThreeViewsAndTwoPaths) {
    const Scene scene = make_builtin_scene(GetParam());
    EXPECT_GE(scene.cameras.size(), 3u);
    EXPECT_GE(scene.paths.size(), 2u);
    EXPECT_FALSE(scene.description.empty());
    EXPECT_EQ(scene.name, GetParam());
}

TEST_P(BuiltinScene, CamerasStandInFreeSpace) {
    const Scene scene = make_builtin_scene(GetParam());
    for (const Camera& camera : scene.cameras) expect_free(scene, camera, "view " + camera.name);
    for (const CameraPath& path : scene.paths) {
        for (int i = 0; i <= 8; ++i) {
            const float time = path.keys.front().time + path.duration() * static_cast<float>(i) / 8.0f;
            expect_free(scene, path.at(time), path.at(time).name);
        }
    }
}

TEST_P(BuiltinScene, ReachesNoFartherThanItsFarPlanes) {
    const Scene scene = make_builtin_scene(GetParam());
    const Bounds bounds = scene.bounds();
    for (const Camera& camera : scene.cameras) {
        const glm::vec3 farthest =
            glm::max(glm::abs(bounds.upper - camera.position()), glm::abs(bounds.lower - camera.position()));
        EXPECT_LT(glm::length(farthest), camera.far_plane) << camera.name;
    }
}

TEST_P(BuiltinScene, IsTheSameEveryTime) {
    EXPECT_EQ(make_builtin_scene(GetParam()).content_hash(), make_builtin_scene(GetParam()).content_hash());
}

TEST(BuiltinScenes, LightOfTheCornellBoxFacesDownAndIsOneSided) {
    const Scene scene = make_cornell();
    int emitters = 0;
    for (const Mesh& mesh : scene.meshes) {
        const Material& material = scene.materials[mesh.material];
        if (!material.is_emissive()) continue;
        EXPECT_FALSE(material.two_sided);
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec3 a = mesh.positions[t.x];
            EXPECT_LT(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a).y, 0.0f);
            ++emitters;
        }
    }
    EXPECT_EQ(emitters, 2);
}

TEST(BuiltinScenes, ColonnadeHasTensOfThousandsOfTriangles) {
    const std::size_t count = make_colonnade().triangle_count();
    EXPECT_GT(count, 50000u);
    EXPECT_LT(count, 200000u);
}

TEST(BuiltinScenes, AnUnknownNameListsTheOnesThereAre) {
    const std::string message = message_of<SceneError>([] { make_builtin_scene("cornel"); });
    EXPECT_THAT(message, testing::AllOf(testing::HasSubstr("cornell"), testing::HasSubstr("colonnade")));
}

}  // namespace
}  // namespace plumb
