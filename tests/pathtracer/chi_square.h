// Pearson's chi-square test of a sampling routine against the density it claims to have, and the proof that the test
// would see an error of 1 %.
//
// A routine turns two uniform numbers into something (a direction, a point, an item). The test sorts many such things
// into cells, and compares the counts with what the density, integrated over each cell, lets expect.
//   Source of the procedure: Pharr et al. 2023, "Physically Based Rendering", 4th edition, and Mitsuba 3, whose BSDF
//   and sampler tests it follows; Knuth 1997, "The Art of Computer Programming" 3.3.1, for the test itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "pathtracer/sample_sequence.h"

namespace plumb {

// The regularised upper incomplete gamma function Q(a, x): by the series of the lower one where that converges fast, by
// Legendre's continued fraction (Lentz's evaluation) elsewhere. Source: DLMF 8.7.1 and 8.9.2.
inline double upper_gamma_share(double a, double x) {
    if (!(x > 0.0)) return 1.0;
    const double factor = std::exp(a * std::log(x) - x - std::lgamma(a));
    constexpr int most_terms = 10000;
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (int n = 1; n < most_terms && term > 1e-16 * sum; ++n) sum += term *= x / (a + n);
        return 1.0 - factor * sum;
    }
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, fraction = d;
    for (int n = 1; n < most_terms; ++n) {
        const double numerator = -n * (n - a);
        b += 2.0;
        d = 1.0 / (numerator * d + b);
        c = numerator / c + b;
        fraction *= c * d;
        if (std::abs(c * d - 1.0) < 1e-15) break;
    }
    return factor * fraction;
}

// How often chance alone makes the statistic at least this large.
inline double chi_square_p_value(double statistic, int degrees_of_freedom) {
    return degrees_of_freedom > 0 ? upper_gamma_share(0.5 * degrees_of_freedom, 0.5 * statistic) : 1.0;
}

struct ChiSquareResult {
    double statistic = 0.0;
    int degrees_of_freedom = 0;
    double p_value = 1.0;  // 0 where something was drawn that has probability 0
};

// Cells with fewer than 5 expected samples are pooled, the rarest first, since the statistic follows its distribution
// only where counts are nearly normal.
inline ChiSquareResult chi_square(std::span<const double> counts, std::span<const double> probabilities) {
    constexpr double fewest_expected = 5.0;
    const double samples = std::accumulate(counts.begin(), counts.end(), 0.0);
    std::vector<std::size_t> order(counts.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](std::size_t cell) { return probabilities[cell]; });
    ChiSquareResult result;
    double pooled_count = 0.0, pooled_expected = 0.0;
    int cells = 0;
    for (const std::size_t cell : order) {
        if (!(probabilities[cell] > 0.0) && counts[cell] > 0.0) return {INFINITY, 0, 0.0};
        pooled_count += counts[cell], pooled_expected += samples * probabilities[cell];
        const bool last = cell == order.back();
        if (pooled_expected < fewest_expected && !last) continue;
        if (pooled_expected > 0.0) {
            const double difference = pooled_count - pooled_expected;
            result.statistic += difference * difference / pooled_expected;
            ++cells;
        }
        pooled_count = pooled_expected = 0.0;
    }
    result.degrees_of_freedom = cells - 1;
    result.p_value = chi_square_p_value(result.statistic, result.degrees_of_freedom);
    return result;
}

// All chi-square tests of the suite together fail a right program with probability 0.01: each may do so with the share
// that Sidak's correction leaves it. The suite has fewer tests than are reckoned with here.
constexpr int tests_in_suite = 64;
inline double significance_of_one_test() { return 1.0 - std::pow(1.0 - 0.01, 1.0 / tests_in_suite); }

// How many samples make a bias of 1 % visible with near certainty.
//
// Probabilities p_i that are off by a relative error e_i raise the statistic of n samples by n sum(p_i e_i^2) on
// average. Of cos(pi u) at an amplitude of 1 % the mean square is 0.5e-4; averaging within cells leaves the
// share `kept` of it. The statistic of k cells has mean k and variance 2 k; raised by s, the variance is 2 k + 4 s
// (Patnaik 1949). A threshold of 3.6 deviations is that of one test in 64 at 0.01; the raised statistic shall pass it
// by 3 of its own, which it fails once in 700 tests.
inline int samples_to_detect_one_percent(std::size_t cells, double kept) {
    constexpr double mean_square = 0.5e-4;
    const auto k = static_cast<double>(cells);
    double raise = 0.0;
    for (int step = 0; step < 40; ++step) raise = 3.6 * std::sqrt(2.0 * k) + 3.0 * std::sqrt(2.0 * k + 4.0 * raise);
    return static_cast<int>(raise / (kept * mean_square));
}

// Independent numbers with 24 bits each, as the path tracer's are: the two that the routine is given, and two for the
// planted bias.
struct IndependentNumbers {
    glm::vec2 u, thinning;

    IndependentNumbers(std::uint64_t seed, int index) {
        const std::uint64_t first = mix_bits(mix_bits(seed) + static_cast<std::uint64_t>(index));
        const std::uint64_t second = mix_bits(first);
        u = pair(first), thinning = pair(second);
    }

private:
    static glm::vec2 pair(std::uint64_t bits) {
        return {to_unit_interval(static_cast<std::uint32_t>(bits)),
                to_unit_interval(static_cast<std::uint32_t>(bits >> 32))};
    }
};

// A third number for routines that need it, hashed from the two: which cell it falls into tells nothing of theirs.
inline float third_number(glm::vec2 u) {
    const auto bits = static_cast<std::uint64_t>(u.x * 0x1p24f) << 24 | static_cast<std::uint64_t>(u.y * 0x1p24f);
    return to_unit_interval(static_cast<std::uint32_t>(mix_bits(bits)));
}

// The planted bias: of the samples drawn with `u` so many are left out that the density of u becomes
// 1 + 0.01 cos(pi u), to first order, instead of 1.
inline bool is_left_out(float u, float thinning) {
    return thinning < 0.02f && thinning < 0.01f * (1.0f - std::cos(glm::pi<float>() * u));
}

// How samples may fail to be things at all: a microfacet reflects below the horizon, a light faces away.
enum class Rejection { never, possible };

// Which of the two numbers a routine uses.
enum class Uses { both, first };

// A test of one routine. `probabilities` are the integrals of the density over the cells and `cell` tells into which
// of them the sample falls that is drawn with given numbers, or -1 for a rejected one, whose probability is what the
// cells leave over.
//
// The routine must pass, and must fail when its random numbers are tilted by 1 % along either axis, and when the
// density is 1 % too small or too large.
template <typename Cell>
void expect_density(const std::string& name, std::vector<double> probabilities, Rejection rejection, const Cell& cell,
                    Uses uses = Uses::both, double kept = 0.7) {
    const std::size_t cells = probabilities.size();
    const double total = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
    // What the quadrature of a density that integrates to one may miss: 1e-5 of 4 million samples is 40, well below the
    // deviation of their count in a cell.
    constexpr double quadrature_error = 1e-5;
    if (rejection == Rejection::never) {
        EXPECT_NEAR(total, 1.0, quadrature_error) << name << ": the density does not integrate to 1";
    } else {
        EXPECT_LE(total, 1.0 + quadrature_error) << name << ": the density integrates to more than 1";
    }
    // Where samples may be rejected, cells may hold a sliver of the accepted ones that the quadrature missed: they are
    // rare, not impossible.
    const auto with_rest = [&](double scale) {
        std::vector<double> scaled = probabilities;
        scaled.push_back(1.0 - scale * total);
        for (std::size_t i = 0; i < cells; ++i) scaled[i] *= scale;
        const double least = rejection == Rejection::possible ? 1e-9 : 0.0;
        for (double& probability : scaled) probability = std::max(probability, least);
        return scaled;
    };
    const int samples = samples_to_detect_one_percent(cells, kept);
    std::vector<double> counts(cells + 1, 0.0), tilted_x = counts, tilted_y = counts;
    for (int i = 0; i < samples; ++i) {
        const IndependentNumbers numbers(1, i);
        const int index = cell(numbers.u);
        const std::size_t found = index < 0 ? cells : static_cast<std::size_t>(index);
        ++counts[found];
        if (!is_left_out(numbers.u.x, numbers.thinning.x)) ++tilted_x[found];
        if (!is_left_out(numbers.u.y, numbers.thinning.y)) ++tilted_y[found];
    }
    const auto show = [&](const ChiSquareResult& result) {
        return name + ": chi-square " + std::to_string(result.statistic) + " with " +
               std::to_string(result.degrees_of_freedom) + " degrees of freedom, p " + std::to_string(result.p_value) +
               ", " + std::to_string(samples) + " samples";
    };
    const double significance = significance_of_one_test();
    const ChiSquareResult right = chi_square(counts, with_rest(1.0));
    EXPECT_GE(right.p_value, significance) << show(right);

    const ChiSquareResult with_tilted_x = chi_square(tilted_x, with_rest(1.0));
    EXPECT_LT(with_tilted_x.p_value, significance) << "first number tilted by 1 %, unseen. " << show(with_tilted_x);
    if (uses == Uses::both) {
        const ChiSquareResult with_tilted_y = chi_square(tilted_y, with_rest(1.0));
        EXPECT_LT(with_tilted_y.p_value, significance)
            << "second number tilted by 1 %, unseen. " << show(with_tilted_y);
    }
    const ChiSquareResult small = chi_square(counts, with_rest(0.99));
    EXPECT_LT(small.p_value, significance) << "density 1 % too small, unseen. " << show(small);
    const bool excess_seen =
        1.01 * total > 1.0 + quadrature_error || chi_square(counts, with_rest(1.01)).p_value < significance;
    EXPECT_TRUE(excess_seen) << name << ": density 1 % too large, unseen";
}

}  // namespace plumb
