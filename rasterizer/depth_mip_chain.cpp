#include "rasterizer/depth_mip_chain.h"

namespace plumb {

std::vector<PassDeclaration> declare_depth_mip_chain() {
    const std::string chain(depth_mip_chain_plane);
    return {declare_mip_chain("depth MIP chain", "depth", chain, 0),
            declare_mip_chain("depth MIP chain of layer 2", "depth", chain, 1)};
}

}  // namespace plumb
