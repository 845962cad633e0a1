// The statistics of z_test.h on known numbers.
#include "tests/pathtracer/z_test.h"

#include <random>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// From printed tables of Student's t (two-sided 0.05 and 0.001), and, far out, from closed forms for 1 and 2 degrees.
TEST(StudentsDistribution, HasTheProbabilitiesOfItsTables) {
    EXPECT_NEAR(student_two_sided(12.7062, 1), 0.05, 1e-6);
    EXPECT_NEAR(student_two_sided(2.2281389, 10), 0.05, 1e-7);
    EXPECT_NEAR(student_two_sided(3.6459586, 30), 0.001, 1e-8);
    EXPECT_NEAR(student_two_sided(1.959964, 1e7), 0.05, 1e-6);  // the normal distribution
    EXPECT_NEAR(student_two_sided(0.0, 5), 1.0, 1e-14);
    for (const double t : {0.3, 2.0, 50.0, 1000.0}) {
        EXPECT_NEAR(student_two_sided(t, 1) / (std::atan(1.0 / t) * 2.0 / 3.14159265358979323846), 1.0, 1e-10) << t;
        const double root = std::sqrt(2.0 + t * t);
        EXPECT_NEAR(student_two_sided(t, 2) / (2.0 / (root * (root + t))), 1.0, 1e-9) << t;
    }
}

Replicates noise(unsigned seed, double mean, double deviation, int renderings = 16) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(static_cast<float>(mean), static_cast<float>(deviation));
    Replicates replicates;
    for (int i = 0; i < renderings; ++i) {
        Image image(8, 6, 3);
        for (float& value : image.values()) value = normal(random);
        replicates.add(image);
    }
    return replicates;
}

// The corrected p-value of equal expectations is evenly distributed (a little to the right, as the block means depend
// on the pixels): below 0.1 in a tenth of the cases. 300 pairs give that share a standard deviation of 1.7 %.
TEST(ZTest, RejectsEqualExpectationsAsOftenAsItSays) {
    int rejected = 0;
    constexpr unsigned pairs = 300;
    for (unsigned pair = 0; pair < pairs; ++pair) {
        if (compare(noise(2 * pair, 1.0, 0.1), noise(2 * pair + 1, 1.0, 0.1), 0.0).p < 0.1) ++rejected;
    }
    EXPECT_GT(rejected, static_cast<int>(0.04 * pairs));
    EXPECT_LT(rejected, static_cast<int>(0.16 * pairs));
}

// 2 % noise per pixel of 48 pixels in 16 renderings is 0.07 % in the mean of all, 0.1 % in a difference of two.
TEST(ZTest, SeesAFaintBiasInTheMeanOfAll) {
    EXPECT_LT(compare(noise(1, 1.0, 0.02), noise(2, 1.01, 0.02)).p, z_test_significance);
    EXPECT_GE(compare(noise(1, 1.0, 0.02), noise(2, 1.0, 0.02)).p, z_test_significance);
}

TEST(ZTest, SeesASingleWrongPixel) {
    Replicates right, wrong;
    std::mt19937 random(5);
    std::normal_distribution<float> normal(1.0f, 0.01f);
    for (Replicates* replicates : {&right, &wrong}) {
        for (int i = 0; i < 16; ++i) {
            Image image(16, 16, 1);
            for (float& value : image.values()) value = normal(random);
            if (replicates == &wrong) image.at(11, 5) *= 1.05f;
            replicates->add(image);
        }
    }
    const Agreement agreement = compare(right, wrong);
    EXPECT_LT(agreement.p, z_test_significance);
    EXPECT_TRUE(agreement.worst.starts_with("block of 1 pixels at 11, 5, channel 0")) << agreement.worst;
}

TEST(ZTest, TakesDifferencesWithoutNoiseForWhatTheyAre) {
    EXPECT_EQ(compare(noise(1, 1.0, 0.0), noise(2, 1.0, 0.0)).p, 1.0);
    EXPECT_EQ(compare(noise(1, 1.0, 0.0), noise(2, 1.001, 0.0)).p, 0.0);
    EXPECT_EQ(compare(noise(1, 1.0, 0.0), noise(2, 1.001, 0.0), 0.01).p, 1.0);
}

}  // namespace
}  // namespace plumb
