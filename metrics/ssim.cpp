#include "metrics/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "frames/parallel.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

constexpr int radius = ssim_window / 2;
constexpr std::size_t margins = ssim_window - 1;  // left and right together
using Kernel = std::array<double, ssim_window>;
constexpr std::array scale_weights = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

Kernel gaussian() {
    constexpr double sigma = 1.5;
    Kernel kernel;
    double sum = 0;
    for (int i = 0; i < ssim_window; ++i) {
        const double x = i - radius;
        sum += kernel[i] = std::exp(-0.5 * x * x / (sigma * sigma));
    }
    for (double& weight : kernel) weight /= sum;
    return kernel;
}

// Mirrors with the edge doubled: -1 -> 0, size -> size - 1.
int mirrored(int index, int size) {
    if (index < 0) return -index - 1;
    return index >= size ? 2 * size - 1 - index : index;
}

// One channel of both images without the others in between, so that a row is contiguous.
struct Channel {
    Channel(const Image& image, int channel)
        : width(image.width()), height(image.height()), values(image.pixel_count()) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] =
                image.values()[i * static_cast<std::size_t>(image.channels()) + static_cast<std::size_t>(channel)];
        }
    }
    const float* row(int y) const {
        return values.data() + static_cast<std::size_t>(mirrored(y, height)) * static_cast<std::size_t>(width);
    }
    int width, height;
    std::vector<float> values;
};

enum class SsimPart { all, contrast_and_structure };

// Computes single rows of SSIM; owns the scratch memory of one thread. Filters down the columns first, which needs no
// more than one row of the five moments at a time.
class RowFilter {
public:
    RowFilter(int width, double data_range)
        : width_(width), c1_(0.01 * data_range * 0.01 * data_range), c2_(0.03 * data_range * 0.03 * data_range) {
        for (auto& row : columns_) row.resize(static_cast<std::size_t>(width) + margins);
        for (auto& row : moments_) row.resize(static_cast<std::size_t>(width));
    }

    void run(const Channel& test, const Channel& reference, int y, SsimPart part, std::span<double> result) {
        filter_columns(test, reference, y);
        for (int m = 0; m < 5; ++m) filter_row(columns_[m], moments_[m]);
        const bool all = part == SsimPart::all;
        for (std::size_t x = 0; x < result.size(); ++x) {
            const double v = moments_[0][x], r = moments_[1][x];
            const double variance_v = moments_[2][x] - v * v, variance_r = moments_[3][x] - r * r;
            const double covariance = moments_[4][x] - v * r;
            const double above = 2.0 * covariance + c2_, below = variance_v + variance_r + c2_;
            result[x] = all ? (2.0 * v * r + c1_) * above / ((v * v + r * r + c1_) * below) : above / below;
        }
    }

private:
    // E[v], E[r], E[v^2], E[r^2], E[vr] down each column, with mirrored margins left and right.
    void filter_columns(const Channel& test, const Channel& reference, int y) {
        for (auto& row : columns_) std::ranges::fill(row, 0.0);
        double* __restrict v1 = columns_[0].data() + radius;
        double* __restrict r1 = columns_[1].data() + radius;
        double* __restrict v2 = columns_[2].data() + radius;
        double* __restrict r2 = columns_[3].data() + radius;
        double* __restrict vr = columns_[4].data() + radius;
        for (int k = 0; k < ssim_window; ++k) {
            const float* __restrict test_row = test.row(y + k - radius);
            const float* __restrict reference_row = reference.row(y + k - radius);
            const double weight = kernel_[k];
            for (int x = 0; x < width_; ++x) {
                const double v = test_row[x], r = reference_row[x];
                v1[x] += weight * v;
                r1[x] += weight * r;
                v2[x] += weight * v * v;
                r2[x] += weight * r * r;
                vr[x] += weight * v * r;
            }
        }
        for (auto& row : columns_) {
            for (int i = 1; i <= radius; ++i) {
                row[radius - i] = row[radius + mirrored(-i, width_)];
                row[radius + width_ - 1 + i] = row[radius + mirrored(width_ - 1 + i, width_)];
            }
        }
    }

    void filter_row(const std::vector<double>& in, std::vector<double>& out) const {
        const double* __restrict source = in.data();
        double* __restrict target = out.data();
        for (int x = 0; x < width_; ++x) {
            double sum = 0;
            for (int k = 0; k < ssim_window; ++k) sum += kernel_[k] * source[x + k];
            target[x] = sum;
        }
    }

    int width_;
    double c1_, c2_;
    Kernel kernel_ = gaussian();
    std::array<std::vector<double>, 5> columns_, moments_;
};

void check(const Image& test, const Image& reference, double data_range) {
    require_same_shape(test, reference);
    if (test.width() < ssim_window || test.height() < ssim_window) {
        throw ImageError(fmt::format("SSIM needs images of at least {0}x{0} pixels, not {1}x{2}", ssim_window,
                                     test.width(), test.height()));
    }
    if (!(data_range > 0.0) || std::isinf(data_range)) {
        throw ImageError(fmt::format("SSIM needs a finite data range above zero, not {}", data_range));
    }
}

// Calls use(channel, y, values of the row) for every row of every channel, from many threads.
void for_each_row(const Image& test, const Image& reference, double data_range, SsimPart part,
                  const std::function<void(int, int, std::span<const double>)>& use) {
    for (int c = 0; c < test.channels(); ++c) {
        const Channel v(test, c), r(reference, c);
        constexpr int rows_at_once = 16;  // whose filter starts anew
        parallel_for((test.height() + rows_at_once - 1) / rows_at_once, [&](int block) {
            RowFilter filter(test.width(), data_range);
            std::vector<double> row(static_cast<std::size_t>(test.width()));
            const int end = std::min(test.height(), (block + 1) * rows_at_once);
            for (int y = block * rows_at_once; y < end; ++y) {
                filter.run(v, r, y, part, row);
                use(c, y, row);
            }
        });
    }
}

Ssim mean_over_windows(const Image& test, const Image& reference, double data_range, SsimPart part, const Image* mask) {
    struct Row {
        double sum = 0;
        std::size_t windows = 0, non_finite = 0;
    };
    // Summed per row first and in order of the rows afterwards: the same bits whatever the number of threads.
    std::vector<Row> rows(static_cast<std::size_t>(test.height()) * static_cast<std::size_t>(test.channels()));
    for_each_row(test, reference, data_range, part, [&](int c, int y, std::span<const double> values) {
        if (y < radius || y >= test.height() - radius) return;
        Row& row =
            rows[static_cast<std::size_t>(c) * static_cast<std::size_t>(test.height()) + static_cast<std::size_t>(y)];
        for (int x = radius; x < test.width() - radius; ++x) {
            if (!pixel_counts(mask, x, y)) continue;
            if (const double value = values[static_cast<std::size_t>(x)]; std::isfinite(value)) {
                row.sum += value;
                ++row.windows;
            } else {
                ++row.non_finite;
            }
        }
    });
    Ssim result;
    result.data_range = data_range;
    double sum = 0;
    for (const Row& row : rows) {
        sum += row.sum;
        result.windows += row.windows;
        result.non_finite_windows += row.non_finite;
    }
    result.mean =
        result.windows > 0 ? sum / static_cast<double>(result.windows) : std::numeric_limits<double>::quiet_NaN();
    return result;
}

// Means of two by two pixels; an odd last row or column is dropped.
Image half_size(const Image& image) {
    Image half(image.width() / 2, image.height() / 2, image.channels());
    for (int y = 0; y < half.height(); ++y) {
        for (int x = 0; x < half.width(); ++x) {
            for (int c = 0; c < half.channels(); ++c) {
                half.at(x, y, c) = 0.25f * (image.at(2 * x, 2 * y, c) + image.at(2 * x + 1, 2 * y, c) +
                                            image.at(2 * x, 2 * y + 1, c) + image.at(2 * x + 1, 2 * y + 1, c));
            }
        }
    }
    return half;
}

}  // namespace

Ssim ssim(const Image& test, const Image& reference, double data_range, const Image* mask) {
    check(test, reference, data_range);
    if (mask) require_mask_fits(*mask, test);
    return mean_over_windows(test, reference, data_range, SsimPart::all, mask);
}

double multi_scale_ssim(const Image& test, const Image& reference, double data_range) {
    check(test, reference, data_range);
    if (std::min(test.width(), test.height()) < multi_scale_ssim_least_side) {
        throw ImageError(fmt::format("multi-scale SSIM needs images of at least {0}x{0} pixels, not {1}x{2}",
                                     multi_scale_ssim_least_side, test.width(), test.height()));
    }
    Image v = test, r = reference;
    double product = 1.0;
    for (std::size_t scale = 0; scale < scale_weights.size(); ++scale) {
        const bool last = scale + 1 == scale_weights.size();
        const SsimPart part = last ? SsimPart::all : SsimPart::contrast_and_structure;
        product *=
            std::pow(std::max(0.0, mean_over_windows(v, r, data_range, part, nullptr).mean), scale_weights[scale]);
        if (!last) v = half_size(v), r = half_size(r);
    }
    return product;
}

Image ssim_map(const Image& test, const Image& reference, double data_range) {
    check(test, reference, data_range);
    Image map(test.width(), test.height(), test.channels());
    for_each_row(test, reference, data_range, SsimPart::all, [&](int c, int y, std::span<const double> values) {
        for (int x = 0; x < test.width(); ++x) {
            map.at(x, y, c) = static_cast<float>(values[static_cast<std::size_t>(x)]);
        }
    });
    return map;
}

}  // namespace plumb
