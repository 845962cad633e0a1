#include "metrics/gbuffer_fidelity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "frames/image_error.h"
#include "metrics/pixel_errors.h"
#include "metrics/shape.h"
#include "metrics/surface_motion.h"

namespace plumb {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double relative_difference(std::span<const float> test, std::span<const float> reference) {
    return std::abs(double{test[0]} - reference[0]) / reference[0];
}

// By both the sine and the cosine, which is exact for small angles too, and for vectors of any length.
double angle_degrees(std::span<const float> a, std::span<const float> b) {
    const double x = double{a[1]} * b[2] - double{a[2]} * b[1], y = double{a[2]} * b[0] - double{a[0]} * b[2],
                 z = double{a[0]} * b[1] - double{a[1]} * b[0];
    const double cosine = double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
    return std::atan2(std::hypot(x, y, z), cosine) * 180.0 / std::numbers::pi;
}

double largest_difference(std::span<const float> a, std::span<const float> b) {
    double largest = 0.0;
    for (std::size_t c = 0; c < a.size(); ++c) {
        const double difference = std::abs(double{a[c]} - b[c]);
        if (!(difference <= largest)) largest = difference;  // also takes a NaN
        if (std::isnan(largest)) return largest;
    }
    return largest;
}

double length_of_difference(std::span<const float> a, std::span<const float> b) {
    return std::hypot(double{a[0]} - b[0], double{a[1]} - b[1]);
}

// How one plane of a layer is compared.
struct PlaneRule {
    std::string_view plane;
    int channels;
    double (*error)(std::span<const float> test, std::span<const float> reference);
    std::optional<ErrorDistribution> LayerFidelity::*result;
    double GbufferFidelitySettings::*tolerance;  // null: does not count towards agreement
};
constexpr PlaneRule rules[] = {
    {"depth", 1, relative_difference, &LayerFidelity::depth, &GbufferFidelitySettings::depth_tolerance},
    {"normal", 3, angle_degrees, &LayerFidelity::normal, &GbufferFidelitySettings::normal_tolerance},
    {"albedo", 3, largest_difference, &LayerFidelity::albedo, &GbufferFidelitySettings::albedo_tolerance},
    {"motion", 2, length_of_difference, &LayerFidelity::motion, nullptr},
};

std::string prefix_of(int layer) { return layer == 1 ? "" : fmt::format("layer{}.", layer); }

// Compares one layer of two frames.
class LayerComparison {
public:
    LayerComparison(const Frame& test, const Frame& reference, int layer, const GbufferFidelitySettings& settings)
        : test_(test),
          reference_(reference),
          prefix_(prefix_of(layer)),
          settings_(settings),
          test_depth_(test.plane(prefix_ + "depth")),
          reference_depth_(reference.plane(prefix_ + "depth")),
          grid_(test_depth_.width(), test_depth_.height(), settings.bootstrap.block_size, settings.mask),
          agrees_(test_depth_.width(), test_depth_.height(), 1, 1.0f) {
        require_same_shape(test_depth_, reference_depth_, fmt::format("plane '{}depth'", prefix_));
        result_.layer = fmt::format("layer{}", layer);
    }

    LayerFidelity run() {
        for (const PlaneRule& rule : rules) {
            const std::string plane = fmt::format("{}{}", prefix_, rule.plane);
            if (test_.has(plane) && reference_.has(plane)) result_.*rule.result = compare(rule, plane);
        }
        count_hits();
        return result_;
    }

private:
    bool both_hit(int x, int y) const {
        return is_surface(test_depth_.at(x, y)) && is_surface(reference_depth_.at(x, y));
    }

    template <typename Use>
    void for_each_pixel(const Use& use) const {
        for (int y = 0; y < test_depth_.height(); ++y) {
            for (int x = 0; x < test_depth_.width(); ++x) {
                if (pixel_counts(settings_.mask, x, y)) use(x, y);
            }
        }
    }

    ErrorDistribution compare(const PlaneRule& rule, const std::string& plane) {
        const Image &test = test_.plane(plane), &reference = reference_.plane(plane);
        require_same_shape(test, reference, fmt::format("plane '{}'", plane));
        if (test.channels() != rule.channels) {
            throw ImageError(
                fmt::format("plane '{}' has {} channels; a G-buffer's has {}", plane, test.channels(), rule.channels));
        }
        ErrorDistribution result;
        std::vector<BlockSum> blocks(grid_.count());
        Image errors(test.width(), test.height(), 1, std::numeric_limits<float>::quiet_NaN());
        for_each_pixel([&](int x, int y) {
            if (!both_hit(x, y)) return;
            const double error = rule.error(test.pixel(x, y), reference.pixel(x, y));
            if (rule.tolerance && !(error <= settings_.*rule.tolerance)) agrees_.at(x, y) = 0.0f;
            if (!std::isfinite(error)) {
                ++result.left_out;
                return;
            }
            ++result.values;
            blocks[grid_.block_of(x, y)].add(error);
            errors.at(x, y) = static_cast<float>(error);
        });
        result.mean = bootstrap_mean(std::move(blocks), settings_.bootstrap);
        result.median = value_percentile(errors, 0.5);
        result.percentile_95 = value_percentile(errors, 0.95);
        result.percentile_99 = value_percentile(errors, 0.99);
        result.maximum = value_percentile(errors, 1.0);
        return result;
    }

    void count_hits() {
        std::vector<BlockSum> hits(grid_.count()), agreeing(grid_.count());
        for_each_pixel([&](int x, int y) {
            const bool test = is_surface(test_depth_.at(x, y)), reference = is_surface(reference_depth_.at(x, y));
            ++result_.pixels;
            result_.both_hit += test && reference;
            result_.only_test += test && !reference;
            result_.only_reference += reference && !test;
            const std::size_t block = grid_.block_of(x, y);
            hits[block].add(test == reference ? 1.0 : 0.0);
            agreeing[block].add(test == reference && agrees_.at(x, y) != 0.0f ? 1.0 : 0.0);
        });
        result_.hit_agreement = bootstrap_mean(std::move(hits), settings_.bootstrap);
        result_.agreement = bootstrap_mean(std::move(agreeing), settings_.bootstrap);
    }

    const Frame &test_, &reference_;
    std::string prefix_;
    const GbufferFidelitySettings& settings_;
    const Image &test_depth_, &reference_depth_;
    BlockGrid grid_;
    Image agrees_;  // 0 where a plane is off by more than its tolerance
    LayerFidelity result_;
};

}  // namespace

std::vector<std::pair<std::string, double>> LayerFidelity::measures() const {
    std::vector<std::pair<std::string, double>> list;
    const auto add_estimate = [&](const std::string& name, const Estimate& estimate) {
        list.emplace_back(name, estimate.value);
        list.emplace_back(name + "_lower", estimate.lower);
        list.emplace_back(name + "_upper", estimate.upper);
    };
    add_estimate("hit_agreement", hit_agreement);
    add_estimate("agreement", agreement);
    const ErrorDistribution missing{{none, none, none}, none, none, none, none, 0, 0};
    for (const auto& [name, distribution] :
         {std::pair<std::string, const std::optional<ErrorDistribution>&>{"depth_error", depth},
          {"normal_angle", normal},
          {"albedo_error", albedo},
          {"motion_error", motion}}) {
        const ErrorDistribution& errors = distribution ? *distribution : missing;
        add_estimate(name + "_mean", errors.mean);
        list.emplace_back(name + "_median", errors.median);
        list.emplace_back(name + "_p95", errors.percentile_95);
        list.emplace_back(name + "_p99", errors.percentile_99);
        list.emplace_back(name + "_maximum", errors.maximum);
    }
    return list;
}

const std::vector<std::string>& fidelity_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const auto& [name, value] : LayerFidelity{}.measures()) list.push_back(name);
        return list;
    }();
    return names;
}

std::vector<std::pair<std::string, double>> fidelity_over_frames(
    const std::vector<std::vector<std::pair<std::string, double>>>& frames) {
    std::vector<std::pair<std::string, double>> result;
    std::vector<double> counts;  // of the frames that have the measure
    for (const auto& frame : frames) {
        for (const auto& [name, value] : frame) {
            const auto known = std::ranges::find(result, name, &std::pair<std::string, double>::first);
            const auto place = static_cast<std::size_t>(known - result.begin());
            if (known == result.end()) result.emplace_back(name, 0.0), counts.push_back(0.0);
            if (std::isnan(value)) continue;
            double& so_far = result[place].second;
            so_far = !name.ends_with("maximum") ? so_far + value
                     : counts[place] > 0.0      ? std::max(so_far, value)
                                                : value;
            counts[place] += 1.0;
        }
    }
    for (std::size_t i = 0; i < result.size(); ++i) {
        auto& [name, value] = result[i];
        if (counts[i] == 0.0 || name.ends_with("_lower") || name.ends_with("_upper"))
            value = none;
        else if (!name.ends_with("maximum"))
            value /= counts[i];
    }
    return result;
}

bool has_gbuffer(const Frame& test, const Frame& reference) { return test.has("depth") && reference.has("depth"); }

std::vector<LayerFidelity> gbuffer_fidelity(const Frame& test, const Frame& reference,
                                            const GbufferFidelitySettings& settings) {
    if (!has_gbuffer(test, reference)) {
        throw ImageError(
            fmt::format("G-buffers are compared where both frames have a plane 'depth'; these have {} and {}",
                        fmt::join(test.plane_names(), ", "), fmt::join(reference.plane_names(), ", ")));
    }
    std::vector<LayerFidelity> layers;
    for (int layer = 1;; ++layer) {
        const std::string depth = prefix_of(layer) + "depth";
        if (!test.has(depth) || !reference.has(depth)) return layers;
        layers.push_back(LayerComparison(test, reference, layer, settings).run());
    }
}

}  // namespace plumb
