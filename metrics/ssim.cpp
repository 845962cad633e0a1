#include "metrics/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
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

SsimMap::SsimMap(const Image& test, const Image& reference, double data_range, SsimPart part)
    : width_(test.width()), height_(test.height()), channels_(test.channels()), data_range_(data_range) {
    check(test, reference, data_range);
    values_.resize(test.values().size());
    for (int c = 0; c < channels_; ++c) {
        const Channel v(test, c), r(reference, c);
        constexpr int rows_at_once = 16;  // whose filter starts anew
        parallel_for((height_ + rows_at_once - 1) / rows_at_once, [&](int block) {
            RowFilter filter(width_, data_range);
            const int end = std::min(height_, (block + 1) * rows_at_once);
            for (int y = block * rows_at_once; y < end; ++y)
                filter.run(v, r, y, part, {values_.data() + index(0, y, c), static_cast<std::size_t>(width_)});
        });
    }
}

// Calls use(x, y, value) for every window that lies within the image and whose centre counts.
template <typename Use>
void SsimMap::for_each_window(const Image* mask, const Use& use) const {
    if (mask) require_mask_fits(*mask, Image(width_, height_, 1));
    for (int c = 0; c < channels_; ++c) {
        for (int y = radius; y < height_ - radius; ++y) {
            for (int x = radius; x < width_ - radius; ++x) {
                if (pixel_counts(mask, x, y)) use(x, y, values_[index(x, y, c)]);
            }
        }
    }
}

Ssim SsimMap::mean(const Image* mask) const {
    Ssim result;
    result.data_range = data_range_;
    double sum = 0;
    for_each_window(mask, [&](int, int, double value) {
        const bool finite = std::isfinite(value);
        sum += finite ? value : 0.0;
        ++(finite ? result.windows : result.non_finite_windows);
    });
    result.mean =
        result.windows > 0 ? sum / static_cast<double>(result.windows) : std::numeric_limits<double>::quiet_NaN();
    return result;
}

std::vector<BlockSum> SsimMap::block_sums(const BlockGrid& grid, const Image* mask, int scale) const {
    std::vector<BlockSum> blocks(grid.count());
    for_each_window(mask, [&](int x, int y, double value) {
        if (std::isfinite(value)) blocks[grid.block_of(x * scale, y * scale)].add(value);
    });
    return blocks;
}

Image SsimMap::image() const {
    Image map(width_, height_, channels_);
    for (int c = 0; c < channels_; ++c) {
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) map.at(x, y, c) = static_cast<float>(values_[index(x, y, c)]);
        }
    }
    return map;
}

MultiScaleSsim::MultiScaleSsim(const Image& test, const Image& reference, double data_range) {
    check(test, reference, data_range);
    if (std::min(test.width(), test.height()) < multi_scale_ssim_least_side) {
        throw ImageError(fmt::format("multi-scale SSIM needs images of at least {0}x{0} pixels, not {1}x{2}",
                                     multi_scale_ssim_least_side, test.width(), test.height()));
    }
    Image v = test, r = reference;
    for (std::size_t scale = 0; scale < scale_weights.size(); ++scale) {
        const bool last = scale + 1 == scale_weights.size();
        maps_.emplace_back(v, r, data_range, last ? SsimPart::all : SsimPart::contrast_and_structure);
        means_.push_back(maps_.back().mean().mean);
        if (!last) v = half_size(v), r = half_size(r);
    }
}

double MultiScaleSsim::value() const {
    double product = 1.0;
    for (std::size_t scale = 0; scale < means_.size(); ++scale)
        product *= std::pow(std::max(0.0, means_[scale]), scale_weights[scale]);
    return product;
}

std::vector<BlockSum> MultiScaleSsim::block_sums(const BlockGrid& grid) const {
    std::vector<BlockSum> blocks = maps_.front().block_sums(grid);
    double windows = 0.0;
    for (const BlockSum& block : blocks) windows += static_cast<double>(block.values);
    const double whole = value();
    for (BlockSum& block : blocks) block.sum = whole * static_cast<double>(block.values);
    int pixels = 1;
    for (std::size_t scale = 0; scale < maps_.size(); ++scale, pixels *= 2) {
        // The mean at this scale, if a block were drawn once more, moves the product by its share of the power.
        const std::vector<BlockSum> of_scale = maps_[scale].block_sums(grid, nullptr, pixels);
        double of_all = 0.0;
        for (const BlockSum& block : of_scale) of_all += static_cast<double>(block.values);
        const double mean = std::max(means_[scale], 1e-9);  // a product of zero moves nowhere
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            const double excess = of_scale[b].sum - means_[scale] * static_cast<double>(of_scale[b].values);
            blocks[b].sum += whole * scale_weights[scale] * windows * excess / (of_all * mean);
        }
    }
    return blocks;
}

Ssim ssim(const Image& test, const Image& reference, double data_range, const Image* mask) {
    check(test, reference, data_range);
    if (mask) require_mask_fits(*mask, test);
    return SsimMap(test, reference, data_range).mean(mask);
}

double multi_scale_ssim(const Image& test, const Image& reference, double data_range) {
    return MultiScaleSsim(test, reference, data_range).value();
}

}  // namespace plumb
