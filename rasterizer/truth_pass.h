// Planes handed in instead of rendered: uploads those of the frame's truth, in which `instance` (the number of an
// instance in the scene, -1 where nothing is) stands for `moving_instance`.
#pragma once

#include <string>
#include <vector>

#include "rasterizer/pass.h"

namespace plumb {

class TruthPass final : public Pass {
public:
    TruthPass(const PassResources& resources, std::vector<std::string> planes);
    // Throws MethodError where the frame brings no truth or lacks a plane.
    void execute(const PassFrame& frame) override;

private:
    struct Upload {
        std::string plane;  // with its layer's prefix
        const GlTexture* texture;
        int layer;
    };
    std::vector<Upload> uploads_;
    std::vector<int> moving_numbers_;              // of every instance
    const PlaneHistory* depth_history_ = nullptr;  // where the pass gives it
};

// The G-buffer (all layers of the method) where gbuffer.source is "truth".
PassDeclaration declare_true_gbuffer(const Scene& scene, const Method& method);
// Direct light of the first layer where direct.source is "truth". No reference holds light of the second layer: the
// method lights that one itself.
PassDeclaration declare_true_direct(const Method& method);

}  // namespace plumb
