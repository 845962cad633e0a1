#include "experiments/parameter_reach.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/method_file.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/passes.h"
#include "rasterizer/plane_reader.h"
#include "rasterizer/probe_pass.h"

namespace plumb {
namespace {

// The method in which the stage runs that `name` decides upon.
Method with_stage_on(const Method& method, std::string_view name) {
    Method on = method;
    if (name == "ao.enabled") on.ao.enabled = true;
    if (name == "radiosity.enabled") on.radiosity.enabled = true;
    if (name == "reflections.enabled") on.reflections.enabled = true;
    if (name == "antialias.temporal") on.antialias.temporal = true;
    if (name == "gbuffer.position") on.gbuffer.position = PositionSource::stored;
    return on;
}

// Stores any other value.
void use_other_value(const MethodParameter& parameter) {
    if (bool* const* truth = std::get_if<bool*>(&parameter.value)) {
        **truth = !**truth;
    } else if (int* const* whole = std::get_if<int*>(&parameter.value)) {
        **whole = static_cast<int>(**whole == parameter.least ? parameter.most : parameter.least);
    } else if (float* const* number = std::get_if<float*>(&parameter.value)) {
        const auto least = static_cast<float>(parameter.least);
        **number = **number == least ? static_cast<float>(parameter.most) : least;
    } else {
        const auto& choice = std::get<MethodChoice>(parameter.value);
        choice.set((choice.get() + 1) % static_cast<int>(choice.names.size()));
    }
}

// Null where this method does not give the plane.
std::optional<PassPlan> plan_plane(const std::vector<PassDeclaration>& declarations, const std::string& plane) {
    try {
        return plan_passes(declarations, planes_behind(plane));
    } catch (const MethodError&) {
        return std::nullopt;
    }
}

std::vector<std::string> all_outputs(const std::vector<PassDeclaration>& declarations) {
    std::vector<std::string> planes;
    for (const PassDeclaration& pass : declarations) {
        if (pass.disabled.empty()) planes.insert(planes.end(), pass.outputs.begin(), pass.outputs.end());
    }
    return planes;
}

bool reads_probe(const PassPlan& plan) {
    return std::ranges::any_of(RadianceMaps::outputs("probe"),
                               [&](const std::string& plane) { return plan.read.contains(plane); });
}

// Whether the views of the probe are rendered with the method's own `name`.
bool is_handed_to_probe(const Method& method, std::string_view name) {
    Method changed = method;
    for (const MethodParameter& parameter : method_parameters(changed)) {
        if (parameter.name == name) use_other_value(parameter);
    }
    const std::vector<MethodDifference> differences =
        diff_methods(method_of_probe_faces(method), method_of_probe_faces(changed));
    return std::ranges::find(differences, name, &MethodDifference::parameter) != differences.end();
}

// What is said of each plane by itself: they are rendered by pipelines of their own.
std::string reason_in(const Method& method, std::string_view name, const std::vector<std::string>* planes,
                      const Scene& scene) {
    Quantities all_bounces;
    all_bounces.bounces = most_diffuse_bounces;
    const std::vector<PassDeclaration> declarations = declare_passes(scene, method, all_bounces);
    std::string reason;
    for (const std::string& plane : planes ? *planes : all_outputs(declarations)) {
        const std::optional<PassPlan> plan = plan_plane(declarations, plane);
        if (!plan && planes) return "";
        if (!plan) continue;
        std::string of_plane = reason_unread(declarations, *plan, name);
        if (!of_plane.empty() && reads_probe(*plan) && is_handed_to_probe(method, name)) {
            const std::vector<std::string> shown = {"total"};
            if (reason_in(method_of_probe_faces(method), name, &shown, scene).empty()) of_plane.clear();
        }
        if (of_plane.empty()) return "";
        if (reason.empty()) reason = std::move(of_plane);
    }
    if (reason.empty() || !planes) return reason;
    return fmt::format("{} is asked for, and {}", fmt::join(*planes, ", "), reason);
}

}  // namespace

std::string reason_nobody_reads(const Method& method, std::string_view name, const std::vector<std::string>* planes,
                                const Scene& scene) {
    try {
        return reason_in(with_stage_on(method, name), name, planes, scene);
    } catch (const MethodError&) {
        return "";
    }
}

Scene make_scene_of_everything() {
    Scene scene;
    scene.name = "everything";
    Material glossy, glowing;
    glossy.metallic = 0.5f;
    glowing.emission = glm::vec3(1.0f);
    scene.materials = {glossy, glowing};
    for (int material = 0; material < 2; ++material) {
        Mesh mesh;
        mesh.material = material;
        mesh.positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
        mesh.triangles = {{0, 1, 2}};
        scene.meshes.push_back(mesh);
        scene.instances.push_back({"", material, glm::mat4(1.0f)});
    }
    scene.instances[0].motion.keys = {{.time = 0.0f}, {.time = 1.0f, .translation = {1.0f, 0.0f, 0.0f}}};
    scene.point_lights.resize(1);
    scene.spot_lights.resize(2);
    scene.spot_lights[0].outer_angle = 0.5f;
    scene.spot_lights[1].outer_angle = 1.5f;  // too wide for a flat map
    scene.directional_lights.resize(1);
    Texture sky;
    sky.width = sky.height = 1;
    sky.texels.assign(4, half(1.0f));
    scene.environment = {.radiance = glm::vec3(1.0f), .texture = 0};
    scene.textures = {sky};
    return scene;
}

}  // namespace plumb
