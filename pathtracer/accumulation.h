// Sums of samples per pixel, apart for the two halves, and the planes and error bars that follow from them.
//
// Samples of a pixel are added in their order, in double, by one thread: sums do not depend on how the work was split
// over passes, threads or runs.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "frames/frame.h"
#include "pathtracer/path_integrator.h"

namespace plumb {

// A plane that is estimated from samples.
struct StochasticPlane {
    enum class Kind { ao, emission, direct, indirect_bounce, indirect, irradiance, total };
    std::string name;
    Kind kind = Kind::ao;
    int bounce = 0;  // k of indirect.k

    int channels() const { return kind == Kind::ao ? 1 : 3; }
};

// What the sums do not contain because it is the same for every sample; empty images stand for 0.
struct ExactParts {
    std::vector<glm::vec3> emission, direct;
};

class Accumulation {
public:
    // `emission_is_sampled`: with anti-aliasing, where each sample sees another point.
    Accumulation(int width, int height, const EstimationPlan& plan, bool emission_is_sampled);

    // Adds sample number `sample` (even: half A) of a pixel. `estimate` has to be that of the plan.
    void add(std::size_t pixel, int sample, const glm::vec3& albedo, const glm::vec3& emission,
             const PathEstimate& estimate);
    // Adds a sample that met nothing: open sky.
    void add_background(std::size_t pixel, int sample, const glm::vec3& emission);

    // Adds `plane` with half_a., half_b. and variance. to `frame`. `samples` is the number per pixel, even.
    void write(const StochasticPlane& plane, int samples, const ExactParts& exact, Frame& frame) const;
    // RMS standard error of the plane over its RMS; 0 for a black plane. The same bits whatever the number of threads.
    double relative_error(const StochasticPlane& plane, int samples, const ExactParts& exact) const;

    std::span<double> values() { return sums_; }
    std::span<const double> values() const { return sums_; }

private:
    double* sums(std::size_t pixel, int half) {
        return &sums_[(2 * pixel + static_cast<std::size_t>(half)) * channels_];
    }
    const double* sums(std::size_t pixel, int half) const {
        return &sums_[(2 * pixel + static_cast<std::size_t>(half)) * channels_];
    }
    glm::vec3 half_mean(const StochasticPlane& plane, std::size_t pixel, int half, int samples,
                        const ExactParts& exact) const;

    int width_, height_;
    int bounces_;
    int ao_ = -1, emission_ = -1, direct_ = -1, indirect_ = -1,
        irradiance_ = -1;  // first channel of each; -1: not summed
    std::size_t channels_ = 0;
    std::vector<double> sums_;
};

}  // namespace plumb
