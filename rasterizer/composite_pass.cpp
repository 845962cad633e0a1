#include "rasterizer/composite_pass.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/temporal_antialias.h"

namespace plumb {
namespace {

// A plane that is read, and what tells the shader of it.
struct Term {
    const char* plane;
    const char* define;
};
constexpr std::array<Term, 9> terms = {{{"direct", "DIRECT"},
                                        {"emission", "EMISSION"},
                                        {"indirect", "INDIRECT"},
                                        {"reflection", "REFLECTION"},
                                        {"ao", "VISIBILITY"},
                                        {"confidence", "CONFIDENCE"},
                                        {"depth", "DEPTH"},
                                        {"normal", "NORMAL"},
                                        {"albedo", "ALBEDO"}}};
constexpr std::size_t light_terms = 4;  // the first of them are radiance that is added
constexpr GLuint composite_ambient_unit = terms.size();

// What ambient light is reflected by is what direct and indirect light are reflected by.
std::string plane_of(const Term& term, const Scene& scene, const Method& method) {
    return term.plane == std::string_view("albedo") ? diffuse_albedo_plane(scene, method) : term.plane;
}

bool is_demo(const Method& method) { return method.composite.kind == CompositeKind::demo; }

bool is_read(std::string_view plane, const Scene& scene, const Method& method) {
    if (plane == "direct") return true;
    if (plane == "emission") return scene.has_emissive_surfaces() || !scene.environment.is_black();
    if (plane == "indirect") return method.radiosity.enabled;
    if (plane == "reflection") return method.reflections.enabled;
    if (plane == "ao") return is_demo(method);
    if (plane == "confidence") return is_demo(method) && method.radiosity.enabled;
    return is_demo(method) && method.composite.fill != AmbientSource::none;
}

ShaderDefines defines(const Scene& scene, const Method& method, const AmbientLight& ambient) {
    ShaderDefines result;
    for (std::size_t unit = 0; unit < terms.size(); ++unit) {
        if (is_read(terms[unit].plane, scene, method)) result.emplace_back(terms[unit].define, std::to_string(unit));
    }
    if (is_demo(method)) result.emplace_back("DEMO", "1");
    for (auto& define : ambient.defines()) result.push_back(std::move(define));
    return result;
}

AmbientSource ambient_source(const Method& method) {
    return is_demo(method) ? method.composite.fill : AmbientSource::none;
}

void require_sound_composite(const Method& method) {
    if (!is_demo(method)) return;
    const auto require = [&](bool condition, const std::string& problem) {
        if (!condition)
            throw MethodError(fmt::format("method '{}': composite.kind is \"demo\", {}", method.name, problem));
    };
    require(method.ao.enabled,
            "which weighs its terms by ambient visibility; set ao.enabled to true, or composite.kind to \"physical\"");
    require(method.radiosity.enabled || method.composite.fill != AmbientSource::none,
            "but without radiosity and ambient light there is nothing to weigh; set radiosity.enabled to true, or "
            "composite.fill to \"ambient\", \"environment\" or \"probe\"");
    require(!method.radiosity.enabled || method.radiosity.fill == AmbientSource::none,
            "which fills low confidence by itself; set composite.fill to what radiosity.fill is, and that to \"none\"");
    require(
        method.composite.ambient >= 0.0f && std::isfinite(method.composite.ambient),
        fmt::format("and composite.ambient is {}; use a finite radiance of zero or more", method.composite.ambient));
}

}  // namespace

CompositePass::CompositePass(const PassResources& resources)
    : ambient_(resources, ambient_source(resources.method), resources.method.composite.ambient, composite_ambient_unit),
      draw_(resources.context, resources.programs, "composite.frag",
            defines(resources.scene, resources.method, ambient_)) {
    for (const Term& term : terms) {
        const bool read = is_read(term.plane, resources.scene, resources.method);
        planes_.push_back(read ? &resources.planes.get(plane_of(term, resources.scene, resources.method)) : nullptr);
    }
    const GLenum format = resources.method.reflections.enabled ? GL_RGBA32F : emission_format(resources.scene);
    const GlTexture& total = resources.planes.create(composited_plane(resources.method), format, 1);
    target_ = GlFramebuffer(resources.context, std::array{GlAttachment{&total}}, {}, "composite");
}

void CompositePass::execute(const PassFrame&) {
    for (std::size_t unit = 0; unit < planes_.size(); ++unit) {
        if (planes_[unit]) planes_[unit]->bind(static_cast<GLuint>(unit));
    }
    ambient_.bind();
    draw_.draw(target_);
}

PassDeclaration declare_composite(const Scene& scene, const Method& method) {
    require_sound_composite(method);
    PassDeclaration pass;
    pass.name = "composite";
    for (std::size_t unit = 0; unit < terms.size(); ++unit) {
        const Term& term = terms[unit];
        if (!is_read(term.plane, scene, method)) continue;
        if (unit < light_terms) pass.remark += pass.inputs.empty() ? term.plane : fmt::format(" + {}", term.plane);
        pass.inputs.push_back(plane_of(term, scene, method));
    }
    if (is_demo(method))
        pass.remark += fmt::format(", as the demo weighs them, ambient light: {}", to_string(ambient_source(method)));
    for (std::string& plane : AmbientLight::inputs(ambient_source(method))) pass.inputs.push_back(std::move(plane));
    pass.outputs = {composited_plane(method)};
    pass.parameters = {{"composite."}};
    pass.create = [](const PassResources& resources) { return std::make_unique<CompositePass>(resources); };
    return pass;
}

}  // namespace plumb
