#include "rasterizer/ambient_obscurance.h"

#include <cmath>

#include <fmt/format.h>

#include "rasterizer/depth_mip_chain.h"
#include "rasterizer/falloff.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/temporal_filter.h"

namespace plumb {
namespace {

// Lights the sky's share of both layers, guard band included, by ambient visibility.
constexpr std::string_view guard_band_reader = "direct";

bool is_blurred(const Method& method) { return method.ao.blur.radius > 0; }

bool reads_normals(const Method& method) { return method.ao.normals == ObscuranceNormals::interpolated; }

// What the temporal filter averages.
std::string plane_of_frame(const Method& method) { return method.ao.temporal.alpha > 0.0f ? "ao.of_frame" : "ao"; }

std::string output_plane(const Method& method) { return is_blurred(method) ? "ao.unfiltered" : plane_of_frame(method); }

std::string reason_to_be_off(const Method& method) { return method.ao.enabled ? "" : "method.ao.enabled is false"; }

std::string depth_plane(const Method& method) {
    return method.ao.use_mip_chain ? std::string(depth_mip_chain_plane) : "depth";
}

void require_sound(const Method& method, const Quantities& quantities) {
    const AmbientObscuranceSettings& settings = method.ao;
    const float radius = quantities.ao_radius;
    if (!(radius > 0.0f && std::isfinite(radius))) {
        throw MethodError(
            fmt::format("ambient obscurance looks for occluders within a finite radius, but the quantity's "
                        "ao_radius is {}; set it to a length in metres, for the truth as well",
                        radius));
    }
    if (settings.layers < 1 || settings.layers > 2) {
        throw MethodError(fmt::format("ao.layers is {}; use 1 or 2", settings.layers));
    }
    if (settings.estimator == AmbientObscuranceEstimator::sao2012_undivided &&
        quantities.ao_falloff == Falloff::cubic) {
        throw MethodError(
            "ao.estimator is \"sao2012_undivided\", whose source gives a scale for the quadratic and the hard falloff "
            "only, and the quantity's ao_falloff is cubic; ask for one of those, or set ao.estimator to \"sao2012\"");
    }
    if (settings.spread_pixels < 0) {
        throw MethodError(fmt::format("ao.spread_pixels is {}; use a number of pixels, or 0 for the projected radius",
                                      settings.spread_pixels));
    }
    if (!(settings.epsilon > 0.0f) || !(settings.bias >= 0.0f) || !(settings.intensity >= 0.0f)) {
        throw MethodError(fmt::format("ao.epsilon {} must be positive, ao.bias {} and ao.intensity {} not negative",
                                      settings.epsilon, settings.bias, settings.intensity));
    }
    if (settings.mip_offset < 0) {
        throw MethodError(fmt::format("ao.mip_offset is {}; use 0 or more (the source: 3)", settings.mip_offset));
    }
    require_points_at_taps("ao", settings.use_mip_chain, settings.mip_points, method);
}

// Of a surface that faces the camera the product is that of a pixel's sides a metre away.
void require_frontal_normals(const View& view) {
    const float side = 1.0f / view.pixels_per_metre(), least_pixels = 1.0f / std::sqrt(longest_g3d_normal);
    if (side * side <= longest_g3d_normal) return;
    const float lines = static_cast<float>(view.height()) * least_pixels / view.pixels_per_metre();
    throw MethodError(fmt::format(
        "ao.normals is \"g3d_demo\", whose limit is made for images of some 700 lines: of this view's {} "
        "lines (guard band included) it rejects every normal, even of surfaces that face the camera; render "
        "{:.0f} lines or more, or set ao.normals to \"face\" or \"interpolated\"",
        view.height(), std::ceil(lines)));
}

std::string in_capitals(std::string_view name) {
    std::string result;
    for (const char c : name) result += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    return result;
}

ShaderDefines shader_defines(const PassResources& resources) {
    const AmbientObscuranceSettings& settings = resources.method.ao;
    require_sound(resources.method, resources.quantities);
    ShaderDefines defines = SampleSpiral::defines(settings.samples, settings.pattern, taps_vary(settings.temporal));
    using enum AmbientObscuranceEstimator;
    for (const auto estimator : {mara2016, g3d_demo, sao2012, sao2012_undivided, alchemy2011, nielsen2015, linear}) {
        defines.emplace_back(in_capitals(to_string(estimator)), std::to_string(static_cast<int>(estimator)));
    }
    const ShaderDefines of_falloff = falloff_defines(resources.quantities.ao_falloff);
    defines.insert(defines.end(), of_falloff.begin(), of_falloff.end());
    const int coarsest = coarsest_mip(resources.planes.width(), resources.planes.height());
    const ShaderDefines chosen = {{"ESTIMATOR", in_capitals(to_string(settings.estimator))},
                                  {"LAYERS", std::to_string(settings.layers)},
                                  {"FACE_NORMALS", reads_normals(resources.method) ? "0" : "1"},
                                  {"G3D_NORMALS", settings.normals == ObscuranceNormals::g3d_demo ? "1" : "0"},
                                  {"LONGEST_NORMAL", shader_literal(longest_g3d_normal)},
                                  {"SPREAD_PIXELS", std::to_string(settings.spread_pixels)},
                                  {"LEAST_SINE", shader_literal(least_hit_sine)},
                                  {"EXPONENT", shader_literal(settings.exponent)},
                                  {"RADIUS", shader_literal(resources.quantities.ao_radius)},
                                  {"BIAS", shader_literal(settings.bias)},
                                  {"EPSILON", shader_literal(settings.epsilon)},
                                  {"INTENSITY", shader_literal(settings.intensity)},
                                  {"MIP_OFFSET", std::to_string(settings.mip_offset)},
                                  {"POINTS_AT_TAPS", settings.mip_points == MipTapPoint::sao2012 ? "1" : "0"},
                                  {"COARSEST_LEVEL", std::to_string(settings.use_mip_chain ? coarsest : 0)}};
    defines.insert(defines.end(), chosen.begin(), chosen.end());
    return defines;
}

GlFramebuffer make_obscurance_target(const PassResources& resources) {
    const GlAttachment attachment{&resources.planes.create(output_plane(resources.method), GL_R32F, 1), 0, 0};
    return GlFramebuffer(resources.context, {&attachment, 1}, {}, "ambient obscurance");
}

}  // namespace

std::string_view to_string(AmbientObscuranceEstimator estimator) {
    switch (estimator) {
        case AmbientObscuranceEstimator::mara2016:
            return "mara2016";
        case AmbientObscuranceEstimator::g3d_demo:
            return "g3d_demo";
        case AmbientObscuranceEstimator::sao2012:
            return "sao2012";
        case AmbientObscuranceEstimator::sao2012_undivided:
            return "sao2012_undivided";
        case AmbientObscuranceEstimator::alchemy2011:
            return "alchemy2011";
        case AmbientObscuranceEstimator::nielsen2015:
            return "nielsen2015";
        case AmbientObscuranceEstimator::linear:
            return "linear";
    }
    return "";
}

AmbientObscurancePass::AmbientObscurancePass(const PassResources& resources)
    : normals_(resources.method.ao.normals),
      depth_(resources.planes.get(depth_plane(resources.method))),
      normal_(reads_normals(resources.method) ? &resources.planes.get("normal") : nullptr),
      position_(stored_positions(resources)),
      spiral_(resources.context, resources.method.ao.samples),
      draw_(resources.context, resources.programs, "ambient_obscurance.frag", shader_defines(resources)),
      target_(make_obscurance_target(resources)),
      area_(resources, glm::ivec2(blur_reach(resources.method.ao.blur)), guard_band_reader) {}

void AmbientObscurancePass::execute(const PassFrame& frame) {
    if (normals_ == ObscuranceNormals::g3d_demo) require_frontal_normals(frame.view);
    depth_.bind(0);
    if (normal_) normal_->bind(1);
    if (position_) position_->bind(stored_position_unit);
    spiral_.bind();
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

std::vector<PassDeclaration> declare_ambient_obscurance(const Method& method, const Quantities& quantities) {
    const std::string depth = depth_plane(method);
    PassDeclaration pass{
        .name = "ambient obscurance",
        .inputs = {"depth", depth},
        .outputs = {output_plane(method)},
        .create = [](const PassResources& resources) { return std::make_unique<AmbientObscurancePass>(resources); },
        .disabled = reason_to_be_off(method),
        .remark = fmt::format("{}, {} taps, {} layer{}", to_string(method.ao.estimator), method.ao.samples,
                              method.ao.layers, method.ao.layers == 1 ? "" : "s")};
    pass.parameters = {{"ao."}, {"gbuffer.guard_band"}};  // with those of its filters, which run where it runs
    if (reads_normals(method)) pass.inputs.emplace_back("normal");
    if (method.ao.layers > 1) pass.inputs.push_back(layer_prefix(1) + depth);
    for (int layer = 0; stores_positions(method) && layer < method.ao.layers; ++layer)
        pass.inputs.push_back(layer_prefix(layer) + "camera_position");
    std::vector<PassDeclaration> passes = {std::move(pass)};
    if (is_blurred(method)) {
        passes.push_back(declare_bilateral_blur({.name = "ambient obscurance blur",
                                                 .settings = method.ao.blur,
                                                 .quantity_radius = quantities.ao_radius,
                                                 .input = output_plane(method),
                                                 .output = plane_of_frame(method),
                                                 .read_beyond = std::string(guard_band_reader),
                                                 .stored_positions = stores_positions(method)}));
        passes.back().disabled = passes.front().disabled;
    }
    return passes;
}

PassDeclaration declare_ambient_obscurance_over_time(const Scene& scene, const Method& method) {
    PassDeclaration pass = declare_temporal_filter(scene, {.name = "ambient obscurance over time",
                                                           .group = "ao.temporal",
                                                           .settings = method.ao.temporal,
                                                           .input = plane_of_frame(method),
                                                           .output = "ao",
                                                           .weight = "ao.history_weight",
                                                           .read_beyond = std::string(guard_band_reader)});
    if (!method.ao.enabled) pass.disabled = reason_to_be_off(method);
    return pass;
}

}  // namespace plumb
