// The scene's environment as radiance maps (radiance_maps.h): `environment.radiance`, `environment.irradiance`,
// `environment.prefiltered`. Made once, in the first frame: an environment does not change.
#pragma once

#include <optional>

#include "rasterizer/environment_light.h"
#include "rasterizer/radiance_maps.h"

namespace plumb {

class EnvironmentMapsPass final : public Pass {
public:
    explicit EnvironmentMapsPass(const PassResources& resources);
    void execute(const PassFrame& frame) override;
    // Makes the maps anew: what the first frame does.
    void make();

private:
    GlContext& context_;
    const Environment& source_;
    EnvironmentLight environment_;
    std::optional<FullscreenDraw> draw_;  // none for a constant environment
    RadianceMaps maps_;
    float size_;
    bool made_ = false;
};

PassDeclaration declare_environment_maps(const Scene& scene, const Method& method);

}  // namespace plumb
