#include "experiments/parameter_effects.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "experiments/parameter_reach.h"
#include "rasterizer/mip_chain_pass.h"
#include "rasterizer/plane_textures.h"

namespace plumb {
namespace {

using AskedPlanes = const std::vector<std::string>*;

bool may_be_asked_for(AskedPlanes planes, std::string_view plane) {
    return !planes || std::ranges::find(*planes, plane) != planes->end();
}

bool layer_may_be_asked_for(AskedPlanes planes, int layer) {
    return !planes ||
           std::ranges::any_of(*planes, [&](const std::string& plane) { return split_layer(plane).layer >= layer; });
}

template <std::size_t Count>
bool is_one_of(std::string_view name, const std::array<const char*, Count>& names) {
    return std::ranges::find(names, name) != names.end();
}

// Why parameter `name` of a blur changes nothing; empty where it matters. `group` is its prefix.
std::string blur_reason(const BilateralBlurSettings& blur, std::string_view group, std::string_view name) {
    if (!name.starts_with(group)) return "";
    name.remove_prefix(group.size());
    if (name != "radius" && blur.radius == 0) return fmt::format("{}radius = 0", group);
    if (blur.kind != BlurKind::bilateral && name != "kind" && name != "radius" && name != "step")
        return fmt::format("{}kind is not \"bilateral\"", group);
    if (name == "depth_key_bits" && blur.depth_sharpness == 0.0f) return fmt::format("{}depth_sharpness = 0", group);
    // It compares the weight of a tap with those nearer to the centre.
    if (name == "monotonic" && blur.radius == 1) return fmt::format("{}radius = 1", group);
    if (name == "plane_exemption" && blur.plane_sharpness == 0.0f) return fmt::format("{}plane_sharpness = 0", group);
    return "";
}

// The same of what is kept from frame to frame.
std::string temporal_reason(const Method& method, std::string_view name) {
    if (name.starts_with("ao.temporal.") && name != "ao.temporal.alpha" && method.ao.temporal.alpha == 0.0f)
        return "ao.temporal.alpha = 0";
    if (name.starts_with("radiosity.temporal.") && name != "radiosity.temporal.alpha" &&
        method.radiosity.temporal.alpha == 0.0f) {
        return "radiosity.temporal.alpha = 0";
    }
    if (name.starts_with("antialias.") && name != "antialias.temporal" && !method.antialias.temporal)
        return "antialias.temporal = false";
    constexpr std::array of_history = {"antialias.clamp", "antialias.reprojection", "antialias.dilate",
                                       "antialias.lookup"};
    if (is_one_of(name, of_history) && method.antialias.alpha == 0.0f)
        return "antialias.alpha = 0 takes nothing from the frames before";
    constexpr std::array of_motion = {"antialias.dilate", "antialias.lookup"};
    if (is_one_of(name, of_motion) && !method.antialias.reprojection)
        return "antialias.reprojection = false takes the same pixel of the frame before";
    return "";
}

bool gathers_in_screen_space(const Method& method) {
    return method.ao.enabled || method.radiosity.enabled || method.reflections.enabled;
}

// A stage that reads planes of the second layer, whatever is asked for.
bool reads_second_layer(const Method& method) {
    const auto remembers_both = [](const TemporalFilterSettings& filter) {
        return filter.alpha > 0.0f && filter.layers == 2;
    };
    return (method.ao.enabled && (method.ao.layers == 2 || remembers_both(method.ao.temporal))) ||
           (method.radiosity.enabled && (method.radiosity.layers == 2 || remembers_both(method.radiosity.temporal))) ||
           (method.reflections.enabled && method.reflections.layers == 2);
}

// The same of the G-buffer.
std::string gbuffer_reason(const Method& method, std::string_view name, AskedPlanes planes) {
    constexpr std::array of_two_layers = {"gbuffer.minimum_separation", "gbuffer.separation_unit", "gbuffer.generation",
                                          "gbuffer.layer_selection"};
    constexpr std::array of_rendering = {"gbuffer.separation_unit", "gbuffer.generation",    "gbuffer.layer_selection",
                                         "gbuffer.depth_mapping",   "gbuffer.normal_format", "gbuffer.position"};
    constexpr const char* nothing_gathers =
        "ao.enabled = false, radiosity.enabled = false and reflections.enabled = false";
    const GBufferSettings& gbuffer = method.gbuffer;
    // Reflections may take it for the thickness of surfaces.
    const bool is_thickness = method.reflections.enabled && method.reflections.thickness == 0.0f &&
                              (name == "gbuffer.minimum_separation" || name == "gbuffer.separation_unit");
    if (is_one_of(name, of_two_layers) && !is_thickness) {
        if (gbuffer.layers == 1) return "gbuffer.layers = 1";
        if (!reads_second_layer(method) && !layer_may_be_asked_for(planes, 1))
            return "no stage reads a second layer, and no plane of one is asked for";
    }
    if (gbuffer.source == SourceOfStage::truth && is_one_of(name, of_rendering)) return "gbuffer.source = \"truth\"";
    if (name == "gbuffer.layers" && gbuffer.layers > 2 && !layer_may_be_asked_for(planes, gbuffer.layers - 1)) {
        return fmt::format("no plane of layer {} is asked for, and no stage reads more than 2", gbuffer.layers);
    }
    if (name == "gbuffer.layer_selection" && gbuffer.generation == LayerGeneration::peel)
        return "gbuffer.generation = \"peel\"";
    if (name == "gbuffer.position" && !gathers_in_screen_space(method)) return nothing_gathers;
    // What fragments are reprojected to may lie in it.
    const bool looks_aside = gbuffer.layers > 1 && gbuffer.generation == LayerGeneration::reproject;
    if (name == "gbuffer.guard_band" && !gathers_in_screen_space(method) && !looks_aside) return nothing_gathers;
    return "";
}

bool reads_ambient(const Method& method, AmbientSource source) {
    return (method.radiosity.enabled && method.radiosity.fill == source) ||
           (method.composite.kind == CompositeKind::demo && method.composite.fill == source);
}

bool falls_back(const Method& method, ReflectionFallback to) {
    return method.reflections.enabled && method.reflections.fallback == to;
}

bool reads_probe(const Method& method) {
    return reads_ambient(method, AmbientSource::probe) || falls_back(method, ReflectionFallback::probe);
}

// Whether the method lights anything itself: what it takes from the truth is the first layer of the view.
bool lights_surfaces(const Method& method, AskedPlanes planes) {
    if (method.direct.source == SourceOfStage::method || reads_probe(method)) return true;
    if (method.gbuffer.layers == 1) return false;
    return (method.radiosity.enabled && method.radiosity.layers == 2) ||
           (method.reflections.enabled && method.reflections.layers == 2) || may_be_asked_for(planes, "layer2.direct");
}

// Why parameter `name` of the shadow maps changes nothing; empty where it matters. `emitters`: the light of emissive
// surfaces is computed.
std::string shadow_reason(const ShadowSettings& shadow, bool emitters, std::string_view name) {
    const bool paraboloids = shadow.point_map == PointShadowMap::dual_paraboloid;
    if (name == "direct.shadow.point_map" || name == "direct.shadow.cube_size" ||
        name.starts_with("direct.shadow.paraboloid_")) {
        if (!shadow.lamps) return "direct.shadow.lamps = false";
    }
    if (name == "direct.shadow.cube_size" && paraboloids) return "direct.shadow.point_map = \"dual_paraboloid\"";
    if (name.starts_with("direct.shadow.paraboloid_") && !paraboloids) return "direct.shadow.point_map = \"cube\"";
    if ((name == "direct.shadow.cube_generation" || name == "direct.shadow.cube_distance") && !emitters) {
        constexpr const char* no_emitters = "no emissive surface has a cube (direct.emitters), and ";
        if (!shadow.lamps) return fmt::format("{}direct.shadow.lamps = false", no_emitters);
        if (paraboloids) return fmt::format("{}direct.shadow.point_map = \"dual_paraboloid\"", no_emitters);
    }
    return "";
}

// The same of direct light.
std::string direct_reason(const Method& method, std::string_view name, AskedPlanes planes) {
    if (!name.starts_with("direct.") || name == "direct.source") return "";
    const DirectSettings& direct = method.direct;
    const bool lights = lights_surfaces(method, planes);
    // Highlights of lamps have shadows, wherever `direct` comes from.
    const bool lights_highlights = method.reflections.enabled && method.reflections.lamps &&
                                   name.starts_with("direct.shadow.") && !name.starts_with("direct.shadow.emitter_");
    if (!lights && !lights_highlights) return "direct.source = \"truth\"";
    if (std::string reason = shadow_reason(direct.shadow, lights && direct.emitters, name); !reason.empty())
        return reason;
    if (name.starts_with("direct.volume_") && direct.local_lights == LocalLights::fullscreen) {
        return "direct.local_lights = \"fullscreen\"";
    }
    if (name == "direct.volume_faces" && direct.local_lights == LocalLights::volume_stencil) {
        return "direct.local_lights = \"volume_stencil\", which draws both faces";
    }
    if (name.starts_with("direct.shadow.emitter_") && !direct.emitters) return "direct.emitters = false";
    return "";
}

// The same of the environment's cubes, the probe and the format of what is lit.
std::string light_reason(const Method& method, std::string_view name, AskedPlanes planes) {
    const bool cube = method.direct.environment == EnvironmentIrradiance::cube && lights_surfaces(method, planes);
    if (name == "environment.size" && !cube && !reads_ambient(method, AmbientSource::environment) &&
        !falls_back(method, ReflectionFallback::environment)) {
        return "no stage reads the environment's cubes (direct.environment, radiosity.fill, composite.fill or "
               "reflections.fallback would)";
    }
    if (name == "environment.samples" && !falls_back(method, ReflectionFallback::environment) &&
        !falls_back(method, ReflectionFallback::probe)) {
        return "no stage reads glossy levels (reflections.fallback would)";
    }
    if (name == "environment.samples" && method.reflections.roughness == ReflectionRoughness::samples) {
        return "reflections.roughness = \"samples\", which reads the sharpest level";
    }
    if (name.starts_with("probe.") && !reads_probe(method)) {
        return "no stage reads the probe (radiosity.fill, composite.fill or reflections.fallback would)";
    }
    // The truth's light is kept as it comes, in one texture for both layers.
    const RadiositySettings& radiosity = method.radiosity;
    const bool chain_follows = method.reflections.enabled && method.reflections.roughness == ReflectionRoughness::mip &&
                               method.gbuffer.radiance_format == RadianceFormat::rgba32f;
    if (name == "gbuffer.radiance_format" && method.direct.source == SourceOfStage::truth && !reads_probe(method) &&
        !chain_follows && !(radiosity.enabled && (radiosity.carry || radiosity.bounces > 1))) {
        return "direct.source = \"truth\", no later bounce is gathered, and the chain of reflections is only wider "
               "with \"rgba32f\"";
    }
    return "";
}

// The same of the reflections.
std::string reflection_reason(const ReflectionSettings& reflections, std::string_view name) {
    if (!name.starts_with("reflections.") || name == "reflections.enabled") return "";
    if (!reflections.enabled) return "reflections.enabled = false";
    if (name == "reflections.samples" && reflections.roughness != ReflectionRoughness::samples) {
        return "reflections.roughness is not \"samples\"";
    }
    if (name == "reflections.step" && reflections.max_steps == 1)
        return "reflections.max_steps = 1, which is reflections.first_step";
    return "";
}

// The same of what radiosity does with the light that it gathers, and of the composite.
std::string bounce_reason(const Method& method, std::string_view name) {
    const RadiositySettings& radiosity = method.radiosity;
    constexpr std::array of_carrying = {"radiosity.damping", "radiosity.carry_from", "radiosity.carry_to"};
    if (is_one_of(name, of_carrying) && !radiosity.carry) return "radiosity.carry = false";
    if (name == "radiosity.bounces" && radiosity.carry) return "radiosity.carry = true makes one bounce a frame";
    if (name == "radiosity.second_layer") {
        if (radiosity.layers == 1) return "radiosity.layers = 1";
        if (radiosity.bounces == 1 && !radiosity.carry) return "radiosity.bounces = 1 and radiosity.carry = false";
    }
    constexpr std::array of_what_is_carried = {"radiosity.carry_from", "radiosity.carry_to", "radiosity.second_layer"};
    if (is_one_of(name, of_what_is_carried) && radiosity.carry && radiosity.damping == 1.0f)
        return "radiosity.damping = 1 takes all away that is carried on";
    if (name == "radiosity.ambient" && radiosity.fill != AmbientSource::ambient) {
        return "radiosity.fill is not \"ambient\"";
    }
    const bool physical = method.composite.kind == CompositeKind::physical;
    if ((name == "composite.fill" || name == "composite.ambient") && physical) return "composite.kind = \"physical\"";
    if (name == "composite.ambient" && method.composite.fill != AmbientSource::ambient) {
        return "composite.fill is not \"ambient\"";
    }
    return "";
}

bool has_exponent(const AmbientObscuranceSettings& ao) {
    return ao.estimator == AmbientObscuranceEstimator::alchemy2011 ||
           ao.estimator == AmbientObscuranceEstimator::nielsen2015;
}

// The same where the visibility is 1 whatever the taps find.
std::string open_sky_reason(const AmbientObscuranceSettings& ao, std::string_view name) {
    if (!name.starts_with("ao.") || name == "ao.enabled") return "";
    if (ao.intensity == 0.0f) return name == "ao.intensity" ? "" : "ao.intensity = 0 leaves nothing obscured";
    if (has_exponent(ao) && ao.exponent == 0.0f && name != "ao.exponent" && name != "ao.estimator")
        return "ao.exponent = 0 leaves nothing obscured";
    return "";
}

// The same of the taps of ambient obscurance and radiosity.
std::string tap_reason(const Method& method, std::string_view name) {
    const AmbientObscuranceEstimator estimator = method.ao.estimator;
    if (name == "ao.exponent" && !has_exponent(method.ao)) {
        return "only ao.estimator = \"alchemy2011\" or \"nielsen2015\" has one";
    }
    if (name == "ao.epsilon" && estimator == AmbientObscuranceEstimator::sao2012_undivided) {
        return "ao.estimator = \"sao2012_undivided\", which divides by nothing";
    }
    if (!method.ao.use_mip_chain && name.starts_with("ao.mip_")) return "ao.use_mip_chain = false";
    const bool of_chain = name == "radiosity.minimum_mip_level" || name.starts_with("radiosity.mip_");
    if (!method.radiosity.use_mip_chain && of_chain) return "radiosity.use_mip_chain = false";
    const RadiositySettings& radiosity = method.radiosity;
    const bool counts_layers = radiosity.estimator == RadiosityEstimator::nielsen2015 && radiosity.layers > 1;
    if (name == "radiosity.normalisation" && radiosity.samples == 1 && !counts_layers)
        return "radiosity.samples = 1, so that all taps are the one that may hit";
    if (name == "radiosity.mip_offset" && method.radiosity.minimum_mip_level == coarsest_mip_level)
        return fmt::format("radiosity.minimum_mip_level = {}, the coarsest", coarsest_mip_level);
    return "";
}

// Why the method's other parameters leave `name` without effect on planes of which each stage shows.
std::string reason_in_method(const Method& method, std::string_view name, AskedPlanes planes) {
    if (name.starts_with("ao.") && name != "ao.enabled" && !method.ao.enabled) return "ao.enabled = false";
    if (name.starts_with("radiosity.") && name != "radiosity.enabled" && !method.radiosity.enabled) {
        return "radiosity.enabled = false";
    }
    for (std::string reason :
         {direct_reason(method, name, planes), light_reason(method, name, planes),
          reflection_reason(method.reflections, name), open_sky_reason(method.ao, name),
          blur_reason(method.ao.blur, "ao.blur.", name), blur_reason(method.radiosity.blur, "radiosity.blur.", name),
          temporal_reason(method, name), tap_reason(method, name), bounce_reason(method, name),
          gbuffer_reason(method, name, planes)}) {
        if (!reason.empty()) return reason;
    }
    return "";
}

}  // namespace

std::string reason_without_effect(const Method& method, std::string_view name, AskedPlanes planes, const Scene* scene) {
    std::string reason = reason_in_method(method, name, planes);
    if (!reason.empty()) return reason;
    if (planes) reason = reason_nobody_reads(method, name, planes, make_scene_of_everything());
    if (!reason.empty() || !scene) return reason;
    reason = reason_nobody_reads(method, name, planes, *scene);
    return reason.empty() ? "" : fmt::format("nothing in scene '{}' is concerned ({})", scene->name, reason);
}

std::string reason_without_effect_of_shared(const Method& method, std::string_view name,
                                            const std::vector<std::string>& planes) {
    return reason_in_method(method, name, &planes);
}

}  // namespace plumb
