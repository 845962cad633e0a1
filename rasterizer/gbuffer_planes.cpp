#include "rasterizer/gbuffer_planes.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rasterizer/gl_error.h"
#include "rasterizer/instance_motion.h"
#include "rasterizer/normal_encoding.h"

namespace plumb {
namespace {

struct GBufferPlane {
    std::string_view name;
    const char* location;  // define of gbuffer.frag; null: always location 0
};
constexpr std::array<GBufferPlane, 9> gbuffer_planes = {{{"depth", nullptr},
                                                         {"normal", "WRITE_NORMAL"},
                                                         {"albedo", "WRITE_ALBEDO"},
                                                         {"diffuse_albedo", "WRITE_DIFFUSE_ALBEDO"},
                                                         {"specular", "WRITE_SPECULAR"},
                                                         {"roughness", "WRITE_ROUGHNESS"},
                                                         {"emission", "WRITE_EMISSION"},
                                                         {moving_instance_plane, "WRITE_MOVING_INSTANCE"},
                                                         {"camera_position", "WRITE_POSITION"}}};

GLenum format_of(std::string_view plane, const Scene& scene, const Method& method) {
    if (plane == "depth") return GL_R32F;
    if (plane == "normal") return texture_format(method.gbuffer.normal_format);
    if (plane == "emission") return emission_format(scene);
    if (plane == "roughness") return GL_R16F;
    if (plane == "camera_position") return method.gbuffer.position == PositionSource::stored ? GL_RGBA32F : GL_RGBA16F;
    return plane == moving_instance_plane ? moving_instance_format(scene) : GL_RGBA16F;
}

bool exists(std::string_view plane, const Method& method) {
    return plane != "camera_position" || stores_positions(method);
}

}  // namespace

std::vector<std::string> gbuffer_outputs(const Method& method, int layer) {
    std::vector<std::string> names;
    for (const GBufferPlane& plane : gbuffer_planes) {
        if (exists(plane.name, method)) names.push_back(layer_prefix(layer) + std::string(plane.name));
    }
    names.push_back(layer_prefix(layer) + std::string(gbuffer_history));
    return names;
}

std::vector<ParameterUse> gbuffer_parameters(int layer) {
    const std::string prefix = layer_prefix(layer);
    return {{"gbuffer.source"},
            {"gbuffer.layers"},
            {"gbuffer.depth_mapping"},
            {"gbuffer.normal_format", {prefix + "normal"}},
            {"gbuffer.position", {prefix + "camera_position"}}};
}

std::vector<ParameterUse> layer_parameters(const std::vector<std::string>& planes) {
    std::vector<ParameterUse> uses;
    for (const char* name :
         {"gbuffer.generation", "gbuffer.layer_selection", "gbuffer.minimum_separation", "gbuffer.separation_unit"})
        uses.push_back({name, planes});
    return uses;
}

bool any_layer_is_read(const PassResources& resources, std::string_view plane) {
    return resources.is_read(plane) || resources.layers_of(plane) > 1;
}

GlTexture& create_gbuffer_planes(const PassResources& resources, int depth_layers, int least_layers) {
    PlaneTextures& planes = resources.planes;
    GlTexture& depth = planes.create("depth", GL_R32F, depth_layers);
    for (const GBufferPlane& plane : gbuffer_planes) {
        const std::string name(plane.name);
        if (name == "depth" || !any_layer_is_read(resources, name)) continue;
        planes.create(name, format_of(name, resources.scene, resources.method),
                      std::max(least_layers, resources.layers_of(name)));
    }
    return depth;
}

GBufferTargets gbuffer_targets(const PassResources& resources, const GlTexture& depth, int layer) {
    GBufferTargets targets;
    for (const GBufferPlane& plane : gbuffer_planes) {
        const std::string name(plane.name);
        if (name == "depth") {
            targets.colours.push_back({&depth, layer});
            continue;
        }
        if (layer < 0 ? !any_layer_is_read(resources, name) : !resources.is_read(layer_prefix(layer) + name)) continue;
        targets.defines.emplace_back(plane.location, fmt::format("{}", targets.colours.size()));
        targets.colours.push_back({&resources.planes.get(name), layer});
    }
    GLint most = 0;
    resources.context.gl.GetIntegerv(GL_MAX_DRAW_BUFFERS, &most);
    if (targets.colours.size() > static_cast<std::size_t>(most)) {
        std::vector<std::string> names;
        for (const GBufferPlane& plane : gbuffer_planes) {
            if (any_layer_is_read(resources, plane.name)) names.emplace_back(plane.name);
        }
        throw MethodError(
            fmt::format("the G-buffer is asked for {} planes at once ({}), and this OpenGL writes {} in a "
                        "pass; ask for fewer, or set gbuffer.position to \"from_depth\"",
                        targets.colours.size(), fmt::join(names, ", "), most));
    }
    return targets;
}

bool has_specular_lobes(const Scene& scene) {
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        return scene.materials[scene.meshes[instance.mesh].material].has_specular_lobe();
    });
}

std::string diffuse_albedo_plane(const Scene& scene, const Method& method) {
    const bool rendered = method.gbuffer.source == SourceOfStage::method;
    return rendered && has_specular_lobes(scene) ? "diffuse_albedo" : "albedo";
}

bool stores_positions(const Method& method) {
    return method.gbuffer.position != PositionSource::from_depth && method.gbuffer.source == SourceOfStage::method;
}

const GlTexture* stored_positions(const PassResources& resources) { return resources.planes.find("camera_position"); }

ShaderDefines gbuffer_defines(const Method& method) {
    ShaderDefines defines = normal_defines(normal_format_of(method));
    if (stores_positions(method)) defines.emplace_back("STORED_POSITION", "1");
    return defines;
}

float separation_in_metres(const GBufferSettings& settings, const Camera& camera) {
    const float unit =
        settings.separation_unit == SeparationUnit::frustum ? camera.far_plane - camera.near_plane : 1.0f;
    return settings.minimum_separation * unit;
}

GLenum emission_format(const Scene& scene) {
    return scene.brightest_emission() > largest_half ? GL_RGBA32F : GL_RGBA16F;
}

GLenum texture_format(RadianceFormat format) {
    constexpr std::array<GLenum, 3> formats{GL_RGBA32F, GL_RGBA16F, GL_R11F_G11F_B10F};
    return formats.at(static_cast<std::size_t>(format));
}

bool belongs_to_gbuffer(std::string_view texture) {
    return texture == "direct" || texture == gbuffer_depth_buffer || texture == gbuffer_history ||
           texture.starts_with("depth_key") ||
           std::ranges::find(gbuffer_planes, texture, &GBufferPlane::name) != gbuffer_planes.end();
}

}  // namespace plumb
