// Depths in few bits, for filters that compare them: the planes `depth_key8` (R8) and `depth_key16` (R16), of layer 1
// and 2, which hold the fraction of the far plane rounded to so many bits; 1 also beyond it and where nothing is.
//
// A blur with depth_key_bits of 8 or 16 compares what it reads from them instead of the depths, as filters do that keep
// a key beside the value that they blur: 1 or 2 bytes a pixel. With 32 bits the key is the plane `depth` itself.
//   Source: the key of 8 bits that banded, and of 16 that did not, in the journal of a student's implementation; a
//   fraction of the far plane (300 m) in the filters that Mara et al. ship with G3D.
#pragma once

#include <string>

#include "rasterizer/fullscreen.h"
#include "rasterizer/pass.h"

namespace plumb {

// `bits`: 8 or 16.
std::string depth_key_plane(int bits);

class DepthKeyPass final : public Pass {
public:
    DepthKeyPass(const PassResources& resources, int bits, int layer);
    void execute(const PassFrame& frame) override;

private:
    const GlTexture& depth_;
    FullscreenDraw draw_;
    GlFramebuffer target_;
};

// One declaration for each number of bits and each layer.
std::vector<PassDeclaration> declare_depth_keys();

}  // namespace plumb
