#include "experiments/mean_measures.h"

#include <cmath>

#include "experiments/no_value.h"

namespace plumb {

void MeanMeasures::add(const std::vector<std::pair<std::string, double>>& measures) {
    if (names_.empty()) names_.resize(measures.size()), sums_.resize(measures.size()), counts_.resize(measures.size());
    for (std::size_t i = 0; i < measures.size(); ++i) {
        names_[i] = measures[i].first;
        if (std::isnan(measures[i].second)) continue;
        sums_[i] += measures[i].second;
        ++counts_[i];
    }
}

std::vector<std::pair<std::string, double>> MeanMeasures::means() const {
    std::vector<std::pair<std::string, double>> result;
    double mse = no_value;
    for (std::size_t i = 0; i < names_.size(); ++i) {
        const double mean = counts_[i] > 0 ? sums_[i] / counts_[i] : no_value;
        if (names_[i] == "mse") mse = mean;
        result.emplace_back(names_[i], names_[i] == "rmse" ? std::sqrt(mse) : mean);
    }
    return result;
}

}  // namespace plumb
