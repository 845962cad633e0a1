#include "experiments/method_parameters.h"

#include <fmt/format.h>

#include "experiments/config.h"

namespace plumb {
namespace {

template <class Enumeration>
MethodChoice choice(Enumeration& value, std::vector<std::string> names) {
    return {std::move(names), [&value] { return static_cast<int>(value); },
            [&value](int index) { value = static_cast<Enumeration>(index); }};
}

void add_blur(std::vector<MethodParameter>& parameters, const std::string& prefix, BilateralBlurSettings& blur) {
    parameters.insert(parameters.end(),
                      {
                          {prefix + "kind", choice(blur.kind, {"bilateral", "gaussian_2015", "gaussian_2015_listing"})},
                          {prefix + "radius", &blur.radius, 0, 64},
                          {prefix + "step", &blur.step, 1, 64},
                          {prefix + "weights", choice(blur.weights, {"gaussian", "g3d"})},
                          {prefix + "depth_sharpness", &blur.depth_sharpness, 0, 1e6},
                          {prefix + "normal_sharpness", &blur.normal_sharpness, 0, 1e6},
                          {prefix + "plane_sharpness", &blur.plane_sharpness, 0, 1e6},
                          {prefix + "plane_exemption", &blur.plane_exemption, 0, 1e6},
                          {prefix + "monotonic", &blur.monotonic},
                          {prefix + "depth_key_bits", &blur.depth_key_bits, 8, 32},
                      });
}

void add_reflections(std::vector<MethodParameter>& parameters, ReflectionSettings& reflections) {
    parameters.insert(parameters.end(),
                      {
                          {"reflections.enabled", &reflections.enabled},
                          {"reflections.roughness", choice(reflections.roughness, {"mirror", "mip", "samples"})},
                          {"reflections.samples", &reflections.samples, 1, 4096},
                          {"reflections.layers", &reflections.layers, 1, 2},
                          {"reflections.step", &reflections.step, 0.25, 64},
                          {"reflections.first_step", &reflections.first_step, 0.25, 64},
                          {"reflections.max_steps", &reflections.max_steps, 1, 16384},
                          {"reflections.refinement_steps", &reflections.refinement_steps, 0, 16},
                          {"reflections.hit", choice(reflections.hit, {"behind", "mara2016", "crossed"})},
                          {"reflections.thickness", &reflections.thickness, 0, 1e6},
                          {"reflections.max_distance", &reflections.max_distance, 1e-6, no_limit},
                          {"reflections.bias", &reflections.bias, 0, 1e3},
                          {"reflections.test_hit_normal", &reflections.test_hit_normal},
                          {"reflections.border_fade", &reflections.border_fade, 0, 4096},
                          {"reflections.fallback", choice(reflections.fallback, {"none", "environment", "probe"})},
                          {"reflections.lamps", &reflections.lamps},
                      });
}

void add_temporal(std::vector<MethodParameter>& parameters, const std::string& prefix, TemporalFilterSettings& filter) {
    parameters.insert(parameters.end(), {
                                            {prefix + "alpha", &filter.alpha, 0, 0.99},
                                            {prefix + "rejection", choice(filter.rejection, {"plane", "mara2016"})},
                                            {prefix + "reject_from", &filter.reject_from, 0, 1e6},
                                            {prefix + "reject_to", &filter.reject_to, 0, 1e6},
                                            {prefix + "layers", &filter.layers, 1, 2},
                                            {prefix + "vary_taps", &filter.vary_taps},
                                        });
}

}  // namespace

std::vector<MethodParameter> method_parameters(Method& m) {
    const std::vector<std::string> sources = {"method", "truth"};
    const std::vector<std::string> tap_patterns = {"sao2012", "nielsen2015"};
    const std::vector<std::string> mip_tap_points = {"exact", "sao2012"};
    const std::vector<std::string> ambient_sources = {"none", "ambient", "environment", "probe"};
    std::vector<MethodParameter> parameters = {
        {"gbuffer.source", choice(m.gbuffer.source, sources)},
        {"gbuffer.layers", &m.gbuffer.layers, 1, 4},
        {"gbuffer.generation", choice(m.gbuffer.generation, {"peel", "delay", "previous", "predict", "reproject"})},
        {"gbuffer.layer_selection", choice(m.gbuffer.layer_selection, {"geometry_shader", "vertex_shader"})},
        {"gbuffer.minimum_separation", &m.gbuffer.minimum_separation, 0, 1e6},
        {"gbuffer.separation_unit", choice(m.gbuffer.separation_unit, {"metres", "frustum"})},
        {"gbuffer.guard_band", &m.gbuffer.guard_band, 0, 4096},
        {"gbuffer.depth_mapping", choice(m.gbuffer.depth_mapping, {"reversed", "standard"})},
        {"gbuffer.position", choice(m.gbuffer.position, {"from_depth", "stored", "stored_16"})},
        {"gbuffer.normal_format",
         choice(m.gbuffer.normal_format, {"oct32", "oct16", "rgb32f", "rgb16f", "rgb10a2", "r11g11b10f", "xy8"})},
        {"gbuffer.radiance_format", choice(m.gbuffer.radiance_format, {"rgba32f", "rgba16f", "r11g11b10f"})},
        {"direct.source", choice(m.direct.source, sources)},
        {"direct.emitters", &m.direct.emitters},
        {"direct.local_lights", choice(m.direct.local_lights, {"fullscreen", "volume", "volume_stencil"})},
        {"direct.volume_threshold", &m.direct.volume_threshold, 1e-9, 1e6},
        {"direct.volume_radius", choice(m.direct.volume_radius, {"attenuation", "ogldev_code"})},
        {"direct.volume_faces", choice(m.direct.volume_faces, {"front", "back", "both"})},
        {"direct.environment", choice(m.direct.environment, {"harmonics", "cube"})},
        {"direct.shadow.lamps", &m.direct.shadow.lamps},
        {"direct.shadow.point_map", choice(m.direct.shadow.point_map, {"cube", "dual_paraboloid"})},
        {"direct.shadow.cube_generation", choice(m.direct.shadow.cube_generation, {"six_views", "one_pass"})},
        {"direct.shadow.cube_distance", choice(m.direct.shadow.cube_distance, {"reciprocal", "linear"})},
        {"direct.shadow.cube_size", &m.direct.shadow.cube_size, 16, 8192},
        {"direct.shadow.paraboloid_size", &m.direct.shadow.paraboloid_size, 16, 16384},
        {"direct.shadow.paraboloid_tessellation", &m.direct.shadow.paraboloid_tessellation, 1, 64},
        {"direct.shadow.map_size", &m.direct.shadow.map_size, 16, 16384},
        {"direct.shadow.pcf_radius", &m.direct.shadow.pcf_radius, 0, 16},
        {"direct.shadow.emitter_size", &m.direct.shadow.emitter_size, 16, 8192},
        {"direct.shadow.emitter_samples", &m.direct.shadow.emitter_samples, 1, 256},
        {"direct.shadow.bias", &m.direct.shadow.bias, 0, 1e3},
        {"environment.size", &m.environment.size, 32, 4096},
        {"environment.samples", &m.environment.samples, 1, 65536},
        {"probe.x", &m.probe.x, -1e6, 1e6},
        {"probe.y", &m.probe.y, -1e6, 1e6},
        {"probe.z", &m.probe.z, -1e6, 1e6},
        {"probe.size", &m.probe.size, 32, 4096},
        {"probe.every_frame", &m.probe.every_frame},
        {"ao.enabled", &m.ao.enabled},
        {"ao.estimator", choice(m.ao.estimator, {"mara2016", "g3d_demo", "sao2012", "sao2012_undivided", "alchemy2011",
                                                 "nielsen2015", "linear"})},
        {"ao.samples", &m.ao.samples, 1, 1000},
        {"ao.pattern", choice(m.ao.pattern, tap_patterns)},
        {"ao.layers", &m.ao.layers, 1, 2},
        {"ao.normals", choice(m.ao.normals, {"interpolated", "face", "g3d_demo"})},
        {"ao.bias", &m.ao.bias, 0, 1e3},
        {"ao.epsilon", &m.ao.epsilon, 0, 1e3},
        {"ao.intensity", &m.ao.intensity, 0, 1e6},
        {"ao.exponent", &m.ao.exponent, 0, 100},
        {"ao.spread_pixels", &m.ao.spread_pixels, 0, 4096},
        {"ao.use_mip_chain", &m.ao.use_mip_chain},
        {"ao.mip_offset", &m.ao.mip_offset, 0, 16},
        {"ao.mip_points", choice(m.ao.mip_points, mip_tap_points)},
    };
    add_blur(parameters, "ao.blur.", m.ao.blur);
    add_temporal(parameters, "ao.temporal.", m.ao.temporal);
    parameters.insert(parameters.end(),
                      {
                          {"radiosity.enabled", &m.radiosity.enabled},
                          {"radiosity.estimator", choice(m.radiosity.estimator, {"mara2016", "nielsen2015"})},
                          {"radiosity.samples", &m.radiosity.samples, 1, 1000},
                          {"radiosity.pattern", choice(m.radiosity.pattern, tap_patterns)},
                          {"radiosity.layers", &m.radiosity.layers, 1, 2},
                          {"radiosity.emitters_shine", &m.radiosity.emitters_shine},
                          {"radiosity.radius", &m.radiosity.radius, 1e-6, no_limit},
                          {"radiosity.spread_pixels", &m.radiosity.spread_pixels, 0, 4096},
                          {"radiosity.test_tap_normal", &m.radiosity.test_tap_normal},
                          {"radiosity.normalisation", choice(m.radiosity.normalisation, {"hits", "samples"})},
                          {"radiosity.use_mip_chain", &m.radiosity.use_mip_chain},
                          {"radiosity.mip_offset", &m.radiosity.mip_offset, 0, 16},
                          {"radiosity.minimum_mip_level", &m.radiosity.minimum_mip_level, 0, 5},
                          {"radiosity.mip_points", choice(m.radiosity.mip_points, mip_tap_points)},
                          {"radiosity.mip_normals_and_radiance", &m.radiosity.mip_normals_and_radiance},
                          {"radiosity.bounces", &m.radiosity.bounces, 1, most_bounces},
                          {"radiosity.second_layer", choice(m.radiosity.second_layer, {"reuse", "gather", "none"})},
                          {"radiosity.carry", &m.radiosity.carry},
                          {"radiosity.damping", &m.radiosity.damping, 0, 1},
                          {"radiosity.carry_from", &m.radiosity.carry_from, 0, 1e6},
                          {"radiosity.carry_to", &m.radiosity.carry_to, 0, 1e6},
                          {"radiosity.saturated_boost", &m.radiosity.saturated_boost, 0, 100},
                          {"radiosity.unsaturated_boost", &m.radiosity.unsaturated_boost, 0, 100},
                          {"radiosity.fill", choice(m.radiosity.fill, ambient_sources)},
                          {"radiosity.ambient", &m.radiosity.ambient, 0, 1e6},
                      });
    add_blur(parameters, "radiosity.blur.", m.radiosity.blur);
    add_temporal(parameters, "radiosity.temporal.", m.radiosity.temporal);
    parameters.insert(parameters.end(),
                      {
                          {"antialias.temporal", &m.antialias.temporal},
                          {"antialias.jitter_length", &m.antialias.jitter_length, 1, 1024},
                          {"antialias.reprojection", &m.antialias.reprojection},
                          {"antialias.alpha", &m.antialias.alpha, 0, 0.9999},
                          {"antialias.dilate", &m.antialias.dilate},
                          {"antialias.lookup", choice(m.antialias.lookup, {"bilinear", "catmull_rom"})},
                          {"antialias.clamp", &m.antialias.clamp},
                      });
    parameters.insert(parameters.end(), {
                                            {"composite.kind", choice(m.composite.kind, {"physical", "demo"})},
                                            {"composite.fill", choice(m.composite.fill, ambient_sources)},
                                            {"composite.ambient", &m.composite.ambient, 0, 1e6},
                                        });
    add_reflections(parameters, m.reflections);
    return parameters;
}

std::vector<std::string> method_parameter_names() {
    Method method;
    std::vector<std::string> names;
    for (const MethodParameter& parameter : method_parameters(method)) names.push_back(parameter.name);
    return names;
}

std::string print_parameter(const MethodParameter& parameter) {
    struct Printer {
        std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
        std::string operator()(const int* value) const { return fmt::format("{}", *value); }
        std::string operator()(const float* value) const {
            const std::string text = fmt::format("{}", *value);  // the shortest text that reads back as the same float
            return text.find_first_of(".einf") == std::string::npos ? text + ".0" : text;
        }
        std::string operator()(const MethodChoice& value) const {
            return fmt::format("\"{}\"", value.names[value.get()]);
        }
    };
    return std::visit(Printer{}, parameter.value);
}

}  // namespace plumb
