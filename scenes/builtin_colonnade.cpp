// An atrium of 30 x 11 x 15.6 m: two storeys of columns and round arches around a court under the open sky, groin
// vaults over the lower aisles, coffers over the upper ones, curtains in the arches, grilles and plants with alpha
// masks. It shows what Sponza shows, with clean geometry.
#include <array>
#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/builtin.h"
#include "scenes/mesh_maker.h"
#include "scenes/procedural_texture.h"

namespace plumb {
namespace {

constexpr int bays = 8;
constexpr float bay_width = 3.6f;
constexpr float half_length = 0.5f * bays * bay_width;
constexpr float arcade_z = 3.5f;  // middle of the arcade walls
constexpr float arch_radius = 1.35f;
constexpr float lower_springing = 3.2f, lower_top = 5.05f;
constexpr float gallery_floor = 5.4f, upper_springing = 8.1f, upper_top = 10.3f;
constexpr float outer_wall = 7.2f;              // |z| of its inner face
constexpr float sink = 0.02f;                   // metres that a piece reaches into its neighbour
constexpr float end_wall = half_length - sink;  // |x| of its inner face

enum MaterialIndex { stone, plaster, marble, timber, iron_grille, leaf, terracotta, red, green, blue, bronze };

float bay_edge(int i) { return -half_length + bay_width * static_cast<float>(i); }
float bay_centre(int i) { return 0.5f * (bay_edge(i) + bay_edge(i + 1)); }

// The frame of one long side: the aisle lies towards +z of it. side 0: z > 0, side 1: z < 0 (turned by half a turn).
glm::mat4 side_frame(int side) {
    const float sign = side == 0 ? 1.0f : -1.0f;  // written out: a rotation by a rounded pi would tilt it
    return glm::scale(glm::mat4(1.0f), glm::vec3(sign, 1.0f, sign));
}

Mesh make_column() {
    Mesh column = make_mesh("column", stone);
    append_box(column, {-0.45f, 0.0f, -0.45f}, {0.45f, 0.2f, 0.45f});
    append_box(column, {-0.48f, 2.88f, -0.48f}, {0.48f, 3.1f, 0.48f});
    std::vector<glm::vec2> profile = {{0.40f, 0.18f}};
    for (int i = 0; i <= 6; ++i) {  // the torus of the base
        const float angle = glm::pi<float>() * (static_cast<float>(i) / 6.0f - 0.5f);
        profile.push_back({0.37f + 0.07f * std::cos(angle), 0.29f + 0.07f * std::sin(angle)});
    }
    for (int i = 0; i <= 8; ++i) {  // the shaft, a little swollen
        const float t = static_cast<float>(i) / 8.0f;
        profile.push_back({0.31f - 0.05f * t * t, 0.38f + 2.10f * t});
    }
    for (int i = 0; i <= 3; ++i) {  // a ring
        const float angle = glm::pi<float>() * (static_cast<float>(i) / 3.0f - 0.5f);
        profile.push_back({0.27f + 0.03f * std::cos(angle), 2.53f + 0.03f * std::sin(angle)});
    }
    for (int i = 0; i <= 6; ++i) {  // the capital's bell
        const float t = static_cast<float>(i) / 6.0f;
        profile.push_back({0.26f + 0.17f * t * t, 2.58f + 0.32f * t});
    }
    append_lathe(column, profile, 24);
    return column;
}

// One groin vault over the bay from `left` to `right`: four webs of two crossing barrels, each ruled from the diagonals
// to the bay's edge. It reaches `sink` into the walls.
void append_groin_vault(Mesh& mesh, float left, float right) {
    constexpr int steps = 24;
    std::array<float, steps + 1> across, height;  // the half circle; mirrored, so that webs meet bit for bit
    for (int i = 0; i <= steps / 2; ++i) {
        const float angle = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(steps);
        across[i] = i == steps / 2 ? 0.0f : -std::cos(angle);
        across[steps - i] = -across[i];
        height[i] = height[steps - i] = std::sin(angle);
    }
    const float near_z = arcade_z + 0.3f - sink, far_z = outer_wall + sink;
    const glm::vec3 centre(0.5f * (left + right), lower_springing, 0.5f * (near_z + far_z));
    const glm::vec3 half(arch_radius + sink, arch_radius + sink, 0.5f * (far_z - near_z));
    for (int web = 0; web < 4; ++web) {
        const bool along_z = web % 2 == 0;
        const float towards = web < 2 ? 1.0f : -1.0f;
        const auto first = static_cast<unsigned>(mesh.positions.size());
        for (int i = 0; i <= steps; ++i) {
            const auto place = [&](float a, float b) { return along_z ? glm::vec3(a, 0, b) : glm::vec3(b, 0, a); };
            const glm::vec3 normal =
                -glm::normalize((place(across[i], 0.0f) + glm::vec3(0.0f, height[i], 0.0f)) / half);
            for (const float w : {std::abs(across[i]), 1.0f}) {
                const glm::vec3 position = centre + half * (place(across[i], towards * w) + glm::vec3(0, height[i], 0));
                append_vertex(mesh, position, normal, 0.4f * glm::vec2(position.x, position.z));
            }
        }
        for (int i = 0; i < steps; ++i) {
            const unsigned a = first + 2 * i;
            if (along_z == (towards > 0.0f)) {
                append_triangle(mesh, a, a + 2, a + 3);
                append_triangle(mesh, a, a + 3, a + 1);
            } else {
                append_triangle(mesh, a, a + 3, a + 2);
                append_triangle(mesh, a, a + 1, a + 3);
            }
        }
    }
}

// A rib under the vaults across the aisle, between two bays, from one wall to the other.
void append_rib(Mesh& mesh, float x) {
    const std::size_t first = mesh.positions.size();
    const float half_span = 0.5f * (outer_wall - arcade_z - 0.3f);
    // The bay of an arch wall, turned so that the aisle's width runs along its x.
    append_arch_bay(mesh, {-half_span - sink, half_span + sink, lower_springing - sink, lower_springing, lower_top,
                           half_span - 0.12f, 0.88f, 24});
    // Half an ellipse as high as the arches: heights above the springing are scaled.
    const float squash = (arch_radius - 0.1f) / (half_span - 0.12f);
    for (std::size_t i = first; i < mesh.positions.size(); ++i) {
        float& y = mesh.positions[i].y;
        if (y > lower_springing && y < lower_top) y = lower_springing + squash * (y - lower_springing);
        glm::vec3& normal = mesh.normals[i];
        normal = glm::normalize(normal / glm::vec3(1.0f, squash, 1.0f));
    }
    const glm::vec3 centre(x, 0.0f, 0.5f * (outer_wall + arcade_z + 0.3f));
    place_vertices(mesh, first,
                   glm::rotate(glm::translate(glm::mat4(1.0f), centre), glm::half_pi<float>(), glm::vec3(0, 1, 0)));
}

// A gathered cloth that hangs in the plane z = `depth` around x = `centre`, from `top` down to `bottom`.
void append_cloth(Mesh& mesh, float centre, float depth, float width, float bottom, float top, int folds, float gather,
                  float phase) {
    const auto position = [=](float u, float v) {  // v = 0 at the lower hem
        const float wave = glm::two_pi<float>() * static_cast<float>(folds) * u + phase;
        const float amplitude = 0.05f + 0.07f * (1.0f - v);
        const float waist = 1.0f - gather * std::exp(-18.0f * (v - 0.42f) * (v - 0.42f));
        const float x = (u - 0.5f) * width * waist + 0.008f * std::sin(2.0f * wave);
        const float sag = 0.04f * std::sin(glm::pi<float>() * static_cast<float>(folds) * u);
        return glm::vec3(centre + x, glm::mix(bottom, top, v) - (1.0f - v) * sag,
                         depth + amplitude * std::sin(wave + 0.6f * std::sin(0.5f * wave)));
    };
    append_surface(mesh, 16 * folds, 20, position, {width, 0.25f * (top - bottom)});
}

void add_materials(Scene& scene) {
    const PeriodicNoise coarse(4, 11), fine(8, 12);
    const auto tinted = [](const glm::vec3& dark, const glm::vec3& light, float t) {
        return glm::vec4(glm::mix(dark, light, t), 1.0f);
    };
    scene.textures = {
        make_texture("stone", 128,
                     [&](glm::vec2 uv) {
                         return tinted({0.48f, 0.42f, 0.34f}, {0.68f, 0.62f, 0.52f}, coarse(uv));
                     }),
        make_texture("plaster", 128,
                     [&](glm::vec2 uv) {
                         return tinted({0.60f, 0.55f, 0.46f}, {0.74f, 0.70f, 0.62f}, fine(uv));
                     }),
        make_texture("marble", 128,
                     [&](glm::vec2 uv) {
                         const bool odd = (uv.x < 0.5f) != (uv.y < 0.5f);
                         const float vein = 0.8f + 0.2f * fine(uv);
                         return glm::vec4(
                             vein * (odd ? glm::vec3(0.30f, 0.24f, 0.20f) : glm::vec3(0.62f, 0.58f, 0.52f)), 1.0f);
                     }),
        make_texture("grille", 64,
                     [](glm::vec2 uv) {
                         const glm::vec2 p = 2.0f * uv - 1.0f;
                         const float ring = std::abs(glm::length(p) - 0.62f);
                         const float bar = std::min(std::abs(p.x), 1.0f - std::abs(p.x));
                         const bool solid = ring < 0.10f || bar < 0.08f || std::abs(p.y) > 0.90f;
                         return glm::vec4(0.09f, 0.09f, 0.10f, solid ? 1.0f : 0.0f);
                     }),
        make_texture(
            "leaf", 64,
            [](glm::vec2 uv) {
                const float half_width = 0.46f * std::sin(glm::pi<float>() * std::pow(uv.y, 0.7f));
                const float off_axis = std::abs(uv.x - 0.5f);
                const bool solid = off_axis < half_width && (off_axis > 0.02f || uv.y > 0.3f);
                return glm::vec4(
                    glm::mix(glm::vec3(0.10f, 0.26f, 0.05f), glm::vec3(0.22f, 0.42f, 0.10f), 2.0f * off_axis),
                    solid ? 1.0f : 0.0f);
            },
            TextureWrap::clamp),
        make_texture("cloth", 64, [](glm::vec2 uv) {
            const float stripe = 0.5f + 0.5f * std::sin(glm::two_pi<float>() * uv.y * 2.0f);
            return glm::vec4(glm::vec3(0.75f + 0.25f * stripe), 1.0f);
        })};
    const auto material = [&](const char* name, const glm::vec3& colour, int texture) {
        Material m;
        m.name = name;
        m.base_colour = colour;
        m.base_colour_texture = texture;
        scene.materials.push_back(m);
    };
    const glm::vec3 white(1.0f);
    material("stone", white, 0);
    material("plaster", white, 1);
    material("marble", white, 2);
    material("timber", {0.26f, 0.15f, 0.08f}, no_texture);
    material("iron grille", white, 3);
    material("leaf", white, 4);
    material("terracotta", {0.48f, 0.20f, 0.11f}, no_texture);
    material("red cloth", {0.62f, 0.06f, 0.05f}, 5);
    material("green cloth", {0.08f, 0.42f, 0.12f}, 5);
    material("blue cloth", {0.06f, 0.14f, 0.55f}, 5);
    material("bronze", {0.50f, 0.36f, 0.20f}, no_texture);
    scene.materials[iron_grille].alpha_mask = scene.materials[leaf].alpha_mask = true;
}

// Everything that both long sides share, in the frame of a side (aisle towards +z).
void add_side(Scene& scene, int side, int column) {
    const glm::mat4 frame = side_frame(side);
    Mesh arcade = make_mesh("arcade", stone), vaults = make_mesh("vaults", plaster), ribs = make_mesh("ribs", stone);
    Mesh grilles = make_mesh("grilles", iron_grille), rails = make_mesh("rails", timber);
    for (int i = 0; i < bays; ++i) {
        const std::size_t first = arcade.positions.size();
        append_arch_bay(
            arcade, {bay_edge(i), bay_edge(i + 1), lower_springing, lower_springing, lower_top, arch_radius, 0.6f, 24},
            0.4f);
        append_arch_bay(
            arcade, {bay_edge(i), bay_edge(i + 1), upper_springing, upper_springing, upper_top, arch_radius, 0.5f, 24},
            0.4f);
        place_vertices(arcade, first, glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, arcade_z)));
        append_groin_vault(vaults, bay_edge(i), bay_edge(i + 1));
        append_quad(grilles, {bay_edge(i), gallery_floor - sink, arcade_z}, {bay_width, 0, 0}, {0, 0.92f, 0},
                    1.0f / 0.46f);
    }
    for (int i = 0; i <= bays; ++i) {
        append_rib(ribs, bay_edge(i));
        append_box(ribs, {bay_edge(i) - 0.47f, -0.03f, outer_wall - 0.15f},
                   {bay_edge(i) + 0.47f, lower_springing + 0.01f, outer_wall + 0.05f}, 0.4f);  // the pilaster below it
    }
    append_box(rails, {-half_length - sink, gallery_floor + 0.86f, arcade_z - 0.06f},
               {half_length + sink, gallery_floor + 0.95f, arcade_z + 0.06f});

    Mesh structure = make_mesh("structure", plaster);
    append_box(structure, {-half_length - 0.65f, -0.3f, outer_wall}, {half_length + 0.65f, 11.02f, outer_wall + 0.6f},
               0.4f);
    append_box(structure, {-half_length - 0.3f, 4.95f, arcade_z - 0.42f},
               {half_length + 0.3f, gallery_floor, outer_wall + 0.1f}, 0.4f);
    append_box(structure, {-half_length - 0.31f, 10.2f, arcade_z - 0.4f},
               {half_length + 0.31f, 10.6f, outer_wall + 0.11f}, 0.4f);
    append_box(structure, {-half_length - 0.32f, 10.55f, arcade_z - 0.55f},
               {half_length + 0.32f, 10.8f, arcade_z + 0.3f}, 0.4f);
    append_box(structure, {-half_length - 0.28f, -0.05f, arcade_z - 0.55f},
               {half_length + 0.28f, 0.12f, arcade_z + 0.55f}, 0.4f);

    Mesh coffers = make_mesh("coffers", timber);
    for (int i = 0; i < 2; ++i) {
        const float z = arcade_z + 1.35f + 1.2f * static_cast<float>(i);
        append_box(coffers, {-half_length - 0.05f, 10.0f, z - 0.1f}, {half_length + 0.05f, 10.25f, z + 0.1f});
    }
    for (int i = 0; i < 3 * bays; ++i) {
        const float x = -half_length + 1.2f * (static_cast<float>(i) + 0.5f);
        append_box(coffers, {x - 0.1f, 9.92f, arcade_z + 0.2f}, {x + 0.1f, 10.26f, outer_wall + 0.05f});
    }
    for (Mesh* mesh : {&arcade, &vaults, &ribs, &grilles, &rails, &structure, &coffers}) {
        add_object(scene, std::move(*mesh), frame);
    }

    for (int i = 0; i <= bays; ++i) {
        // Columns stand 2 cm in the kerb and reach 2 cm into the walls above them; the upper ones are slimmer.
        const glm::mat4 lower = glm::translate(frame, glm::vec3(bay_edge(i), 0.1f, arcade_z));
        const float lower_scale = (lower_springing + 0.02f - 0.1f) / 3.1f;
        scene.instances.push_back({"lower column", column, glm::scale(lower, glm::vec3(1.0f, lower_scale, 1.0f))});
        const glm::mat4 upper = glm::translate(frame, glm::vec3(bay_edge(i), gallery_floor - sink, arcade_z));
        const float upper_scale = (upper_springing - gallery_floor + 2.0f * sink) / 3.1f;
        scene.instances.push_back({"upper column", column, glm::scale(upper, glm::vec3(0.95f, upper_scale, 0.95f))});
    }
}

void add_cloths(Scene& scene) {
    Random random(2014);
    std::array<Mesh, 3> curtains = {make_mesh("red curtains", red), make_mesh("green curtains", green),
                                    make_mesh("blue curtains", blue)};
    const auto append = [&](int colour, int side, const auto& make) {
        Mesh& mesh = curtains[colour];
        const std::size_t first = mesh.positions.size();
        make(mesh);
        place_vertices(mesh, first, side_frame(side));
    };
    Mesh rods = make_mesh("curtain rods", timber);
    int count = 0;
    for (int side = 0; side < 2; ++side) {
        for (int i = side; i < bays; i += 2) {  // every other arch of the lower storey
            const float gather = random.uniform(0.25f, 0.5f), phase = random.uniform(0.0f, 6.0f);
            append(count++ % 3, side, [&](Mesh& mesh) {
                append_cloth(mesh, bay_centre(i), arcade_z + 0.75f, 2.9f, 0.45f, 3.9f, 7, gather, phase);
            });
            const std::size_t first = rods.positions.size();
            append_box(rods, {bay_edge(i), 3.86f, arcade_z + 0.73f}, {bay_edge(i + 1), 3.9f, arcade_z + 0.77f});
            place_vertices(rods, first, side_frame(side));
        }
        for (int i = 1 - side; i < bays; i += 3) {  // and long ones before the upper storey
            const float phase = random.uniform(0.0f, 6.0f);
            append(count++ % 3, side, [&](Mesh& mesh) {
                append_cloth(mesh, bay_centre(i), arcade_z - 0.75f, 1.7f, 5.9f, 10.3f, 4, 0.05f, phase);
            });
        }
    }
    for (Mesh& mesh : curtains) add_object(scene, std::move(mesh));
    add_object(scene, std::move(rods));
}

void add_ends(Scene& scene) {
    Mesh walls = make_mesh("end walls", plaster), portals = make_mesh("portals", stone);
    for (int end = 0; end < 2; ++end) {
        const glm::mat4 turn =
            glm::rotate(glm::mat4(1.0f), (end == 0 ? 0.5f : -0.5f) * glm::pi<float>(), glm::vec3(0, 1, 0));
        std::size_t first = walls.positions.size();
        append_box(walls, {-outer_wall - 0.1f, -0.31f, -end_wall - 0.6f}, {outer_wall + 0.1f, 11.0f, -end_wall}, 0.4f);
        place_vertices(walls, first, turn);
        // A blind arch before the wall: its back, 2 cm within the wall, is never seen.
        first = portals.positions.size();
        append_arch_bay(portals, {-3.3f, 3.3f, -0.02f, 3.6f, 9.0f, 2.1f, 0.36f, 32}, 0.4f);
        append_box(portals, {-3.3f, 8.9f, -0.18f}, {3.3f, 9.2f, 0.3f}, 0.4f);
        for (const float x : {-3.3f, 3.3f}) {  // trims close its sides
            append_box(portals, {x - 0.04f, -0.03f, -0.19f}, {x + 0.04f, 9.1f, 0.21f}, 0.4f);
        }
        place_vertices(portals, first, glm::translate(turn, glm::vec3(0, 0, -end_wall + 0.16f)));
    }
    add_object(scene, std::move(walls));
    add_object(scene, std::move(portals));

    Mesh floor = make_mesh("floor", marble);
    append_quad(floor, {-half_length - 0.2f, 0, outer_wall + 0.2f}, {2 * half_length + 0.4f, 0, 0},
                {0, 0, -2 * outer_wall - 0.4f}, 0.5f);
    add_object(scene, std::move(floor));
}

void add_court(Scene& scene) {
    Mesh pedestal = make_mesh("pedestal", stone);
    append_box(pedestal, {-0.9f, -0.02f, -0.9f}, {0.9f, 0.25f, 0.9f});
    append_lathe(pedestal,
                 std::vector<glm::vec2>{{0.7f, 0.23f},
                                        {0.7f, 0.35f},
                                        {0.55f, 0.5f},
                                        {0.5f, 0.9f},
                                        {0.5f, 1.1f},
                                        {0.62f, 1.2f},
                                        {0.62f, 1.3f},
                                        {0.0f, 1.3f}},
                 32);
    add_object(scene, std::move(pedestal));

    Mesh knot = make_mesh("knot", bronze);  // a trefoil knot of a 13 cm tube
    const auto curve = [](float u) {
        const float t = glm::two_pi<float>() * u;
        return 0.27f * glm::vec3(std::sin(t) + 2.0f * std::sin(2.0f * t), std::cos(t) - 2.0f * std::cos(2.0f * t),
                                 -std::sin(3.0f * t));
    };
    append_surface(
        knot, 192, 16,
        [&](float u, float v) {
            const glm::vec3 along = glm::normalize(curve(u + 1e-3f) - curve(u - 1e-3f));
            const glm::vec3 across = glm::normalize(glm::cross(along, glm::vec3(0, 0, 1)));
            const float angle = glm::two_pi<float>() * v;
            return curve(u) + 0.13f * (std::cos(angle) * across + std::sin(angle) * glm::cross(across, along));
        },
        {1.0f, 1.0f}, true, true);
    add_object(scene, std::move(knot), glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 2.16f, 0.0f)));

    Random random(77);
    Mesh pot = make_mesh("pot", terracotta);
    append_lathe(pot,
                 std::vector<glm::vec2>{{0.0f, -0.01f},
                                        {0.24f, -0.01f},
                                        {0.32f, 0.3f},
                                        {0.36f, 0.55f},
                                        {0.40f, 0.58f},
                                        {0.40f, 0.64f},
                                        {0.34f, 0.64f},
                                        {0.32f, 0.56f},
                                        {0.0f, 0.56f}},
                 28);
    Mesh plant = make_mesh("plant", leaf);
    for (int i = 0; i < 48; ++i) {
        const float turn = random.uniform(0.0f, glm::two_pi<float>()), lean = random.uniform(0.15f, 0.75f);
        const float length = random.uniform(0.5f, 0.95f), width = random.uniform(0.10f, 0.18f);
        const float root = random.uniform(0.0f, 0.12f);
        const glm::vec3 outwards(std::cos(turn), 0.0f, -std::sin(turn)), across(std::sin(turn), 0.0f, std::cos(turn));
        append_surface(plant, 2, 6, [&](float u, float v) {  // an arc that bends outwards and down
            const float bend = lean + 1.3f * lean * v;
            return glm::vec3(0.0f, 0.54f, 0.0f) + outwards * (root + length * v * std::sin(bend)) +
                   glm::vec3(0.0f, length * v * std::cos(bend), 0.0f) + across * width * (u - 0.5f) * 2.0f;
        });
    }
    const int pot_index = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(pot));
    scene.meshes.push_back(std::move(plant));
    for (const float x : {-9.0f, -3.6f, 3.6f, 9.0f}) {
        for (const float z : {-2.2f, 2.2f}) {
            const glm::mat4 place = glm::rotate(glm::translate(glm::mat4(1.0f), glm::vec3(x, 0, z)),
                                                random.uniform(0.0f, 6.28f), glm::vec3(0, 1, 0));
            scene.instances.push_back({"pot", pot_index, place});
            scene.instances.push_back({"plant", pot_index + 1, place});
        }
    }
}

void add_views(Scene& scene) {
    constexpr float near_plane = 0.1f, far_plane = 60.0f;
    const auto view = [&](const char* name, const glm::vec3& eye, const glm::vec3& target, float degrees) {
        scene.cameras.push_back(Camera::look_at(name, eye, target, glm::radians(degrees)));
        scene.cameras.back().near_plane = near_plane;
        scene.cameras.back().far_plane = far_plane;
    };
    view("court", {-12.6f, 2.2f, 0.9f}, {2.0f, 3.2f, -0.4f}, 60.0f);
    view("aisle", {-11.2f, 1.7f, 5.9f}, {2.0f, 1.9f, 4.9f}, 60.0f);
    view("gallery", {-6.0f, 7.1f, -6.1f}, {-4.4f, 5.9f, 3.5f}, 65.0f);
    view("curtain", {-2.2f, 1.7f, 0.4f}, {-5.4f, 2.0f, 4.3f}, 55.0f);
    CameraPath strafe{"strafe", glm::radians(60.0f), near_plane, far_plane, {}};
    strafe.keys = {{0.0f, {-11.0f, 1.9f, -1.2f}, {-9.5f, 2.2f, 4.5f}},
                   {4.0f, {-1.5f, 1.9f, -1.4f}, {0.5f, 2.3f, 4.5f}},
                   {8.0f, {9.5f, 2.1f, -1.2f}, {11.0f, 2.2f, 4.5f}}};
    CameraPath walk{"walk", glm::radians(60.0f), near_plane, far_plane, {}};
    walk.keys = {{0.0f, {-12.6f, 2.2f, 0.9f}, {2.0f, 3.2f, -0.4f}},
                 {3.0f, {-6.0f, 1.9f, 0.6f}, {1.0f, 2.6f, -2.5f}},
                 {6.0f, {-2.6f, 2.0f, 1.0f}, {1.5f, 2.4f, -3.0f}},
                 {9.0f, {2.4f, 3.4f, 1.3f}, {9.0f, 3.6f, -1.5f}}};
    scene.paths = {strafe, walk};
}

}  // namespace

Scene make_colonnade() {
    Scene scene;
    scene.name = "colonnade";
    scene.description =
        "An atrium under the open sky: columns, arches, vaults, coloured curtains, masked grilles and plants";
    add_materials(scene);
    const int column = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(make_column());
    for (int side = 0; side < 2; ++side) add_side(scene, side, column);
    add_ends(scene);
    add_cloths(scene);
    add_court(scene);

    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(0.30f, -1.0f, 0.24f)), {11.0f, 9.8f, 8.2f}});
    scene.environment.radiance = {0.55f, 0.70f, 0.95f};
    scene.point_lights.push_back({"lamp", {-5.4f, 2.7f, 5.5f}, {7.0f, 5.0f, 3.0f}});
    add_views(scene);
    return scene;
}

}  // namespace plumb
