#include "rasterizer/temporal_antialias.h"

#include <array>

#include <fmt/format.h>

namespace plumb {
namespace {

constexpr GLuint antialias_instance_unit = 3;
constexpr const char* resolved_plane = "total";
constexpr const char* resolved_before = "total.previous";  // which nobody reads once the pass has run

// The digits of `index` in `base`, mirrored about the point.
double radical_inverse(int index, int base) {
    double result = 0.0, place = 1.0;
    for (; index > 0; index /= base) {
        place /= base;
        result += place * (index % base);
    }
    return result;
}

const GlTexture& create_resolved(PlaneTextures& planes) {
    // Whole floats: in half ones a small share of a new colour is rounded away.
    const GlTexture& resolved = planes.create(resolved_plane, GL_RGBA32F, 1);
    planes.create_history(resolved_plane, resolved_before);
    return resolved;
}

ShaderDefines defines(const AntialiasSettings& settings, const std::optional<Reprojection>& reprojection,
                      const InnerArea& area) {
    ShaderDefines result = reprojection ? reprojection->defines() : ShaderDefines();
    result.emplace_back("REPROJECT", reprojection ? "1" : "0");
    result.emplace_back("LEAST_WEIGHT", shader_literal(1.0f - settings.alpha));
    result.emplace_back("CLAMP_HISTORY", settings.clamp ? "1" : "0");
    result.emplace_back("DILATE", reprojection && settings.dilate ? "1" : "0");
    result.emplace_back("CATMULL_ROM", settings.lookup == HistoryLookup::catmull_rom ? "1" : "0");
    result.emplace_back("MARGIN", std::to_string(area.corner().x));
    return result;
}

std::optional<Reprojection> make_reprojection(const PassResources& resources) {
    if (!resources.method.antialias.reprojection) return std::nullopt;
    return Reprojection(resources, antialias_instance_unit);
}

}  // namespace

std::vector<glm::vec2> jitter_offsets(const AntialiasSettings& settings) {
    // From index 1: point 0 of every base lies in the corner.
    const auto point = [](int i) { return glm::dvec2(radical_inverse(i + 1, 2), radical_inverse(i + 1, 3)); };
    glm::dvec2 mean(0.0);
    for (int i = 0; i < settings.jitter_length; ++i) mean += point(i) / static_cast<double>(settings.jitter_length);
    std::vector<glm::vec2> offsets;
    offsets.reserve(static_cast<std::size_t>(settings.jitter_length));
    for (int i = 0; i < settings.jitter_length; ++i) offsets.emplace_back(point(i) - mean);
    return offsets;
}

std::string composited_plane(const Method& method) {
    return method.antialias.temporal ? std::string(aliased_plane) : resolved_plane;
}

TemporalAntialiasPass::TemporalAntialiasPass(const PassResources& resources)
    : aliased_(resources.planes.get(aliased_plane)),
      depth_(resources.method.antialias.reprojection ? &resources.planes.get("depth") : nullptr),
      reprojection_(make_reprojection(resources)),
      area_(resources, {0, 0}),
      resolved_(create_resolved(resources.planes)),
      history_(*resources.planes.history_of(resolved_plane)),
      draw_(resources.context, resources.programs, "temporal_antialias.frag",
            defines(resources.method.antialias, reprojection_, area_)),
      target_(resources.context, std::array{GlAttachment{&resolved_}}, {}, "temporal antialias") {}

void TemporalAntialiasPass::execute(const PassFrame& frame) {
    history_.trade_places();
    aliased_.bind(0);
    if (depth_) depth_->bind(1);
    history_.before().bind(2);
    if (reprojection_) reprojection_->bind();
    draw_.program().set("has_history", frame.continues ? 1 : 0);
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

PassDeclaration declare_temporal_antialias(const Scene& scene, const Method& method) {
    PassDeclaration pass;
    pass.name = "temporal antialias";
    pass.inputs = {std::string(aliased_plane)};
    if (method.antialias.reprojection) {
        pass.inputs.emplace_back("depth");
        for (std::string& plane : Reprojection::inputs(scene, 0)) pass.inputs.push_back(std::move(plane));
    }
    pass.outputs = {resolved_plane};
    pass.parameters = {{"antialias."}};
    pass.kept = pass.outputs;
    pass.scratch = {resolved_before};
    pass.create = [](const PassResources& resources) { return std::make_unique<TemporalAntialiasPass>(resources); };
    if (!method.antialias.temporal) pass.disabled = "antialias.temporal is false";
    pass.remark = fmt::format("{} offsets, alpha {}{}", method.antialias.jitter_length, method.antialias.alpha,
                              method.antialias.reprojection ? "" : ", not reprojected");
    return pass;
}

}  // namespace plumb
