#include "rasterizer/radiosity_carry.h"

#include <fmt/format.h>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/radiosity_planes.h"
#include "rasterizer/radiosity_reflection.h"

namespace plumb {
namespace {

struct CarryUnits {
    enum : GLuint { depth, previous_depth, direct, albedo, irradiance, moving_instance };
};

void require_sound_carry(const RadiositySettings& settings) {
    if (!(settings.damping >= 0.0f && settings.damping <= 1.0f)) {
        throw MethodError(
            fmt::format("radiosity.damping is {}; it is the fraction taken away of what is carried on: "
                        "use 0 to 1",
                        settings.damping));
    }
    if (!(settings.carry_from >= 0.0f && settings.carry_to >= settings.carry_from)) {
        throw MethodError(
            fmt::format("radiosity.carry_from is {} and radiosity.carry_to {} metres; use distances of "
                        "zero or more, carry_to not below carry_from",
                        settings.carry_from, settings.carry_to));
    }
}

GlFramebuffer make_carry_target(const PassResources& resources) {
    const std::string name(sent_radiosity_plane);
    const int layers = resources.method.radiosity.layers;
    const GlTexture& sent =
        resources.planes.create(name, texture_format(resources.method.gbuffer.radiance_format), layers);
    std::vector<GlAttachment> attachments;
    attachments.reserve(static_cast<std::size_t>(layers));
    for (int layer = 0; layer < layers; ++layer) attachments.push_back({&sent, layer, 0});
    return GlFramebuffer(resources.context, attachments, {}, "radiosity carried on");
}

}  // namespace

RadiosityCarryPass::RadiosityCarryPass(const PassResources& resources)
    : planes_(resources.planes),
      depth_(resources.planes.get("depth")),
      previous_depth_(resources.planes.get(gbuffer_history)),
      direct_(resources.planes.get("direct")),
      albedo_(resources.planes.get(diffuse_albedo_plane(resources.scene, resources.method))),
      takes_all_(resources.method.radiosity.damping == 1.0f),
      reprojection_(resources, CarryUnits::moving_instance),
      draw_(resources.context, resources.programs, "radiosity_carry.frag", defines(resources)),
      target_(make_carry_target(resources)) {}

ShaderDefines RadiosityCarryPass::defines(const PassResources& resources) const {
    const RadiositySettings& settings = resources.method.radiosity;
    require_sound_carry(settings);
    ShaderDefines result = {{"LAYERS", std::to_string(settings.layers)},
                            {"REUSE", "0"},
                            {"GATHER", "1"},
                            {"NONE", "2"},
                            {"SECOND_LAYER", std::to_string(static_cast<int>(settings.second_layer))},
                            {"KEPT_LAYERS", std::to_string(receiving_layers(settings, 1))},
                            {"DAMPING", shader_literal(settings.damping)},
                            {"CARRY_FROM", shader_literal(settings.carry_from)},
                            {"CARRY_TO", shader_literal(settings.carry_to)},
                            {"CARRY_IS_CUT", settings.carry_from == settings.carry_to ? "1" : "0"}};
    for (auto& define : boost_defines(settings)) result.push_back(std::move(define));
    for (auto& define : reprojection_.defines()) result.push_back(std::move(define));
    return result;
}

void RadiosityCarryPass::execute(const PassFrame& frame) {
    depth_.bind(CarryUnits::depth);
    previous_depth_.bind(CarryUnits::previous_depth);
    direct_.bind(CarryUnits::direct);
    albedo_.bind(CarryUnits::albedo);
    // Until this frame's passes write it, the plane holds what they gave in the last one.
    planes_.get(radiosity_plane(1)).bind(CarryUnits::irradiance);
    reprojection_.bind();
    // A driver may find out that nothing is read where all is taken away.
    if (!takes_all_) draw_.program().set("continues", frame.continues ? 1 : 0);
    draw_.draw(target_);
}

PassDeclaration declare_radiosity_carry(const Scene& scene, const Method& method) {
    const RadiositySettings& settings = method.radiosity;
    PassDeclaration pass;
    pass.name = "radiosity carried on";
    for (int layer = 0; layer < settings.layers; ++layer) {
        for (const std::string& plane :
             {std::string("depth"), std::string("direct"), diffuse_albedo_plane(scene, method)})
            pass.inputs.push_back(layer_prefix(layer) + plane);
        pass.outputs.push_back(layer_prefix(layer) + std::string(sent_radiosity_plane));
    }
    for (int layer = 0; layer < receiving_layers(settings, 1); ++layer) {
        pass.inputs.push_back(layer_prefix(layer) + std::string(gbuffer_history));
        for (std::string& plane : Reprojection::inputs(scene, layer)) pass.inputs.push_back(std::move(plane));
    }
    for (const char* name : {"radiosity.damping", "radiosity.carry_from", "radiosity.carry_to",
                             "radiosity.second_layer", "gbuffer.radiance_format"})
        pass.parameters.push_back({name});
    if (settings.damping < 1.0f) {
        for (const char* name : {"radiosity.saturated_boost", "radiosity.unsaturated_boost"})
            pass.parameters.push_back({name});
    }
    pass.kept = {radiosity_plane(1)};  // what this frame's passes give, the next frame carries on
    pass.create = [](const PassResources& resources) { return std::make_unique<RadiosityCarryPass>(resources); };
    pass.remark =
        fmt::format("what was {} m off is lost, {} of the rest taken away", settings.carry_to, settings.damping);
    return pass;
}

}  // namespace plumb
