// The ground truth of one view: what is asked for, how it is controlled, and the path tracer that answers.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "frames/frame.h"
#include "frames/quantities.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

struct ReferenceSettings {
    Quantities quantities;
    int samples = 256;          // per pixel, even; the most where a target error is set
    double target_error = 0.0;  // stop early once the relative standard error of every stochastic plane (RMS standard error
                                // over the RMS of the plane) is below it; 0: never
    std::uint64_t seed = 1;
    float minimum_separation = 0.1f;  // metres between the first and the second layer, for layer2.* planes
    bool antialias = false;           // primary rays spread over the pixel instead of through its centre
};

struct ReferenceProgress {
    int samples_done = 0, samples_wanted = 0;
    double relative_error = 0.0;  // the worst plane's
    double rays_per_second = 0.0;
    double seconds = 0.0;
};

// How a run is watched and interrupted; nothing here changes a pixel.
struct ReferenceControl {
    int threads = 0;  // 0: all
    std::function<void(const ReferenceProgress&)> on_progress;
    const std::atomic<bool>* stop = nullptr;  // set from a signal handler; the run ends after the current pass
    std::filesystem::path checkpoint;         // written every minute and on stop; resumed from where it exists
};

struct ReferenceResult {
    Frame frame;       // wanted planes, with half_a., half_b. and variance. for every stochastic one
    int samples = 0;   // per pixel
    double seconds = 0.0;
    std::uint64_t rays = 0;
    bool complete = true;  // false: stopped; resume from the checkpoint
};

class PathTracer {
public:
    explicit PathTracer(const Scene& scene);  // keeps a reference to the scene
    ~PathTracer();
    PathTracer(PathTracer&&) noexcept;

    // The same scene, view and settings give the same bits whatever the number of threads.
    ReferenceResult render(const View& view, const ReferenceSettings& settings,
                           const ReferenceControl& control = {}) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace plumb
