#include "rasterizer/radiosity_sum.h"

#include <array>

#include <fmt/format.h>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/radiosity_planes.h"
#include "rasterizer/radiosity_reflection.h"

namespace plumb {
namespace {

// Texture units of radiosity_sum.frag; the bounces take those before.
struct SumUnits {
    enum : GLuint { albedo = most_bounces, depth, normal, fill };
};

struct Output {
    const char* plane;
    const char* define;  // in radiosity_sum.frag
    GLenum format;
};
constexpr std::array<Output, 3> outputs = {{{"irradiance", "IRRADIANCE", GL_RGBA32F},
                                            {"confidence", "CONFIDENCE", GL_R32F},
                                            {"indirect", "INDIRECT", GL_RGBA32F}}};

// Allocates the outputs that are read and notes their locations.
GlFramebuffer make_target(const PassResources& resources, ShaderDefines& locations) {
    std::vector<GlAttachment> attachments;
    for (const Output& output : outputs) {
        if (!resources.is_read(output.plane)) continue;
        locations.emplace_back(output.define, std::to_string(attachments.size()));
        attachments.push_back({&resources.planes.create(output.plane, output.format, 1), 0, 0});
    }
    return GlFramebuffer(resources.context, attachments, {}, "radiosity sum");
}

bool fills(const Method& method) { return method.radiosity.fill != AmbientSource::none; }

}  // namespace

RadiositySumPass::RadiositySumPass(const PassResources& resources)
    : albedo_(resources.planes.get(diffuse_albedo_plane(resources.scene, resources.method))),
      fill_(resources, resources.method.radiosity.fill, resources.method.radiosity.ambient, SumUnits::fill),
      target_(make_target(resources, locations_)),
      draw_(resources.context, resources.programs, "radiosity_sum.frag", defines(resources)),
      area_(resources, {0, 0}) {
    for (int bounce = 1; bounce <= resources.method.radiosity.bounces; ++bounce)
        gathered_.push_back(&resources.planes.get(radiosity_plane(bounce)));
    if (!fills(resources.method)) return;
    depth_ = &resources.planes.get("depth");
    normal_ = &resources.planes.get("normal");
}

ShaderDefines RadiositySumPass::defines(const PassResources& resources) const {
    const RadiositySettings& settings = resources.method.radiosity;
    ShaderDefines result = locations_;
    result.emplace_back("BOUNCES", std::to_string(settings.bounces));
    for (auto& define : boost_defines(settings)) result.push_back(std::move(define));
    if (fills(resources.method)) result.emplace_back("FILL", "1");
    for (auto& define : fill_.defines()) result.push_back(std::move(define));
    return result;
}

void RadiositySumPass::execute(const PassFrame&) {
    for (std::size_t i = 0; i < gathered_.size(); ++i) gathered_[i]->bind(static_cast<GLuint>(i));
    albedo_.bind(SumUnits::albedo);
    if (depth_) depth_->bind(SumUnits::depth), normal_->bind(SumUnits::normal);
    fill_.bind();
    const InnerArea::Restriction restriction(area_);
    draw_.draw(target_);
}

PassDeclaration declare_radiosity_sum(const Scene& scene, const Method& method) {
    const RadiositySettings& settings = method.radiosity;
    PassDeclaration pass;
    pass.name = "radiosity reflection";
    for (int bounce = 1; bounce <= settings.bounces; ++bounce) pass.inputs.push_back(radiosity_plane(bounce));
    pass.inputs.push_back(diffuse_albedo_plane(scene, method));
    if (fills(method)) {
        for (const char* plane : {"depth", "normal"}) pass.inputs.emplace_back(plane);
        for (std::string& plane : AmbientLight::inputs(settings.fill)) pass.inputs.push_back(std::move(plane));
    }
    for (const Output& output : outputs) pass.outputs.emplace_back(output.plane);
    pass.parameters = {{"radiosity.bounces", {"irradiance", "indirect"}},
                       {"radiosity.saturated_boost", {"indirect"}},
                       {"radiosity.unsaturated_boost", {"indirect"}},
                       {"radiosity.fill", {"irradiance", "indirect"}},
                       {"radiosity.ambient", {"irradiance", "indirect"}}};
    pass.create = [](const PassResources& resources) { return std::make_unique<RadiositySumPass>(resources); };
    pass.remark = fmt::format("{} bounce{}{}", settings.bounces, settings.bounces == 1 ? "" : "s",
                              fills(method) ? fmt::format(", filled from: {}", to_string(settings.fill)) : "");
    return pass;
}

}  // namespace plumb
