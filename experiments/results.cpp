#include "experiments/results.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/no_value.h"

namespace plumb {
namespace {

// An unbiased estimate may fall below zero where the error is lost in noise; its root is then zero.
double root(double mse) { return std::sqrt(std::max(0.0, mse)); }

}  // namespace

double ResultRow::rmse() const { return root(mse); }
double ResultRow::rmse_lower() const { return root(mse_lower); }
double ResultRow::rmse_upper() const { return root(mse_upper); }

double measure_named(const std::vector<std::pair<std::string, double>>& measures, std::string_view name) {
    const auto found = std::ranges::find(measures, name, &std::pair<std::string, double>::first);
    return found == measures.end() ? no_value : found->second;
}

std::string oracle_name(int layers) {
    if (layers == 0) return "oracle, all in view";
    return fmt::format("oracle, {} layer{}", layers, layers == 1 ? "" : "s");
}

std::string oracle_name_of_bounces(int bounces) {
    return fmt::format("oracle, {} bounce{}", bounces, bounces == 1 ? "" : "s");
}

}  // namespace plumb
