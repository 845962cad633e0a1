// A light probe: what is seen from a point of the scene in all directions, as radiance maps (radiance_maps.h):
// `probe.radiance`, `probe.irradiance`, `probe.prefiltered`.
//
// Six square views of 90 degrees from ProbeSettings are rendered by this very rasterizer, with the method's own passes:
// emission, direct light with the view's shadow maps, the environment with its ambient visibility; one layer, without
// radiosity and reflections. Captured once, in the first frame, and what was needed for it is let go; every_frame keeps
// it and captures anew.
//   Good for: light from outside the view and from behind it, where a screen-space method has nothing to read. Bad for:
//   points far from the probe, which see other things, and near ones that something hides from it; whatever only
//   indirect light reaches is black in the probe; ambient visibility has seams where two faces meet.
#pragma once

#include <memory>

#include "rasterizer/light_set.h"
#include "rasterizer/radiance_maps.h"

namespace plumb {

class ProbePass final : public Pass {
public:
    explicit ProbePass(const PassResources& resources);
    ~ProbePass() override;
    void execute(const PassFrame& frame) override;

private:
    class Capture;

    RadianceMaps maps_;
    bool every_frame_;
    std::unique_ptr<Capture> capture_;  // gone once it is not needed any more
};

// What its views are rendered with, to show `total`.
Method method_of_probe_faces(const Method& method);

PassDeclaration declare_probe(const Scene& scene, const LightSet& lights, const Method& method);

}  // namespace plumb
