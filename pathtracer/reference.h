// The ground truth of one view: what is asked for, how it is controlled, and the path tracer that answers.
//
// Computes the planes of Quantities by tracing paths with Embree: light sampling and direction sampling joined by
// multiple importance sampling at every vertex, Owen-scrambled Sobol points, no clamping. Surfaces have the lobes of
// scenes/material.h: Lambertian, GGX, and thin transparency. At the first point they are kept apart: `direct` and
// `indirect` are what its diffuse lobe reflects, `reflection` is what its specular lobe reflects and what passes
// straight through it; at later points all lobes scatter. Directional lights with an angular size are seen in mirrors
// and through panes, both of which is `reflection`, but not by the camera.
//   Good for: diffuse and glossy light of any kind. Bad for: caustics, which only paths from the eye look for, and
//   light that squeezes through small gaps.
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
#include <vector>

#include "frames/frame.h"
#include "frames/quantities.h"
#include "pathtracer/sample_points.h"
#include "pathtracer/time_span.h"
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

// Restricts what rays may meet to what a view's G-buffer holds: the best that any method could make of it. The way from
// a surface to a light stays that of the whole scene, as shadow maps have it; where nothing is met there is the
// environment.
struct OracleSettings {
    View view;                        // with its guard band
    int layers = 1;                   // 0: all that lies in the view's frustum
    float minimum_separation = 0.1f;  // metres along the view axis between layers
};

struct ReferenceSettings {
    Quantities quantities;
    int samples = 256;          // per pixel, even; the most where a target error is set
    int first_sample = 0;       // even; the samples rendered are first_sample to samples - 1
    double target_error = 0.0;  // stop early once the relative standard error of every stochastic plane (RMS standard
                                // error over the RMS of the plane) is below it; 0: never
    std::uint64_t seed = 1;
    float minimum_separation = 0.1f;    // metres along the view axis between the first and the second layer (layer2.*)
    bool antialias = false;             // primary rays spread over the pixel instead of through its centre, but for the
                                        // G-buffer's, which never do
    std::optional<View> previous_view;  // where the camera was in the frame before (motion); none: it stood still
    EmitterSampling emitter_sampling = EmitterSampling::both;
    SamplePoints points = SamplePoints::sobol;
    // Bounces that every path is given; then it goes on with the probability of its throughput (Russian roulette),
    // which changes no expectation. 0: every path goes on to the last bounce.
    int roulette_after = 8;
    std::optional<OracleSettings> oracle;
    // Where the camera was when the shutter opened; it is open over the path tracer's time span, until the camera is
    // where the view has it. None: an instant. Primary rays move linearly. The G-buffer's planes are those of the end.
    std::optional<View> view_at_shutter_opening;
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
    // Written every so many seconds and on stop; resumed from where it exists, also with more samples or another target
    // error. The caller removes it once the frame is in safety.
    std::filesystem::path checkpoint = {};
    double checkpoint_seconds = 60.0;  // 0: after every pass
};

struct ReferenceResult {
    // The wanted planes. For every stochastic one also
    //   half_a.*, half_b.*  the means of the even and of the odd samples, which are independent. `plane` is their
    //                       average; that of indirect is the sum of those of its bounces, that of total the sum of its
    //                       parts, so that the planes add up, and rounding may tell it from the average of its halves;
    //   variance.*          of the mean, per channel: ((half_a - half_b) / 2)^2. Unbiased also where samples have low
    //                       discrepancy, but with one degree of freedom per pixel: average it over pixels before use.
    Frame frame;
    int samples = 0;         // per pixel
    double seconds = 0.0;    // over all runs that led here
    std::uint64_t rays = 0;  // over all runs that led here
    bool complete = true;    // false: stopped; resume from the checkpoint
    // True: the very bits would come out of any split of the samples over shards. False where a pixel is so much
    // brighter than the lights would have it that its sum was rounded.
    bool exact = true;
};

// What a pixel's ray meets, found exactly.
struct LayerSettings {
    int layers = 2;
    // Metres along the view axis: layer k + 1 is the nearest hit that is deeper than layer k by more.
    float minimum_separation = 0.1f;
    const View* previous_view = nullptr;  // for motion; none: the camera stood still
};

class RayRecorder;

// A reference whose samples are all taken. Its planes need neither the scene nor the path tracer any more, so that
// large ones can have their memory.
class SampledReference {
public:
    struct Parts;

    explicit SampledReference(std::unique_ptr<Parts> parts);
    ~SampledReference();
    SampledReference(SampledReference&&) noexcept;

    ReferenceResult result() &&;

private:
    std::unique_ptr<Parts> parts_;
};

class PathTracer {
public:
    // Keeps a reference to the scene. Instances that move do so over `span`: while the shutter is open, or from the
    // frame before to this one; what knows no time sees them at its end. An empty span: as they stand in the scene.
    // Throws SceneError for indices that point nowhere.
    explicit PathTracer(const Scene& scene, const TimeSpan& span = {});
    ~PathTracer();
    PathTracer(PathTracer&&) noexcept;

    // The same scene, view and settings give the same bits whatever the number of threads, and whether or not the run
    // was interrupted. Throws ReferenceError for settings that make no sense and for a checkpoint of another run.
    ReferenceResult render(const View& view, const ReferenceSettings& settings,
                           const ReferenceControl& control = {}) const {
        return sample(view, settings, control).result();
    }
    SampledReference sample(const View& view, const ReferenceSettings& settings,
                            const ReferenceControl& control = {}) const;

    // Renders settings.first_sample to settings.samples into `file`, to be merged. False where it was stopped.
    bool render_shard(const View& view, const ReferenceSettings& settings, const std::filesystem::path& file,
                      const ReferenceControl& control = {}) const;
    // All samples of the shards, which must follow each other from 0 on: the bits of one run. Throws ReferenceError for
    // gaps, overlaps, and shards of another scene, view or settings.
    SampledReference merge(const View& view, const ReferenceSettings& settings,
                           const std::vector<std::filesystem::path>& shards, int threads = 0) const;

    // Every ray that render() traces by batches is told to `recorder` (null: none), for benchmarks.
    void set_recorder(RayRecorder* recorder);

    // Planes depth, normal, albedo, position (world), motion (pixels: position in the previous view minus position now;
    // of a point at infinity where nothing is met; infinite where the point was behind the previous camera), emission,
    // instance (index into Scene::instances, -1: nothing), and seen_before (1 where the previous view saw the surface
    // point: within its frame and with nothing in front, as the scene stood when the time span began) of the first
    // layer; "layer2." and so on before the names of the others. Alpha-masked holes are no surface. Nothing nearer than
    // the near plane or deeper than the far plane is met.
    Frame gbuffer(const View& view, const LayerSettings& settings = {}, int threads = 0) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

// RMS standard error of a plane over its RMS, from the frame of a reference: what ReferenceSettings::target_error
// bounds. 0 for a plane without noise, infinite for one of nothing but noise.
double relative_standard_error(const Frame& frame, const std::string& plane);

// 1 where a pixel's 3x3 neighbourhood holds an edge: other instances, hits beside misses, a step of more than a pixel's
// width off the pixel's tangent plane, or normals more than 15 degrees apart; else 0. Two renderers may rightly differ
// there by rounding alone. `layer` counts from 1.
Image silhouettes(const Frame& gbuffer, const View& view, int layer = 1);

}  // namespace plumb
