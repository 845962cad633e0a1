#include "rasterizer/depth_mip_chain.h"

#include <fmt/format.h>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"

namespace plumb {

void require_points_at_taps(std::string_view stage, bool use_mip_chain, MipTapPoint points, const Method& method) {
    if (!use_mip_chain || points == MipTapPoint::exact || !stores_positions(method)) return;
    throw MethodError(
        fmt::format("{0}.mip_points is \"sao2012\", which computes points at the taps' own positions, but "
                    "gbuffer.position is \"stored\", which has those of pixels only; set gbuffer.position to "
                    "\"from_depth\" or {0}.mip_points to \"exact\"",
                    stage));
}

std::vector<PassDeclaration> declare_depth_mip_chain() {
    const std::string chain(depth_mip_chain_plane);
    return {declare_mip_chain("depth MIP chain", "depth", chain, 0),
            declare_mip_chain("depth MIP chain of layer 2", "depth", chain, 1)};
}

}  // namespace plumb
