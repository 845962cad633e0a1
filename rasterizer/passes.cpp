#include "rasterizer/passes.h"

#include <cmath>

#include <fmt/format.h>

#include "rasterizer/gbuffer_pass.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/motion_pass.h"
#include "rasterizer/truth_pass.h"

namespace plumb {
namespace {

void require(bool condition, const Method& method, const std::string& problem) {
    if (!condition) throw MethodError(fmt::format("method '{}': {}", method.name, problem));
}

}  // namespace

void validate(const Method& method) {
    const GBufferSettings& gbuffer = method.gbuffer;
    require(gbuffer.layers == 1 || gbuffer.layers == 2, method,
            fmt::format("gbuffer.layers is {}; it can be 1 or 2", gbuffer.layers));
    require(
        gbuffer.minimum_separation >= 0.0f && std::isfinite(gbuffer.minimum_separation), method,
        fmt::format("gbuffer.minimum_separation is {}; it must be zero or more metres", gbuffer.minimum_separation));
    require(gbuffer.guard_band >= 0 && gbuffer.guard_band <= 4096, method,
            fmt::format("gbuffer.guard_band is {}; it must lie between 0 and 4096 pixels", gbuffer.guard_band));
    const bool any_truth = gbuffer.source == SourceOfStage::truth || method.direct.source == SourceOfStage::truth;
    require(!(any_truth && gbuffer.guard_band > 0), method,
            "planes from the truth have no guard band; set gbuffer.guard_band to 0");
}

std::vector<PassDeclaration> declare_passes(const Scene& scene, const Method& method, const Quantities&) {
    validate(method);
    std::vector<PassDeclaration> passes;
    passes.push_back(declare_true_gbuffer(method));
    passes.push_back(declare_gbuffer(scene, method));
    passes.push_back(declare_second_layer(method));
    passes.push_back(declare_motion(0));
    passes.push_back(declare_motion(1));
    return passes;
}

}  // namespace plumb
