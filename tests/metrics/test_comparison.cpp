#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/comparison.h"
#include "tests/metrics/pattern.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Comparison, MeasuresHaveAFixedOrderAndNamesThatThresholdsCanRelyOn) {
    std::vector<std::string> names = measure_names();
    // Intervals stand right behind what they are of.
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (!has_interval(names[i])) continue;
        EXPECT_EQ(names.at(i + 1), names[i] + "_lower");
        EXPECT_EQ(names.at(i + 2), names[i] + "_upper");
        names.erase(names.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                    names.begin() + static_cast<std::ptrdiff_t>(i) + 3);
    }
    EXPECT_THAT(
        names, ElementsAre("mae", "mse", "rmse", "bias", "relative_mse_pbrt", "relative_mse_tev", "relative_mse_falcor",
                           "psnr", "ssim", "ms_ssim", "flip", "flip_first_exposure", "flip_last_exposure", "median",
                           "p95", "p99", "maximum", "data_range", "reference_mean", "values", "left_out",
                           "unbiased_mse", "unbiased_rmse", "unbiased_relative_mse_pbrt", "unbiased_relative_mse_tev",
                           "unbiased_relative_mse_falcor", "unbiased_psnr", "reference_noise_mse", "noise_ratio",
                           "trustworthy"));
}

TEST(Comparison, TellsIntervalsOfAllThatSaysHowFarImagesAreApart) {
    const Image reference = test::pattern(180, 200, false), other = test::pattern(180, 200, true);
    Image test = reference;  // near enough that no scale of MS-SSIM has a negative mean
    for (std::size_t i = 0; i < test.values().size(); ++i) test.values()[i] += 0.2f * other.values()[i];
    ComparisonSettings settings;
    settings.flip = FlipRange::displayed;
    settings.referenced.bootstrap.resamples = 100;
    Frame method(200, 180), truth(200, 180);
    method.set("ao", test);
    for (const char* plane : {"ao", "half_a.ao", "half_b.ao"}) truth.set(plane, reference);
    const PlaneComparison comparison = compare_plane(method, truth, "ao", settings).front();
    for (const std::string& name : measure_names()) {
        if (!has_interval(name)) continue;
        EXPECT_LE(comparison.measure(name + "_lower"), comparison.measure(name)) << name;
        EXPECT_GE(comparison.measure(name + "_upper"), comparison.measure(name)) << name;
        EXPECT_LT(comparison.measure(name + "_lower"), comparison.measure(name + "_upper")) << name;
    }
    settings.intervals = false;
    const PlaneComparison without = compare_plane(method, truth, "ao", settings).front();
    EXPECT_EQ(without.measure("mae"), comparison.measure("mae"));
    EXPECT_EQ(without.measure("unbiased_mse"), comparison.measure("unbiased_mse"));
    EXPECT_TRUE(std::isnan(without.measure("mae_lower")));
}

TEST(Comparison, TellsPsnrFreeOfTheReferencesNoise) {
    Frame method(64, 64), truth(64, 64);
    method.set("ao", Image(64, 64, 1, 0.75f));
    truth.set("ao", Image(64, 64, 1, 0.5f));
    truth.set("half_a.ao", Image(64, 64, 1, 0.375f)), truth.set("half_b.ao", Image(64, 64, 1, 0.625f));
    const PlaneComparison comparison = compare_plane(method, truth, "ao").front();
    // 0.375 times 0.125 against 0.25 squared; the peak of ao is 1.
    EXPECT_NEAR(comparison.measure("unbiased_psnr"), -10.0 * std::log10(0.046875), 1e-9);
    EXPECT_NEAR(comparison.measure("unbiased_psnr_lower"), -10.0 * std::log10(0.046875), 1e-9);
    EXPECT_NEAR(comparison.measure("psnr"), -10.0 * std::log10(0.0625), 1e-9);
    EXPECT_NEAR(comparison.measure("unbiased_relative_mse_tev"), 0.046875 / 0.26, 1e-9);
    method.set("ao", Image(64, 64, 1, 0.5f));
    EXPECT_EQ(compare_plane(method, truth, "ao").front().measure("unbiased_psnr"),
              std::numeric_limits<double>::infinity())
        << "below zero: lost in the noise";
}

TEST(Comparison, OverRegionsIsThatOfTheMasksWithTheMapsOfTheWholeImage) {
    const Image test = test::pattern(37, 53, true), reference = test::pattern(37, 53, false);
    Frame method(53, 37), truth(53, 37);
    method.set("ao", test), truth.set("ao", reference);
    Region right{"border", Image(53, 37, 1), 0}, none{"rest", Image(53, 37, 1), 0};
    for (int y = 0; y < 37; ++y) {
        for (int x = 30; x < 53; ++x) right.mask.at(x, y) = 1.0f, ++right.pixels;
    }
    ComparisonSettings settings;
    settings.flip = FlipRange::by_plane;
    const auto comparisons = compare_plane(method, truth, "ao", settings, {right, none});
    ASSERT_EQ(comparisons.size(), 2u) << "a region without pixels is left out";
    const PlaneComparison& inside = comparisons[1];
    EXPECT_EQ(inside.region, "border");
    EXPECT_EQ(inside.pixels, right.pixels);
    EXPECT_EQ(inside.measure("mae"), pixel_errors(test, reference, 1.0, &right.mask).mae);
    EXPECT_EQ(inside.measure("p95"), pixel_errors(test, reference, 1.0, &right.mask).percentile_95);
    EXPECT_EQ(inside.measure("ssim"), ssim(test, reference, 1.0, &right.mask).mean);
    EXPECT_EQ(inside.measure("flip"), mean_flip(ldr_flip(test, reference), &right.mask));
    EXPECT_LT(inside.measure("flip_lower"), inside.measure("flip"));
    EXPECT_TRUE(std::isnan(inside.measure("ms_ssim")));
    EXPECT_EQ(comparisons[0].measure("mae"), pixel_errors(test, reference, 1.0).mae);
}

TEST(Comparison, TakesExposuresAndPixelsPerDegreeThatAreStated) {
    const Image test = test::pattern(37, 53, true), reference = test::pattern(37, 53, false);
    ComparisonSettings settings;
    settings.flip = FlipRange::radiance;
    settings.pixels_per_degree = 30.0;
    settings.exposures = ExposureRange{-2.0, 1.0, 3};
    const PlaneComparison comparison = compare_planes(test, reference, settings, "total");
    EXPECT_EQ(comparison.measure("flip"), mean_flip(hdr_flip(test, reference, {-2.0, 1.0, 3}, 30.0)));
    EXPECT_EQ(comparison.measure("flip_first_exposure"), -2.0);
    EXPECT_TRUE(compare_planes(test, Image(53, 37, 3), settings, "total").flip) << "a stated range shows black too";
}

TEST(Comparison, HoldsTheSameNumbersAsTheMeasuresThemselves) {
    const Image test = test::pattern(37, 53, true), reference = test::pattern(37, 53, false);
    ComparisonSettings settings;
    settings.data_range = 1.0;
    const PlaneComparison comparison = compare_planes(test, reference, settings, "direct");
    EXPECT_EQ(comparison.plane, "direct");
    EXPECT_EQ(comparison.measure("mse"), pixel_errors(test, reference, 1.0).mse);
    EXPECT_EQ(comparison.measure("ssim"), ssim(test, reference, 1.0).mean);
    EXPECT_EQ(comparison.measure("data_range"), 1.0);
    EXPECT_TRUE(std::isnan(comparison.measure("unbiased_mse"))) << "no half-buffers";
    EXPECT_EQ(comparison.best_mse(), comparison.errors.mse);
    EXPECT_TRUE(std::isnan(comparison.measure("flip"))) << "nobody asked for it";
    EXPECT_THROW(comparison.measure("rsme"), ImageError);
}

TEST(Comparison, TakesTheFlipThatSuitsThePlane) {
    const Image test = test::pattern(37, 53, true), reference = test::pattern(37, 53, false);
    ComparisonSettings settings;
    settings.flip = FlipRange::by_plane;
    const PlaneComparison displayed = compare_planes(test, reference, settings, "layer2.albedo");
    EXPECT_EQ(displayed.measure("flip"), mean_flip(ldr_flip(test, reference)));
    EXPECT_TRUE(std::isnan(displayed.measure("flip_first_exposure")));

    const PlaneComparison radiance = compare_planes(test, reference, settings, "indirect");
    const ExposureRange range = exposure_range(reference);
    EXPECT_EQ(radiance.measure("flip"), mean_flip(hdr_flip(test, reference, range)));
    EXPECT_EQ(radiance.measure("flip_first_exposure"), range.first);
    EXPECT_EQ(radiance.measure("flip_last_exposure"), range.last);

    EXPECT_FALSE(compare_planes(test, reference, settings, "normal").flip) << "geometry has no colour";
    EXPECT_FALSE(compare_planes(test, Image(53, 37, 3), settings, "indirect").flip) << "no exposure shows black";
    settings.flip = FlipRange::displayed;
    EXPECT_EQ(compare_planes(test, reference, settings, "indirect").flip, displayed.flip);
}

TEST(Comparison, DataRangeIgnoresALampAndStaysPositiveInTheDark) {
    Image radiance(20, 20, 1, 0.5f);
    radiance.at(3, 3) = 1000.0f;
    EXPECT_EQ(default_data_range("total", radiance), 0.5);
    EXPECT_EQ(default_data_range("ao", radiance), 1.0);
    EXPECT_EQ(default_data_range("layer2.normal", radiance), 2.0);
    Image spark(20, 20, 1);
    spark.at(0, 0) = 3.0f;
    EXPECT_EQ(default_data_range("indirect", spark), 3.0);
    EXPECT_EQ(default_data_range("indirect", Image(20, 20, 1)), 1.0);
}

TEST(Comparison, SmallImagesHaveNoSsim) {
    const PlaneComparison comparison = compare_planes(Image(4, 4, 1, 1.0f), Image(4, 4, 1, 0.5f));
    EXPECT_TRUE(std::isnan(comparison.measure("ssim")));
    EXPECT_DOUBLE_EQ(comparison.measure("rmse"), 0.5);
}

TEST(Comparison, OfFramesTakesCommonPlanesHalfBuffersAndSamples) {
    Frame method(12, 12), reference(12, 12);
    method.set("direct", Image(12, 12, 3, 1.0f));
    method.set("ao", Image(12, 12, 1, 0.5f));
    method.set("layer2.depth", Image(12, 12, 1, 2.0f));
    reference.set("direct", Image(12, 12, 3, 0.75f));
    reference.set("half_a.direct", Image(12, 12, 3, 0.5f));
    reference.set("half_b.direct", Image(12, 12, 3, 1.0f));
    reference.set("variance.direct", Image(12, 12, 3, 0.1f));
    reference.set("ao", Image(12, 12, 1, 0.5f));
    reference.set("indirect", Image(12, 12, 3));
    reference.facts["samples"] = "64";

    const FrameComparison comparison = compare_frames(method, reference);
    ASSERT_EQ(comparison.planes.size(), 2u);
    EXPECT_EQ(comparison.planes[0].plane, "ao");
    EXPECT_EQ(comparison.planes[0].errors.mse, 0.0);
    EXPECT_FALSE(comparison.planes[0].referenced);
    EXPECT_EQ(comparison.planes[1].plane, "direct");
    ASSERT_TRUE(comparison.planes[1].referenced);
    EXPECT_EQ(comparison.planes[1].referenced->reference_samples, 64);
    EXPECT_DOUBLE_EQ(comparison.planes[1].best_mse(), 0.0) << "(1 - 0.5)(1 - 1)";
    EXPECT_DOUBLE_EQ(comparison.planes[1].errors.mse, 0.0625);
    EXPECT_EQ(comparison.planes[1].measure("trustworthy"), 0.0);
    EXPECT_THAT(comparison.only_in_test, ElementsAre("layer2.depth"));
    EXPECT_THAT(comparison.only_in_reference, ElementsAre("indirect"));
}

TEST(Comparison, OfFramesThatDoNotFitSaysWhy) {
    const auto message = [](const Frame& a, const Frame& b) -> std::string {
        try {
            compare_frames(a, b);
        } catch (const ImageError& error) {
            return error.what();
        }
        return "no ImageError";
    };
    Frame a(2, 2), b(3, 2), c(2, 2);
    a.set("ao", Image(2, 2, 1));
    b.set("ao", Image(3, 2, 1));
    c.set("direct", Image(2, 2, 3));
    EXPECT_THAT(message(a, b), AllOf(HasSubstr("plane 'ao'"), HasSubstr("2x2"), HasSubstr("3x2")));
    EXPECT_THAT(message(a, c), AllOf(HasSubstr("no plane in common"), HasSubstr("ao"), HasSubstr("direct")));
}

}  // namespace
}  // namespace plumb
