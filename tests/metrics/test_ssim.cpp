#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "frames/image_error.h"
#include "metrics/ssim.h"
#include "tests/metrics/pattern.h"

namespace plumb {
namespace {

// Golden values of scikit-image 0.19.3 (Debian 12, python3-skimage):
//
//   import numpy as np
//   from skimage.metrics import structural_similarity as s
//   y, x = np.mgrid[0:37, 0:53]
//   value = lambda change: np.stack([((x * 37 + y * 91 + x * y + c * 17 + change) % 256) / 256.0 for c in range(3)],
//   -1) a, b = value(0), value((x // 8 + y // 8) * 5) k = dict(gaussian_weights=True, sigma=1.5,
//   use_sample_covariance=False) s(b, a, data_range=1.0, channel_axis=2, **k)                         #
//   0.5119202931691481 s(b[..., 0], a[..., 0], data_range=2.5, **k)                         # 0.538402006401901
//   s(b[..., 0], a[..., 0], data_range=1.0, full=True, **k)[1][y, x]     # the map, borders included
//
// Tolerance: both work in double precision on the same values and differ in the order of summation only. The variances
// are differences of nearly equal sums, which costs a few digits: 1e-10.
constexpr double order_of_summation = 1e-10;

Image channel_of(const Image& image, int channel) {
    Image result(image.width(), image.height(), 1);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) result.at(x, y) = image.at(x, y, channel);
    }
    return result;
}

// SSIM of one window as the formula stands, 121 weights, variances as sums of squared deviations from the mean.
double window_ssim(const Image& v, const Image& r, int cx, int cy, int c, double range) {
    double weights = 0, mean_v = 0, mean_r = 0;
    const auto visit = [&](auto&& use) {
        for (int dy = -5; dy <= 5; ++dy) {
            for (int dx = -5; dx <= 5; ++dx) {
                use(std::exp(-(dx * dx + dy * dy) / 4.5), double{v.at(cx + dx, cy + dy, c)},
                    double{r.at(cx + dx, cy + dy, c)});
            }
        }
    };
    visit([&](double w, double a, double b) {
        weights += w;
        mean_v += w * a;
        mean_r += w * b;
    });
    mean_v /= weights;
    mean_r /= weights;
    double variance_v = 0, variance_r = 0, covariance = 0;
    visit([&](double w, double a, double b) {
        variance_v += w * (a - mean_v) * (a - mean_v);
        variance_r += w * (b - mean_r) * (b - mean_r);
        covariance += w * (a - mean_v) * (b - mean_r);
    });
    const double c1 = std::pow(0.01 * range, 2), c2 = std::pow(0.03 * range, 2);
    return (2 * mean_v * mean_r + c1) * (2 * covariance / weights + c2) /
           ((mean_v * mean_v + mean_r * mean_r + c1) * ((variance_v + variance_r) / weights + c2));
}

double direct_ssim(const Image& v, const Image& r, double range) {
    double sum = 0;
    int count = 0;
    for (int c = 0; c < v.channels(); ++c) {
        for (int y = 5; y < v.height() - 5; ++y) {
            for (int x = 5; x < v.width() - 5; ++x) {
                sum += window_ssim(v, r, x, y, c, range);
                ++count;
            }
        }
    }
    return sum / count;
}

TEST(Ssim, MatchesScikitImage) {
    const Image test = test::pattern(37, 53, true), reference = test::pattern(37, 53, false);
    const Ssim colour = ssim(test, reference, 1.0);
    EXPECT_NEAR(colour.mean, 0.5119202931691481, order_of_summation);
    EXPECT_EQ(colour.windows, 43u * 27u * 3u);
    EXPECT_NEAR(ssim(channel_of(test, 0), channel_of(reference, 0), 2.5).mean, 0.538402006401901, order_of_summation);
}

TEST(Ssim, MapMatchesScikitImageAtTheBorders) {
    const Image map = SsimMap(test::pattern(37, 53, true), test::pattern(37, 53, false), 1.0).image();
    constexpr double float32 = 1e-7;  // the map is stored in single precision
    EXPECT_NEAR(map.at(0, 0), 1.0, float32);
    EXPECT_NEAR(map.at(20, 36), 0.40916366332904963, float32);
    EXPECT_NEAR(map.at(52, 18), 0.45001643065395075, float32);
    EXPECT_NEAR(map.at(26, 18), 0.4672129561126069, float32);
}

TEST(Ssim, MatchesADirectEvaluationOnRadianceWithStrongContrast) {
    std::mt19937 random(7);
    std::lognormal_distribution<float> radiance(-1.0f, 1.5f);
    std::normal_distribution<float> noise(0.0f, 0.1f);
    Image reference(40, 31, 2), test(40, 31, 2);
    for (std::size_t i = 0; i < reference.values().size(); ++i) {
        reference.values()[i] = radiance(random);
        test.values()[i] = reference.values()[i] * (1.0f + noise(random));
    }
    // The direct form subtracts the mean first, this one subtracts squares: at contrasts of 1000 that costs three
    // digits.
    EXPECT_NEAR(ssim(test, reference, 3.0).mean, direct_ssim(test, reference, 3.0), 1e-9);
}

TEST(Ssim, IsOneForEqualImagesAndForBlackOnes) {
    const Image image = test::pattern(20, 20, true);
    EXPECT_NEAR(ssim(image, image, 1.0).mean, 1.0, order_of_summation);
    EXPECT_NEAR(ssim(Image(11, 11, 1), Image(11, 11, 1), 1.0).mean, 1.0, order_of_summation);
}

TEST(Ssim, OfTwoConstantsIsTheBrightnessTermAlone) {
    // No variance: SSIM = (2 a b + C1) / (a^2 + b^2 + C1) with C1 = 1e-4.
    EXPECT_NEAR(ssim(Image(15, 15, 1, 0.5f), Image(15, 15, 1, 0.25f), 1.0).mean, 0.2501 / 0.3126, order_of_summation);
}

TEST(Ssim, TheDataRangeIsNotGuessed) {
    const Image test = test::pattern(20, 20, true), reference = test::pattern(20, 20, false);
    EXPECT_LT(ssim(test, reference, 0.1).mean, ssim(test, reference, 10.0).mean);
    EXPECT_THROW(ssim(test, reference, 0.0), ImageError);
}

TEST(Ssim, AValueThatIsNotFiniteSpoilsItsWindowsOnlyAndIsCounted) {
    const Image reference = test::pattern(41, 41, false);
    for (const float poison : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image test = test::pattern(41, 41, true);
        test.at(20, 20, 1) = poison;
        const Ssim result = ssim(test, reference, 1.0);
        EXPECT_EQ(result.non_finite_windows, 121u);
        EXPECT_EQ(result.windows, 31u * 31u * 3u - 121u);
        EXPECT_TRUE(std::isfinite(result.mean));
        EXPECT_TRUE(std::isnan(SsimMap(test, reference, 1.0).image().at(20, 20, 1)));
    }
}

TEST(Ssim, AMaskChoosesWindowCentres) {
    const Image test = channel_of(test::pattern(30, 30, true), 0),
                reference = channel_of(test::pattern(30, 30, false), 0);
    Image mask(30, 30, 1);
    mask.at(12, 17) = mask.at(20, 9) = 1.0f;
    mask.at(2, 2) = 1.0f;  // too near to the border to count
    const Ssim result = ssim(test, reference, 1.0, &mask);
    EXPECT_EQ(result.windows, 2u);
    EXPECT_NEAR(result.mean,
                0.5 * (window_ssim(test, reference, 12, 17, 0, 1.0) + window_ssim(test, reference, 20, 9, 0, 1.0)),
                order_of_summation);
    EXPECT_TRUE(std::isnan(ssim(test, reference, 1.0, &(mask = Image(30, 30, 1))).mean));
}

// As the formula stands: scales one after the other, every window by itself.
double multi_scale_by_formula(Image v, Image r, double range) {
    const std::array weights = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
    double product = 1.0;
    for (int scale = 0; scale < 5; ++scale) {
        double sum = 0.0;
        int windows = 0;
        for (int y = 5; y < v.height() - 5; ++y) {
            for (int x = 5; x < v.width() - 5; ++x, ++windows) {
                double total = 0, mean_v = 0, mean_r = 0, square_v = 0, square_r = 0, both = 0;
                for (int dy = -5; dy <= 5; ++dy) {
                    for (int dx = -5; dx <= 5; ++dx) {
                        const double w = std::exp(-(dx * dx + dy * dy) / 4.5), a = v.at(x + dx, y + dy),
                                     b = r.at(x + dx, y + dy);
                        total += w, mean_v += w * a, mean_r += w * b;
                        square_v += w * a * a, square_r += w * b * b, both += w * a * b;
                    }
                }
                mean_v /= total, mean_r /= total;
                const double c1 = std::pow(0.01 * range, 2), c2 = std::pow(0.03 * range, 2);
                const double contrast = (2 * (both / total - mean_v * mean_r) + c2) /
                                        (square_v / total - mean_v * mean_v + square_r / total - mean_r * mean_r + c2);
                const double brightness = (2 * mean_v * mean_r + c1) / (mean_v * mean_v + mean_r * mean_r + c1);
                sum += scale == 4 ? brightness * contrast : contrast;
            }
        }
        product *= std::pow(sum / windows, weights[scale]);
        const auto halve = [](const Image& image) {
            Image half(image.width() / 2, image.height() / 2, 1);
            for (int y = 0; y < half.height(); ++y) {
                for (int x = 0; x < half.width(); ++x) {
                    half.at(x, y) = 0.25f * (image.at(2 * x, 2 * y) + image.at(2 * x + 1, 2 * y) +
                                             image.at(2 * x, 2 * y + 1) + image.at(2 * x + 1, 2 * y + 1));
                }
            }
            return half;
        };
        v = halve(v), r = halve(r);
    }
    return product;
}

TEST(MultiScaleSsim, AgreesWithItsFormula) {
    // Odd sizes, so that rows and columns are dropped on the way down.
    Image test(187, 181, 1), reference(187, 181, 1);
    for (int y = 0; y < 181; ++y) {
        for (int x = 0; x < 187; ++x) {
            reference.at(x, y) = 0.5f + 0.4f * std::sin(0.11f * static_cast<float>(x + 2 * y));
            test.at(x, y) = 0.9f * reference.at(x, y) + 0.002f * static_cast<float>((x * 37 + y * 91) % 61);
        }
    }
    const double expected = multi_scale_by_formula(test, reference, 1.0);
    EXPECT_LT(expected, 0.99);  // the two differ
    EXPECT_NEAR(multi_scale_ssim(test, reference, 1.0), expected, order_of_summation);
    EXPECT_EQ(multi_scale_ssim(reference, reference, 1.0), 1.0);
}

// NumPy 1.24.2 and SciPy 1.10.1 (Debian 12), whose window is that of structural_similarity:
//
//   import numpy as np
//   from scipy.ndimage import gaussian_filter
//   y, x = np.mgrid[0:181, 0:187]
//   f = np.float32
//   r = f(((x // 16) * 29 + (y // 16) * 53) % 64) / f(64) * f(0.5) + f((x * 37 + y * 91 + x * y) % 256) / f(256) *
//   f(0.5) v = r * f(0.75) + f((x * 5 + y * 3) % 32) / f(128) g = lambda a: gaussian_filter(a, 1.5, truncate=3.5,
//   mode='reflect')[5:-5, 5:-5] def ssim(v, r, last):
//       v, r = v.astype(float), r.astype(float)
//       mv, mr = g(v), g(r)
//       cs = (2 * (g(v * r) - mv * mr) + 0.03**2) / (g(v * v) - mv * mv + g(r * r) - mr * mr + 0.03**2)
//       return ((2 * mv * mr + 0.01**2) / (mv**2 + mr**2 + 0.01**2) * cs if last else cs).mean()
//   def half(a):
//       a = a[:a.shape[0] // 2 * 2, :a.shape[1] // 2 * 2]
//       return f(0.25) * (a[0::2, 0::2] + a[0::2, 1::2] + a[1::2, 0::2] + a[1::2, 1::2])
//   result = 1.0
//   for k, w in enumerate((0.0448, 0.2856, 0.3001, 0.2363, 0.1333)):
//       result *= ssim(v, r, k == 4)**w
//       v, r = half(v), half(r)
TEST(MultiScaleSsim, MatchesNumPyAndSciPy) {
    Image test(187, 181, 1), reference(187, 181, 1);
    for (int y = 0; y < 181; ++y) {
        for (int x = 0; x < 187; ++x) {
            reference.at(x, y) = static_cast<float>(((x / 16) * 29 + (y / 16) * 53) % 64) / 64.0f * 0.5f +
                                 static_cast<float>((x * 37 + y * 91 + x * y) % 256) / 256.0f * 0.5f;
            test.at(x, y) = reference.at(x, y) * 0.75f + static_cast<float>((x * 5 + y * 3) % 32) / 128.0f;
        }
    }
    EXPECT_NEAR(multi_scale_ssim(test, reference, 1.0), 0.9065057731775003, order_of_summation);
}

// At the coarsest scale one pixel is left of 16 x 16, at which contrast and structure have nothing to say of a
// constant.
TEST(MultiScaleSsim, OfTwoConstantsIsTheBrightnessTermOfTheCoarsestScaleAlone) {
    const double brightness = 0.2501 / 0.3126;  // (2 * 0.5 * 0.25 + 1e-4) / (0.25 + 0.0625 + 1e-4)
    EXPECT_NEAR(multi_scale_ssim(Image(176, 176, 1, 0.5f), Image(176, 176, 1, 0.25f), 1.0),
                std::pow(brightness, 0.1333), order_of_summation);
}

TEST(MultiScaleSsim, ForgivesNoiseThatDistanceTakesAway) {
    // Of one pixel's size: gone at coarser scales. A slope stays.
    Image flat(200, 200, 1, 0.5f), noisy = flat, sloped = flat;
    std::mt19937 random(1);
    for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 200; ++x) {
            noisy.at(x, y) += random() % 2 == 0 ? 0.1f : -0.1f;
            sloped.at(x, y) += 0.1f * std::sqrt(3.0f) * (2.0f * (static_cast<float>(x) + 0.5f) / 200.0f - 1.0f);
        }
    }
    const double of_noise = multi_scale_ssim(noisy, flat, 1.0), of_slope = multi_scale_ssim(sloped, flat, 1.0);
    EXPECT_GT(of_noise, ssim(noisy, flat, 1.0).mean);
    EXPECT_LT(of_slope, 1.0);
}

TEST(MultiScaleSsim, ImagesTooSmallForItsScalesAreRefused) {
    EXPECT_THROW(multi_scale_ssim(Image(200, 175, 1), Image(200, 175, 1), 1.0), ImageError);
    EXPECT_EQ(multi_scale_ssim(Image(176, 176, 1), Image(176, 176, 1), 1.0), 1.0);
}

TEST(Ssim, ImagesSmallerThanTheWindowAreRefused) {
    EXPECT_THROW(ssim(Image(10, 20, 1), Image(10, 20, 1), 1.0), ImageError);
}

}  // namespace
}  // namespace plumb
