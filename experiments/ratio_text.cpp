#include "experiments/ratio_text.h"

#include <cmath>

#include <fmt/format.h>

namespace plumb {
namespace {

constexpr int fewest_digits = 2, most_digits = 6;  // behind the point

std::string with_digits(double value, int digits) { return fmt::format("{:.{}f}", value, digits); }

bool is_rounded_to_one(double value, int digits) {
    constexpr double rounding = 1e-9;  // more than the logarithms of equal ratios leave
    return std::abs(value - 1.0) > rounding && with_digits(value, digits) == with_digits(1.0, digits);
}

}  // namespace

RatioText print_ratio(const RatioSummary& ratio) {
    if (!ratio.has_interval()) return {with_digits(ratio.mean, fewest_digits), "", ""};
    int digits = fewest_digits;
    while (digits < most_digits && (is_rounded_to_one(ratio.lower, digits) || is_rounded_to_one(ratio.upper, digits)))
        ++digits;
    return {with_digits(ratio.mean, digits), with_digits(ratio.lower, digits), with_digits(ratio.upper, digits)};
}

}  // namespace plumb
