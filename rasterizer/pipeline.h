// The real-time side: a list of passes that renders the wanted planes of a view with a method.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "frames/frame.h"
#include "frames/quantities.h"
#include "rasterizer/method.h"
#include "rasterizer/moment.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

class GlContext;

struct PassTiming {
    std::string pass;
    double milliseconds = 0.0;
};

struct PassDecision {
    std::string pass;
    bool runs = false;
    std::string reason;
};

struct RasterResult {
    Frame frame;                      // the wanted planes
    std::vector<PassTiming> timings;  // in the order of execution; what was read back is not timed
    double milliseconds = 0.0;        // their sum
};

class Pipeline {
public:
    // Compiles and allocates only the passes whose outputs are wanted. Throws MethodError for parameters that cannot be
    // combined or that would change nothing.
    Pipeline(GlContext& context, const Scene& scene, const Method& method, const Quantities& quantities, int width,
             int height);
    ~Pipeline();

    // Each pass, whether it runs, and why.
    const std::vector<PassDecision>& decisions() const;

    // Renders one frame. Passes that keep something from frame to frame use it where the frame rendered before is the
    // request's `previous`, and drop it else. Where `total` is anti-aliased over frames, every other plane is that of
    // the view with the frame's offset (temporal_antialias.h).
    RasterResult render(const FrameRequest& request);
    // Renders the next frame as if it were the first: nothing is kept.
    void forget();
    // Runs all passes, without reading anything back: for timing.
    std::vector<PassTiming> time_passes(const FrameRequest& request);

    // The same where the instances stay as the scene has them.
    RasterResult render(const View& view, const View* previous = nullptr, const Frame* truth = nullptr);
    std::vector<PassTiming> time_passes(const View& view, const Frame* truth = nullptr);
    // Bytes of the G-buffer's textures per pixel, over all layers: planes, lit radiance, the hardware's depth and what
    // is kept for the next frame, as far as the wanted planes need them.
    std::size_t gbuffer_bytes_per_pixel() const;
    // Bytes of all shadow maps together, of lamps and of emissive surfaces.
    std::size_t shadow_map_bytes() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace plumb
