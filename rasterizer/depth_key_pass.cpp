#include "rasterizer/depth_key_pass.h"

#include <array>

#include <fmt/format.h>

namespace plumb {
namespace {

// Whichever layer's pass is made first allocates for both.
GlFramebuffer make_key_target(const PassResources& resources, int bits, int layer) {
    PlaneTextures& planes = resources.planes;
    const std::string name = depth_key_plane(bits);
    if (!planes.has(name)) planes.create(name, bits == 8 ? GL_R8 : GL_R16, resources.layers_of(name));
    return GlFramebuffer(resources.context, std::array{GlAttachment{&planes.get(name), layer}}, {}, "depth keys");
}

}  // namespace

std::string depth_key_plane(int bits) { return fmt::format("depth_key{}", bits); }

DepthKeyPass::DepthKeyPass(const PassResources& resources, int bits, int layer)
    : depth_(resources.planes.get("depth")),
      draw_(resources.context, resources.programs, "depth_key.frag",
            {{"DEPTH_KEYS", fmt::format("{}.0", (1 << bits) - 1)}, {"LAYER", std::to_string(layer)}}),
      target_(make_key_target(resources, bits, layer)) {}

void DepthKeyPass::execute(const PassFrame&) {
    depth_.bind(0);
    draw_.draw(target_);
}

std::vector<PassDeclaration> declare_depth_keys() {
    std::vector<PassDeclaration> passes;
    for (const int bits : {8, 16}) {
        for (int layer = 0; layer < 2; ++layer) {
            PassDeclaration pass;
            pass.name = fmt::format("depth keys of {} bits{}", bits, layer == 0 ? "" : " of layer 2");
            pass.inputs = {layer_prefix(layer) + "depth"};
            pass.outputs = {layer_prefix(layer) + depth_key_plane(bits)};
            pass.create = [bits, layer](const PassResources& resources) {
                return std::make_unique<DepthKeyPass>(resources, bits, layer);
            };
            passes.push_back(std::move(pass));
        }
    }
    return passes;
}

}  // namespace plumb
