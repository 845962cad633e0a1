// The ground truth of one view: what is asked for, how it is controlled, and the path tracer that answers.
//
// Computes the planes of Quantities by tracing paths with Embree: light sampling and direction sampling joined by
// multiple importance sampling at every vertex, Owen-scrambled Sobol points, no clamping, no roulette. Surfaces are
// Lambertian with SurfaceSample::albedo; what the metallic part of a material reflects is not part of any plane here.
//   Good for: diffuse light of any kind. Bad for: caustics (there are none) and light that squeezes through small gaps.
//
// At a pixel that sees nothing: depth is infinity, normal and albedo 0, ao 1, and the environment's radiance is
// `emission`.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "frames/frame.h"
#include "frames/quantities.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

// How light from emissive surfaces and the environment is found; all three have the same expectation. Point, spot and
// directional lights are always sampled.
enum class EmitterSampling {
    lights,      // points on emitters, directions by the environment's radiance
    directions,  // cosine-distributed directions only: fair to everything, slow for small lights
    both,        // joined by the power heuristic (Veach 1997, section 9.2)
};

struct ReferenceSettings {
    Quantities quantities;
    int samples = 256;          // per pixel, even; the most where a target error is set
    double target_error = 0.0;  // stop early once the relative standard error of every stochastic plane (RMS standard
                                // error over the RMS of the plane) is below it; 0: never
    std::uint64_t seed = 1;
    float minimum_separation = 0.1f;  // metres along the view axis between the first and the second layer (layer2.*)
    bool antialias =
        false;  // primary rays spread over the pixel instead of through its centre; the G-buffer's never do
    std::optional<View> previous_view;  // where the camera was in the frame before (motion); none: it stood still
    EmitterSampling emitter_sampling = EmitterSampling::both;
};

struct ReferenceProgress {
    int samples_done = 0, samples_wanted = 0;
    double relative_error = 0.0;  // the worst plane's
    double rays_per_second = 0.0;
    double seconds = 0.0;
};

// How a run is watched and interrupted; nothing here changes a pixel.
struct ReferenceControl {
    int threads = 0;                                                 // 0: all
    std::function<void(const ReferenceProgress&)> on_progress = {};  // about once a second, from the calling thread
    const std::atomic<bool>* stop = nullptr;  // set from a signal handler; the run ends after the current pass
    // Written every minute and on stop; resumed from where it exists, also with more samples or another target error.
    // The caller removes it once the frame is in safety.
    std::filesystem::path checkpoint = {};
};

struct ReferenceResult {
    // The wanted planes. For every stochastic one also
    //   half_a.*, half_b.*  the means of the even and of the odd samples: independent, and `plane` is their average;
    //   variance.*          of the mean, per channel: ((half_a - half_b) / 2)^2. Unbiased also for low-discrepancy
    //   samples,
    //                       but with one degree of freedom per pixel: average it over pixels before use.
    Frame frame;
    int samples = 0;         // per pixel
    double seconds = 0.0;    // over all runs that led here
    std::uint64_t rays = 0;  // over all runs that led here
    bool complete = true;    // false: stopped; resume from the checkpoint
};

// What a pixel's ray meets, found exactly.
struct LayerSettings {
    int layers = 2;
    float minimum_separation =
        0.1f;  // metres along the view axis: layer k + 1 is the nearest hit deeper than layer k by more
    const View* previous_view = nullptr;  // for motion; none: the camera stood still
};

class PathTracer {
public:
    // Keeps a reference to the scene. Throws SceneError for indices that point nowhere.
    explicit PathTracer(const Scene& scene);
    ~PathTracer();
    PathTracer(PathTracer&&) noexcept;

    // The same scene, view and settings give the same bits whatever the number of threads, and whether or not the run
    // was interrupted. Throws ReferenceError for settings that make no sense and for a checkpoint of another run.
    ReferenceResult render(const View& view, const ReferenceSettings& settings,
                           const ReferenceControl& control = {}) const;

    // Planes depth, normal, albedo, position (world), motion (pixels: position in the previous view minus position now;
    // of a point at infinity where nothing is met; infinite where the point was behind the previous camera), emission,
    // and instance (index into Scene::instances, -1: nothing) of the first layer; "layer2." and so on before the names
    // of the others. Alpha-masked holes are no surface. Nothing nearer than the near plane or deeper than the far plane
    // is met.
    Frame gbuffer(const View& view, const LayerSettings& settings = {}, int threads = 0) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

// 1 where a pixel's 3x3 neighbourhood holds an edge: other instances, hits beside misses, a step of more than a pixel's
// width off the pixel's tangent plane, or normals more than 15 degrees apart; else 0. Two renderers may rightly differ
// there by rounding alone. `layer` counts from 1.
Image silhouettes(const Frame& gbuffer, const View& view, int layer = 1);

}  // namespace plumb
