#include "rasterizer/depth_mip_chain.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace plumb {
namespace {

constexpr int maximum_level = 5;  // as in depth_mip_chain.glsl

// The pass of layer 0 comes first and allocates both layers.
const GlTexture& chain_texture(const PassResources& resources, int layer) {
    const std::string name(depth_mip_chain_plane);
    if (layer > 0) return resources.planes.get(name);
    const int levels = 1 + coarsest_depth_mip(resources.planes.width(), resources.planes.height());
    return resources.planes.create(name, GL_R32F, resources.layers_of(name), levels);
}

}  // namespace

int coarsest_depth_mip(int width, int height) {
    return std::min(maximum_level,
                    static_cast<int>(std::bit_width(static_cast<unsigned>(std::min(width, height)))) - 1);
}

DepthMipChainPass::DepthMipChainPass(const PassResources& resources, int layer)
    : depth_(resources.planes.get("depth")),
      chain_(chain_texture(resources, layer)),
      layer_(layer),
      draw_(resources.context, resources.programs, "depth_mip_chain.frag") {
    for (int level = 1; level < chain_.levels(); ++level) {
        const GlAttachment target{&chain_, layer, level};
        coarser_levels_.emplace_back(resources.context, std::span(&target, 1), GlAttachment{}, "depth MIP chain");
    }
}

void DepthMipChainPass::execute(const PassFrame&) {
    depth_.context().gl.CopyImageSubData(depth_.id(), depth_.target(), 0, 0, 0, layer_, chain_.id(), chain_.target(), 0,
                                         0, 0, layer_, depth_.width(), depth_.height(), 1);
    depth_.bind(0);
    draw_.program().set("layer", layer_);
    int level = 0;
    for (const GlFramebuffer& target : coarser_levels_) {
        draw_.program().set("level", ++level);
        draw_.draw(target);
    }
}

std::vector<PassDeclaration> declare_depth_mip_chain() {
    const std::string first(depth_mip_chain_plane), second = std::string(second_layer_prefix) + first;
    const auto create = [](int layer) {
        return
            [layer](const PassResources& resources) { return std::make_unique<DepthMipChainPass>(resources, layer); };
    };
    return {{"depth MIP chain", {"depth"}, {first}, create(0)},
            {"depth MIP chain of layer 2", {"layer2.depth", first}, {second}, create(1)}};
}

}  // namespace plumb
