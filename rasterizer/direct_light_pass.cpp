#include "rasterizer/direct_light_pass.h"

#include <array>
#include <span>

#include "rasterizer/environment_light.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/light_volume_pass.h"
#include "rasterizer/shadow_pass.h"

namespace plumb {
namespace {

// Texture units of direct_light.frag besides those of LightBuffers.
struct DirectLightUnits {
    enum : GLuint { depth, normal, albedo, ambient = 6, local_irradiance = 8, environment };
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
      lights_(resources, LightKinds::all),
      dark_(lights_.lights().empty() && resources.scene.environment.is_black()),
      draw_(context_, resources.programs, "direct_light.frag", defines(resources)),
      depth_(resources.planes.get("depth")),
      normal_(resources.planes.get("normal")),
      albedo_(resources.planes.get(diffuse_albedo_plane(resources.scene, resources.method))) {
    PlaneTextures& planes = resources.planes;
    // Whoever comes first, this pass for either layer or the truth's, allocates for both layers.
    if (!planes.has("direct"))
        planes.create("direct", texture_format(resources.method.gbuffer.radiance_format),
                      resources.layers_of("direct"));
    target_ = GlFramebuffer(context_, std::array{GlAttachment{&planes.get("direct"), layer}}, {}, "direct");
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
    const bool by_volumes = uses_light_volumes(resources.scene, resources.method);
    ShaderDefines result = light_count_defines(lights_.lights(), !by_volumes);
    if (by_volumes) result.emplace_back("LOCAL_IRRADIANCE", "1");
    for (auto& define : lights_.shadow_defines()) result.push_back(std::move(define));
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

void DirectLightPass::execute(const PassFrame& frame) {
    depth_.bind(DirectLightUnits::depth);
    normal_.bind(DirectLightUnits::normal);
    albedo_.bind(DirectLightUnits::albedo);
    if (local_irradiance_) local_irradiance_->bind(DirectLightUnits::local_irradiance);
    if (environment_irradiance_) environment_irradiance_->bind(DirectLightUnits::environment);
    if (ambient_visibility_) ambient_visibility_->bind(DirectLightUnits::ambient);
    lights_.bind(frame.time);
    if (!dark_) draw_.program().set("layer", layer_);
    draw_.draw(target_);
}

PassDeclaration declare_direct_light(const Scene& scene, const LightSet& lights, const Method& method, int layer) {
    const std::string prefix = layer_prefix(layer);
    PassDeclaration pass;
    pass.name = layer == 0 ? "direct" : "direct.layer2";
    pass.inputs = {prefix + "depth", prefix + "normal", prefix + diffuse_albedo_plane(scene, method)};
    for (std::string& texture : shadow_textures(lights)) pass.inputs.push_back(std::move(texture));
    if (uses_light_volumes(scene, method)) pass.inputs.push_back(prefix + "local_irradiance");
    if (uses_irradiance_cube(scene, method)) pass.inputs.emplace_back("environment.irradiance");
    if (uses_ambient_visibility(scene, method)) pass.inputs.emplace_back("ao");
    pass.outputs = {prefix + "direct"};
    // What comes from the truth is kept as it comes, in one texture for both layers.
    if (method.direct.source == SourceOfStage::method) pass.parameters.push_back({"gbuffer.radiance_format"});
    if (layer == 0) pass.parameters.push_back({"direct.source"});
    if (scene.has_emissive_surfaces()) pass.parameters.push_back({"direct.emitters"});
    if (!scene.environment.is_black()) pass.parameters.push_back({"direct.environment"});
    if (!(scene.point_lights.empty() && scene.spot_lights.empty())) {
        for (const char* name : {"direct.shadow.lamps", "direct.local_lights"}) pass.parameters.push_back({name});
    }
    pass.create = [layer](const PassResources& resources) {
        return std::make_unique<DirectLightPass>(resources, layer);
    };
    pass.remark = lights.summary() + (scene.environment.is_black() ? "" : ", environment");
    if (layer == 0 && method.direct.source == SourceOfStage::truth) pass.disabled = "direct.source is \"truth\"";
    if (layer == 1 && method.gbuffer.layers < 2) pass.disabled = "gbuffer.layers is 1";
    return pass;
}

}  // namespace plumb
