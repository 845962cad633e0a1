#include "rasterizer/direct_light_pass.h"

#include <array>
#include <span>

#include <fmt/format.h>

#include "rasterizer/environment_light.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/light_volume_pass.h"
#include "rasterizer/shadow_pass.h"

namespace plumb {
namespace {

// Texture units of direct_light.frag.
struct DirectLightUnits {
    enum : GLuint {
        depth,
        normal,
        albedo,
        points,
        maps,
        emitters,
        ambient,
        paraboloids,
        local_irradiance,
        environment
    };
};

bool uses_ambient_visibility(const Scene& scene, const Method& method) {
    return !scene.environment.is_black() && method.ao.enabled;
}

bool uses_irradiance_cube(const Scene& scene, const Method& method) {
    return !scene.environment.is_black() && method.direct.environment == EnvironmentIrradiance::cube;
}

}  // namespace

DirectLightPass::DirectLightPass(const PassResources& resources, int layer)
    : context_(resources.context),
      layer_(layer),
      lights_(resources.scene, resources.method.direct),
      dark_(lights_.empty() && resources.scene.environment.is_black()),
      draw_(context_, resources.programs, "direct_light.frag", defines(resources)),
      points_(GlBuffer::from(context_, lights_.points)),
      spots_(GlBuffer::from(context_, lights_.spots)),
      directionals_(GlBuffer::from(context_, lights_.directionals)),
      emitters_(GlBuffer::from(context_, lights_.emitters)),
      pieces_(GlBuffer::from(context_, lights_.pieces)),
      emitter_cubes_(GlBuffer::from(context_, lights_.emitter_cube_records)),
      depth_(resources.planes.get("depth")),
      normal_(resources.planes.get("normal")),
      albedo_(resources.planes.get(diffuse_albedo_plane(resources.scene, resources.method))) {
    PlaneTextures& planes = resources.planes;
    // Whoever comes first, this pass for either layer or the truth's, allocates for both layers.
    if (!planes.has("direct"))
        planes.create("direct", texture_format(resources.method.gbuffer.radiance_format),
                      resources.layers_of("direct"));
    target_ = GlFramebuffer(context_, std::array{GlAttachment{&planes.get("direct"), layer}}, {}, "direct");
    shadow_points_ = planes.find("shadow.points");
    shadow_paraboloids_ = planes.find("shadow.paraboloids");
    shadow_maps_ = planes.find("shadow.maps");
    shadow_emitters_ = planes.find("shadow.emitters");
    if (uses_ambient_visibility(resources.scene, resources.method)) ambient_visibility_ = &planes.get("ao");
    if (uses_light_volumes(resources.scene, resources.method)) {
        local_irradiance_ = &planes.get("local_irradiance");
    }
    if (uses_irradiance_cube(resources.scene, resources.method)) {
        environment_irradiance_ = &planes.get("environment.irradiance");
    } else {
        set_environment(resources);
    }
}

ShaderDefines DirectLightPass::defines(const PassResources& resources) const {
    ShaderDefines result;
    const auto add_count = [&](const char* name, std::size_t count) {
        if (count > 0) result.emplace_back(name, fmt::format("{}", count));
    };
    if (uses_light_volumes(resources.scene, resources.method)) {
        result.emplace_back("LOCAL_IRRADIANCE", "1");
    } else {
        add_count("POINT_LIGHTS", lights_.points.size());
        add_count("SPOT_LIGHTS", lights_.spots.size());
    }
    add_count("DIRECTIONAL_LIGHTS", lights_.directionals.size());
    add_count("EMITTERS", lights_.emitters.size());
    for (auto& define : shadow_defines(lights_, resources.method.direct.shadow)) result.push_back(std::move(define));
    const Environment& environment = resources.scene.environment;
    if (!environment.is_black()) result.emplace_back("ENVIRONMENT", environment.texture == no_texture ? "1" : "9");
    if (uses_irradiance_cube(resources.scene, resources.method)) result.emplace_back("ENVIRONMENT_CUBE", "1");
    if (uses_ambient_visibility(resources.scene, resources.method)) result.emplace_back("AMBIENT_VISIBILITY", "1");
    return result;
}

void DirectLightPass::set_environment(const PassResources& resources) const {
    if (resources.scene.environment.is_black()) return;
    const IrradianceCoefficients coefficients = project_irradiance(resources.scene);
    const std::size_t used = resources.scene.environment.texture == no_texture ? 1 : coefficients.size();
    draw_.program().set("environment_irradiance", std::span(coefficients).first(used));
}

void DirectLightPass::execute(const PassFrame&) {
    depth_.bind(DirectLightUnits::depth);
    normal_.bind(DirectLightUnits::normal);
    albedo_.bind(DirectLightUnits::albedo);
    if (shadow_points_) shadow_points_->bind(DirectLightUnits::points);
    if (shadow_paraboloids_) shadow_paraboloids_->bind(DirectLightUnits::paraboloids);
    if (shadow_maps_) shadow_maps_->bind(DirectLightUnits::maps);
    if (shadow_emitters_) shadow_emitters_->bind(DirectLightUnits::emitters);
    if (local_irradiance_) local_irradiance_->bind(DirectLightUnits::local_irradiance);
    if (environment_irradiance_) environment_irradiance_->bind(DirectLightUnits::environment);
    if (ambient_visibility_) ambient_visibility_->bind(DirectLightUnits::ambient);
    const std::array<const GlBuffer*, 6> buffers{&points_,   &spots_,  &directionals_,
                                                 &emitters_, &pieces_, &emitter_cubes_};
    for (std::size_t i = 0; i < buffers.size(); ++i) buffers[i]->bind(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(i));
    if (!dark_) draw_.program().set("layer", layer_);
    draw_.draw(target_);
}

PassDeclaration declare_direct_light(const Scene& scene, const LightSet& lights, const Method& method, int layer) {
    const std::string prefix(layer == 0 ? "" : second_layer_prefix);
    PassDeclaration pass;
    pass.name = layer == 0 ? "direct" : "direct.layer2";
    pass.inputs = {prefix + "depth", prefix + "normal", prefix + diffuse_albedo_plane(scene, method)};
    for (std::string& texture : shadow_textures(lights)) pass.inputs.push_back(std::move(texture));
    if (uses_light_volumes(scene, method)) pass.inputs.push_back(prefix + "local_irradiance");
    if (uses_irradiance_cube(scene, method)) pass.inputs.emplace_back("environment.irradiance");
    if (uses_ambient_visibility(scene, method)) pass.inputs.emplace_back("ao");
    pass.outputs = {prefix + "direct"};
    pass.create = [layer](const PassResources& resources) {
        return std::make_unique<DirectLightPass>(resources, layer);
    };
    pass.remark = lights.summary() + (scene.environment.is_black() ? "" : ", environment");
    if (layer == 0 && method.direct.source == SourceOfStage::truth) pass.disabled = "direct.source is \"truth\"";
    if (layer == 1 && method.gbuffer.layers < 2) pass.disabled = "gbuffer.layers is 1";
    return pass;
}

}  // namespace plumb
