#include "experiments/results.h"

#include <algorithm>
#include <cmath>

namespace plumb {
namespace {

// An unbiased estimate may fall below zero where the error is lost in noise; its root is then zero.
double root(double mse) { return std::sqrt(std::max(0.0, mse)); }

}  // namespace

double ResultRow::rmse() const { return root(mse); }
double ResultRow::rmse_lower() const { return root(mse_lower); }
double ResultRow::rmse_upper() const { return root(mse_upper); }

}  // namespace plumb
