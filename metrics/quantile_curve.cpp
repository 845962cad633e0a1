#include "metrics/quantile_curve.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace plumb {
namespace {

constexpr std::size_t levels = 1000;
constexpr int bits_left_off = 13;                                       // of a float's 23 of fraction
constexpr std::size_t bins = std::size_t{255} << (23 - bits_left_off);  // all finite floats that are not negative

std::size_t bin_of(float value) { return std::bit_cast<std::uint32_t>(value) >> bits_left_off; }

// The middle of a bin; of the first, which holds zero, its lower end.
float value_in(std::size_t bin) {
    if (bin == 0) return 0.0f;
    const auto bits = static_cast<std::uint32_t>(bin) << bits_left_off;
    return std::bit_cast<float>(bits | (std::uint32_t{1} << (bits_left_off - 1)));
}

}  // namespace

double QuantileCurve::at(double level) const {
    if (values_.empty() || std::isnan(level)) return std::numeric_limits<double>::quiet_NaN();
    const double place = std::clamp(level, 0.0, 1.0) * levels;
    const auto below = std::min(static_cast<std::size_t>(place), levels - 1);
    return std::lerp(values_[below], values_[below + 1], place - static_cast<double>(below));
}

void QuantileCurve::average_in(const QuantileCurve& other, std::size_t weight) {
    if (other.values_.empty()) return;
    if (values_.empty()) {
        values_ = other.values_;
        return;
    }
    for (std::size_t i = 0; i < values_.size(); ++i)
        values_[i] += (other.values_[i] - values_[i]) / static_cast<double>(weight + 1);
}

QuantileCounter::QuantileCounter() : counts_(bins) {}

void QuantileCounter::add(float value) {
    // Rounding to float may make a large difference infinite.
    ++counts_[std::min(bin_of(value), bins - 1)];
    ++count_;
}

QuantileCurve QuantileCounter::curve() const {
    QuantileCurve curve;
    if (count_ == 0) return curve;
    curve.values_.reserve(levels + 1);
    std::size_t bin = 0, up_to = counts_[0];  // values in the bins so far
    for (std::size_t level = 0; level <= levels; ++level) {
        const auto rank = static_cast<std::size_t>(
            std::lround(static_cast<double>(level) / levels * static_cast<double>(count_ - 1)));
        while (up_to <= rank) up_to += counts_[++bin];
        curve.values_.push_back(value_in(bin));
    }
    return curve;
}

}  // namespace plumb
