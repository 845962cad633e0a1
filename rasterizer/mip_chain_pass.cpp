#include "rasterizer/mip_chain_pass.h"

#include <algorithm>
#include <bit>
#include <span>

namespace plumb {
namespace {

// Whichever layer's pass is made first allocates for both.
const GlTexture& chain_texture(const PassResources& resources, const std::string& plane, const std::string& chain) {
    PlaneTextures& planes = resources.planes;
    if (planes.has(chain)) return planes.get(chain);
    return planes.create(chain, planes.get(plane).format(), resources.layers_of(chain),
                         1 + coarsest_mip(planes.width(), planes.height()));
}

}  // namespace

std::string mip_chain_of(const std::string& plane) { return plane + "_mip_chain"; }

int coarsest_mip(int width, int height) {
    return std::min(coarsest_mip_level,
                    static_cast<int>(std::bit_width(static_cast<unsigned>(std::min(width, height)))) - 1);
}

MipChainPass::MipChainPass(const PassResources& resources, const std::string& plane, const std::string& chain,
                           int layer)
    : plane_(resources.planes.get(plane)),
      chain_(chain_texture(resources, plane, chain)),
      layer_(layer),
      draw_(resources.context, resources.programs, "mip_chain.frag") {
    // The texture may have more levels, of which nobody reads (plane_pool.h).
    for (int level = 1; level <= coarsest_mip(chain_.width(), chain_.height()); ++level) {
        const GlAttachment target{&chain_, layer, level};
        coarser_levels_.emplace_back(resources.context, std::span(&target, 1), GlAttachment{}, "MIP chain");
    }
}

void MipChainPass::execute(const PassFrame&) {
    const GladGLContext& gl = plane_.context().gl;
    if (plane_.id() == chain_.id()) {
        gl.TextureBarrier();  // the finest level is read while others are drawn into
    } else {
        gl.CopyImageSubData(plane_.id(), plane_.target(), 0, 0, 0, layer_, chain_.id(), chain_.target(), 0, 0, 0,
                            layer_, plane_.width(), plane_.height(), 1);
    }
    plane_.bind(0);
    draw_.program().set("layer", layer_);
    int level = 0;
    for (const GlFramebuffer& target : coarser_levels_) {
        draw_.program().set("level", ++level);
        draw_.draw(target);
    }
}

PassDeclaration declare_mip_chain(const std::string& pass_name, const std::string& plane, const std::string& chain,
                                  int layer) {
    PassDeclaration pass;
    pass.name = pass_name;
    pass.inputs = {layer_prefix(layer) + plane};
    pass.outputs = {layer_prefix(layer) + chain};
    pass.create = [plane, chain, layer](const PassResources& resources) {
        return std::make_unique<MipChainPass>(resources, plane, chain, layer);
    };
    pass.in_place = PassDeclaration::InPlace{.output = chain, .input = plane, .is_chain = true};
    return pass;
}

}  // namespace plumb
