// A closed room of 4 x 2.7 x 4 m, full of what one depth layer misses: slats and panels just off a coloured wall,
// bowls, leaning boards, frames, a stool before a box. Light comes from a lamp and from a small panel.
#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/builtin.h"
#include "scenes/mesh_maker.h"
#include "scenes/procedural_texture.h"

namespace plumb {
namespace {

enum MaterialIndex { wall_white, boards, orange, teal, violet, pale, wood, clay, panel_light, metal };

glm::mat4 placed(const glm::vec3& where, float yaw_degrees, float lean_degrees = 0.0f) {
    const glm::mat4 turned =
        glm::rotate(glm::translate(glm::mat4(1.0f), where), glm::radians(yaw_degrees), glm::vec3(0, 1, 0));
    return glm::rotate(turned, glm::radians(lean_degrees), glm::vec3(1, 0, 0));
}

void add_materials(Scene& scene) {
    const PeriodicNoise grain(4, 5);
    scene.textures.push_back(make_texture("boards", 128, [&](glm::vec2 uv) {
        const float plank = std::floor(uv.x * 4.0f);
        const float tone = grain({uv.x + 0.37f * plank, 0.25f * uv.y + 0.21f * plank});
        return glm::vec4(glm::mix(glm::vec3(0.30f, 0.19f, 0.11f), glm::vec3(0.52f, 0.36f, 0.22f), tone), 1.0f);
    }));
    const auto material = [&](const char* name, const glm::vec3& colour) -> Material& {
        Material m;
        m.name = name;
        m.base_colour = colour;
        return scene.materials.emplace_back(m);
    };
    material("white wall", {0.74f, 0.73f, 0.70f});
    material("floor boards", {1.0f, 1.0f, 1.0f}).base_colour_texture = 0;
    material("orange", {0.70f, 0.28f, 0.05f});
    material("teal", {0.05f, 0.42f, 0.40f});
    material("violet", {0.33f, 0.10f, 0.48f});
    material("pale", {0.66f, 0.64f, 0.52f});
    material("wood", {0.45f, 0.28f, 0.15f});
    material("clay", {0.55f, 0.33f, 0.24f});
    Material& light = material("light panel", {0.78f, 0.78f, 0.78f});
    light.emission = {9.0f, 8.4f, 7.4f};
    light.two_sided = false;
    material("grey enamel", {0.28f, 0.30f, 0.33f});
}

void add_room(Scene& scene) {
    Mesh room = make_mesh("room", wall_white), floor = make_mesh("floor", boards);
    // Walls reach 2 cm past each other.
    append_quad(room, {-2.02f, -0.02f, -2.0f}, {4.04f, 0, 0}, {0, 2.74f, 0});
    append_quad(room, {2.02f, -0.02f, 2.0f}, {-4.04f, 0, 0}, {0, 2.74f, 0});
    append_quad(room, {2.0f, -0.02f, -2.02f}, {0, 0, 4.04f}, {0, 2.74f, 0});
    append_quad(room, {-2.02f, 2.7f, -2.02f}, {4.04f, 0, 0}, {0, 0, 4.04f});
    append_quad(floor, {-2.02f, 0.0f, 2.02f}, {4.04f, 0, 0}, {0, 0, -4.04f}, 0.9f);
    add_object(scene, std::move(room));
    add_object(scene, std::move(floor));
    Mesh left = make_mesh("left wall", teal);
    append_quad(left, {-2.0f, -0.02f, 2.02f}, {0, 0, -4.04f}, {0, 2.74f, 0});
    add_object(scene, std::move(left));
    Mesh light = make_mesh("light panel", panel_light);  // 1 cm below the ceiling, facing down
    append_quad(light, {0.55f, 2.69f, -0.35f}, {0.6f, 0, 0}, {0, 0, 0.6f});
    add_object(scene, std::move(light));
}

// Before the back wall: slats over an orange board, thin upright panels with 4 to 14 cm behind them, frames 3 cm off.
void add_wall_objects(Scene& scene) {
    Mesh board = make_mesh("board", orange);
    append_box(board, {-1.85f, 0.25f, -2.01f}, {-0.55f, 1.75f, -1.97f});
    add_object(scene, std::move(board));
    Mesh slats = make_mesh("slats", wood);
    for (int i = 0; i < 13; ++i) {
        const float x = -1.80f + 0.1f * static_cast<float>(i);
        append_box(slats, {x, 0.17f, -1.86f}, {x + 0.035f, 1.83f, -1.82f});
    }
    append_box(slats, {-1.88f, 0.12f, -1.87f}, {-0.52f, 0.18f, -1.81f});
    append_box(slats, {-1.88f, 1.82f, -1.87f}, {-0.52f, 1.88f, -1.81f});
    append_box(slats, {-1.87f, -0.01f, -1.865f}, {-1.81f, 0.13f, -1.815f});
    append_box(slats, {-0.59f, -0.01f, -1.865f}, {-0.53f, 0.13f, -1.815f});
    add_object(scene, std::move(slats));

    Random random(31);
    Mesh uprights[3] = {make_mesh("violet panels", violet), make_mesh("pale panels", pale),
                        make_mesh("orange panels", orange)};
    for (int i = 0; i < 8; ++i) {
        const float x = -0.32f + 0.17f * static_cast<float>(i), height = random.uniform(0.5f, 1.15f);
        const float gap = random.uniform(0.04f, 0.14f), turn = random.uniform(-14.0f, 14.0f);
        append_box(uprights[i % 3], {-0.065f, -0.01f, -0.008f}, {0.065f, height, 0.008f},
                   placed({x, 0, -1.98f + gap + 0.03f}, turn));
    }
    for (Mesh& mesh : uprights) add_object(scene, std::move(mesh));

    Mesh frames = make_mesh("frames", metal), pictures = make_mesh("pictures", teal);
    for (int i = 0; i < 3; ++i) {
        const float x = -0.25f + 0.62f * static_cast<float>(i), y = 1.42f + 0.07f * static_cast<float>(i % 2);
        append_box(frames, {x - 0.03f, y - 0.03f, -1.97f}, {x + 0.45f, y, -1.93f});
        append_box(frames, {x - 0.03f, y + 0.5f, -1.97f}, {x + 0.45f, y + 0.53f, -1.93f});
        append_box(frames, {x - 0.03f, y - 0.005f, -1.965f}, {x, y + 0.505f, -1.935f});
        append_box(frames, {x + 0.42f, y - 0.005f, -1.965f}, {x + 0.45f, y + 0.505f, -1.935f});
        append_box(pictures, {x - 0.005f, y - 0.006f, -1.955f}, {x + 0.425f, y + 0.506f, -1.95f});
    }
    add_object(scene, std::move(frames));
    add_object(scene, std::move(pictures));
}

Mesh make_bowl() {
    Mesh bowl = make_mesh("bowl", clay);
    std::vector<glm::vec2> profile = {{0.0f, -0.002f}, {0.07f, -0.002f}, {0.075f, 0.012f}};
    for (int i = 0; i <= 10; ++i) {  // outside
        const float angle = glm::half_pi<float>() * static_cast<float>(i) / 10.0f;
        profile.push_back({0.085f + 0.115f * std::sin(angle), 0.014f + 0.13f * (1.0f - std::cos(angle))});
    }
    for (int i = 10; i >= 0; --i) {  // inside, a centimetre thinner
        const float angle = glm::half_pi<float>() * static_cast<float>(i) / 10.0f;
        profile.push_back({0.072f + 0.118f * std::sin(angle), 0.026f + 0.122f * (1.0f - std::cos(angle))});
    }
    profile.push_back({0.0f, 0.024f});
    append_lathe(bowl, profile, 40);
    return bowl;
}

// A shelf board along the right wall with bowls on it and below it, one stacked into another, and balls in one.
void add_shelf(Scene& scene) {
    Mesh shelf = make_mesh("shelf", wood);
    append_box(shelf, {1.45f, 0.86f, -1.2f}, {2.01f, 0.90f, 1.0f});
    append_box(shelf, {1.50f, -0.01f, -1.12f}, {1.55f, 0.87f, -1.07f});
    append_box(shelf, {1.50f, -0.01f, 0.87f}, {1.55f, 0.87f, 0.92f});
    append_box(shelf, {1.49f, 0.38f, -1.21f}, {2.02f, 0.41f, 1.01f});
    add_object(scene, std::move(shelf));

    const int bowl = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(make_bowl());
    const auto put = [&](const glm::vec3& where, float scale) {
        const glm::mat4 place = glm::scale(glm::translate(glm::mat4(1.0f), where), glm::vec3(scale));
        scene.instances.push_back({"bowl", bowl, place});
    };
    for (int i = 0; i < 4; ++i)
        put({1.72f, 0.90f, -0.95f + 0.48f * static_cast<float>(i)}, 0.9f + 0.08f * static_cast<float>(i));
    put({1.72f, 0.945f, -0.95f}, 0.88f);
    put({1.72f, 0.99f, -0.95f}, 0.86f);
    for (int i = 0; i < 4; ++i) put({1.74f, 0.41f, -0.85f + 0.45f * static_cast<float>(i)}, 1.0f);
    put({-0.25f, 0.47f, 0.15f}, 1.3f);

    Mesh balls = make_mesh("balls", orange);
    const auto ball = [&](const glm::vec3& centre, float radius) {
        std::vector<glm::vec2> profile;
        for (int i = 0; i <= 16; ++i) {
            const float angle = glm::pi<float>() * (static_cast<float>(i) / 16.0f - 0.5f);
            const float r = i == 0 || i == 16 ? 0.0f : radius * std::cos(angle);
            profile.push_back({r, radius * std::sin(angle)});
        }
        const std::size_t first = balls.positions.size();
        append_lathe(balls, profile, 32);
        place_vertices(balls, first, glm::translate(glm::mat4(1.0f), centre));
    };
    ball({-0.32f, 0.575f, 0.12f}, 0.075f);
    ball({-0.18f, 0.575f, 0.20f}, 0.075f);
    ball({1.72f, 0.995f, 0.01f}, 0.07f);
    ball({-1.10f, 0.118f, 0.55f}, 0.12f);
    add_object(scene, std::move(balls));
}

// In the middle: a stool with thin legs, a stack of turned boxes, boards leaning on it and on the teal wall.
void add_floor_objects(Scene& scene) {
    Mesh stool = make_mesh("stool", wood);
    append_box(stool, {-0.55f, 0.44f, -0.13f}, {0.05f, 0.472f, 0.43f});
    for (const float x : {-0.53f, -0.005f}) {
        for (const float z : {-0.11f, 0.375f}) append_box(stool, {x, -0.01f, z}, {x + 0.035f, 0.45f, z + 0.035f});
    }
    append_box(stool, {-0.525f, 0.16f, -0.10f}, {0.025f, 0.185f, -0.085f});
    append_box(stool, {-0.525f, 0.16f, 0.385f}, {0.025f, 0.185f, 0.40f});
    add_object(scene, std::move(stool));

    Random random(8);
    Mesh stack = make_mesh("stacked boxes", pale);
    float height = -0.005f;
    for (int i = 0; i < 6; ++i) {
        const float half = random.uniform(0.10f, 0.19f), tall = random.uniform(0.10f, 0.24f);
        const float turn = random.uniform(0.0f, 90.0f);
        append_box(stack, {-half, 0.0f, -half}, {half, tall, half}, placed({0.82f, height, -0.62f}, turn));
        height += tall - 0.003f;
    }
    add_object(scene, std::move(stack));

    Mesh leaning = make_mesh("leaning boards", violet);
    append_box(leaning, {-0.25f, 0.0f, -0.01f}, {0.25f, 1.0f, 0.01f}, placed({0.70f, -0.005f, -0.12f}, 8.0f, -17.0f));
    append_box(leaning, {-0.35f, 0.0f, -0.01f}, {0.35f, 1.5f, 0.01f}, placed({-1.70f, -0.005f, -0.75f}, 90.0f, -9.0f));
    append_box(leaning, {-0.20f, 0.0f, -0.01f}, {0.20f, 1.1f, 0.01f}, placed({-1.58f, -0.005f, -0.62f}, 90.0f, -14.0f));
    add_object(scene, std::move(leaning));

    Mesh grid = make_mesh("grid", metal);  // a rack of thin bars before the teal wall
    for (int i = 0; i < 9; ++i) {
        const float z = 0.1f + 0.14f * static_cast<float>(i);
        append_box(grid, {-1.87f, 0.30f, z}, {-1.855f, 1.60f, z + 0.015f});
    }
    for (int i = 0; i < 4; ++i) {
        const float y = 0.35f + 0.4f * static_cast<float>(i);
        append_box(grid, {-1.885f, y, 0.05f}, {-1.865f, y + 0.02f, 1.30f});
        append_box(grid, {-2.01f, y + 0.003f, 0.08f}, {-1.88f, y + 0.017f, 0.094f});
        append_box(grid, {-2.01f, y + 0.003f, 1.25f}, {-1.88f, y + 0.017f, 1.264f});
    }
    add_object(scene, std::move(grid));
}

void add_views(Scene& scene) {
    constexpr float near_plane = 0.05f, far_plane = 10.0f;
    const auto view = [&](const char* name, const glm::vec3& eye, const glm::vec3& target, float degrees) {
        scene.cameras.push_back(Camera::look_at(name, eye, target, glm::radians(degrees)));
        scene.cameras.back().near_plane = near_plane;
        scene.cameras.back().far_plane = far_plane;
    };
    view("front", {0.05f, 1.35f, 1.85f}, {0.0f, 0.75f, -1.5f}, 60.0f);
    view("slats", {-0.35f, 1.15f, -0.35f}, {-1.35f, 0.9f, -1.95f}, 55.0f);
    view("shelf", {0.35f, 1.30f, 0.75f}, {1.75f, 0.75f, -0.4f}, 60.0f);
    view("leaning", {0.6f, 1.0f, 1.3f}, {-1.7f, 0.7f, -0.1f}, 60.0f);
    CameraPath strafe{"strafe", glm::radians(60.0f), near_plane, far_plane, {}};
    strafe.keys = {{0.0f, {-1.2f, 1.25f, 1.4f}, {-0.9f, 0.8f, -1.9f}},
                   {2.0f, {-0.1f, 1.35f, 1.5f}, {0.0f, 0.8f, -1.9f}},
                   {4.0f, {1.1f, 1.25f, 1.4f}, {0.8f, 0.8f, -1.9f}}};
    CameraPath approach{"approach", glm::radians(55.0f), near_plane, far_plane, {}};
    approach.keys = {{0.0f, {0.9f, 1.45f, 1.6f}, {-0.6f, 0.8f, -1.9f}},
                     {2.0f, {0.3f, 1.35f, 0.7f}, {-0.9f, 0.85f, -1.9f}},
                     {4.0f, {-0.5f, 1.2f, -0.5f}, {-1.3f, 0.9f, -1.95f}}};
    scene.paths = {strafe, approach};
}

}  // namespace

Scene make_clutter() {
    Scene scene;
    scene.name = "clutter";
    scene.description = "A closed room full of thin gaps and occluders just off its walls, where one depth layer fails";
    add_materials(scene);
    add_room(scene);
    add_wall_objects(scene);
    add_shelf(scene);
    add_floor_objects(scene);
    scene.point_lights.push_back({"lamp", {-0.7f, 2.2f, 0.9f}, {5.0f, 4.6f, 4.0f}});
    add_views(scene);
    return scene;
}

}  // namespace plumb
