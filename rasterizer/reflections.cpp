#include "rasterizer/reflections.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "rasterizer/falloff.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/lamp_highlights_pass.h"
#include "rasterizer/specular_albedo_texture.h"

namespace plumb {
namespace {

// Texture units of reflections.frag besides those of surface_radiance.glsl and stored_position_unit.
struct ReflectionUnits {
    enum : GLuint { depth, normal, specular, chain = 7, roughness, lamps, fallback, specular_albedo };
};

// Rays of one draw: a driver may end a shader that takes too long, and Mesa's software rasterizer ends all loops of a
// fragment after 65536 turns in total (two layers are two more turns each step).
int rays_per_draw(const ReflectionSettings& settings) {
    constexpr int steps_per_draw = 16384;
    return settings.roughness == ReflectionRoughness::samples ? std::max(1, steps_per_draw / settings.max_steps) : 1;
}

// Shaders have no infinity to compare with.
constexpr float longest_ray = 1e30f;

bool has_lamps(const LightSet& lights, const Method& method) {
    return method.reflections.lamps && !(lights.points.empty() && lights.spots.empty() && lights.directionals.empty());
}

bool is_limited(const Quantities& quantities) { return std::isfinite(quantities.reflection_radius); }

// The plane that answers where rays find nothing; empty: none.
std::string fallback_plane(const Method& method) {
    switch (method.reflections.fallback) {
        case ReflectionFallback::none:
            return "";
        case ReflectionFallback::environment:
            return "environment.prefiltered";
        case ReflectionFallback::probe:
            return "probe.prefiltered";
    }
    return "";
}

void require(bool condition, const std::string& problem) {
    if (!condition) throw MethodError(problem);
}

void require_sound(const ReflectionSettings& settings, const Quantities& quantities) {
    require(settings.layers == 1 || settings.layers == 2,
            fmt::format("reflections.layers is {}; use 1 or 2", settings.layers));
    require(settings.step >= 0.25f && settings.step <= 64.0f && settings.first_step >= 0.25f &&
                settings.first_step <= 64.0f,
            fmt::format("reflections.step is {} and reflections.first_step {}; use 0.25 to 64 pixels", settings.step,
                        settings.first_step));
    require(settings.max_steps >= 1 && settings.max_steps <= 16384,
            fmt::format("reflections.max_steps is {}; use 1 to 16384", settings.max_steps));
    require(settings.refinement_steps >= 0 && settings.refinement_steps <= 16,
            fmt::format("reflections.refinement_steps is {}; use 0 to 16", settings.refinement_steps));
    require(settings.samples >= 1 && settings.samples <= 4096,
            fmt::format("reflections.samples is {}; use 1 to 4096", settings.samples));
    require(settings.thickness >= 0.0f && std::isfinite(settings.thickness),
            fmt::format("reflections.thickness is {}; use a finite length in metres, 0 for the G-buffer's minimum "
                        "separation",
                        settings.thickness));
    require(settings.bias >= 0.0f && std::isfinite(settings.bias),
            fmt::format("reflections.bias is {}; use zero or more metres", settings.bias));
    require(settings.border_fade >= 0,
            fmt::format("reflections.border_fade is {}; use zero or more pixels", settings.border_fade));
    require(settings.max_distance > 0.0f,
            fmt::format("reflections.max_distance is {}; use more than zero metres", settings.max_distance));
    require(quantities.reflection_radius > 0.0f,
            fmt::format("the quantity's reflection_radius is {}; it must be more than zero metres",
                        quantities.reflection_radius));
    require(settings.fallback == ReflectionFallback::none || !is_limited(quantities),
            fmt::format("reflections.fallback is \"{}\", and the quantity's reflection_radius {} metres, beyond which "
                        "nothing counts; set the one to \"none\" or the other to infinity",
                        to_string(settings.fallback), quantities.reflection_radius));
}

ShaderDefines shader_defines(const PassResources& resources, bool lamps, bool fallback) {
    const ReflectionSettings& settings = resources.method.reflections;
    const Quantities& quantities = resources.quantities;
    require_sound(settings, quantities);
    constexpr std::array roughness_names{"MIRROR", "MIP", "SAMPLED"};
    ShaderDefines defines;
    for (std::size_t i = 0; i < roughness_names.size(); ++i)
        defines.emplace_back(roughness_names[i], std::to_string(i));
    const float longest = std::min({settings.max_distance, quantities.reflection_radius, longest_ray});
    const ShaderDefines chosen = {
        {"ROUGHNESS", roughness_names.at(static_cast<std::size_t>(settings.roughness))},
        {"SAMPLES", std::to_string(settings.samples)},
        {"RAYS_PER_DRAW", std::to_string(rays_per_draw(settings))},
        {"LAYERS", std::to_string(settings.layers)},
        {"STEP", shader_literal(settings.step)},
        {"FIRST_STEP", shader_literal(settings.first_step)},
        {"MAX_STEPS", std::to_string(settings.max_steps)},
        {"REFINEMENT_STEPS", std::to_string(settings.refinement_steps)},
        {"HIT_IN_FRONT", settings.hit == ReflectionHit::mara2016 ? "1" : "0"},
        {"HIT_ACROSS", settings.hit == ReflectionHit::crossed ? "1" : "0"},
        {"BIAS", shader_literal(settings.bias)},
        {"TEST_HIT_NORMAL", settings.test_hit_normal ? "1" : "0"},
        {"MAX_DISTANCE", shader_literal(longest)},
        {"BORDER_FADE", std::to_string(settings.border_fade)},
        {"LAMPS", lamps ? "1" : "0"},
        {"FALLBACK", fallback ? "1" : "0"},
        {"COARSEST_RADIANCE_LEVEL",
         std::to_string(coarsest_radiance_level(resources.planes.width(), resources.planes.height()))}};
    defines.insert(defines.end(), chosen.begin(), chosen.end());
    const auto add = [&](const ShaderDefines& more) { defines.insert(defines.end(), more.begin(), more.end()); };
    add(SurfaceRadiance(resources.scene, resources.method, quantities).defines());
    add(SpecularAlbedoTexture::defines(ReflectionUnits::specular_albedo));
    if (is_limited(quantities)) {
        defines.emplace_back("RADIUS", shader_literal(quantities.reflection_radius));
        add(falloff_defines(quantities.reflection_falloff));
    }
    return defines;
}

const GlTexture* find_read(const PassResources& resources, const std::string& plane) {
    return resources.is_read(plane) ? resources.planes.find(plane) : nullptr;
}

GlFramebuffer make_reflection_target(const PassResources& resources) {
    const GlTexture& reflection = resources.planes.create("reflection", GL_RGBA32F, 1);
    return GlFramebuffer(resources.context, std::array{GlAttachment{&reflection}}, {}, "reflections");
}

// A scene that reflects nothing.
class NoReflectionPass final : public Pass {
public:
    explicit NoReflectionPass(const PassResources& resources) : target_(make_reflection_target(resources)) {}
    void execute(const PassFrame&) override {
        constexpr std::array<float, 4> black{};
        target_.context().gl.ClearNamedFramebufferfv(target_.id(), GL_COLOR, 0, black.data());
    }

private:
    GlFramebuffer target_;
};

}  // namespace

std::string_view to_string(ReflectionRoughness roughness) {
    constexpr std::array<std::string_view, 3> names{"mirror", "mip", "samples"};
    return names.at(static_cast<std::size_t>(roughness));
}

std::string_view to_string(ReflectionFallback fallback) {
    constexpr std::array<std::string_view, 3> names{"none", "environment", "probe"};
    return names.at(static_cast<std::size_t>(fallback));
}

ReflectionPass::ReflectionPass(const PassResources& resources)
    : context_(resources.context),
      gbuffer_(resources.method.gbuffer),
      thickness_(resources.method.reflections.thickness),
      rays_(resources.method.reflections.roughness == ReflectionRoughness::samples
                ? resources.method.reflections.samples
                : 0),
      rays_per_draw_(rays_per_draw(resources.method.reflections)),
      depth_(resources.planes.get("depth")),
      normal_(resources.planes.get("normal")),
      specular_(resources.planes.get("specular")),
      roughness_(resources.planes.get("roughness")),
      position_(stored_positions(resources)),
      chain_(find_read(resources, radiance_chain_plane)),
      lamps_(find_read(resources, lamp_highlights_plane)),
      sources_(resources.planes, SurfaceRadiance(resources.scene, resources.method, resources.quantities)),
      specular_albedo_(specular_albedo_table(resources.context, resources.planes)),
      draw_(resources.context, resources.programs, "reflections.frag",
            shader_defines(resources, lamps_ != nullptr, !fallback_plane(resources.method).empty())),
      target_(make_reflection_target(resources)),
      area_(resources, {0, 0}) {
    const std::string fallback = fallback_plane(resources.method);
    if (!fallback.empty()) fallback_ = &resources.planes.get(fallback);
    const SurfaceRadiance surfaces(resources.scene, resources.method, resources.quantities);
    finds_light_ = chain_ || fallback_ || surfaces.direct || surfaces.emission || surfaces.indirect;
}

void ReflectionPass::execute(const PassFrame& frame) {
    depth_.bind(ReflectionUnits::depth);
    normal_.bind(ReflectionUnits::normal);
    specular_.bind(ReflectionUnits::specular);
    roughness_.bind(ReflectionUnits::roughness);
    if (position_) position_->bind(stored_position_unit);
    if (chain_) chain_->bind(ReflectionUnits::chain);
    if (lamps_) lamps_->bind(ReflectionUnits::lamps);
    if (fallback_) fallback_->bind(ReflectionUnits::fallback);
    sources_.bind();
    specular_albedo_.bind(ReflectionUnits::specular_albedo);
    // A driver finds out that rays are of no use where they can bring nothing.
    if (finds_light_) {
        draw_.program().set("thickness",
                            thickness_ > 0.0f ? thickness_ : separation_in_metres(gbuffer_, frame.view.camera()));
    }
    const InnerArea::Restriction restriction(area_);
    if (rays_ == 0 || !finds_light_) {
        draw_.draw(target_);
        return;
    }
    const GladGLContext& gl = context_.gl;
    for (int first = 0; first < rays_; first += rays_per_draw_) {
        if (first == rays_per_draw_) {
            gl.Enable(GL_BLEND);
            gl.BlendEquation(GL_FUNC_ADD);
            gl.BlendFunc(GL_ONE, GL_ONE);
        }
        draw_.program().set("first_ray", first);
        draw_.draw(target_);
    }
    gl.Disable(GL_BLEND);
}

std::vector<PassDeclaration> declare_reflections(const Scene& scene, const LightSet& lights, const Method& method,
                                                 const Quantities& quantities) {
    const ReflectionSettings& settings = method.reflections;
    PassDeclaration pass;
    pass.name = "reflections";
    pass.outputs = {"reflection"};
    if (!settings.enabled) pass.disabled = "method.reflections.enabled is false";
    if (!has_specular_lobes(scene)) {
        pass.create = [](const PassResources& resources) { return std::make_unique<NoReflectionPass>(resources); };
        pass.remark = "nothing in the scene has a specular lobe";
        return {std::move(pass)};
    }
    for (const char* name :
         {"enabled", "roughness", "samples", "layers", "step", "first_step", "max_steps", "refinement_steps",
          "thickness", "hit", "max_distance", "bias", "test_hit_normal", "border_fade", "fallback"})
        pass.parameters.push_back({fmt::format("reflections.{}", name)});
    pass.parameters.push_back({"gbuffer.guard_band"});
    if (settings.thickness == 0.0f) {
        for (const char* name : {"gbuffer.minimum_separation", "gbuffer.separation_unit"})
            pass.parameters.push_back({name});
    }
    if (!(lights.points.empty() && lights.spots.empty() && lights.directionals.empty()))
        pass.parameters.push_back({"reflections.lamps"});
    pass.create = [](const PassResources& resources) { return std::make_unique<ReflectionPass>(resources); };
    pass.inputs = {"depth", "normal", "specular", "roughness"};
    for (std::string& plane : SurfaceRadiance(scene, method, quantities).planes(settings.layers))
        pass.inputs.push_back(std::move(plane));
    if (settings.layers > 1) {
        pass.inputs.emplace_back("layer2.depth");
        if (settings.test_hit_normal) pass.inputs.emplace_back("layer2.normal");
    }
    for (int layer = 0; stores_positions(method) && layer < settings.layers; ++layer)
        pass.inputs.push_back(layer_prefix(layer) + "camera_position");
    if (settings.roughness == ReflectionRoughness::mip) pass.inputs.emplace_back(radiance_chain_plane);
    if (has_lamps(lights, method)) pass.inputs.emplace_back(lamp_highlights_plane);
    const std::string fallback = fallback_plane(method);
    if (!fallback.empty()) pass.inputs.push_back(fallback);
    pass.remark =
        fmt::format("{}, {} layer{}, steps of {} pixels, fallback: {}",
                    settings.roughness == ReflectionRoughness::samples ? fmt::format("{} rays", settings.samples)
                                                                       : std::string(to_string(settings.roughness)),
                    settings.layers, settings.layers == 1 ? "" : "s", settings.step, to_string(settings.fallback));
    std::vector<PassDeclaration> passes;
    passes.push_back(declare_lamp_highlights(lights, method));
    passes.push_back(declare_radiance_mip_chain(scene, method, quantities));
    passes.push_back(std::move(pass));
    return passes;
}

}  // namespace plumb
