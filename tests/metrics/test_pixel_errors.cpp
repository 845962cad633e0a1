#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>

#include "frames/exr.h"
#include "frames/image_error.h"
#include "metrics/error_image.h"
#include "metrics/pixel_errors.h"
#include "tests/metrics/pattern.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
// Sums of a few doubles made of values that float32 holds exactly.
constexpr double rounding = 1e-12;

Image row(std::initializer_list<float> values) {
    Image image(static_cast<int>(values.size()), 1, 1);
    std::ranges::copy(values, image.values().begin());
    return image;
}

template <typename Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const ImageError& error) {
        return error.what();
    }
    return "no ImageError";
}

// NumPy 1.24.2 and scikit-image 0.19.3 (Debian 12), on the images of test_ssim.cpp:
//
//   import numpy as np
//   from skimage.metrics import peak_signal_noise_ratio
//   y, x = np.mgrid[0:37, 0:53]
//   value = lambda change: np.stack([((x * 37 + y * 91 + x * y + c * 17 + change) % 256) / 256.0 for c in range(3)],
//   -1) r, v = value(0), value((x // 8 + y // 8) * 5) e = v - r np.abs(e).mean(), e.mean(), np.percentile(np.abs(e),
//   [50, 95, 99]), peak_signal_noise_ratio(r, v, data_range=1.0) for w in ((r + 0.01)**2, r**2 + 0.01, r**2 + 0.001):
//   (e**2 / w).mean()
TEST(PixelErrors, MatchNumPy) {
    const PixelErrors errors = pixel_errors(test::pattern(37, 53, true), test::pattern(37, 53, false), 1.0);
    EXPECT_NEAR(errors.mae, 0.16325110487846337, rounding);
    EXPECT_NEAR(errors.bias, -0.002147341917389087, rounding);
    EXPECT_NEAR(errors.relative_mse_pbrt, 1.1802320524960377, rounding);
    EXPECT_NEAR(errors.relative_mse_tev, 0.23428578192357158, rounding);
    EXPECT_NEAR(errors.relative_mse_falcor, 0.5927745903280035, rounding);
    EXPECT_NEAR(errors.psnr, 10.83603534216654, 10 * rounding);
    EXPECT_EQ(errors.median, 0.09765625);
    EXPECT_EQ(errors.percentile_95, 0.8828125);
    EXPECT_EQ(errors.percentile_99, 0.94140625);
}

TEST(PixelErrors, MatchFourValuesComputedByHand) {
    // Differences: 0.5, -1, 0, 2; squares 0.25, 1, 0, 4.
    const PixelErrors errors = pixel_errors(row({1.5f, 1.0f, 0.25f, 2.0f}), row({1.0f, 2.0f, 0.25f, 0.0f}), 2.0);
    EXPECT_EQ(errors.values, 4u);
    EXPECT_NEAR(errors.mae, 3.5 / 4, rounding);
    EXPECT_NEAR(errors.mse, 5.25 / 4, rounding);
    EXPECT_NEAR(errors.rmse, std::sqrt(1.3125), rounding);
    EXPECT_NEAR(errors.bias, 1.5 / 4, rounding);
    EXPECT_NEAR(errors.reference_mean, 3.25 / 4, rounding);
    EXPECT_NEAR(errors.relative_mse_pbrt, (0.25 / (1.01 * 1.01) + 1 / (2.01 * 2.01) + 0 + 4 / (0.01 * 0.01)) / 4,
                40000 * rounding);
    EXPECT_NEAR(errors.relative_mse_tev, (0.25 / 1.01 + 1 / 4.01 + 0 + 4 / 0.01) / 4, 400 * rounding);
    EXPECT_NEAR(errors.relative_mse_falcor, (0.25 / 1.001 + 1 / 4.001 + 0 + 4 / 0.001) / 4, 4000 * rounding);
    EXPECT_NEAR(errors.psnr, 10 * std::log10(4 / 1.3125), rounding);
    EXPECT_EQ(errors.peak, 2.0);
    EXPECT_NEAR(errors.median, 0.75, rounding) << "of 0, 0.5, 1, 2";
    EXPECT_NEAR(errors.percentile_95, 1.85, rounding) << "position 2.85: between 1 and 2";
    EXPECT_NEAR(errors.percentile_99, 1.97, rounding);
    EXPECT_EQ(errors.maximum, 2.0);
}

TEST(PixelErrors, BiasCarriesTheSignAndEqualImagesHaveInfinitePsnr) {
    EXPECT_LT(pixel_errors(row({0.0f}), row({1.0f}), 1).bias, 0);
    const PixelErrors equal = pixel_errors(row({3.0f, 4.0f}), row({3.0f, 4.0f}), 1);
    EXPECT_EQ(equal.mse, 0.0);
    EXPECT_TRUE(std::isinf(equal.psnr));
}

TEST(PixelErrors, RunOverChannelsAlike) {
    Image test(1, 1, 3), reference(1, 1, 3);
    test.at(0, 0, 2) = 3.0f;
    EXPECT_NEAR(pixel_errors(test, reference, 1).mse, 3.0, rounding);
    EXPECT_EQ(pixel_errors(test, reference, 1).values, 3u);
}

TEST(PixelErrors, SmallDifferencesOnLargeValuesSurvive) {
    // One float32 step at 4096 is 2^-11; a sum in single precision over 10^6 squares would lose most of it.
    const float step = std::ldexp(1.0f, -11);
    const Image reference(1000, 1000, 1, 4096.0f), test(1000, 1000, 1, 4096.0f + step);
    EXPECT_NEAR(pixel_errors(test, reference, 1).mse, std::ldexp(1.0, -22), 1e-9 * std::ldexp(1.0, -22));
}

TEST(PixelErrors, ValuesThatAreNotFiniteAreLeftOutAndCounted) {
    const PixelErrors errors =
        pixel_errors(row({1.0f, nan, infinity, 0.0f, nan}), row({0.0f, 0.0f, infinity, -infinity, 0.0f}), 1);
    EXPECT_EQ(errors.values, 1u);
    EXPECT_EQ(errors.left_out, 4u);
    EXPECT_EQ(errors.non_finite_test, 3u);
    EXPECT_EQ(errors.non_finite_reference, 2u);
    EXPECT_EQ(errors.mse, 1.0);
}

TEST(PixelErrors, AMaskChoosesPixels) {
    const PixelErrors errors = [&] {
        const Image mask = row({0.0f, 1.0f, 0.5f});
        return pixel_errors(row({9.0f, 1.0f, 2.0f}), row({0.0f, 0.0f, 0.0f}), 1, &mask);
    }();
    EXPECT_EQ(errors.values, 2u);
    EXPECT_NEAR(errors.mse, 2.5, rounding);
}

TEST(PixelErrors, WrongUseIsExplainedWithBothShapes) {
    EXPECT_THAT(message_of([] { pixel_errors(Image(4, 3, 3), Image(2, 5, 1), 1); }),
                AllOf(HasSubstr("4x3 with 3 channels"), HasSubstr("2x5 with 1 channels")));
    EXPECT_THAT(message_of([] { pixel_errors(row({nan}), row({0.0f}), 1); }), HasSubstr("1 values are not finite"));
    EXPECT_THAT(message_of([] { pixel_errors(row({1}), row({0}), 0); }), HasSubstr("peak above zero"));
    EXPECT_THAT(message_of([] { pixel_errors(Image(), Image(), 1); }), HasSubstr("no value"));
    const Image mask(2, 2, 1);
    EXPECT_THAT(message_of([&] { pixel_errors(row({1}), row({0}), 1, &mask); }), HasSubstr("2x2"));
}

TEST(PixelErrors, PercentilesAreNumPys) {
    // numpy.percentile of |a - b|, see SSIM's golden values for the images: 0.09765625, 0.8828125, 0.94140625.
    const PixelErrors errors = pixel_errors(test::pattern(37, 53, true), test::pattern(37, 53, false), 1);
    EXPECT_EQ(errors.median, 0.09765625);
    EXPECT_EQ(errors.percentile_95, 0.8828125);
    EXPECT_EQ(errors.percentile_99, 0.94140625);
    EXPECT_NEAR(value_percentile(row({4, 1, nan, 2, 3}), 0.5), 2.5, rounding);
    EXPECT_TRUE(std::isnan(value_percentile(row({nan}), 0.5)));
}

TEST(PixelErrors, MseAndPsnrAreThoseOfScikitImage) {
    // mean_squared_error and peak_signal_noise_ratio (data_range 1), scikit-image 0.19.3, same images.
    const PixelErrors errors = pixel_errors(test::pattern(37, 53, true), test::pattern(37, 53, false), 1);
    EXPECT_NEAR(errors.mse, 0.08248908110830465, rounding);
    EXPECT_NEAR(errors.psnr, 10.83603534216654, rounding);
}

TEST(PixelErrors, AgreeWithOiiotool) {
    if (std::system("oiiotool --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "oiiotool is not installed";
    const TemporaryFolder folder;
    Frame a(53, 37), b(53, 37);
    a.set("total", test::pattern(37, 53, true));
    b.set("total", test::pattern(37, 53, false));
    write_exr(folder / "a.exr", a);
    write_exr(folder / "b.exr", b);
    const auto path = [&](const char* name) { return "'" + (folder / name).string() + "' "; };
    const std::string command = "oiiotool " + path("a.exr") + path("b.exr") + "--diff > " + path("out.txt") + " 2>&1";
    ASSERT_NE(std::system(command.c_str()), -1);  // its exit code says that the images differ
    std::ifstream file(folder / "out.txt");
    std::stringstream text;
    text << file.rdbuf();
    const auto number_after = [&](const std::string& label) {
        const auto at = text.str().find(label + " = ");
        return at == std::string::npos ? -1.0 : std::stod(text.str().substr(at + label.size() + 3));
    };
    const PixelErrors errors = pixel_errors(a.plane("total"), b.plane("total"), 1);
    // It prints six significant digits; its peak is 1.
    EXPECT_NEAR(number_after("Mean error"), errors.mae, 1e-6) << text.str();
    EXPECT_NEAR(number_after("RMS error"), errors.rmse, 1e-6) << text.str();
    EXPECT_NEAR(number_after("Peak SNR"), errors.psnr, 1e-4) << text.str();
    EXPECT_NEAR(number_after("Max error "), errors.maximum, 1e-6) << text.str();
}

TEST(ErrorImages, MatchValuesComputedByHand) {
    const Image test = row({1.5f, 1.0f, nan}), reference = row({1.0f, 2.0f, 0.0f});
    EXPECT_FLOAT_EQ(absolute_error(test, reference).at(1, 0), 1.0f);
    EXPECT_FLOAT_EQ(signed_difference(test, reference).at(1, 0), -1.0f);
    EXPECT_TRUE(std::isnan(absolute_error(test, reference).at(2, 0)));
    Image colour(1, 1, 3, 1.0f);
    colour.at(0, 0, 2) = 4.0f;
    EXPECT_FLOAT_EQ(mean_of_channels(colour).at(0, 0), 2.0f);
    EXPECT_THROW(absolute_error(test, Image(1, 1, 1)), ImageError);
}

}  // namespace
}  // namespace plumb
