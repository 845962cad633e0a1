#include "pathtracer/accumulation.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

namespace plumb {
namespace {

void add_colour(double* sums, const glm::vec3& colour) {
    sums[0] += colour.x, sums[1] += colour.y, sums[2] += colour.z;
}

}  // namespace

Accumulation::Accumulation(int width, int height, const EstimationPlan& plan, bool emission_is_sampled)
    : width_(width), height_(height), bounces_(plan.bounces) {
    int next = 0;
    const auto reserve = [&next](bool wanted, int channels) {
        const int first = wanted ? next : -1;
        if (wanted) next += channels;
        return first;
    };
    ao_ = reserve(plan.ao, 1);
    emission_ = reserve(emission_is_sampled, 3);
    direct_ = reserve(plan.direct, 3);
    indirect_ = reserve(plan.indirect, 3 * bounces_);
    irradiance_ = reserve(plan.irradiance, 3);
    channels_ = static_cast<std::size_t>(next);
    sums_.resize(channels_ * 2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

void Accumulation::add(std::size_t pixel, int sample, const glm::vec3& albedo, const glm::vec3& emission,
                       const PathEstimate& estimate) {
    double* sum = sums(pixel, sample & 1);
    if (ao_ >= 0) sum[ao_] += estimate.ambient_visibility;
    if (emission_ >= 0) add_colour(sum + emission_, emission);
    if (direct_ >= 0) add_colour(sum + direct_, albedo * estimate.radiance[0]);
    if (indirect_ < 0) return;
    glm::vec3 incoming(0.0f);
    for (int k = 1; k <= bounces_; ++k) {
        incoming += estimate.radiance[k];
        add_colour(sum + indirect_ + 3 * (k - 1), albedo * estimate.radiance[k]);
    }
    if (irradiance_ >= 0) add_colour(sum + irradiance_, glm::pi<float>() * incoming);
}

void Accumulation::add_background(std::size_t pixel, int sample, const glm::vec3& emission) {
    double* sum = sums(pixel, sample & 1);
    if (ao_ >= 0) sum[ao_] += 1.0;
    if (emission_ >= 0) add_colour(sum + emission_, emission);
}

glm::vec3 Accumulation::half_mean(const StochasticPlane& plane, std::size_t pixel, int half, int samples,
                                  const ExactParts& exact) const {
    using Kind = StochasticPlane::Kind;
    const double* sum = sums(pixel, half);
    const double scale = 2.0 / samples;
    const auto mean = [&](int first) {
        return glm::vec3(scale * sum[first], scale * sum[first + 1], scale * sum[first + 2]);
    };
    const auto emission = [&] {
        if (emission_ >= 0) return mean(emission_);
        return exact.emission.empty() ? glm::vec3(0.0f) : exact.emission[pixel];
    };
    const auto direct = [&] { return exact.direct.empty() ? mean(direct_) : mean(direct_) + exact.direct[pixel]; };
    const auto indirect = [&] {
        glm::vec3 colour(0.0f);
        for (int k = 1; k <= bounces_; ++k) colour += mean(indirect_ + 3 * (k - 1));
        return colour;
    };
    switch (plane.kind) {
        case Kind::ao:
            return glm::vec3(static_cast<float>(scale * sum[ao_]));
        case Kind::emission:
            return emission();
        case Kind::direct:
            return direct();
        case Kind::indirect_bounce:
            return mean(indirect_ + 3 * (plane.bounce - 1));
        case Kind::indirect:
            return indirect();
        case Kind::irradiance:
            return mean(irradiance_);
        case Kind::total:
            return emission() + direct() + indirect();
    }
    return glm::vec3(0.0f);
}

void Accumulation::write(const StochasticPlane& plane, int samples, const ExactParts& exact, Frame& frame) const {
    const int channels = plane.channels();
    Image& mean = frame.set(plane.name, Image(width_, height_, channels));
    Image& half_a = frame.set("half_a." + plane.name, Image(width_, height_, channels));
    Image& half_b = frame.set("half_b." + plane.name, Image(width_, height_, channels));
    Image& variance = frame.set("variance." + plane.name, Image(width_, height_, channels));
    tbb::parallel_for(0, height_, [&](int y) {
        for (int x = 0; x < width_; ++x) {
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
            const glm::vec3 a = half_mean(plane, pixel, 0, samples, exact),
                            b = half_mean(plane, pixel, 1, samples, exact);
            for (int c = 0; c < channels; ++c) {
                half_a.at(x, y, c) = a[c];
                half_b.at(x, y, c) = b[c];
                mean.at(x, y, c) = 0.5f * (a[c] + b[c]);
                variance.at(x, y, c) = 0.25f * (a[c] - b[c]) * (a[c] - b[c]);
            }
        }
    });
}

double Accumulation::relative_error(const StochasticPlane& plane, int samples, const ExactParts& exact) const {
    struct Row {
        double variance = 0.0, square = 0.0;
    };
    std::vector<Row> rows(static_cast<std::size_t>(height_));
    tbb::parallel_for(0, height_, [&](int y) {
        Row& row = rows[static_cast<std::size_t>(y)];
        for (int x = 0; x < width_; ++x) {
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
            const glm::dvec3 a = half_mean(plane, pixel, 0, samples, exact),
                             b = half_mean(plane, pixel, 1, samples, exact);
            const glm::dvec3 half_difference = 0.5 * (a - b), mean = 0.5 * (a + b);
            row.variance += glm::dot(half_difference, half_difference);
            // The noise in the square of the mean is taken off, so that a dark plane does not look brighter than it is.
            row.square += glm::dot(mean, mean) - glm::dot(half_difference, half_difference);
        }
    });
    double variance = 0.0, square = 0.0;
    for (const Row& row : rows) variance += row.variance, square += row.square;
    if (variance == 0.0) return 0.0;
    return square > 0.0 ? std::sqrt(variance / square) : HUGE_VAL;
}

}  // namespace plumb
