// Samples of all pixels of a view, tile by tile on all threads: where their paths start, a batch of paths at a time.
//
// Paths start at the point that the ray through the pixel's centre met, which is found once; or, where samples are
// spread over the pixel, the lens or the time that the shutter is open, where a primary ray of their own ends.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "pathtracer/accumulation.h"
#include "pathtracer/path_integrator.h"
#include "pathtracer/reference.h"
#include "pathtracer/traced_scene.h"

namespace plumb {

class TileSampler {
public:
    // Keeps references to all. `hits`: of the rays through the pixels' centres, row by row; `accumulation` takes what
    // the samples bring.
    TileSampler(const TracedScene& scene, const View& view, const ReferenceSettings& settings,
                bool primary_rays_are_sampled, const std::vector<SurfaceHit>& hits, const PathIntegrator& integrator,
                Accumulation& accumulation);
    ~TileSampler();
    TileSampler(const TileSampler&) = delete;
    TileSampler& operator=(const TileSampler&) = delete;

    // Samples first_sample .. first_sample + count - 1 of every pixel. Returns the number of rays.
    std::uint64_t sample(int first_sample, int count);

private:
    struct Scratch;

    void sample_tile(int tile, int first_sample, int count, Scratch& scratch);
    void add_centre_samples(int left, int right, int y, int first_sample, int count, Scratch& scratch);
    void add_centre_samples(int x, int y, const SurfacePoint& point, const glm::vec3& direction, int first_sample,
                            int count, Scratch& scratch);
    void add_spread_samples(int x, int y, int first_sample, int count, Scratch& scratch);
    void make_primary_rays(Scratch& scratch) const;
    void trace_primary_rays(Scratch& scratch);
    void flush(Scratch& scratch);

    const TracedScene& scene_;
    const View& view_;
    const ReferenceSettings& settings_;
    bool primary_rays_are_sampled_;
    const std::vector<SurfaceHit>& hits_;
    const PathIntegrator& integrator_;
    Accumulation& accumulation_;
    tbb::enumerable_thread_specific<std::unique_ptr<Scratch>> scratch_;
};

}  // namespace plumb
