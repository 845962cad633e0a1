#include "rasterizer/radiance_mip_chain.h"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>

#include "rasterizer/gbuffer_planes.h"

namespace plumb {
namespace {

struct RadianceChainUnits {
    enum : GLuint { depth, finer = 0, direct = 4, emission, indirect };
};

ShaderDefines defines_of_level(const PassResources& resources, bool first) {
    ShaderDefines defines = SurfaceRadiance(resources.scene, resources.method, resources.quantities).defines();
    defines.emplace_back("FIRST_LEVEL", first ? "1" : "0");
    return defines;
}

GLenum chain_format(const PassResources& resources) {
    const bool is_wide = resources.method.gbuffer.radiance_format == RadianceFormat::rgba32f;
    return is_wide ? GL_RGBA32F : emission_format(resources.scene);
}

}  // namespace

int coarsest_radiance_level(int width, int height) {
    return static_cast<int>(std::bit_width(static_cast<unsigned>(std::min(width, height)))) - 1;
}

SurfaceRadiance::SurfaceRadiance(const Scene& scene, const Method& method, const Quantities& quantities)
    : direct(quantities.bounces >= 1),
      emission(scene.has_emissive_surfaces()),
      indirect(quantities.bounces >= 2 && method.radiosity.enabled) {}

std::vector<std::string> SurfaceRadiance::planes(int layers) const {
    std::vector<std::string> names;
    for (int layer = 0; layer < layers; ++layer) {
        if (direct) names.push_back(layer_prefix(layer) + "direct");
        if (emission) names.push_back(layer_prefix(layer) + "emission");
    }
    if (indirect) names.emplace_back("indirect");
    return names;
}

ShaderDefines SurfaceRadiance::defines() const {
    const auto flag = [](bool on) { return on ? "1" : "0"; };
    return {{"BOUNCED", flag(direct)}, {"EMISSION", flag(emission)}, {"INDIRECT", flag(indirect)}};
}

SurfaceRadiancePlanes::SurfaceRadiancePlanes(const PlaneTextures& planes, const SurfaceRadiance& radiance)
    : direct_(radiance.direct ? &planes.get("direct") : nullptr),
      emission_(radiance.emission ? &planes.get("emission") : nullptr),
      indirect_(radiance.indirect ? &planes.get("indirect") : nullptr) {}

void SurfaceRadiancePlanes::bind() const {
    if (direct_) direct_->bind(RadianceChainUnits::direct);
    if (emission_) emission_->bind(RadianceChainUnits::emission);
    if (indirect_) indirect_->bind(RadianceChainUnits::indirect);
}

RadianceMipChainPass::RadianceMipChainPass(const PassResources& resources)
    : sources_(resources.planes, SurfaceRadiance(resources.scene, resources.method, resources.quantities)),
      depth_(resources.planes.get("depth")),
      chain_(resources.planes.create(radiance_chain_plane, chain_format(resources), resources.method.reflections.layers,
                                     1 + coarsest_radiance_level(resources.planes.width(), resources.planes.height()))),
      first_level_(resources.context, resources.programs, "radiance_mip_chain.frag", defines_of_level(resources, true)),
      further_levels_(resources.context, resources.programs, "radiance_mip_chain.frag",
                      defines_of_level(resources, false)) {
    targets_.resize(static_cast<std::size_t>(chain_.layers()));
    for (int layer = 0; layer < chain_.layers(); ++layer) {
        for (int level = 0; level < chain_.levels(); ++level) {
            targets_[static_cast<std::size_t>(layer)].emplace_back(resources.context,
                                                                   std::array{GlAttachment{&chain_, layer, level}},
                                                                   GlAttachment{}, "radiance MIP chain");
        }
    }
}

void RadianceMipChainPass::execute(const PassFrame&) {
    sources_.bind();
    for (int layer = 0; layer < chain_.layers(); ++layer) {
        const std::vector<GlFramebuffer>& levels = targets_[static_cast<std::size_t>(layer)];
        depth_.bind(RadianceChainUnits::depth);
        first_level_.program().set("layer", layer);
        first_level_.draw(levels.front());
        // Each level is read while the next one is drawn into: other texels of the same texture, which OpenGL allows
        // where a barrier follows each draw.
        chain_.bind(RadianceChainUnits::finer);
        further_levels_.program().set("layer", layer);
        for (std::size_t level = 1; level < levels.size(); ++level) {
            chain_.context().gl.TextureBarrier();
            further_levels_.program().set("finer_level", static_cast<int>(level) - 1);
            further_levels_.draw(levels[level]);
        }
    }
}

PassDeclaration declare_radiance_mip_chain(const Scene& scene, const Method& method, const Quantities& quantities) {
    const ReflectionSettings& settings = method.reflections;
    PassDeclaration pass;
    pass.name = "radiance MIP chain";
    pass.inputs = SurfaceRadiance(scene, method, quantities).planes(settings.layers);
    for (int layer = 0; layer < settings.layers; ++layer) pass.inputs.push_back(layer_prefix(layer) + "depth");
    pass.outputs = {radiance_chain_plane};
    pass.create = [](const PassResources& resources) { return std::make_unique<RadianceMipChainPass>(resources); };
    if (emission_format(scene) != GL_RGBA32F) pass.parameters.push_back({"gbuffer.radiance_format"});
    pass.remark = fmt::format("{} layer{}", settings.layers, settings.layers == 1 ? "" : "s");
    if (!settings.enabled) pass.disabled = "method.reflections.enabled is false";
    return pass;
}

}  // namespace plumb
