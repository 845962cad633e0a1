// Choice among weighted items.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace plumb {

// Chooses item i with probability weight[i] / sum, by inversion, so that a well spread `u` gives well spread choices.
class DiscreteDistribution {
public:
    DiscreteDistribution() = default;
    explicit DiscreteDistribution(std::span<const double> weights) {
        cumulative_.reserve(weights.size());
        double sum = 0.0;
        for (const double weight : weights) cumulative_.push_back(sum += weight);
        sum_ = sum;
        largest_target_ = std::nextafter(sum, 0.0);
    }

    // True where nothing has a weight: sample() must not be called.
    bool empty() const { return !(sum_ > 0.0); }
    double sum() const { return sum_; }

    // `u` in [0, 1). An item of weight 0 is never chosen.
    std::size_t sample(double u) const { return find(std::min(u * sum_, largest_target_)); }

    // The same; `within` is where in the item's share u fell, in [0, 1).
    std::size_t sample(double u, double& within) const {
        const double target = std::min(u * sum_, largest_target_);
        const std::size_t item = find(target);
        const double first = item == 0 ? 0.0 : cumulative_[item - 1];
        within = std::clamp((target - first) / (cumulative_[item] - first), 0.0, 0x1.fffffep-1);
        return item;
    }

    double probability(std::size_t item) const {
        return (cumulative_[item] - (item == 0 ? 0.0 : cumulative_[item - 1])) / sum_;
    }

private:
    // The first item whose cumulative weight exceeds the target: bisection without branches that could be mispredicted.
    std::size_t find(double target) const {
        const double* first = cumulative_.data();
        for (std::size_t length = cumulative_.size(); length > 1;) {
            const std::size_t half = length / 2;
            first += static_cast<std::size_t>(first[half - 1] <= target) * half;
            length -= half;
        }
        return static_cast<std::size_t>(first - cumulative_.data());
    }

    std::vector<double> cumulative_;
    double sum_ = 0.0;
    double largest_target_ = 0.0;  // u * sum may round up to the sum, beyond the last item
};

}  // namespace plumb
