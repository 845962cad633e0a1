#include "rasterizer/radiosity_reflection.h"

#include <fmt/format.h>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/radiosity_planes.h"

namespace plumb {
namespace {

// Whose irradiance `layer` reflects.
int gathered_layer(const RadiositySettings& settings, int layer) {
    return settings.second_layer == SecondLayerIndirect::gather ? layer : 0;
}

ShaderDefines shader_defines(const RadiositySettings& settings, int layer) {
    ShaderDefines defines = boost_defines(settings);
    defines.emplace_back("LAYER", std::to_string(layer));
    defines.emplace_back("GATHERED_LAYER", std::to_string(gathered_layer(settings, layer)));
    return defines;
}

// Whichever layer's pass is made first allocates for both.
GlFramebuffer make_bounce_target(const PassResources& resources, int bounce, int layer) {
    const Method& method = resources.method;
    const std::string name = indirect_plane(bounce);
    const bool is_last = plane_of_later_bounces(method.radiosity, bounce).empty();
    if (!resources.planes.has(name)) {
        const GLenum format = is_last ? GL_RGBA32F : texture_format(method.gbuffer.radiance_format);
        resources.planes.create(name, format, resources.layers_of(name));
    }
    const GlAttachment attachment{&resources.planes.get(name), layer, 0};
    return GlFramebuffer(resources.context, {&attachment, 1}, {}, "radiosity reflection");
}

}  // namespace

ShaderDefines boost_defines(const RadiositySettings& settings) {
    if (settings.saturated_boost == 1.0f && settings.unsaturated_boost == 1.0f) return {};
    return {{"SATURATED_BOOST", shader_literal(settings.saturated_boost)},
            {"UNSATURATED_BOOST", shader_literal(settings.unsaturated_boost)}};
}

RadiosityReflectionPass::RadiosityReflectionPass(const PassResources& resources, int bounce, int layer)
    : gathered_(resources.planes.get(radiosity_plane(bounce))),
      albedo_(resources.planes.get(diffuse_albedo_plane(resources.scene, resources.method))),
      target_(make_bounce_target(resources, bounce, layer)),
      draw_(resources.context, resources.programs, "radiosity_reflection.frag",
            shader_defines(resources.method.radiosity, layer)),
      area_(resources, {0, 0}, plane_of_later_bounces(resources.method.radiosity, bounce)) {}

void RadiosityReflectionPass::execute(const PassFrame&) {
    gathered_.bind(0);
    albedo_.bind(1);
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

PassDeclaration declare_radiosity_reflection(const Scene& scene, const Method& method, int bounce, int layer) {
    const std::string prefix = layer_prefix(layer), plane = prefix + indirect_plane(bounce);
    PassDeclaration pass;
    pass.name = plane;
    pass.inputs = {layer_prefix(gathered_layer(method.radiosity, layer)) + radiosity_plane(bounce),
                   prefix + diffuse_albedo_plane(scene, method)};
    pass.outputs = {plane};
    pass.parameters = {{"radiosity.saturated_boost"}, {"radiosity.unsaturated_boost"}, {"radiosity.bounces"}};
    if (layer > 0) pass.parameters.push_back({"radiosity.second_layer"});
    if (!plane_of_later_bounces(method.radiosity, bounce).empty())
        pass.parameters.push_back({"gbuffer.radiance_format"});
    pass.create = [bounce, layer](const PassResources& resources) {
        return std::make_unique<RadiosityReflectionPass>(resources, bounce, layer);
    };
    return pass;
}

}  // namespace plumb
