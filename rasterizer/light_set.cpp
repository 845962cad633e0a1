#include "rasterizer/light_set.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rasterizer/scene_reach.h"

namespace plumb {
namespace {

// Nothing closer to a lamp than this casts its shadow. Emitters start closer, since things may stand right before them.
constexpr float lamp_near_plane = 0.01f;
constexpr float emitter_near_plane = 0.001f;
// A flat map of a cone wider than this (half angle, radians) wastes most of its texels on the middle.
constexpr float widest_flat_cone = 1.1f;
// Texels beyond the cone or the scene, so that filtering never reads past the border.
float border_texels(const ShadowSettings& settings) { return 2.0f + static_cast<float>(settings.pcf_radius); }

glm::vec4 terms_of(const Attenuation& attenuation) {
    return {attenuation.constant, attenuation.linear, attenuation.quadratic, 0.0f};
}

// Looks from `eye` along the unit `direction`; any roll.
glm::mat3 axes_towards(const glm::vec3& direction) {
    const glm::vec3 helper = std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = glm::normalize(glm::cross(direction, helper));
    return {right, glm::cross(right, direction), -direction};
}

SpotRecord make_spot(const SpotLight& light, const ShadowSettings& settings) {
    SpotRecord record{};
    record.position = light.position;
    record.direction = light.direction;
    record.intensity = light.intensity;
    record.cosine_outer = std::cos(light.outer_angle);
    // Equal angles would divide by zero; a ten-thousandth in the cosine is a hard edge.
    record.cosine_inner = std::max(std::cos(light.inner_angle), record.cosine_outer + 1e-4f);
    record.attenuation = terms_of(light.attenuation);
    record.map = record.cube = -1;
    if (light.outer_angle > widest_flat_cone) return record;
    const auto size = static_cast<float>(settings.map_size);
    const float tangent = std::tan(light.outer_angle) * size / (size - 2.0f * border_texels(settings));
    record.texel_size = 2.0f * tangent / size;
    const glm::mat3 camera_from_world = glm::transpose(axes_towards(light.direction));
    glm::mat4 view(camera_from_world);
    view[3] = glm::vec4(-camera_from_world * light.position, 1.0f);
    glm::mat4 projection(0.0f);  // infinite, reversed: depth = near / distance
    projection[0][0] = projection[1][1] = 1.0f / tangent;
    projection[3][2] = lamp_near_plane;
    projection[2][3] = -1.0f;
    record.clip_from_world = projection * view;
    return record;
}

DirectionalRecord make_directional(const DirectionalLight& light, const Bounds& scene, const ShadowSettings& settings) {
    DirectionalRecord record{};
    record.direction = light.direction;
    record.irradiance = light.irradiance;
    const glm::mat3 axes = axes_towards(light.direction);
    record.right = glm::vec4(axes[0], 0.0f), record.up = glm::vec4(axes[1], 0.0f);
    Bounds box;  // of the scene's box in the light's axes
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point(corner & 1 ? scene.upper.x : scene.lower.x, corner & 2 ? scene.upper.y : scene.lower.y,
                              corner & 4 ? scene.upper.z : scene.lower.z);
        box.add(glm::transpose(axes) * point);
    }
    const auto size = static_cast<float>(settings.map_size);
    const float side = std::max({box.upper.x - box.lower.x, box.upper.y - box.lower.y, 1e-3f}) * size /
                       (size - 2.0f * border_texels(settings));
    record.texel_size = side / size;
    // Depth 1 at the side of the light (+z of the axes), 0 at the far side; a little room for the lifted receivers.
    const float margin = 0.01f * scene.diagonal() + settings.bias;
    const float near_z = box.upper.z + margin, far_z = box.lower.z - margin;
    const glm::vec3 centre = box.centre();
    glm::mat4 projection(1.0f);
    projection[0][0] = projection[1][1] = 2.0f / side;
    projection[2][2] = 1.0f / (near_z - far_z);
    projection[3] = glm::vec4(-2.0f * centre.x / side, -2.0f * centre.y / side, -far_z / (near_z - far_z), 1.0f);
    record.clip_from_world = projection * glm::mat4(glm::transpose(axes));
    return record;
}

}  // namespace

LightSet::LightSet(const Scene& scene, const DirectSettings& direct) {
    const ShadowSettings& settings = direct.shadow;
    const Bounds bounds = bounds_over_time(scene);
    const bool paraboloids = settings.point_map == PointShadowMap::dual_paraboloid;
    const bool linear_cubes = settings.cube_distance == CubeDistance::linear;
    // Returns the number of the cube or pair of paraboloids and the scale of its depths.
    const auto add_point_map = [&](const glm::vec3& position) -> std::pair<int, float> {
        if (!settings.lamps) return {-1, 0.0f};
        std::vector<ShadowCube>& list = paraboloids ? point_paraboloids : point_cubes;
        list.push_back({position, lamp_near_plane, reach(bounds, position), -1, {0.0f, 0.0f, 0.0f, 1.0f}});
        return {static_cast<int>(list.size()) - 1, paraboloids || linear_cubes ? list.back().range : lamp_near_plane};
    };
    const auto add_map = [&](const glm::mat4& clip_from_world) {
        maps.push_back({clip_from_world});
        return static_cast<int>(maps.size()) - 1;
    };
    for (const PointLight& light : scene.point_lights) {
        const auto [cube, depth_scale] = add_point_map(light.position);
        points.push_back({light.position, depth_scale, light.intensity, cube, terms_of(light.attenuation)});
    }
    for (const SpotLight& light : scene.spot_lights) {
        SpotRecord& record = spots.emplace_back(make_spot(light, settings));
        if (record.texel_size == 0.0f) {
            std::tie(record.cube, record.depth_scale) = add_point_map(light.position);
        } else if (settings.lamps) {
            record.map = add_map(record.clip_from_world);
        }
    }
    for (const DirectionalLight& light : scene.directional_lights) {
        DirectionalRecord& record = directionals.emplace_back(make_directional(light, bounds, settings));
        record.map = add_map(record.clip_from_world);
    }
    if (!direct.emitters) return;
    for (const EmitterLight& emitter : find_emitters(scene, settings.emitter_samples)) {
        emitters.push_back({static_cast<int>(pieces.size()),
                            static_cast<int>(emitter.pieces.size()),
                            static_cast<int>(emitter_cubes.size()),
                            static_cast<int>(emitter.sample_points.size()),
                            emitter.discs ? 1 : 0,
                            emitter.both_sides ? 1 : 0,
                            {}});
        pieces.insert(pieces.end(), emitter.pieces.begin(), emitter.pieces.end());
        for (const glm::vec3& point : emitter.sample_points) {
            emitter_cubes.push_back(
                {point, emitter_near_plane, reach(bounds, point), emitter.instance, emitter.front_plane});
            emitter_cube_records.push_back({point, linear_cubes ? emitter_cubes.back().range : emitter_near_plane});
        }
    }
}

std::string LightSet::summary() const {
    std::vector<std::string> parts;
    const auto add = [&](std::size_t count, const char* name) {
        if (count > 0) parts.push_back(fmt::format("{} {}{}", count, name, count == 1 ? "" : "s"));
    };
    add(points.size(), "point light");
    add(spots.size(), "spot light");
    add(directionals.size(), "directional light");
    add(emitters.size(), "emissive surface");
    return parts.empty() ? "no lights" : fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace plumb
