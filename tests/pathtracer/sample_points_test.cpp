// The points of many samples side by side are those of one at a time, as the formulas of their sources define them, and
// know nothing of each other.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "pathtracer/sample_sequence.h"

namespace plumb {
namespace {

TEST(SampleLanes, HoldThePointsOfSingleSamplesBitForBit) {
    for (const SamplePoints points : {SamplePoints::sobol, SamplePoints::random}) {
        int different = 0;
        for (const std::uint64_t seed : {0ull, 1ull, 0xffffffffffffffffull}) {
            for (const glm::ivec2 pixel : {glm::ivec2(0, 0), glm::ivec2(1919, 1079), glm::ivec2(3, 70000)}) {
                SampleSequence sequence(seed, pixel.x, pixel.y, points);
                // Lanes filled in runs, as a batch of several pixels is: from odd samples and odd lanes on as well.
                SampleLanes lanes;
                const int firsts[] = {0, 7, 1000000, 65535}, counts[] = {5, 30, 1, 28};
                for (int run = 0, begin = 0; run < 4; begin += counts[run++]) {
                    sequence.start_samples(firsts[run], counts[run], begin, lanes);
                }
                for (const std::uint32_t dimension : {0u, 1u, 2u, 517u, 65540u, 1u << 20, 0xffffffffu}) {
                    Lanes<float> x, y, number, second;
                    Lanes<std::uint32_t> first;
                    sample_points(lanes, most_lanes, dimension, x, y);
                    sample_points(lanes, most_lanes, dimension, first, second);
                    sample_numbers(lanes, most_lanes, dimension, number);
                    for (int run = 0, lane = 0; run < 4; ++run) {
                        for (int i = 0; i < counts[run]; ++i, ++lane) {
                            sequence.start_sample(firsts[run] + i);
                            const glm::vec2 point = sequence.point(dimension);
                            const bool equal = x[lane] == point.x && y[lane] == point.y && number[lane] == point.x;
                            // With all bits of the first number, of which the others keep 24.
                            const FixedPoint fixed = fixed_sobol_point(sequence.index(), mix_word(dimension));
                            const bool equal_in_full = first[lane] == fixed.x && second[lane] == point.y &&
                                                       to_unit_interval(first[lane]) == point.x;
                            different += equal && equal_in_full ? 0 : 1;
                            EXPECT_TRUE(point.x >= 0.0f && point.x < 1.0f && point.y >= 0.0f && point.y < 1.0f);
                        }
                    }
                }
            }
        }
        EXPECT_EQ(different, 0);
    }
}

// The generator matrix of the second Sobol dimension is Pascal's triangle modulo 2 (Sobol 1967): bit j of the point
// (from the top) is the sum over k >= j of binomial(k, j) times bit k of the index.
TEST(SobolPoints, AreThoseOfPascalsTriangle) {
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const std::uint32_t index = i < 1000 ? i : static_cast<std::uint32_t>(mix_bits(i));
        std::uint32_t expected = 0;
        for (std::uint32_t j = 0; j < 32; ++j) {
            std::uint32_t bit = 0;
            for (std::uint32_t k = j; k < 32; ++k) {
                const bool odd = (k & j) == j;  // binomial(k, j) modulo 2, by Lucas
                bit ^= odd ? index >> k & 1u : 0u;
            }
            expected |= bit << (31 - j);
        }
        ASSERT_EQ(reverse_bits(reversed_second_sobol_dimension(index)), expected) << index;
    }
}

// Each half of each pixel is a (0, 2)-sequence of its own: in any aligned run of 2^m of its samples there is one point
// in each elementary box, whatever the box's shape; also in dimensions that differ by a single high bit.
TEST(SampleSequence, StratifiesBothHalvesInEveryDimension) {
    for (const std::uint32_t dimension : {0u, 4u, 10u, 65540u, (1u << 20) + 10u}) {
        for (const int half : {0, 1}) {
            SampleSequence sequence(12345, 640, 360);
            for (const int m : {2, 6, 8}) {
                const int count = 1 << m;
                for (const int first : {0, 3 * count}) {
                    std::vector<glm::vec2> points;
                    for (int i = first; i < first + count; ++i) {
                        sequence.start_sample(2 * i + half);
                        points.push_back(sequence.point(dimension));
                    }
                    for (int a = 0; a <= m; ++a) {
                        std::set<std::pair<int, int>> boxes;
                        for (const glm::vec2& point : points) {
                            boxes.insert({static_cast<int>(point.x * static_cast<float>(1 << a)),
                                          static_cast<int>(point.y * static_cast<float>(1 << (m - a)))});
                        }
                        EXPECT_EQ(static_cast<int>(boxes.size()), count)
                            << "dimension " << dimension << ", half " << half << ", m " << m << ", a " << a;
                    }
                }
            }
        }
    }
}

// Correlations between all pairs of the dimensions that the first vertices use, over pixels. Of n independent uniform
// numbers each is normal with deviation 1 / sqrt(n). Some 300 pairs are looked at, of which one passes 4.5 deviations
// by chance with probability 0.002; and together their mean square is 1 / n to within 4 of its own deviations.
TEST(SampleSequence, LeavesNoPairOfDimensionsPixelsOrHalvesCorrelated) {
    constexpr int pixels = 128 * 128;
    std::vector<std::vector<double>> columns;
    std::vector<std::string> names;
    const auto add = [&](const std::string& name, std::uint32_t dimension, int sample, glm::ivec2 shift, int axis) {
        std::vector<double> column;
        for (int i = 0; i < pixels; ++i) {
            SampleSequence sequence(1, i % 128 + shift.x, i / 128 + shift.y);
            sequence.start_sample(sample);
            column.push_back(std::sqrt(12.0) * (static_cast<double>(sequence.point(dimension)[axis]) - 0.5));
        }
        columns.push_back(std::move(column));
        names.push_back(name);
    };
    for (const std::uint32_t dimension : {0u, 1u, 2u, 4u, 5u, 6u, 7u, 12u, 13u, 65540u}) {
        for (const int axis : {0, 1}) add("dimension " + std::to_string(dimension), dimension, 0, {0, 0}, axis);
    }
    add("other half", 4, 1, {0, 0}, 0), add("next sample", 4, 2, {0, 0}, 0);
    add("next pixel", 4, 0, {1, 0}, 0), add("next row", 4, 0, {0, 1}, 0);
    add("transposed half", 4, 1, {1, 1}, 0);
    double squares = 0.0;
    int pairs = 0;
    for (std::size_t a = 0; a < columns.size(); ++a) {
        for (std::size_t b = a + 1; b < columns.size(); ++b) {
            double sum = 0.0;
            for (std::size_t i = 0; i < pixels; ++i) sum += columns[a][i] * columns[b][i];
            const double deviations = sum / std::sqrt(static_cast<double>(pixels));
            // The next sample of the same half is stratified against this one: the only pair that must know each other.
            const bool same_sequence = names[b] == "next sample" && names[a] == "dimension 4";
            if (same_sequence) continue;
            EXPECT_LT(std::abs(deviations), 4.5) << names[a] << " and " << names[b];
            squares += deviations * deviations, ++pairs;
        }
    }
    EXPECT_NEAR(squares / pairs, 1.0, 4.0 * std::sqrt(2.0 / pairs)) << pairs << " pairs";
}

}  // namespace
}  // namespace plumb
