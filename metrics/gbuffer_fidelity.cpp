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
#include "metrics/measure_blocks.h"
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

// How the errors of fidelity_planes are told, in their order, and from where on they are no agreement.
struct ErrorRule {
    double (*error)(std::span<const float> test, std::span<const float> reference);
    double GbufferFidelitySettings::*tolerance;  // null: does not count towards agreement
};
constexpr std::array<ErrorRule, fidelity_planes.size()> rules = {
    {{relative_difference, &GbufferFidelitySettings::depth_tolerance},
     {angle_degrees, &GbufferFidelitySettings::normal_tolerance},
     {largest_difference, &GbufferFidelitySettings::albedo_tolerance},
     {length_of_difference, nullptr}}};

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
        for (std::size_t i = 0; i < fidelity_planes.size(); ++i) {
            const std::string plane = fmt::format("{}{}", prefix_, fidelity_planes[i].plane);
            if (test_.has(plane) && reference_.has(plane)) compare(i, plane);
        }
        count_hits();
        if (settings_.keep_blocks) result_.blocks = std::move(blocks_);
        return std::move(result_);
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

    Estimate mean(const std::vector<BlockSum>& blocks) const {
        return settings_.intervals ? bootstrap_mean(blocks, settings_.bootstrap)
                                   : Estimate{mean_of(blocks), none, none};
    }

    void compare(std::size_t index, const std::string& plane) {
        const FidelityPlane& kind = fidelity_planes[index];
        const ErrorRule& rule = rules[index];
        const Image &test = test_.plane(plane), &reference = reference_.plane(plane);
        require_same_shape(test, reference, fmt::format("plane '{}'", plane));
        if (test.channels() != kind.channels) {
            throw ImageError(
                fmt::format("plane '{}' has {} channels; a G-buffer's has {}", plane, test.channels(), kind.channels));
        }
        ErrorDistribution& result = (result_.*kind.result).emplace();
        ErrorBlocks blocks;
        blocks.errors.resize(grid_.count());
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
            blocks.errors[grid_.block_of(x, y)].add(error);
            errors.at(x, y) = static_cast<float>(error);
        });
        result.mean = mean(blocks.errors);
        result.maximum = value_percentile(errors, 1.0);
        add_percentiles(errors, blocks, result);
        blocks_.errors.at(index) = std::move(blocks);
    }

    void add_percentiles(const Image& errors, ErrorBlocks& blocks, ErrorDistribution& result) const {
        QuantileCounter magnitudes;
        for (const float error : errors.values()) {
            if (!std::isnan(error)) magnitudes.add(error);
        }
        blocks.magnitudes = magnitudes.curve();
        for (std::size_t i = 0; i < error_percentiles.size(); ++i) {
            const double level = error_percentiles[i].level, percentile = value_percentile(errors, level);
            std::vector<BlockSum>& not_above = blocks.not_above.at(i);
            not_above.resize(grid_.count());
            for_each_pixel([&](int x, int y) {
                const float error = errors.at(x, y);
                if (!std::isnan(error)) not_above[grid_.block_of(x, y)].add(error <= percentile ? 1.0 : 0.0);
            });
            result.*error_percentiles[i].estimate =
                settings_.intervals ? percentile_interval(percentile, level, mean(not_above), blocks.magnitudes)
                                    : Estimate{percentile, none, none};
        }
    }

    void count_hits() {
        blocks_.hits.resize(grid_.count()), blocks_.agreeing.resize(grid_.count());
        for_each_pixel([&](int x, int y) {
            const bool test = is_surface(test_depth_.at(x, y)), reference = is_surface(reference_depth_.at(x, y));
            ++result_.pixels;
            result_.both_hit += test && reference;
            result_.only_test += test && !reference;
            result_.only_reference += reference && !test;
            const std::size_t block = grid_.block_of(x, y);
            blocks_.hits[block].add(test == reference ? 1.0 : 0.0);
            blocks_.agreeing[block].add(test == reference && agrees_.at(x, y) != 0.0f ? 1.0 : 0.0);
        });
        result_.hit_agreement = mean(blocks_.hits);
        result_.agreement = mean(blocks_.agreeing);
    }

    const Frame &test_, &reference_;
    std::string prefix_;
    const GbufferFidelitySettings& settings_;
    const Image &test_depth_, &reference_depth_;
    BlockGrid grid_;
    Image agrees_;  // 0 where a plane is off by more than its tolerance
    LayerFidelity result_;
    LayerBlocks blocks_;
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
    constexpr Estimate no_estimate{none, none, none};
    const ErrorDistribution missing{no_estimate, no_estimate, no_estimate, no_estimate, none, 0, 0};
    for (const FidelityPlane& kind : fidelity_planes) {
        const std::string name(kind.measure);
        const ErrorDistribution& errors = this->*kind.result ? *(this->*kind.result) : missing;
        add_estimate(name + "_mean", errors.mean);
        for (const ErrorPercentile& percentile : error_percentiles)
            add_estimate(fmt::format("{}_{}", name, percentile.name), errors.*percentile.estimate);
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
