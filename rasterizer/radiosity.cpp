#include "rasterizer/radiosity.h"

#include <cmath>

#include <fmt/format.h>

#include "rasterizer/bilateral_blur.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/radiosity_carry.h"
#include "rasterizer/radiosity_gather.h"
#include "rasterizer/radiosity_planes.h"
#include "rasterizer/radiosity_reflection.h"
#include "rasterizer/radiosity_sum.h"
#include "rasterizer/temporal_filter.h"

namespace plumb {
namespace {

void require_sound_radiosity(const Method& method) {
    const RadiositySettings& settings = method.radiosity;
    const auto require = [&](bool condition, const std::string& problem) {
        if (!condition) throw MethodError(fmt::format("method '{}': {}", method.name, problem));
    };
    require(settings.bounces >= 1 && settings.bounces <= most_bounces,
            fmt::format("radiosity.bounces is {}; it can be 1 to {}", settings.bounces, most_bounces));
    require(!settings.carry || settings.bounces == 1,
            fmt::format("radiosity.carry makes one bounce a frame and keeps all bounces in one sum, but "
                        "radiosity.bounces is {}; set it to 1, or radiosity.carry to false",
                        settings.bounces));
    for (const auto& [name, boost] : {std::pair{"saturated_boost", settings.saturated_boost},
                                      std::pair{"unsaturated_boost", settings.unsaturated_boost}}) {
        require(
            boost >= 0.0f && std::isfinite(boost),
            fmt::format("radiosity.{} is {}; use a finite factor of zero or more (1 conserves energy)", name, boost));
    }
    require(settings.ambient >= 0.0f && std::isfinite(settings.ambient),
            fmt::format("radiosity.ambient is {}; use a finite radiance of zero or more", settings.ambient));
}

constexpr const char* carried_bounces =
    "method.radiosity.carry is true, which holds all bounces in one sum; ask for 'indirect', or set radiosity.carry to "
    "false and radiosity.bounces to the number wanted";

// Nobody makes the planes of bounces beyond the last; asking for one shall tell why.
PassDeclaration declare_missing_bounces(const RadiositySettings& settings) {
    PassDeclaration pass;
    pass.name = "further bounces";
    for (int bounce = settings.bounces + 1; bounce <= most_bounces; ++bounce)
        pass.outputs.push_back(indirect_plane(bounce));
    pass.disabled = fmt::format("method.radiosity.bounces is {}", settings.bounces);
    if (settings.carry) pass.disabled = carried_bounces;
    return pass;
}

void declare_gathering(std::vector<PassDeclaration>& passes, const Scene& scene, const Method& method, int bounce,
                       int layer) {
    const RadiositySettings& settings = method.radiosity;
    passes.push_back(declare_radiosity_gather(scene, method, bounce, layer));
    const std::string name = passes.back().name;
    if (settings.blur.radius > 0) {
        passes.push_back(declare_bilateral_blur({.name = name + " blur",
                                                 .settings = settings.blur,
                                                 .quantity_radius = settings.radius,
                                                 .input = gathered_plane(settings, bounce),
                                                 .output = blurred_plane(settings, bounce),
                                                 .layer = layer,
                                                 .read_beyond = plane_of_later_bounces(settings, bounce),
                                                 .stored_positions = stores_positions(method)}));
    }
    passes.push_back(declare_temporal_filter(scene, {.name = name + " over time",
                                                     .group = "radiosity.temporal",
                                                     .settings = settings.temporal,
                                                     .input = blurred_plane(settings, bounce),
                                                     .output = radiosity_plane(bounce),
                                                     .layer = layer,
                                                     .weight = bounce == 1 ? "radiosity.history_weight" : "",
                                                     .read_beyond = plane_of_later_bounces(settings, bounce)}));
}

void declare_reflections(std::vector<PassDeclaration>& passes, const Scene& scene, const Method& method, int bounce) {
    const RadiositySettings& settings = method.radiosity;
    const int layers = bounce < settings.bounces ? sending_layers(settings, bounce + 1) : 1;
    for (int layer = 0; layer < layers; ++layer) {
        passes.push_back(declare_radiosity_reflection(scene, method, bounce, layer));
        if (settings.carry) passes.back().disabled = carried_bounces;
    }
}

}  // namespace

std::vector<PassDeclaration> declare_radiosity(const Scene& scene, const Method& method) {
    const RadiositySettings& settings = method.radiosity;
    if (settings.enabled) require_sound_radiosity(method);
    std::vector<PassDeclaration> passes;
    if (settings.carry) passes.push_back(declare_radiosity_carry(scene, method));
    for (int bounce = 1; bounce <= settings.bounces; ++bounce) {
        for (PassDeclaration& pass : declare_gathered_chains(settings, bounce)) passes.push_back(std::move(pass));
        // The second layer first: what only the next frame reads of it is made with what is read of the first one.
        for (int layer = receiving_layers(settings, bounce) - 1; layer >= 0; --layer)
            declare_gathering(passes, scene, method, bounce, layer);
        declare_reflections(passes, scene, method, bounce);
    }
    if (settings.bounces < most_bounces) passes.push_back(declare_missing_bounces(settings));
    passes.push_back(declare_radiosity_sum(scene, method));
    if (!settings.enabled) {
        for (PassDeclaration& pass : passes) pass.disabled = "method.radiosity.enabled is false";
    }
    return passes;
}

}  // namespace plumb
