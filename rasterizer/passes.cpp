#include "rasterizer/passes.h"

#include <cmath>

#include <fmt/format.h>

#include "rasterizer/ambient_obscurance.h"
#include "rasterizer/composite_pass.h"
#include "rasterizer/depth_key_pass.h"
#include "rasterizer/depth_mip_chain.h"
#include "rasterizer/direct_light_pass.h"
#include "rasterizer/environment_maps_pass.h"
#include "rasterizer/gbuffer_pass.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/light_volume_pass.h"
#include "rasterizer/motion_pass.h"
#include "rasterizer/one_pass_gbuffer.h"
#include "rasterizer/probe_pass.h"
#include "rasterizer/radiosity.h"
#include "rasterizer/reflections.h"
#include "rasterizer/shadow_pass.h"
#include "rasterizer/temporal_antialias.h"
#include "rasterizer/truth_pass.h"

namespace plumb {
namespace {

void require(bool condition, const Method& method, const std::string& problem) {
    if (!condition) throw MethodError(fmt::format("method '{}': {}", method.name, problem));
}

}  // namespace

void validate(const Method& method) {
    const GBufferSettings& gbuffer = method.gbuffer;
    require(gbuffer.layers >= 1 && gbuffer.layers <= most_layers, method,
            fmt::format("gbuffer.layers is {}; it can be 1 to {}", gbuffer.layers, most_layers));
    require(
        gbuffer.generation == LayerGeneration::peel || gbuffer.source == SourceOfStage::truth || gbuffer.layers == 2,
        method,
        fmt::format("gbuffer.generation is \"{}\", which draws 2 layers, and gbuffer.layers is {}; set it to 2, or "
                    "gbuffer.generation to \"peel\"",
                    to_string(gbuffer.generation), gbuffer.layers));
    require(gbuffer.minimum_separation >= 0.0f && std::isfinite(gbuffer.minimum_separation), method,
            fmt::format("gbuffer.minimum_separation is {}; it must be zero or more", gbuffer.minimum_separation));
    require(gbuffer.separation_unit == SeparationUnit::metres || gbuffer.minimum_separation < 1.0f, method,
            fmt::format("gbuffer.minimum_separation is {} of the frustum; it must be less than the whole of it (or set "
                        "gbuffer.separation_unit to \"metres\")",
                        gbuffer.minimum_separation));
    require(gbuffer.guard_band >= 0 && gbuffer.guard_band <= 4096, method,
            fmt::format("gbuffer.guard_band is {}; it must lie between 0 and 4096 pixels", gbuffer.guard_band));
    const bool any_truth = gbuffer.source == SourceOfStage::truth || method.direct.source == SourceOfStage::truth;
    const ShadowSettings& shadow = method.direct.shadow;
    for (const auto& [name, value] :
         {std::pair{"cube_size", shadow.cube_size}, std::pair{"map_size", shadow.map_size},
          std::pair{"emitter_size", shadow.emitter_size}, std::pair{"paraboloid_size", shadow.paraboloid_size}}) {
        require(value >= 16 && value <= 16384, method,
                fmt::format("direct.shadow.{} is {}; it must lie between 16 and 16384 texels", name, value));
    }
    require(shadow.emitter_samples >= 1 && shadow.emitter_samples <= 256, method,
            fmt::format("direct.shadow.emitter_samples is {}; it must lie between 1 and 256", shadow.emitter_samples));
    require(shadow.paraboloid_tessellation >= 1 && shadow.paraboloid_tessellation <= 64, method,
            fmt::format("direct.shadow.paraboloid_tessellation is {}; it must lie between 1 and 64",
                        shadow.paraboloid_tessellation));
    require(shadow.pcf_radius >= 0 && shadow.pcf_radius <= 16, method,
            fmt::format("direct.shadow.pcf_radius is {}; it must lie between 0 and 16 texels", shadow.pcf_radius));
    require(
        method.direct.volume_threshold > 0.0f && std::isfinite(method.direct.volume_threshold), method,
        fmt::format("direct.volume_threshold is {}; it must be more than zero W/m^2, as light never falls to nothing",
                    method.direct.volume_threshold));
    require(!(method.radiosity.enabled && method.radiosity.emitters_shine &&
              (method.direct.emitters || method.direct.source == SourceOfStage::truth)),
            method,
            "radiosity.emitters_shine would count the light of emissive surfaces a second time beside `direct`; set "
            "direct.emitters to false (and direct.source to \"method\"), or leave emitters_shine off");
    require(method.environment.samples >= 1 && method.environment.samples <= 65536, method,
            fmt::format("environment.samples is {}; it must lie between 1 and 65536", method.environment.samples));
    require(shadow.bias >= 0.0f && std::isfinite(shadow.bias), method,
            fmt::format("direct.shadow.bias is {}; it must be zero or more metres", shadow.bias));
    const AntialiasSettings& antialias = method.antialias;
    require(antialias.jitter_length >= 1 && antialias.alpha >= 0.0f && antialias.alpha < 1.0f, method,
            fmt::format("antialias.jitter_length is {} and antialias.alpha is {}; the first must be at least 1, the "
                        "second not negative and less than 1, else nothing new comes in",
                        antialias.jitter_length, antialias.alpha));
    require(!(any_truth && antialias.temporal), method,
            "antialias.temporal moves the view by parts of a pixel, and planes from the truth do not follow; set it to "
            "false, or gbuffer.source and direct.source to \"method\"");
    require(!(any_truth && gbuffer.guard_band > 0), method,
            "planes from the truth have no guard band; set gbuffer.guard_band to 0");
}

std::vector<PassDeclaration> declare_passes(const Scene& scene, const Method& method, const Quantities& quantities) {
    validate(method);
    const LightSet lights(scene, method.direct);
    std::vector<PassDeclaration> passes;
    const auto add_all = [&](std::vector<PassDeclaration> more) {
        for (PassDeclaration& pass : more) passes.push_back(std::move(pass));
    };
    passes.push_back(declare_true_gbuffer(scene, method));
    passes.push_back(declare_gbuffer(scene, method));
    for (int layer = 1; layer < most_layers; ++layer) passes.push_back(declare_peeled_layer(method, layer));
    for (int layer = 0; layer < most_layers; ++layer) passes.push_back(declare_motion(scene, layer));
    add_all(declare_depth_mip_chain());
    add_all(declare_depth_keys());
    add_all(declare_ambient_obscurance(method, quantities));
    passes.push_back(declare_ambient_obscurance_over_time(scene, method));
    passes.push_back(declare_shadows(lights, method));
    passes.push_back(declare_light_volumes(scene, lights, method, 0));
    passes.push_back(declare_light_volumes(scene, lights, method, 1));
    passes.push_back(declare_environment_maps(scene, method));
    passes.push_back(declare_probe(scene, lights, method));
    passes.push_back(declare_true_direct(method));
    passes.push_back(declare_direct_light(scene, lights, method, 0));
    passes.push_back(declare_direct_light(scene, lights, method, 1));
    add_all(declare_radiosity(scene, method));
    add_all(declare_reflections(scene, lights, method, quantities));
    passes.push_back(declare_composite(scene, method));
    passes.push_back(declare_temporal_antialias(scene, method));
    return passes;
}

}  // namespace plumb
