// Choice among weighted items.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pathtracer/lanes.h"

namespace plumb {

// Chooses item i with probability weight[i] / sum, by inversion, so that a well spread `u` gives well spread choices.
class DiscreteDistribution {
public:
    DiscreteDistribution() = default;
    explicit DiscreteDistribution(std::span<const double> weights) {
        cumulative_.reserve(weights.size() + 1);
        cumulative_.push_back(0.0);
        for (const double weight : weights) cumulative_.push_back(cumulative_.back() + weight);
        sum_ = cumulative_.back();
        largest_target_ = std::nextafter(sum_, 0.0);
    }

    // True where nothing has a weight: sample() must not be called.
    bool empty() const { return !(sum_ > 0.0); }
    double sum() const { return sum_; }

    // `u` in [0, 1). An item of weight 0 is never chosen. The first item whose share ends beyond u: bisection without
    // branches that could be mispredicted.
    PLUMBLINE_INLINE std::size_t sample(double u) const {
        const double at = target(u);
        const double* first = cumulative_.data() + 1;
        for (std::size_t length = cumulative_.size() - 1; length > 1;) {
            const std::size_t half = length / 2;
            first += static_cast<std::size_t>(first[half - 1] <= at) * half;
            length -= half;
        }
        return static_cast<std::size_t>(first - cumulative_.data()) - 1;
    }

    // sample(2^-32 u) of the first `count` lanes. A few items are counted for all lanes together: bisection takes each
    // lane by itself.
    void sample(const Lanes<std::uint32_t>& u, int count, Lanes<std::uint32_t>& items) const {
        constexpr std::size_t few = 8;
        const std::size_t size = cumulative_.size() - 1;
        const int end = whole_groups(count);
        if (size > few) {
            for (int i = 0; i < end; ++i) items[i] = static_cast<std::uint32_t>(sample(0x1p-32 * u[i]));
            return;
        }
        items.fill(0, count, 0);
        for (std::size_t item = 0; item + 1 < size; ++item) {
            const double share_ends = cumulative_[item + 1];
            for (int i = 0; i < end; ++i) items[i] += share_ends <= target(0x1p-32 * u[i]) ? 1 : 0;
        }
    }

    // Where in the share of `item`, which sample(u) chose, u fell: in [0, 1). Without branches, for loops over lanes.
    PLUMBLINE_INLINE double within(double u, std::size_t item) const {
        const double first = cumulative_[item];
        return std::min((target(u) - first) / (cumulative_[item + 1] - first), 0x1.fffffep-1);
    }

    double probability(std::size_t item) const { return (cumulative_[item + 1] - cumulative_[item]) / sum_; }

private:
    PLUMBLINE_INLINE double target(double u) const { return std::min(u * sum_, largest_target_); }

    std::vector<double> cumulative_;  // of the items before each, and of all
    double sum_ = 0.0;
    double largest_target_ = 0.0;  // u * sum may round up to the sum, beyond the last item
};

}  // namespace plumb
