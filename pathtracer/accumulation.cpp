#include "pathtracer/accumulation.h"

#include <algorithm>
#include <cmath>
#include <new>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "frames/parallel.h"
#include "pathtracer/reference_error.h"

namespace plumb {
namespace {

// From the variances of the means and from their squares less these: the noise in the square of a mean is taken off, so
// that a dark plane does not look brighter than it is.
double error_ratio(double variance, double square) {
    if (variance == 0.0) return 0.0;
    return square > 0.0 ? std::sqrt(variance / square) : HUGE_VAL;
}

}  // namespace

Accumulation::Accumulation(int width, int height, const EstimationPlan& plan, bool emission_is_sampled,
                           double light_level)
    : width_(width), height_(height), bounces_(plan.indirect ? plan.bounces : 0) {
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
    reflection_ = reserve(plan.reflection, 3);
    channels_ = static_cast<std::size_t>(next);
    const std::size_t size = channels_ * 2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    try {
        sums_ = ZeroedArray<double>(size);
    } catch (const std::bad_alloc&) {
        throw ReferenceError(fmt::format(
            "the sums of {}x{} pixels over {} bounces need {:.1f} GiB, which this machine does not give; ask "
            "for fewer bounces, planes or pixels",
            width, height, bounces_, static_cast<double>(size * sizeof(double)) / 0x1p30));
    }
    // 2^-32 of the light level: a sample of a thousandth of it is off by 1e-7 of itself, one as likely up as down. The
    // ambient visibility, at most 1, has a quantum of its own, however dim the scene.
    quantum_ = std::exp2(std::ceil(std::log2(light_level > 0.0 ? light_level : 1.0)) - 32.0);
    rounding_ = 0x1.8p52 * quantum_;
}

void Accumulation::add(const SampleBatch& samples, const VertexBatch& starts, const BatchEstimate& estimate) {
    const int count = starts.count;
    if (ao_ >= 0) {
        for (int i = 0; i < count; ++i) {
            sums(samples.pixel[i], samples.half[i])[ao_] += rounded_visibility(estimate.ambient_visibility[i]);
        }
    }
    if (channels_ == (ao_ >= 0 ? 1u : 0u)) return;
    for (int i = 0; i < count; ++i) {
        double* sum = sums(samples.pixel[i], samples.half[i]);
        if (emission_ >= 0) add_colour(sum + emission_, starts.emission.get(i));
        if (reflection_ >= 0) add_colour(sum + reflection_, estimate.reflection.get(i));
        const glm::vec3 albedo = starts.albedo.get(i);
        if (direct_ >= 0) add_colour(sum + direct_, albedo * estimate.radiance[0].get(i));
        if (indirect_ < 0) continue;
        glm::vec3 incoming(0.0f);
        double* bounce_sum = sum + indirect_;
        for (int k = 1; k <= bounces_; ++k, bounce_sum += 3) {
            const glm::vec3 radiance = estimate.radiance[k].get(i);
            incoming += radiance;
            add_colour(bounce_sum, albedo * radiance);
        }
        if (irradiance_ >= 0) add_colour(sum + irradiance_, glm::pi<float>() * incoming);
    }
}

void Accumulation::add_background(std::size_t pixel, int half, const glm::vec3& emission) {
    double* sum = sums(pixel, half);
    if (ao_ >= 0) sum[ao_] += 1.0;
    if (emission_ >= 0) add_colour(sum + emission_, emission);
}

bool Accumulation::is_exact() const {
    constexpr double largest_count = 0x1p53;  // of quanta
    bool exact = true;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        if (!std::isfinite(sums_[i])) {
            const std::size_t pixel = i / (2 * channels_), width = static_cast<std::size_t>(width_);
            throw ReferenceError(
                fmt::format("a sample of pixel ({}, {}) is {}, no finite number; look for what it sees whose light, "
                            "colour, normal or texture is none, or brighter than single precision tells",
                            pixel % width, pixel / width, sums_[i]));
        }
        const bool is_visibility = ao_ >= 0 && i % channels_ == static_cast<std::size_t>(ao_);
        exact = exact && sums_[i] < largest_count * (is_visibility ? visibility_quantum : quantum_);
    }
    return exact;
}

Accumulation::Value Accumulation::value(const StochasticPlane& plane, std::size_t pixel, int samples,
                                        const ExactParts& exact) const {
    using Kind = StochasticPlane::Kind;
    const double scale = 2.0 / samples;
    const auto from_halves = [](const glm::vec3& a, const glm::vec3& b) { return Value{a, b, 0.5f * (a + b)}; };
    const auto summed = [&](int first, const glm::vec3& always = glm::vec3(0.0f)) {
        const double *a = sums(pixel, 0) + first, *b = sums(pixel, 1) + first;
        return from_halves(always + glm::vec3(scale * a[0], scale * a[1], scale * a[2]),
                           always + glm::vec3(scale * b[0], scale * b[1], scale * b[2]));
    };
    const auto added = [](const Value& one, const Value& other) {
        return Value{one.half_a + other.half_a, one.half_b + other.half_b, one.mean + other.mean};
    };
    const auto constant = [](const ZeroedArray<glm::vec3>& image, std::size_t at) {
        return image.empty() ? glm::vec3(0.0f) : image[at];
    };
    const auto emission = [&] {
        const glm::vec3 same = constant(exact.emission, pixel);
        return emission_ >= 0 ? summed(emission_) : from_halves(same, same);
    };
    const auto direct = [&] { return summed(direct_, constant(exact.direct, pixel)); };
    const auto indirect = [&] {
        Value sum{};
        for (int k = 1; k <= bounces_; ++k) sum = added(sum, summed(indirect_ + 3 * (k - 1)));
        return sum;
    };
    switch (plane.kind) {
        case Kind::ao: {
            const auto a = static_cast<float>(scale * sums(pixel, 0)[ao_]);
            const auto b = static_cast<float>(scale * sums(pixel, 1)[ao_]);
            return from_halves(glm::vec3(a), glm::vec3(b));
        }
        case Kind::emission:
            return emission();
        case Kind::direct:
            return direct();
        case Kind::indirect_bounce:
            return summed(indirect_ + 3 * (plane.bounce - 1));
        case Kind::indirect:
            return indirect();
        case Kind::irradiance:
            return summed(irradiance_);
        case Kind::reflection:
            return reflection_ >= 0 ? summed(reflection_) : Value{};
        case Kind::total: {
            const Value diffuse = added(added(emission(), direct()), indirect());
            return reflection_ >= 0 ? added(diffuse, summed(reflection_)) : diffuse;
        }
    }
    return {};
}

void Accumulation::write(const std::vector<StochasticPlane>& planes, int samples, ExactParts exact, Frame& frame) {
    struct Target {
        const StochasticPlane& plane;
        Image &mean, &half_a, &half_b, &variance;
    };
    std::vector<Target> targets;
    for (const StochasticPlane& plane : planes) {
        const auto image = [&](const char* prefix) -> Image& {
            return frame.set(prefix + plane.name, Image(width_, height_, plane.channels()));
        };
        targets.push_back({plane, image(""), image("half_a."), image("half_b."), image("variance.")});
    }
    const auto write_pixel = [&](const Target& target, int x, int y) {
        const Value at = value(
            target.plane, static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x),
            samples, exact);
        for (int c = 0; c < target.plane.channels(); ++c) {
            const float difference = at.half_a[c] - at.half_b[c];
            target.half_a.at(x, y, c) = at.half_a[c];
            target.half_b.at(x, y, c) = at.half_b[c];
            target.mean.at(x, y, c) = at.mean[c];
            target.variance.at(x, y, c) = 0.25f * difference * difference;
        }
    };
    // Planes take as much memory as the sums: band by band, so that there are never both.
    constexpr int band = 32;
    const auto give_rows_back = [&](auto& values, std::size_t row, int first, int end) {
        if (!values.empty())
            values.give_back(row * static_cast<std::size_t>(first), row * static_cast<std::size_t>(end));
    };
    const auto row = static_cast<std::size_t>(width_);
    for (int top = 0; top < height_; top += band) {
        const int end = std::min(height_, top + band);
        parallel_for(end - top, [&](int y) {
            for (const Target& target : targets) {
                for (int x = 0; x < width_; ++x) write_pixel(target, x, top + y);
            }
        });
        give_rows_back(sums_, 2 * channels_ * row, top, end);
        give_rows_back(exact.emission, row, top, end);
        give_rows_back(exact.direct, row, top, end);
    }
    sums_ = {};
}

double Accumulation::relative_error(const StochasticPlane& plane, int samples, const ExactParts& exact) const {
    struct Row {
        double variance = 0.0, square = 0.0;
    };
    std::vector<Row> rows(static_cast<std::size_t>(height_));
    parallel_for(height_, [&](int y) {
        Row& row = rows[static_cast<std::size_t>(y)];
        for (int x = 0; x < width_; ++x) {
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
            const Value at = value(plane, pixel, samples, exact);
            const glm::dvec3 a = at.half_a, b = at.half_b;
            const glm::dvec3 half_difference = 0.5 * (a - b), mean = 0.5 * (a + b);
            row.variance += glm::dot(half_difference, half_difference);
            row.square += glm::dot(mean, mean) - glm::dot(half_difference, half_difference);
        }
    });
    double variance = 0.0, square = 0.0;
    for (const Row& row : rows) variance += row.variance, square += row.square;
    return error_ratio(variance, square);
}

double relative_standard_error(const Frame& frame, const std::string& plane) {
    double variance = 0.0, square = 0.0;
    for (const float value : frame.plane("variance." + plane).values()) variance += value;
    for (const float value : frame.plane(plane).values()) square += static_cast<double>(value) * value;
    return error_ratio(variance, square - variance);
}

}  // namespace plumb
