#include "metrics/pixel_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

double square(double value) { return value * value; }

// Reorders `values`.
template <typename Value>
double percentile(std::vector<Value>& values, double p) {
    const double position = p * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::ptrdiff_t>(position);
    const auto nth = values.begin() + below;
    std::nth_element(values.begin(), nth, values.end());
    const double fraction = position - static_cast<double>(below);
    if (fraction == 0.0) return *nth;
    return std::lerp(static_cast<double>(*nth), static_cast<double>(*std::min_element(nth + 1, values.end())),
                     fraction);
}

}  // namespace

PixelErrors pixel_errors(const Image& test, const Image& reference, double peak, const Image* mask) {
    require_same_shape(test, reference);
    if (mask) require_mask_fits(*mask, test);
    if (!(peak > 0.0) || std::isinf(peak)) {
        throw ImageError(fmt::format("PSNR needs a finite peak above zero, not {}; give the data range", peak));
    }
    PixelErrors errors;
    errors.peak = peak;
    std::vector<double> magnitudes;
    magnitudes.reserve(test.values().size());
    double absolute = 0, squared = 0, signed_sum = 0, reference_sum = 0, pbrt = 0, tev = 0, falcor = 0;
    for (int y = 0; y < test.height(); ++y) {
        for (int x = 0; x < test.width(); ++x) {
            if (!pixel_counts(mask, x, y)) continue;
            for (int c = 0; c < test.channels(); ++c) {
                const double v = test.at(x, y, c), r = reference.at(x, y, c);
                const bool finite_v = std::isfinite(v), finite_r = std::isfinite(r);
                errors.non_finite_test += !finite_v;
                errors.non_finite_reference += !finite_r;
                if (!finite_v || !finite_r) {
                    ++errors.left_out;
                    continue;
                }
                const double difference = v - r;
                magnitudes.push_back(std::abs(difference));
                absolute += std::abs(difference);
                signed_sum += difference;
                reference_sum += r;
                squared += square(difference);
                pbrt += square(difference) / relative_weight_pbrt(r);
                tev += square(difference) / relative_weight_tev(r);
                falcor += square(difference) / relative_weight_falcor(r);
            }
        }
    }
    errors.values = magnitudes.size();
    if (errors.values == 0) {
        throw ImageError(
            fmt::format("nothing to compare in {}x{} pixels: {} values are not finite, all others are masked",
                        test.width(), test.height(), errors.left_out));
    }
    const auto count = static_cast<double>(errors.values);
    errors.mae = absolute / count;
    errors.bias = signed_sum / count;
    errors.reference_mean = reference_sum / count;
    errors.mse = squared / count;
    errors.rmse = std::sqrt(errors.mse);
    errors.relative_mse_pbrt = pbrt / count;
    errors.relative_mse_tev = tev / count;
    errors.relative_mse_falcor = falcor / count;
    errors.psnr =
        errors.mse > 0.0 ? 10.0 * std::log10(square(peak) / errors.mse) : std::numeric_limits<double>::infinity();
    errors.maximum = *std::ranges::max_element(magnitudes);
    errors.median = percentile(magnitudes, 0.5);
    errors.percentile_95 = percentile(magnitudes, 0.95);
    errors.percentile_99 = percentile(magnitudes, 0.99);
    return errors;
}

double value_percentile(const Image& image, double p, const Image* mask) {
    if (mask) require_mask_fits(*mask, image);
    if (!(p >= 0.0 && p <= 1.0)) throw ImageError(fmt::format("a percentile lies within 0..1, not at {}", p));
    std::vector<float> values;
    values.reserve(image.values().size());
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            if (!pixel_counts(mask, x, y)) continue;
            for (const float value : image.pixel(x, y)) {
                if (std::isfinite(value)) values.push_back(value);
            }
        }
    }
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : percentile(values, p);
}

}  // namespace plumb
