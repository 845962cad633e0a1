// The quantiles of many values at once, from one pass over them: what intervals of percentiles are read from.
//
// Values above zero are counted by sign, exponent and the ten leading bits of the fraction, so that a quantile is known
// to within a thousandth of itself; kept at a thousand levels, linear between. Curves of several images have a mean,
// level by level. Good for: the ends of intervals. Bad for: the percentiles themselves; pixel_errors() has those
// exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb {

class QuantileCurve {
public:
    // Without values: NaN everywhere.
    QuantileCurve() = default;

    // Below which the fraction `level` of the values lies; levels beyond 0 and 1 are taken as those.
    double at(double level) const;

    // Levels of the mean of this curve, taken `weight` times, and `other`; a curve without values has no weight.
    void average_in(const QuantileCurve& other, std::size_t weight);

private:
    friend class QuantileCounter;
    std::vector<double> values_;  // at equally spaced levels
};

class QuantileCounter {
public:
    QuantileCounter();

    void add(float value);  // finite, not below zero
    QuantileCurve curve() const;

private:
    std::vector<std::uint32_t> counts_;
    std::size_t count_ = 0;
};

}  // namespace plumb
