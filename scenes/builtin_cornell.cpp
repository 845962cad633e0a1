#include <array>
#include <initializer_list>

#include <glm/glm.hpp>

#include "scenes/builtin.h"

namespace plumb {
namespace {

using Quad = std::array<glm::vec3, 4>;

// Corners come in millimetres, as measured; the scene is in metres. Each quad is cut along its first diagonal: the
// measured left wall is 3 mm off a plane.
void add_quads(Scene& scene, const char* name, int material, std::initializer_list<Quad> quads) {
    Mesh mesh;
    mesh.name = name;
    mesh.material = material;
    for (const Quad& quad : quads) {
        const auto first = static_cast<unsigned>(mesh.positions.size());
        for (const glm::vec3& corner : quad) mesh.positions.push_back(0.001f * corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    scene.instances.push_back({name, static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(std::move(mesh));
}

Material diffuse(const char* name, const glm::vec3& albedo) {
    Material material;
    material.name = name;
    material.base_colour = albedo;
    return material;
}

}  // namespace

// Corners: "Cornell Box Data", Cornell University Program of Computer Graphics. Its spectra are given here as linear
// Rec.709 colours, the light scaled to the radiance that renderers commonly use for this scene.
Scene make_cornell() {
    Scene scene;
    scene.name = "cornell";
    scene.description = "The measured Cornell box: colour bleeding in a closed room, one emissive square";

    scene.materials = {diffuse("white", {0.725f, 0.71f, 0.68f}), diffuse("red", {0.63f, 0.065f, 0.05f}),
                       diffuse("green", {0.14f, 0.45f, 0.091f}), diffuse("light", {0.78f, 0.78f, 0.78f})};
    scene.materials[3].emission = {18.4f, 15.6f, 8.0f};
    scene.materials[3].two_sided = false;
    constexpr int white = 0, red = 1, green = 2, light = 3;

    add_quads(scene, "floor", white, {{{{552.8f, 0, 0}, {0, 0, 0}, {0, 0, 559.2f}, {549.6f, 0, 559.2f}}}});
    add_quads(scene, "ceiling", white,
              {{{{556, 548.8f, 0}, {556, 548.8f, 559.2f}, {0, 548.8f, 559.2f}, {0, 548.8f, 0}}}});
    add_quads(scene, "back wall", white,
              {{{{549.6f, 0, 559.2f}, {0, 0, 559.2f}, {0, 548.8f, 559.2f}, {556, 548.8f, 559.2f}}}});
    add_quads(scene, "right wall", green, {{{{0, 0, 559.2f}, {0, 0, 0}, {0, 548.8f, 0}, {0, 548.8f, 559.2f}}}});
    add_quads(scene, "left wall", red,
              {{{{552.8f, 0, 0}, {549.6f, 0, 559.2f}, {556, 548.8f, 559.2f}, {556, 548.8f, 0}}}});
    // The light hangs half a millimetre below the ceiling, so that the two never lie in one plane.
    add_quads(scene, "light", light,
              {{{{343, 548.3f, 227}, {343, 548.3f, 332}, {213, 548.3f, 332}, {213, 548.3f, 227}}}});
    add_quads(scene, "short block", white,
              {{{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
               {{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
               {{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
               {{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
               {{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}}});
    add_quads(scene, "tall block", white,
              {{{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
               {{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
               {{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
               {{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
               {{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}}});

    // 35 mm lens, 25 mm square film: 2 atan(12.5 / 35) = 0.6864 rad.
    Camera front = Camera::look_at("front", {0.278f, 0.273f, -0.8f}, {0.278f, 0.273f, 0.0f}, 0.6864f);
    Camera blocks = Camera::look_at("blocks", {0.46f, 0.38f, -0.22f}, {0.24f, 0.12f, 0.30f}, 0.9f);
    Camera gap = Camera::look_at("gap", {0.06f, 0.22f, 0.02f}, {0.36f, 0.14f, 0.36f}, 1.0f);
    for (Camera* camera : {&front, &blocks, &gap}) {
        camera->near_plane = 0.01f;
        camera->far_plane = 5.0f;
        scene.cameras.push_back(*camera);
    }
    CameraPath strafe{"strafe", 0.6864f, 0.01f, 5.0f, {}};
    strafe.keys = {{0.0f, {0.21f, 0.273f, -0.75f}, {0.26f, 0.26f, 0.1f}},
                   {1.0f, {0.278f, 0.29f, -0.72f}, {0.278f, 0.25f, 0.1f}},
                   {2.0f, {0.35f, 0.273f, -0.75f}, {0.30f, 0.26f, 0.1f}}};
    CameraPath orbit{"orbit", 0.9f, 0.01f, 5.0f, {}};
    orbit.keys = {{0.0f, {0.46f, 0.38f, -0.22f}, {0.24f, 0.12f, 0.30f}},
                  {1.5f, {0.28f, 0.42f, -0.30f}, {0.26f, 0.14f, 0.30f}},
                  {3.0f, {0.08f, 0.34f, -0.20f}, {0.30f, 0.14f, 0.32f}}};
    scene.paths = {strafe, orbit};
    return scene;
}

}  // namespace plumb
