// A plane at several resolutions, none of whose texels is an average: each is one of level 0, by the rotated grid that
// depth_mip_chain.h describes. Depth, normals and radiance so subsampled belong together.
#pragma once

#include <string>
#include <vector>

#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"

namespace plumb {

// Makes the chain of one layer of a plane, level 0 included: a copy, or the plane itself where nobody keeps that.
class MipChainPass final : public Pass {
public:
    MipChainPass(const PassResources& resources, const std::string& plane, const std::string& chain, int layer);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& plane_;
    const GlTexture& chain_;
    int layer_;
    FullscreenDraw draw_;
    std::vector<GlFramebuffer> coarser_levels_;  // 1, 2, ...
};

// The plane that holds the chain of `plane`, without a layer's prefix.
std::string mip_chain_of(const std::string& plane);
constexpr int coarsest_mip_level = 5;  // maximum_mip_level of depth_mip_chain.glsl
// The level from which there is only one texel across the smaller side, at most coarsest_mip_level.
int coarsest_mip(int width, int height);

PassDeclaration declare_mip_chain(const std::string& pass_name, const std::string& plane, const std::string& chain,
                                  int layer);

}  // namespace plumb
