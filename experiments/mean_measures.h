#pragma once

#include <string>
#include <utility>
#include <vector>

namespace plumb {

// Means over frames of named measures, those frames left out where a measure is NaN. The root mean squared error is the
// root of the mean squared one. Every frame must name the same measures in the same order.
class MeanMeasures {
public:
    void add(const std::vector<std::pair<std::string, double>>& measures);

    // In the order of the measures; NaN where no frame had a value.
    std::vector<std::pair<std::string, double>> means() const;

private:
    std::vector<std::string> names_;
    std::vector<double> sums_;
    std::vector<int> counts_;
};

}  // namespace plumb
