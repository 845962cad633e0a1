#include "parameter_pictures.h"

#include <algorithm>

#include "experiments/method_file.h"
#include "method_where_it_matters.h"
#include "rasterizer/pipeline.h"
#include "tests/busy_scene.h"

namespace plumb {
namespace {

// Values that show at this size within few frames; of the others the next one, or a little more.
const std::map<std::string, const char*> telling_values = {
    {"gbuffer.generation", "\"previous\""},
    {"gbuffer.minimum_separation", "0.8"},
    {"gbuffer.separation_unit", "\"frustum\""},
    {"gbuffer.guard_band", "8"},
    {"ao.blur.depth_key_bits", "8"},
    {"radiosity.blur.depth_key_bits", "8"},
    {"ao.blur.plane_exemption", "0.01"},
    {"radiosity.blur.plane_exemption", "0.01"},
    {"ao.spread_pixels", "9"},
    {"ao.mip_offset", "0"},
    {"radiosity.spread_pixels", "9"},
    {"radiosity.mip_offset", "0"},
    {"radiosity.minimum_mip_level", "2"},
    {"antialias.jitter_length", "2"},
    {"direct.volume_threshold", "3.0"},
    {"direct.shadow.bias", "0.05"},
    {"direct.shadow.paraboloid_tessellation", "1"},
    {"environment.size", "64"},
    {"environment.samples", "2"},
    {"probe.size", "64"},
    {"reflections.max_steps", "3"},
    {"reflections.first_step", "4.0"},
    {"reflections.max_distance", "0.4"},
    {"reflections.bias", "0.2"},
};

}  // namespace

const std::map<std::string, std::string>& parameters_without_pixels() {
    static const std::map<std::string, std::string> reasons = {
        {"gbuffer.source", "hands in the planes that it would render"},
        {"direct.source", "hands in the plane that it would render"},
        {"gbuffer.layers", "decides which planes there are to ask for"},
        {"gbuffer.layer_selection", "time alone: the same triangles reach the same layers"},
        {"gbuffer.depth_mapping",
         "precision of the depth test, which shows where surfaces lie closer than a float tells"},
        {"radiosity.mip_normals_and_radiance", "time and memory alone: the chains hold the very texels of level 0"},
        {"direct.shadow.cube_generation", "time alone: the same triangles reach the same faces"},
    };
    return reasons;
}

void use_another_value(Method& method, const std::string& name) {
    std::vector<MethodParameter> parameters = method_parameters(method);
    const MethodParameter& parameter = *std::ranges::find(parameters, name, &MethodParameter::name);
    const auto telling = telling_values.find(name);
    if (telling != telling_values.end()) {
        // Whether or not it has an effect there.
        Method start = method;
        start.name = "start";
        const std::string text = "name = \"" + method.name + "\"\nbase = \"start\"\n" + name + " = " + telling->second;
        method = read_method(parse_config(text, "another value"), "another value", {start});
    } else if (bool* const* truth = std::get_if<bool*>(&parameter.value)) {
        **truth = !**truth;
    } else if (int* const* whole = std::get_if<int*>(&parameter.value)) {
        **whole = **whole == parameter.least ? **whole + 1 : **whole - 1;
    } else if (float* const* number = std::get_if<float*>(&parameter.value)) {
        **number = **number * 1.1f + 0.013f;
    } else {
        const auto& choice = std::get<MethodChoice>(parameter.value);
        choice.set((choice.get() + 1) % static_cast<int>(choice.names.size()));
    }
}

Method small_method(const std::string& name) {
    Method method = method_where_it_matters(name);
    ShadowSettings& shadow = method.direct.shadow;
    shadow.cube_size = shadow.emitter_size = shadow.paraboloid_size = 48;
    shadow.map_size = 96;
    method.environment = {.size = 32, .samples = 8};
    method.probe.size = 32;
    method.ao.samples = 6, method.radiosity.samples = 8;
    method.reflections.max_steps = 64;
    if (method.reflections.roughness == ReflectionRoughness::samples) method.reflections.samples = 2;
    // Emissive surfaces must not count twice, and are farther away than a metre.
    if (name == "radiosity.emitters_shine") {
        method.direct.emitters = false;
        method.radiosity.radius = 3.0f;
    }
    // Both layers of a tap that send light: farther away than a metre.
    if (name == "radiosity.estimator") method.radiosity.radius = 3.0f;
    // Taps are some ten pixels away.
    if (name.ends_with(".use_mip_chain") || name.ends_with(".mip_points"))
        method.ao.mip_offset = method.radiosity.mip_offset = 0;
    // Points are found again within some centimetres.
    if (name.starts_with("radiosity.carry_")) method.radiosity.carry_from = 0.005f, method.radiosity.carry_to = 0.02f;
    if (name == "direct.local_lights") method.direct.volume_threshold = 3.0f;
    // The spheres of one definition reach the floor, those of the other do not.
    if (name == "direct.volume_radius") method.direct.volume_threshold = 1.0f;
    // Highlights of lamps are brighter than what there is else to be seen.
    if (name.starts_with("probe.") || name.starts_with("environment.")) method.reflections.lamps = false;
    return method;
}

std::vector<std::string> telling_planes(const std::string& name) {
    const auto of = [&](const char* group) { return name.starts_with(group); };
    if (name == "ao.enabled") return {"direct"};
    if (name == "radiosity.enabled" || name == "reflections.enabled" || of("composite.") || of("antialias."))
        return {"total"};
    if (of("ao.")) return {"ao"};
    if (of("direct.")) return {"direct"};
    if (of("reflections.") || name == "environment.samples") return {"reflection"};
    if (name == "environment.size") return {"direct"};
    if (name == "gbuffer.normal_format" || name == "gbuffer.position") return {"ao"};
    if (of("gbuffer.") && name != "gbuffer.guard_band" && name != "gbuffer.radiance_format") return {"layer2.depth"};
    return {"irradiance", "indirect"};
}

Frame render_busy_frames(GlContext& context, const Scene& scene, const Method& method,
                         const std::vector<std::string>& planes, const PictureSize& size) {
    const auto [width, height] = size;
    Pipeline pipeline(context, scene, method, {.planes = planes}, width, height);
    pipeline.time_passes(busy_frame(0, width, height));
    pipeline.time_passes(busy_frame(1, width, height));
    return pipeline.render(busy_frame(2, width, height)).frame;
}

bool same_pixels(const Frame& first, const Frame& second, const std::vector<std::string>& planes) {
    return std::ranges::all_of(planes, [&](const std::string& plane) {
        return std::ranges::equal(first.plane(plane).values(), second.plane(plane).values());
    });
}

}  // namespace plumb
