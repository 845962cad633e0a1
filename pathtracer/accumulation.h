// Sums of samples per pixel, apart for the two halves, and the planes and error bars that follow from them.
//
// Sums are exact: each sample is rounded to a multiple of a quantum, far below the noise, and multiples of it add up in
// double without rounding. So they do not depend on the order of the samples, nor on how these were split over passes,
// threads, runs and machines.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "frames/frame.h"
#include "frames/zeroed_array.h"
#include "pathtracer/path_integrator.h"

namespace plumb {

// A plane that is estimated from samples.
struct StochasticPlane {
    enum class Kind { ao, emission, direct, indirect_bounce, indirect, irradiance, reflection, total };
    std::string name;
    Kind kind = Kind::ao;
    int bounce = 0;  // k of indirect.k

    int channels() const { return kind == Kind::ao ? 1 : 3; }
};

// What the sums do not contain because it is the same for every sample; empty images stand for 0.
struct ExactParts {
    ZeroedArray<glm::vec3> emission, direct;
};

// Which samples a batch of paths, or of rays, belongs to.
struct SampleBatch {
    Lanes<std::uint32_t> pixel;
    Lanes<std::uint8_t> half;  // 0: A, 1: B

    // Lanes `begin` to end - 1 become consecutive samples of a pixel, the first of which has an even or odd number.
    void fill(int begin, int end, std::uint32_t of_pixel, int first_sample) {
        pixel.fill(begin, end, of_pixel);
        for (int i = 0; i < whole_groups(end - begin); ++i) {
            half[begin + i] = static_cast<std::uint8_t>((first_sample + i) & 1);
        }
    }
};

class Accumulation {
public:
    // `emission_is_sampled`: where each sample sees another point. `light_level`: about the brightest radiance of the
    // scene; sums stay exact up to two million times it.
    Accumulation(int width, int height, const EstimationPlan& plan, bool emission_is_sampled, double light_level);

    // Adds what the paths that begin at `starts` found. `estimate` has to be that of the plan. Batches that are added
    // at the same time must not share pixels.
    void add(const SampleBatch& samples, const VertexBatch& starts, const BatchEstimate& estimate);
    // Adds a sample that met nothing: open sky.
    void add_background(std::size_t pixel, int half, const glm::vec3& emission);

    // Adds each plane with its half_a., half_b. and variance. to `frame`, and gives the sums' memory and that of
    // `exact` back as it goes: nothing may be asked afterwards. `samples` is the number per pixel, even. The mean of
    // `indirect` is the sum of the means of indirect.1, .2 and so on, that of `total` is emission + direct + indirect +
    // reflection, added in this order in float; of all others it is that of the halves.
    void write(const std::vector<StochasticPlane>& planes, int samples, ExactParts exact, Frame& frame);
    // RMS standard error of the plane over its RMS; 0 for a black plane. The same bits whatever the number of threads.
    double relative_error(const StochasticPlane& plane, int samples, const ExactParts& exact) const;
    // False once a sum has grown so large that its last bits depend on the order of the samples. Throws ReferenceError
    // for a sum that is no finite number.
    bool is_exact() const;

    std::span<double> values() { return sums_.values(); }
    std::span<const double> values() const { return sums_.values(); }

private:
    double* sums(std::size_t pixel, int half) {
        return &sums_[(2 * pixel + static_cast<std::size_t>(half)) * channels_];
    }
    const double* sums(std::size_t pixel, int half) const {
        return &sums_[(2 * pixel + static_cast<std::size_t>(half)) * channels_];
    }
    double rounded(float value) const { return (static_cast<double>(value) + rounding_) - rounding_; }
    static double rounded_visibility(float value) {
        constexpr double rounding = 0x1.8p52 * visibility_quantum;
        return (static_cast<double>(value) + rounding) - rounding;
    }
    void add_colour(double* sum, const glm::vec3& colour) const {
        sum[0] += rounded(colour.x), sum[1] += rounded(colour.y), sum[2] += rounded(colour.z);
    }
    // Both halves and the mean of a plane at a pixel.
    struct Value {
        glm::vec3 half_a, half_b, mean;
    };
    Value value(const StochasticPlane& plane, std::size_t pixel, int samples, const ExactParts& exact) const;

    int width_, height_;
    int bounces_;
    // First channel of each; -1: not summed.
    int ao_ = -1, emission_ = -1, direct_ = -1, indirect_ = -1, irradiance_ = -1, reflection_ = -1;
    std::size_t channels_ = 0;
    static constexpr double visibility_quantum = 0x1p-32;
    double quantum_, rounding_;  // a number so large that its last bit is worth a quantum
    ZeroedArray<double> sums_;
};

}  // namespace plumb
