#include "metrics/student.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace plumb {

// 97.5 % quantiles of Student's t for 1 to 30 degrees of freedom (any table of it); beyond, Cornish and Fisher's first
// two terms, which are within 1e-4.
double student_t(int degrees) {
    constexpr std::array table = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                  2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                                  2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
    if (degrees <= static_cast<int>(table.size())) return table[static_cast<std::size_t>(degrees) - 1];
    constexpr double z = 1.959964;
    return z + (z * z * z + z) / (4.0 * degrees) +
           (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96.0 * degrees * degrees);
}

Estimate student_mean(const std::vector<double>& values) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN(),
                     infinity = std::numeric_limits<double>::infinity();
    if (values.empty()) return {none, none, none};
    const auto count = static_cast<double>(values.size());
    double sum = 0.0, squares = 0.0;
    for (const double value : values) sum += value;
    const double mean = sum / count;
    if (values.size() == 1) return {mean, -infinity, infinity};
    for (const double value : values) squares += (value - mean) * (value - mean);
    const double reach = student_t(static_cast<int>(values.size()) - 1) * std::sqrt(squares / (count - 1.0) / count);
    return {mean, mean - reach, mean + reach};
}

}  // namespace plumb
