#include "rasterizer/radiosity.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "rasterizer/depth_mip_chain.h"
#include "rasterizer/falloff.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

constexpr std::string_view filtered_plane = "radiosity";

std::string gathered_plane(const Method& method) {
    return std::string(filtered_plane) + (method.radiosity.blur.radius > 0 ? ".unfiltered" : "");
}

std::string depth_plane(const Method& method) {
    return method.radiosity.use_mip_chain ? std::string(depth_mip_chain_plane) : "depth";
}

void require_sound(const RadiositySettings& settings) {
    if (!(settings.radius > 0.0f && std::isfinite(settings.radius))) {
        throw MethodError(
            fmt::format("radiosity.radius is {}; use a finite length in metres, as large as the room at most: the taps "
                        "spread over it",
                        settings.radius));
    }
    if (settings.layers < 1 || settings.layers > 2) {
        throw MethodError(fmt::format("radiosity.layers is {}; use 1 or 2", settings.layers));
    }
    if (settings.mip_offset < 0) {
        throw MethodError(
            fmt::format("radiosity.mip_offset is {}; use 0 or more (the source: 4)", settings.mip_offset));
    }
    if (settings.minimum_mip_level < 0 || settings.minimum_mip_level > 5) {
        throw MethodError(fmt::format("radiosity.minimum_mip_level is {}; use 0 to 5", settings.minimum_mip_level));
    }
    if (!settings.use_mip_chain && settings.minimum_mip_level > 0) {
        throw MethodError(
            fmt::format("radiosity.minimum_mip_level is {}, but radiosity.use_mip_chain is false; set one "
                        "of them to its default",
                        settings.minimum_mip_level));
    }
}

ShaderDefines shader_defines(const PassResources& resources) {
    const RadiositySettings& settings = resources.method.radiosity;
    require_sound(settings);
    const int coarsest =
        settings.use_mip_chain ? coarsest_depth_mip(resources.planes.width(), resources.planes.height()) : 0;
    ShaderDefines defines = SampleSpiral::defines(settings.samples);
    const ShaderDefines chosen = {
        {"HITS", "0"},
        {"SAMPLES", "1"},
        {"NORMALISATION", settings.normalisation == RadiosityNormalisation::hits ? "HITS" : "SAMPLES"},
        {"LAYERS", std::to_string(settings.layers)},
        {"EMITTERS_SHINE", settings.emitters_shine ? "1" : "0"},
        {"TEST_TAP_NORMAL", settings.test_tap_normal ? "1" : "0"},
        {"RADIUS", shader_literal(settings.radius)},
        {"MIP_OFFSET", std::to_string(settings.mip_offset)},
        {"FINEST_LEVEL", std::to_string(std::min(settings.minimum_mip_level, coarsest))},
        {"COARSEST_LEVEL", std::to_string(coarsest)}};
    defines.insert(defines.end(), chosen.begin(), chosen.end());
    const ShaderDefines of_falloff = falloff_defines(resources.quantities.indirect_falloff);
    defines.insert(defines.end(), of_falloff.begin(), of_falloff.end());
    return defines;
}

GlFramebuffer gathering_target(const PassResources& resources) {
    const GlTexture& gathered = resources.planes.create(gathered_plane(resources.method), GL_RGBA32F, 1);
    const GlAttachment attachment{&gathered, 0, 0};
    return GlFramebuffer(resources.context, {&attachment, 1}, {}, "radiosity");
}

struct ReflectionOutput {
    const char* plane;
    const char* define;  // in radiosity_reflection.frag
    GLenum format;
};
constexpr std::array<ReflectionOutput, 4> reflection_outputs = {{{"irradiance", "IRRADIANCE", GL_RGBA32F},
                                                                 {"confidence", "CONFIDENCE", GL_R32F},
                                                                 {"indirect", "INDIRECT", GL_RGBA32F},
                                                                 {"indirect.1", "FIRST_BOUNCE", GL_RGBA32F}}};

// Allocates the outputs that are read and notes their locations.
GlFramebuffer reflection_target(const PassResources& resources, ShaderDefines& locations) {
    std::vector<GlAttachment> attachments;
    for (const ReflectionOutput& output : reflection_outputs) {
        if (!resources.is_read(output.plane)) continue;
        locations.emplace_back(output.define, std::to_string(attachments.size()));
        attachments.push_back({&resources.planes.create(output.plane, output.format, 1), 0, 0});
    }
    return GlFramebuffer(resources.context, attachments, {}, "radiosity reflection");
}

}  // namespace

std::string_view to_string(RadiosityNormalisation normalisation) {
    return normalisation == RadiosityNormalisation::hits ? "hits" : "samples";
}

RadiosityPass::RadiosityPass(const PassResources& resources)
    : depth_(resources.planes.get(depth_plane(resources.method))),
      normal_(resources.planes.get("normal")),
      position_(stored_positions(resources)),
      direct_(resources.planes.get("direct")),
      spiral_(resources.context, resources.method.radiosity.samples),
      draw_(resources.context, resources.programs, "radiosity.frag", shader_defines(resources)),
      target_(gathering_target(resources)),
      area_(resources, glm::ivec2(blur_reach(resources.method.radiosity.blur))) {
    if (resources.method.radiosity.emitters_shine) emission_ = &resources.planes.get("emission");
}

void RadiosityPass::execute(const PassFrame&) {
    depth_.bind(0);
    normal_.bind(1);
    if (position_) position_->bind(stored_position_unit);
    direct_.bind(2);
    if (emission_) emission_->bind(4);
    spiral_.bind();
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

RadiosityReflectionPass::RadiosityReflectionPass(const PassResources& resources)
    : gathered_(resources.planes.get(filtered_plane)),
      albedo_(resources.planes.get("albedo")),
      target_(reflection_target(resources, locations_)),
      draw_(resources.context, resources.programs, "radiosity_reflection.frag", locations_),
      area_(resources, {0, 0}) {}

void RadiosityReflectionPass::execute(const PassFrame&) {
    gathered_.bind(0);
    albedo_.bind(1);
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

std::vector<PassDeclaration> declare_radiosity(const Method& method) {
    const RadiositySettings& settings = method.radiosity;
    const std::string depth = depth_plane(method),
                      disabled = settings.enabled ? "" : "method.radiosity.enabled is false";
    PassDeclaration gathering{
        .name = "radiosity",
        .inputs = {"depth", "normal", "direct", depth},
        .outputs = {gathered_plane(method)},
        .create = [](const PassResources& resources) { return std::make_unique<RadiosityPass>(resources); },
        .disabled = disabled,
        .remark = fmt::format("{} taps, {} layer{}, divided by the {}", settings.samples, settings.layers,
                              settings.layers == 1 ? "" : "s", to_string(settings.normalisation))};
    std::vector<std::string> of_each_layer = {depth, "normal", "direct"};
    if (settings.emitters_shine) {
        gathering.inputs.emplace_back("emission");
        gathering.remark += ", emitters shine";
        of_each_layer.emplace_back("emission");
    }
    if (settings.layers > 1) {
        for (const std::string& plane : of_each_layer) {
            gathering.inputs.push_back(std::string(second_layer_prefix) + plane);
        }
    }
    for (int layer = 0; stores_positions(method) && layer < settings.layers; ++layer)
        gathering.inputs.push_back(layer_prefix(layer) + "camera_position");
    std::vector<PassDeclaration> passes = {std::move(gathering)};
    if (settings.blur.radius > 0) {
        passes.push_back(declare_bilateral_blur({.name = "radiosity blur",
                                                 .settings = settings.blur,
                                                 .quantity_radius = settings.radius,
                                                 .input = gathered_plane(method),
                                                 .output = std::string(filtered_plane),
                                                 .stored_positions = stores_positions(method)}));
        passes.back().disabled = disabled;
    }
    PassDeclaration reflection{
        .name = "radiosity reflection",
        .inputs = {std::string(filtered_plane), "albedo"},
        .outputs = {},
        .create = [](const PassResources& resources) { return std::make_unique<RadiosityReflectionPass>(resources); },
        .disabled = disabled};
    for (const ReflectionOutput& output : reflection_outputs) reflection.outputs.emplace_back(output.plane);
    passes.push_back(std::move(reflection));
    return passes;
}

}  // namespace plumb
