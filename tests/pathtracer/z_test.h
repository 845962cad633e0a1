// Do two ways of rendering have the same expectation? Tests of significance on independent renderings, instead of
// looking at pictures.
//
// Samples within a rendering are low-discrepancy points and depend on each other; renderings with different seeds do
// not. So the unit here is the rendering: of each way some tens with different seeds, whose spread around their mean is
// the standard error whatever the points. Compared are all pixels and channels, and besides the means of all blocks of
// 2 x 2, 4 x 4... pixels up to the whole image: a bias at an edge shows in its pixels, a faint bias everywhere in the
// mean of all. Of the many p-values (Welch's t-test) the smallest counts, after Sidak's correction for their number.
//   Sources: Mitsuba 3, src/render/tests/test_renders.py, tests pixels so with Sidak's correction (Sidak 1967); Welch
//   1947, "The Generalization of Student's Problem".
//
// The significance level is 1e-3 instead of Mitsuba's 0.01: there are some tens of such tests here, and when the random
// numbers change for a good reason hardly one of them may fail by chance. What that costs in sharpness is looked at in
// every single use: expect_agreement also demands that the same data are rejected once one side is 1 % brighter, which
// takes a standard error of the image's mean of about 0.12 %. Few pixels with many samples each get there soonest.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "frames/image.h"

namespace plumb {

constexpr double z_test_significance = 1e-3, planted_bias = 0.01;

// The regularised incomplete beta function by its continued fraction, evaluated with Lentz's algorithm.
//   Source: NIST Digital Library of Mathematical Functions, 8.17.22; Lentz 1976.
inline double incomplete_beta(double a, double b, double x) {
    if (x <= 0.0 || x >= 1.0) return x <= 0.0 ? 0.0 : 1.0;
    // The fraction converges fast on one side only; the other follows from symmetry.
    if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incomplete_beta(b, a, 1.0 - x);
    constexpr double tiny = 1e-300;
    const auto nonzero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
    double numerator = 1.0, denominator = 0.0, fraction = 1.0;
    for (int i = 0; i < 500; ++i) {
        const int m = i / 2;
        double term = 1.0;
        if (i > 0) {
            term = i % 2 == 0 ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                              : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        }
        denominator = 1.0 / nonzero(1.0 + term * denominator);
        numerator = nonzero(1.0 + term / numerator);
        fraction *= numerator * denominator;
        if (std::abs(numerator * denominator - 1.0) < 1e-14) break;
    }
    const double front =
        std::exp(a * std::log(x) + b * std::log1p(-x) + std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b)) / a;
    return front * (fraction - 1.0);
}

// The probability that Student's t with that many degrees of freedom is farther from 0 than t.
inline double student_two_sided(double t, double degrees_of_freedom) {
    return incomplete_beta(0.5 * degrees_of_freedom, 0.5, degrees_of_freedom / (degrees_of_freedom + t * t));
}

// Means and their variances over renderings that differ by nothing but the seed.
class Replicates {
public:
    // Image by image; all of one shape.
    void add(const Image& image) {
        const std::vector<double> values = with_blocks(image);
        sums_.resize(values.size()), squares_.resize(values.size()), first_.resize(values.size());
        if (count_ == 0) first_ = values;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double offset = values[i] - first_[i];  // small, so that squares do not cancel
            sums_[i] += offset, squares_[i] += offset * offset;
        }
        ++count_;
        width_ = image.width(), height_ = image.height(), channels_ = image.channels();
    }
    // The same renderings, had they all been brighter by `factor`.
    Replicates scaled(double factor) const {
        Replicates copy = *this;
        for (double& value : copy.sums_) value *= factor;
        for (double& value : copy.first_) value *= factor;
        for (double& value : copy.squares_) value *= factor * factor;
        return copy;
    }

    int count() const { return count_; }
    std::size_t size() const { return sums_.size(); }
    double mean(std::size_t i) const { return first_[i] + sums_[i] / count_; }
    double variance_of_mean(std::size_t i) const {
        return std::max(0.0, (squares_[i] - sums_[i] * sums_[i] / count_) / (count_ - 1.0) / count_);
    }
    std::string where(std::size_t i) const {
        std::size_t first = 0;
        for (int block = 1;; block *= 2) {
            const int columns = (width_ + block - 1) / block, rows = (height_ + block - 1) / block;
            const auto values = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                                static_cast<std::size_t>(channels_);
            if (i < first + values) {
                const int rest = static_cast<int>(i - first);
                return fmt::format("block of {} pixels at {}, {}, channel {}", block,
                                   block * (rest / channels_ % columns), block * (rest / channels_ / columns),
                                   rest % channels_);
            }
            first += values;
        }
    }

private:
    // The values, then the means of blocks of growing size, the last of which is the image.
    static std::vector<double> with_blocks(const Image& image) {
        std::vector<double> values;
        for (int block = 1;; block *= 2) {
            for (int top = 0; top < image.height(); top += block) {
                for (int left = 0; left < image.width(); left += block) {
                    for (int channel = 0; channel < image.channels(); ++channel) {
                        double sum = 0.0;
                        int pixels = 0;
                        for (int y = top; y < std::min(top + block, image.height()); ++y) {
                            for (int x = left; x < std::min(left + block, image.width()); ++x, ++pixels) {
                                sum += image.at(x, y, channel);
                            }
                        }
                        values.push_back(sum / pixels);
                    }
                }
            }
            if (block >= image.width() && block >= image.height()) return values;
        }
    }

    int count_ = 0, width_ = 0, height_ = 0, channels_ = 0;
    std::vector<double> first_, sums_, squares_;
};

struct Agreement {
    double p = 1.0;  // that chance alone makes two ways of the same expectation differ so much, corrected
    std::string worst;
};

// `tolerance`: how far, of the value, the expectations may differ for a reason that the caller gives; else the rounding
// of float32 through some tens of operations.
inline Agreement compare(const Replicates& a, const Replicates& b, double tolerance = 1e-5) {
    double smallest = 1.0;
    std::string worst = "nothing differs";
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double va = a.variance_of_mean(i), vb = b.variance_of_mean(i), sum = va + vb;
        const double difference =
            std::abs(a.mean(i) - b.mean(i)) - tolerance * std::max(std::abs(a.mean(i)), std::abs(b.mean(i)));
        if (!(difference > 0.0)) continue;
        double p = 0.0;
        if (sum > 0.0) {
            const double freedom = sum * sum / (va * va / (a.count() - 1.0) + vb * vb / (b.count() - 1.0));
            p = student_two_sided(difference / std::sqrt(sum), freedom);
        }
        if (p < smallest) {
            smallest = p;
            worst = fmt::format("{}: {:.6g} against {:.6g}, standard error {:.2g}", a.where(i), a.mean(i), b.mean(i),
                                std::sqrt(sum));
        }
    }
    // 1 - (1 - p)^n, without cancellation.
    const double corrected = smallest >= 1.0 ? 1.0 : -std::expm1(static_cast<double>(a.size()) * std::log1p(-smallest));
    return {corrected, worst};
}

// Agree as they are; do not agree where either is 1 % brighter.
inline void expect_agreement(const Replicates& a, const Replicates& b, const std::string& what,
                             double tolerance = 1e-5) {
    ASSERT_EQ(a.size(), b.size()) << what;
    const Agreement agreement = compare(a, b, tolerance);
    EXPECT_GE(agreement.p, z_test_significance) << what << ": " << agreement.worst;
    for (const double factor : {1.0 + planted_bias, 1.0 / (1.0 + planted_bias)}) {
        const Agreement biased = compare(a, b.scaled(factor), tolerance);
        EXPECT_LT(biased.p, z_test_significance)
            << what << ": does not see a planted bias of 1 % (factor " << factor << "): " << biased.worst;
    }
}

}  // namespace plumb
