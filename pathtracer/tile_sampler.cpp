#include "pathtracer/tile_sampler.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "frames/parallel.h"
#include "pathtracer/direction_sampling.h"
#include "pathtracer/exact_gbuffer.h"
#include "pathtracer/path_dimensions.h"

namespace plumb {
namespace {

constexpr int tile_size = 16;  // pixels
int tiles_along(int pixels) { return (pixels + tile_size - 1) / tile_size; }

// What lies in a lane, on a surface without a specular side.
SurfacePoint plain_point(const SurfaceLanes& surfaces, int lane) {
    SurfacePoint point;
    point.ray_origin = surfaces.ray_origin.get(lane);
    point.geometric_normal = surfaces.geometric_normal.get(lane);
    point.shading_normal = surfaces.shading_normal.get(lane);
    point.bulge = surfaces.bulge[lane];
    point.albedo = surfaces.albedo.get(lane);
    return point;
}

}  // namespace

// What one thread needs to follow a batch of paths.
struct TileSampler::Scratch {
    VertexBatch starts;
    SampleBatch samples;
    PathWorkspace workspace;
    BatchEstimate estimate;
    std::uint64_t rays = 0;
    // Rays from the camera, whose they are, and what they met.
    RayBatch primary;
    SampleBatch primary_samples;
    SampleLanes primary_points;
    Lanes<float> primary_x, primary_y;  // the pixel's upper left corner
    HitBatch hits;
    MetRays met;
    SurfaceLanes surfaces;
};

TileSampler::TileSampler(const TracedScene& scene, const View& view, const ReferenceSettings& settings,
                         bool primary_rays_are_sampled, const std::vector<SurfaceHit>& hits,
                         const PathIntegrator& integrator, Accumulation& accumulation)
    : scene_(scene),
      view_(view),
      settings_(settings),
      primary_rays_are_sampled_(primary_rays_are_sampled),
      hits_(hits),
      integrator_(integrator),
      accumulation_(accumulation) {}

TileSampler::~TileSampler() = default;

void TileSampler::flush(Scratch& scratch) {
    if (scratch.starts.count == 0) return;
    integrator_.estimate(scratch.starts, scratch.workspace, scratch.estimate);
    accumulation_.add(scratch.samples, scratch.starts, scratch.estimate);
    scratch.rays += static_cast<std::uint64_t>(scratch.estimate.rays);
    scratch.starts.clear();
}

// Starts `count` paths of one pixel at `point`, which lies at its centre.
void TileSampler::add_centre_samples(int x, int y, const SurfacePoint& point, const glm::vec3& direction,
                                     int first_sample, int count, Scratch& scratch) {
    const SampleSequence sequence(settings_.seed, x, y, settings_.points);
    VertexBatch& starts = scratch.starts;
    for (int sample = first_sample; sample < first_sample + count;) {
        // As many samples of the pixel as the batch still has room for: one vertex for all.
        const int begin = starts.count, end = std::min(most_lanes, begin + first_sample + count - sample);
        integrator_.add_start(point, direction, {}, now, starts);
        starts.repeat(begin, end);
        scratch.samples.fill(begin, end, static_cast<std::uint32_t>(pixel_index(view_, x, y)), sample);
        sequence.start_samples(sample, end - begin, begin, starts.samples);
        sample += end - begin;
        if (end == most_lanes) flush(scratch);
    }
}

// The pixels of a row from `left` on, as many as a batch has lanes: what they see is looked up side by side.
void TileSampler::add_centre_samples(int left, int right, int y, int first_sample, int count, Scratch& scratch) {
    RayBatch& rays = scratch.primary;
    rays.count = 0;
    for (int x = left; x < right; ++x) {
        const Ray ray = view_.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        scratch.hits.set(rays.count, hits_[pixel_index(view_, x, y)]);
        rays.add(ray.origin, ray.direction, infinite_distance, now);
    }
    scratch.met.find(rays, scratch.hits);
    scene_.surface_points(rays, scratch.hits, scratch.met, scratch.surfaces);
    for (int x = left, j = 0; x < right; ++x) {
        if (scratch.hits.missed(x - left)) {
            for (int i = 0; i < count; ++i) accumulation_.add_background(pixel_index(view_, x, y), i & 1, {});
            continue;
        }
        const SurfaceHit hit = scratch.hits.get(x - left);
        const glm::vec3 direction = rays.direction.get(x - left);
        const int surface = j++;
        add_centre_samples(x, y,
                           scene_.is_plain(hit.instance) ? plain_point(scratch.surfaces, surface)
                                                         : scene_.surface_point(hit, direction),
                           direction, first_sample, count, scratch);
    }
}

// The rays that wait in `scratch.primary`: through the pixel's area, the lens and the time that the shutter is open.
PLUMBLINE_FOR_EACH_MACHINE
void TileSampler::make_primary_rays(Scratch& scratch) const {
    RayBatch& rays = scratch.primary;
    const int count = rays.count;
    const SampleLanes& points = scratch.primary_points;
    Lanes<float> x, y, lens_x, lens_y;
    x.fill(0, count, 0.5f), y.fill(0, count, 0.5f);
    if (settings_.antialias) sample_points(points, count, pixel_dimension, x, y);
    const bool has_lens = view_.camera().aperture_radius > 0.0f;
    if (has_lens) sample_points(points, count, lens_dimension, lens_x, lens_y);
    rays.time.fill(0, count, now);
    const std::optional<View>& opening = settings_.view_at_shutter_opening;
    if (opening) sample_numbers(points, count, time_dimension, rays.time);
    for (int i = 0; i < count; ++i) {
        const float at_x = scratch.primary_x[i] + x[i], at_y = scratch.primary_y[i] + y[i];
        const glm::vec2 lens = has_lens ? sample_disc({lens_x[i], lens_y[i]}) : glm::vec2(0.0f);
        Ray ray = view_.lens_ray(at_x, at_y, lens);
        float scale = depth_per_distance(view_, ray.direction);
        if (opening) {
            const Ray before = opening->lens_ray(at_x, at_y, lens);
            // Each ray's angle with its own view's axis: a ray keeps it as both turn.
            scale = glm::mix(depth_per_distance(*opening, before.direction), scale, rays.time[i]);
            ray.origin = glm::mix(before.origin, ray.origin, rays.time[i]);
            ray.direction = glm::normalize(glm::mix(before.direction, ray.direction, rays.time[i]));
        }
        rays.set(i, ray.origin, ray.direction, view_.camera().far_plane / scale, rays.time[i]);
        rays.nearest[i] = view_.camera().near_plane / scale;
    }
}

// Traces the primary rays that wait, and follows the paths that start where they end.
void TileSampler::trace_primary_rays(Scratch& scratch) {
    RayBatch& rays = scratch.primary;
    const HitBatch& hits = scratch.hits;
    const SampleBatch& samples = scratch.primary_samples;
    make_primary_rays(scratch);
    scene_.intersect(rays, scratch.hits);
    scratch.rays += static_cast<std::uint64_t>(rays.count);
    MetRays& met = scratch.met;
    met.find(rays, hits);
    for (int i = 0; i < rays.count && met.count < rays.count; ++i) {
        if (!hits.missed(i)) continue;
        accumulation_.add_background(samples.pixel[i], samples.half[i],
                                     scene_.scene().environment_radiance(rays.direction.get(i)));
    }
    integrator_.start(rays, hits, met, scratch.primary_points, scratch.starts);
    for (int j = 0; j < met.count; ++j) {
        scratch.samples.pixel[j] = samples.pixel[met.ray[j]];
        scratch.samples.half[j] = samples.half[met.ray[j]];
    }
    flush(scratch);
    rays.count = 0;
}

// Lets `count` rays through pixel (x, y) wait to be traced.
void TileSampler::add_spread_samples(int x, int y, int first_sample, int count, Scratch& scratch) {
    const SampleSequence sequence(settings_.seed, x, y, settings_.points);
    for (int sample = first_sample; sample < first_sample + count;) {
        const int begin = scratch.primary.count, end = std::min(most_lanes, begin + first_sample + count - sample);
        scratch.primary_samples.fill(begin, end, static_cast<std::uint32_t>(pixel_index(view_, x, y)), sample);
        scratch.primary_x.fill(begin, end, static_cast<float>(x));
        scratch.primary_y.fill(begin, end, static_cast<float>(y));
        sequence.start_samples(sample, end - begin, begin, scratch.primary_points);
        scratch.primary.count = end;
        sample += end - begin;
        if (end == most_lanes) trace_primary_rays(scratch);
    }
}

void TileSampler::sample_tile(int tile, int first_sample, int count, Scratch& scratch) {
    const int columns = tiles_along(view_.width());
    const int left = tile % columns * tile_size, top = tile / columns * tile_size;
    const int right = std::min(left + tile_size, view_.width()), bottom = std::min(top + tile_size, view_.height());
    for (int y = top; y < bottom; ++y) {
        if (!primary_rays_are_sampled_) {
            add_centre_samples(left, right, y, first_sample, count, scratch);
            continue;
        }
        for (int x = left; x < right; ++x) add_spread_samples(x, y, first_sample, count, scratch);
    }
    // Other tiles' pixels are other threads'.
    if (scratch.primary.count > 0 && primary_rays_are_sampled_) trace_primary_rays(scratch);
    flush(scratch);
}

std::uint64_t TileSampler::sample(int first_sample, int count) {
    parallel_for(tiles_along(view_.width()) * tiles_along(view_.height()), [&](int tile) {
        std::unique_ptr<Scratch>& scratch = scratch_.local();
        if (!scratch) scratch = std::make_unique<Scratch>();
        sample_tile(tile, first_sample, count, *scratch);
    });
    std::uint64_t rays = 0;
    for (std::unique_ptr<Scratch>& scratch : scratch_) rays += std::exchange(scratch->rays, 0);
    return rays;
}

}  // namespace plumb
