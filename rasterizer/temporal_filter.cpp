#include "rasterizer/temporal_filter.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

constexpr GLuint history_instance_unit = 5;

const TemporalFilterSettings& checked(const TemporalFilterRequest& request) {
    const TemporalFilterSettings& settings = request.settings;
    if (!(settings.alpha > 0.0f && settings.alpha < 1.0f)) {
        throw MethodError(fmt::format(
            "{0}.alpha is {1}; it must be less than 1, else nothing new comes in, and not negative (0: no filter)",
            request.group, settings.alpha));
    }
    if (!(settings.reject_from >= 0.0f && settings.reject_to >= settings.reject_from &&
          std::isfinite(settings.reject_to))) {
        throw MethodError(
            fmt::format("{0}.reject_from is {1} and {0}.reject_to is {2} metres; neither may be negative, "
                        "and the second not less than the first",
                        request.group, settings.reject_from, settings.reject_to));
    }
    if (settings.layers < 1 || settings.layers > 2) {
        throw MethodError(fmt::format("{}.layers is {}; use 1 or 2", request.group, settings.layers));
    }
    return settings;
}

bool reads_normals(const TemporalFilterSettings& settings) { return settings.rejection == HistoryRejection::plane; }

// Which nobody reads once the filter has run.
std::string filtered_before(const TemporalFilterRequest& request) { return request.output + ".previous"; }

bool writes_weight(const PassResources& resources, const TemporalFilterRequest& request) {
    return resources.is_read(layer_prefix(request.layer) + request.weight);
}

const GlTexture& create_output(const PassResources& resources, const TemporalFilterRequest& request) {
    PlaneTextures& planes = resources.planes;
    // Whichever layer's pass is made first allocates for both.
    const auto create = [&](const std::string& name, GLenum format) -> const GlTexture& {
        return planes.has(name) ? planes.get(name) : planes.create(name, format, resources.layers_of(name));
    };
    const GlTexture& output = create(request.output, planes.get(request.input).format());
    if (!planes.history_of(request.output)) planes.create_history(request.output, filtered_before(request));
    if (writes_weight(resources, request)) create(request.weight, GL_R32F);
    return output;
}

ShaderDefines defines(const PassResources& resources, const TemporalFilterRequest& request,
                      const Reprojection& reprojection, const InnerArea& area) {
    const TemporalFilterSettings& settings = checked(request);
    ShaderDefines result = reprojection.defines();
    result.emplace_back("ALPHA", shader_literal(settings.alpha));
    result.emplace_back("FROM_PLANE", settings.rejection == HistoryRejection::plane ? "1" : "0");
    result.emplace_back("REJECT_FROM", shader_literal(settings.reject_from));
    result.emplace_back("REJECT_TO", shader_literal(settings.reject_to));
    result.emplace_back("HARD_CUT", settings.reject_from == settings.reject_to ? "1" : "0");
    result.emplace_back("LAYER", std::to_string(request.layer));
    result.emplace_back("LAYERS", std::to_string(settings.layers));
    result.emplace_back("MARGIN", std::to_string(area.corner().x));
    if (writes_weight(resources, request)) result.emplace_back("WRITE_WEIGHT", "1");
    return result;
}

GlFramebuffer make_target(const PassResources& resources, const TemporalFilterRequest& request) {
    std::vector<GlAttachment> attachments{{&resources.planes.get(request.output), request.layer}};
    if (writes_weight(resources, request))
        attachments.push_back({&resources.planes.get(request.weight), request.layer});
    return GlFramebuffer(resources.context, attachments, {}, request.name.c_str());
}

}  // namespace

TemporalFilterPass::TemporalFilterPass(const PassResources& resources, const TemporalFilterRequest& request)
    : noisy_(resources.planes.get(request.input)),
      depth_(resources.planes.get("depth")),
      normal_(reads_normals(request.settings) ? &resources.planes.get("normal") : nullptr),
      previous_depth_(resources.planes.get(gbuffer_history)),
      is_first_(!resources.planes.has(request.output)),
      reprojection_(resources, history_instance_unit),
      area_(resources, {0, 0}, request.read_beyond),
      output_(create_output(resources, request)),
      history_(*resources.planes.history_of(request.output)),
      draw_(resources.context, resources.programs, "temporal_filter.frag",
            defines(resources, request, reprojection_, area_)),
      target_(make_target(resources, request)) {}

void TemporalFilterPass::execute(const PassFrame& frame) {
    if (is_first_) history_.trade_places();
    noisy_.bind(0);
    depth_.bind(1);
    if (normal_) normal_->bind(2);
    previous_depth_.bind(3);
    history_.before().bind(4);
    reprojection_.bind();
    draw_.program().set("has_history", frame.continues ? 1 : 0);
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

std::string_view to_string(HistoryRejection rejection) {
    return rejection == HistoryRejection::plane ? "plane" : "mara2016";
}

bool taps_vary(const TemporalFilterSettings& settings) { return settings.alpha > 0.0f && settings.vary_taps; }

PassDeclaration declare_temporal_filter(const Scene& scene, const TemporalFilterRequest& request) {
    if (request.settings.alpha != 0.0f) checked(request);
    const std::string prefix = layer_prefix(request.layer);
    PassDeclaration pass{.name = request.name,
                         .inputs = {prefix + request.input, prefix + "depth"},
                         .outputs = {prefix + request.output},
                         .create =
                             [request](const PassResources& resources) {
                                 return std::make_unique<TemporalFilterPass>(resources, request);
                             },
                         .kept = {request.output},
                         .scratch = {filtered_before(request)}};
    if (reads_normals(request.settings)) pass.inputs.push_back(prefix + "normal");
    // The second layer's own, or both.
    for (int layer = 0; layer < 2; ++layer) {
        if (layer == request.layer || request.settings.layers == 2)
            pass.inputs.push_back(layer_prefix(layer) + std::string(gbuffer_history));
    }
    for (std::string& plane : Reprojection::inputs(scene, request.layer)) pass.inputs.push_back(std::move(plane));
    if (!request.weight.empty()) pass.outputs.push_back(prefix + request.weight);
    if (request.settings.alpha == 0.0f) pass.disabled = fmt::format("{}.alpha is 0", request.group);
    pass.remark = fmt::format("alpha {}, {} layer{} of the frame before, distance from the {}", request.settings.alpha,
                              request.settings.layers, request.settings.layers == 1 ? "" : "s",
                              reads_normals(request.settings) ? "plane" : "point");
    return pass;
}

}  // namespace plumb
