#include "metrics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include "frames/image_error.h"
#include "frames/parallel.h"
#include "frames/tone_map.h"
#include "metrics/flip_colour.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

constexpr double feature_width = 0.082;  // w, degrees
constexpr int rows_at_once = 64;         // of a block that one thread filters
constexpr double nearly_white = 0.85;    // tone-mapped
constexpr double aces_exposure = 0.6;    // of the source, before its tone mapper

// Weights for offsets -radius..radius.
struct Kernel {
    int radius = 0;
    std::vector<float> weights;

    template <typename Weight>
    Kernel(int reach, const Weight& weight) : radius(reach) {
        for (int i = -reach; i <= reach; ++i) weights.push_back(static_cast<float>(weight(i)));
    }
};

double gaussian(double x, double sigma) { return std::exp(-0.5 * x * x / (sigma * sigma)); }

// With a sum of 1. Beyond six sigma a weight is below 2e-8, which no sum of floats feels.
Kernel gaussian_kernel(int radius, double sigma) {
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i) sum += gaussian(i, sigma);
    return {std::min(radius, static_cast<int>(std::ceil(6.0 * sigma))),
            [&](int i) { return gaussian(i, sigma) / sum; }};
}

// The weights of `shape`, those above zero made to sum to 1 and those below to -1.
template <typename Shape>
Kernel balanced_kernel(int radius, const Shape& shape) {
    double above = 0.0, below = 0.0;
    for (int i = -radius; i <= radius; ++i) (shape(i) > 0.0 ? above : below) += std::abs(shape(i));
    return {radius, [&, above, below](int i) { return shape(i) / (shape(i) > 0.0 ? above : below); }};
}

// A term of a contrast sensitivity's filter: scale sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct SensitivityTerm {
    double scale, b;
    double sigma(double pixels_per_degree) const { return pixels_per_degree * std::sqrt(0.5 * b) / std::numbers::pi; }
    // What the term sums to in both dimensions, up to a factor that all terms share.
    double sum(int radius, double pixels_per_degree) const {
        double along = 0.0;
        for (int i = -radius; i <= radius; ++i) along += gaussian(i, sigma(pixels_per_degree));
        return scale * std::sqrt(std::numbers::pi / b) * along * along;
    }
};
constexpr SensitivityTerm lightness_term{1.0, 0.0047}, red_green_term{1.0, 0.0053}, blue_yellow_narrow{34.1, 0.04},
    blue_yellow_wide{13.5, 0.025};

// One filter is a kernel along the rows and one along the columns; the eye's and the features' are sums of such.
struct Filters {
    explicit Filters(double pixels_per_degree) {
        const int reach = static_cast<int>(
            std::ceil(3.0 * blue_yellow_narrow.sigma(pixels_per_degree)));  // of the widest, as the source
        const auto eye = [&](const SensitivityTerm& term) {
            return gaussian_kernel(reach, term.sigma(pixels_per_degree));
        };
        const double narrow = blue_yellow_narrow.sum(reach, pixels_per_degree),
                     wide = blue_yellow_wide.sum(reach, pixels_per_degree);
        lightness.push_back(eye(lightness_term));
        red_green.push_back(eye(red_green_term));
        blue_yellow = {eye(blue_yellow_narrow), eye(blue_yellow_wide)};
        blue_yellow_shares = {static_cast<float>(narrow / (narrow + wide)), static_cast<float>(wide / (narrow + wide))};

        const double sigma = 0.5 * feature_width * pixels_per_degree;
        const int feature_reach = static_cast<int>(std::ceil(3.0 * sigma));
        features.push_back(gaussian_kernel(feature_reach, sigma));
        features.push_back(balanced_kernel(feature_reach, [=](int i) { return -i * gaussian(i, sigma); }));
        features.push_back(balanced_kernel(
            feature_reach, [=](int i) { return (i * i / (sigma * sigma) - 1.0) * gaussian(i, sigma); }));
    }
    // Of the widest kernel.
    int reach() const { return std::max(blue_yellow.front().radius, features.front().radius); }

    std::vector<Kernel> lightness, red_green, blue_yellow;
    std::array<float, 2> blue_yellow_shares{};
    std::vector<Kernel> features;  // Gaussian, its first and its second derivative
};

// Rows of floats, as many as a block and its surroundings have.
class Rows {
public:
    void resize(int width, int count) {
        width_ = static_cast<std::size_t>(width);
        values_.resize(width_ * static_cast<std::size_t>(count));
    }
    float* row(int i) { return values_.data() + static_cast<std::size_t>(i) * width_; }
    const float* row(int i) const { return values_.data() + static_cast<std::size_t>(i) * width_; }

private:
    std::size_t width_ = 0;
    std::vector<float> values_;
};

// What one image gives for a block of rows: its filtered colour, and how much of an edge and of a point is at a pixel.
class ImageBlock {
public:
    // Rows `begin` to `end` of `image`; those around them come in for the filters, edge rows again and again.
    template <typename ColourAt>
    void run(const Filters& filters, int width, int height, int begin, int end, const ColourAt& colour_at) {
        width_ = width, reach_ = filters.reach();
        const int rows = end - begin, around = rows + 2 * reach_;
        for (Rows& channel : opponent_) channel.resize(width + 2 * reach_, 1);
        for (Rows& half : half_) half.resize(width, around);
        for (int i = 0; i < around; ++i) {
            const int y = std::clamp(begin - reach_ + i, 0, height - 1);
            for (int x = 0; x < width; ++x) {
                const glm::vec3 colour = opponent_from_rgb(colour_at(x, y));
                for (int c = 0; c < 3; ++c) opponent_[c].row(0)[x + reach_] = colour[c];
            }
            for (Rows& channel : opponent_) {
                float* const row = channel.row(0);
                std::fill_n(row, reach_, row[reach_]);
                std::fill_n(row + reach_ + width, reach_, row[reach_ + width - 1]);
            }
            float* const lightness = opponent_[0].row(0);
            along_row(filters.lightness[0], lightness, half_[lightness_half].row(i));
            along_row(filters.red_green[0], opponent_[1].row(0), half_[red_green_half].row(i));
            for (int k = 0; k < 2; ++k)
                along_row(filters.blue_yellow[k], opponent_[2].row(0), half_[blue_yellow_half + k].row(i));
            // Features are of the lightness from 0 to 1.
            for (int x = 0; x < width + 2 * reach_; ++x) lightness[x] = (lightness[x] + 16.0f) / 116.0f;
            for (int k = 0; k < 3; ++k) along_row(filters.features[k], lightness, half_[feature_half + k].row(i));
        }
    }

    // The filtered colours of row `i` of the block, clamped to what a screen can show.
    void colours(const Filters& filters, int i, std::vector<glm::vec3>& colours) {
        along_columns(filters.lightness[0], half_[lightness_half], i, columns_[0]);
        along_columns(filters.red_green[0], half_[red_green_half], i, columns_[1]);
        for (int k = 0; k < 2; ++k)
            along_columns(filters.blue_yellow[k], half_[blue_yellow_half + k], i, columns_[2 + k]);
        colours.resize(static_cast<std::size_t>(width_));
        for (std::size_t x = 0; x < colours.size(); ++x) {
            const float blue_yellow =
                filters.blue_yellow_shares[0] * columns_[2][x] + filters.blue_yellow_shares[1] * columns_[3][x];
            colours[x] = glm::clamp(rgb_from_opponent({columns_[0][x], columns_[1][x], blue_yellow}), 0.0f, 1.0f);
        }
    }

    // Lengths of the gradients that the edge and the point filter find in row `i`.
    void features(const Filters& filters, int i, std::vector<float>& edges, std::vector<float>& points) {
        const auto lengths = [&](int derivative, std::vector<float>& result) {
            along_columns(filters.features[0], half_[feature_half + derivative], i, columns_[0]);
            along_columns(filters.features[derivative], half_[feature_half], i, columns_[1]);
            result.resize(static_cast<std::size_t>(width_));
            for (std::size_t x = 0; x < result.size(); ++x)
                result[x] = std::sqrt(columns_[0][x] * columns_[0][x] + columns_[1][x] * columns_[1][x]);
        };
        lengths(1, edges);
        lengths(2, points);
    }

private:
    static constexpr int lightness_half = 0, red_green_half = 1, blue_yellow_half = 2, feature_half = 4;

    // `from` holds `reach_` values more on either side.
    void along_row(const Kernel& kernel, const float* from, float* to) const {
        const float* const first = from + reach_ - kernel.radius;
        add_weighted(
            kernel, [first](std::size_t k) { return first + k; }, to);
    }
    void along_columns(const Kernel& kernel, const Rows& from, int i, std::vector<float>& to) const {
        to.resize(static_cast<std::size_t>(width_));
        const int first = i + reach_ - kernel.radius;
        add_weighted(
            kernel, [&](std::size_t k) { return from.row(first + static_cast<int>(k)); }, to.data());
    }

    // The sum over k of weight k times the values from source(k) on. Four at a time, so that the sums are not written
    // and read again for every weight.
    template <typename Source>
    void add_weighted(const Kernel& kernel, const Source& source, float* __restrict to) const {
        const std::vector<float>& w = kernel.weights;
        std::fill_n(to, width_, 0.0f);
        std::size_t k = 0;
        for (; k + 4 <= w.size(); k += 4) {
            const float *const a = source(k), *const b = source(k + 1), *const c = source(k + 2),
                               *const d = source(k + 3);
            for (int x = 0; x < width_; ++x) to[x] += w[k] * a[x] + w[k + 1] * b[x] + w[k + 2] * c[x] + w[k + 3] * d[x];
        }
        for (; k < w.size(); ++k) {
            const float* const a = source(k);
            for (int x = 0; x < width_; ++x) to[x] += w[k] * a[x];
        }
    }

    int width_ = 0, reach_ = 0;
    std::array<Rows, 3> opponent_;  // of one row
    std::array<Rows, 7> half_;      // filtered along rows only
    std::array<std::vector<float>, 4> columns_;
};

// 1 where every value of a pixel is finite, in both images.
std::vector<std::uint8_t> finite_pixels(const Image& test, const Image& reference) {
    std::vector<std::uint8_t> finite(test.pixel_count(), 1);
    const auto channels = static_cast<std::size_t>(test.channels());
    for (std::size_t i = 0; i < test.values().size(); ++i) {
        if (!std::isfinite(test.values()[i]) || !std::isfinite(reference.values()[i])) finite[i / channels] = 0;
    }
    return finite;
}

glm::vec3 colour_of(const Image& image, std::size_t pixel) {
    const auto values = image.values();
    return image.channels() == 1 ? glm::vec3(values[pixel])
                                 : glm::vec3(values[3 * pixel], values[3 * pixel + 1], values[3 * pixel + 2]);
}

// FLIP of both images as `shown(colour)` makes them, 0 to 1; the larger of it and what `flip` holds stays there.
template <typename Shown>
void raise_to_flip(const Image& test, const Image& reference, const std::vector<std::uint8_t>& finite,
                   const Filters& filters, const Shown& shown, Image& flip) {
    const int width = test.width(), height = test.height();
    parallel_for((height + rows_at_once - 1) / rows_at_once, [&](int block) {
        const int begin = block * rows_at_once, end = std::min(height, begin + rows_at_once);
        const auto index = [width](int x, int y) {
            return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        };
        const auto colour_in = [&](const Image& image) {
            return [&](int x, int y) {
                const std::size_t pixel = index(x, y);
                return finite[pixel] ? glm::clamp(shown(colour_of(image, pixel)), 0.0f, 1.0f) : glm::vec3(0.0f);
            };
        };
        ImageBlock of_test, of_reference;
        of_test.run(filters, width, height, begin, end, colour_in(test));
        of_reference.run(filters, width, height, begin, end, colour_in(reference));
        std::vector<glm::vec3> test_colours, reference_colours;
        std::vector<float> test_edges, test_points, edges, points;
        for (int y = begin; y < end; ++y) {
            of_test.colours(filters, y - begin, test_colours);
            of_reference.colours(filters, y - begin, reference_colours);
            of_test.features(filters, y - begin, test_edges, test_points);
            of_reference.features(filters, y - begin, edges, points);
            for (int x = 0; x < width; ++x) {
                const auto i = static_cast<std::size_t>(x);
                float& value = flip.at(x, y);
                if (!finite[index(x, y)]) {
                    value = std::numeric_limits<float>::quiet_NaN();
                    continue;
                }
                const float feature = std::sqrt(  // q_f, the exponent, is a half
                    std::max(std::abs(edges[i] - test_edges[i]), std::abs(points[i] - test_points[i])) /
                    std::numbers::sqrt2_v<float>);
                const float colour = colour_difference(test_colours[i], reference_colours[i]);
                value = std::max(value, std::pow(colour, 1.0f - feature));
            }
        }
    });
}

void require_comparable(const Image& test, const Image& reference, double pixels_per_degree) {
    require_same_shape(test, reference);
    if (test.channels() != 1 && test.channels() != 3) {
        throw ImageError(
            fmt::format("FLIP compares images of one channel or of three, not of {}; name the planes that are colours",
                        test.channels()));
    }
    if (!(pixels_per_degree > 0.0) || std::isinf(pixels_per_degree)) {
        throw ImageError(fmt::format("FLIP needs a positive number of pixels per degree, not {}", pixels_per_degree));
    }
}

float tone_mapped(float x) {
    return apply_tone_curve(ToneCurve::aces, static_cast<float>(aces_exposure) * std::max(x, 0.0f));
}

// The exposed value that the tone mapper makes nearly white.
double value_of_nearly_white() {
    const double a = AcesFit::a - nearly_white * AcesFit::c, b = AcesFit::b - nearly_white * AcesFit::d,
                 c = -nearly_white * AcesFit::e;
    return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a) / aces_exposure;
}

}  // namespace

Image ldr_flip(const Image& test, const Image& reference, double pixels_per_degree) {
    require_comparable(test, reference, pixels_per_degree);
    Image flip(test.width(), test.height(), 1);
    raise_to_flip(
        test, reference, finite_pixels(test, reference), Filters(pixels_per_degree),
        [](const glm::vec3& colour) { return colour; }, flip);
    return flip;
}

ExposureRange exposure_range(const Image& reference) {
    require_comparable(reference, reference, flip_pixels_per_degree);
    std::vector<float> luminances;
    const std::vector<std::uint8_t> finite = finite_pixels(reference, reference);
    for (std::size_t i = 0; i < finite.size(); ++i) {
        if (!finite[i]) continue;
        const auto value = static_cast<float>(luminance(colour_of(reference, i)));
        if (value > 0.0f) luminances.push_back(value);
    }
    if (luminances.empty()) {
        throw ImageError(
            "no pixel of the reference is brighter than black, so that no exposure shows it; state a range");
    }
    const auto black = reference.pixel_count() - luminances.size();
    std::ranges::sort(luminances);
    // The middle of all pixels, of which the black ones come first; of the others where those are more than half.
    const std::size_t middle = reference.pixel_count() / 2;
    const double median = middle >= black ? luminances[middle - black] : luminances[luminances.size() / 2];
    const double bright = value_of_nearly_white();
    ExposureRange range{std::log2(bright / luminances.back()), std::log2(bright / median), 2};
    range.count = std::max(2, static_cast<int>(std::ceil(range.last - range.first)));
    return range;
}

Image hdr_flip(const Image& test, const Image& reference, const ExposureRange& exposures, double pixels_per_degree) {
    require_comparable(test, reference, pixels_per_degree);
    if (exposures.count < 1 || !std::isfinite(exposures.first) || !std::isfinite(exposures.last)) {
        throw ImageError(fmt::format("HDR-FLIP needs at least one exposure and a finite range, not {} from {} to {}",
                                     exposures.count, exposures.first, exposures.last));
    }
    const Filters filters(pixels_per_degree);
    const std::vector<std::uint8_t> finite = finite_pixels(test, reference);
    Image flip(test.width(), test.height(), 1);
    for (int i = 0; i < exposures.count; ++i) {
        const double share = exposures.count == 1 ? 0.0 : static_cast<double>(i) / (exposures.count - 1);
        const auto factor = static_cast<float>(std::exp2(exposures.first + share * (exposures.last - exposures.first)));
        raise_to_flip(
            test, reference, finite, filters,
            [factor](const glm::vec3& colour) {
                return glm::vec3(tone_mapped(factor * colour.x), tone_mapped(factor * colour.y),
                                 tone_mapped(factor * colour.z));
            },
            flip);
    }
    return flip;
}

double mean_flip(const Image& flip, const Image* mask) {
    if (mask) require_mask_fits(*mask, flip);
    double sum = 0.0;
    std::size_t count = 0;
    for (int y = 0; y < flip.height(); ++y) {
        for (int x = 0; x < flip.width(); ++x) {
            if (!pixel_counts(mask, x, y) || !std::isfinite(flip.at(x, y))) continue;
            sum += flip.at(x, y);
            ++count;
        }
    }
    return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(count);
}

}  // namespace plumb
