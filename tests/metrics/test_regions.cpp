#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gmock/gmock.h>

#include "frames/image_error.h"
#include "metrics/regions.h"

namespace plumb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int width = 40, height = 20;
constexpr float infinite = std::numeric_limits<float>::infinity();

// A wall at `depth` metres that faces the camera.
Frame wall(float depth = 2.0f) {
    Frame frame(width, height);
    frame.set("depth", Image(width, height, 1, depth));
    Image& normal = frame.set("normal", Image(width, height, 3));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) normal.at(x, y, 2) = 1.0f;
    }
    return frame;
}

const Region& region(const std::vector<Region>& regions, const std::string& name) {
    for (const Region& each : regions) {
        if (each.name == name) return each;
    }
    throw std::out_of_range(name);
}

std::vector<std::string> names_of(const std::vector<Region>& regions) {
    std::vector<std::string> names;
    names.reserve(regions.size());
    for (const Region& each : regions) names.push_back(each.name);
    return names;
}

// The columns of a mask's row that are set.
std::vector<int> columns_of(const Image& mask, int row) {
    std::vector<int> columns;
    for (int x = 0; x < mask.width(); ++x) {
        if (mask.at(x, row) != 0.0f) columns.push_back(x);
    }
    return columns;
}

TEST(Regions, AWallThatFacesTheCameraHasABorderAndARest) {
    const auto regions = regions_of(wall());
    EXPECT_THAT(names_of(regions), ElementsAre("silhouettes", "border", "rest"));
    EXPECT_EQ(region(regions, "silhouettes").pixels, 0u);
    // A tenth of 20 pixels on each side.
    EXPECT_EQ(region(regions, "rest").pixels, 36u * 16);
    EXPECT_EQ(region(regions, "border").pixels, 40u * 20 - 36u * 16);
    EXPECT_EQ(region(regions, "border").mask.at(1, 10), 1.0f);
    EXPECT_EQ(region(regions, "border").mask.at(2, 10), 0.0f);
}

TEST(Regions, AStepInDepthIsASilhouetteTwoPixelsWideOnEitherSide) {
    Frame frame = wall();
    for (int y = 0; y < height; ++y) {
        for (int x = 20; x < width; ++x) frame.plane("depth").at(x, y) = 2.05f;  // 2.5 % farther
    }
    // Pixels 19 and 20 are at the edge; two more on either side are near it.
    EXPECT_THAT(columns_of(region(regions_of(frame), "silhouettes").mask, 10), ElementsAre(17, 18, 19, 20, 21, 22));
    RegionSettings settings;
    settings.silhouette_width = 0;
    EXPECT_THAT(columns_of(region(regions_of(frame, nullptr, settings), "silhouettes").mask, 10), ElementsAre(19, 20));
    settings.silhouette_depth_bend = 0.03;
    EXPECT_EQ(region(regions_of(frame, nullptr, settings), "silhouettes").pixels, 0u) << "2.5 % is below 3 %";
}

TEST(Regions, AFloorSeenAtAGrazingAngleIsNoSilhouette) {
    // Of a floor 1 m below a camera with 20 pixels to 45 degrees, row j (centre) is seen at depth 20 / (j + 0.5): from
    // 40 m down to 1 m, in steps of up to two thirds of the depth.
    Frame frame = wall();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) frame.plane("depth").at(x, y) = 20.0f / (static_cast<float>(y) + 0.5f);
    }
    EXPECT_EQ(region(regions_of(frame), "silhouettes").pixels, 0u);
}

TEST(Regions, ACreaseOfMoreThanFifteenDegreesAndTheEdgeToNothingAreSilhouettes) {
    for (const double degrees : {14.0, 16.0}) {
        Frame frame = wall();
        const double angle = degrees * std::numbers::pi / 180.0;
        for (int y = 0; y < height; ++y) {
            for (int x = 20; x < width; ++x) {
                frame.plane("normal").at(x, y, 0) = static_cast<float>(std::sin(angle));
                frame.plane("normal").at(x, y, 2) = static_cast<float>(std::cos(angle));
            }
        }
        EXPECT_EQ(region(regions_of(frame), "silhouettes").pixels > 0, degrees > 15.0) << degrees << " degrees";
    }
    Frame sky = wall();
    for (int x = 0; x < width; ++x) sky.plane("depth").at(x, 0) = infinite;
    const auto regions = regions_of(sky);
    EXPECT_EQ(region(regions, "silhouettes").pixels, 4u * width) << "rows 0 and 1, widened to rows 0 to 3";
}

TEST(Regions, NewlySeenIsWhatAPostHidBeforeAndWhatComesInOverTheEdge) {
    // A camera that pans right by three pixels: the wall's point x - 3 pixels away was seen three pixels to the right.
    Frame now = wall(), before = wall();
    for (Frame* frame : {&now, &before}) {
        Image& position = frame->set("position", Image(width, height, 3, -2.0f));
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                position.at(x, y, 0) = 0.01f * static_cast<float>(frame == &now ? x + 3 : x);
                position.at(x, y, 1) = 0.01f * static_cast<float>(y);
            }
        }
    }
    Image& motion = now.set("motion", Image(width, height, 2));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) motion.at(x, y, 0) = 3.0f;
        before.plane("position").at(13, y, 2) = -1.0f;  // the post
    }
    EXPECT_THAT(columns_of(region(regions_of(now, &before), "newly_seen").mask, 5), ElementsAre(10, 37, 38, 39));
    EXPECT_THAT(names_of(regions_of(now, nullptr)), testing::Not(testing::Contains("newly_seen")));

    // A renderer that knows says so itself.
    Image& seen = now.set("seen_before", Image(width, height, 1, 1.0f));
    seen.at(4, 5) = 0.0f;
    EXPECT_THAT(columns_of(region(regions_of(now, &before), "newly_seen").mask, 5), ElementsAre(4));
}

TEST(Regions, SecondLayerIsWhereItHoldsSomethingAndRestIsWhatNothingElseIs) {
    Frame frame = wall();
    Image& second = frame.set("layer2.depth", Image(width, height, 1, infinite));
    for (int x = 10; x < 15; ++x) second.at(x, 10) = 3.0f;
    const auto regions = regions_of(frame);
    EXPECT_THAT(columns_of(region(regions, "second_layer").mask, 10), ElementsAre(10, 11, 12, 13, 14));
    EXPECT_EQ(region(regions, "rest").pixels, 36u * 16 - 5);
    EXPECT_EQ(region(regions, "rest").mask.at(12, 10), 0.0f);
}

TEST(Regions, ErrorsAreOfTheirPixelsAlone) {
    Frame frame = wall();
    Image& second = frame.set("layer2.depth", Image(width, height, 1, infinite));
    Frame method(width, height), truth(width, height);
    Image& test = method.set("ao", Image(width, height, 1, 0.5f));
    truth.set("half_a.ao", Image(width, height, 1, 0.25f));
    truth.set("half_b.ao", Image(width, height, 1, 0.25f));
    for (int x = 10; x < 20; ++x) {
        second.at(x, 10) = 3.0f;
        test.at(x, 10) = 0.75f;
    }
    const auto errors = errors_in_regions(method, truth, "ao", 64, regions_of(frame));
    ASSERT_EQ(errors.size(), 3u) << "there are no silhouettes, and none in the list";
    EXPECT_EQ(errors[0].region, "second_layer");
    EXPECT_EQ(errors[0].pixels, 10u);
    EXPECT_DOUBLE_EQ(errors[0].error.mse, 0.25);
    EXPECT_EQ(errors[1].region, "border");
    EXPECT_DOUBLE_EQ(errors[1].error.mse, 0.0625);
    EXPECT_EQ(errors[2].region, "rest");
    EXPECT_DOUBLE_EQ(errors[2].error.mse, 0.0625);
    EXPECT_DOUBLE_EQ(errors[2].error.lower, 0.0625) << "the same everywhere";
    EXPECT_EQ(errors[2].error.reference_samples, 64);
}

TEST(Regions, SayWhatIsMissingAndWhichSettingsMakeSense) {
    Frame frame(width, height);
    frame.set("depth", Image(width, height, 1, 2.0f));
    try {
        regions_of(frame);
        FAIL() << "no ImageError";
    } catch (const ImageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("normal"));
    }
    RegionSettings settings;
    settings.border = 0.6;
    EXPECT_THROW(regions_of(wall(), nullptr, settings), ImageError);
    const Frame before = wall();
    EXPECT_THROW(regions_of(wall(), &before), ImageError) << "no motion";
}

// Two renderings of a truth of 1 whose halves share their noise with those of the reference, as with one seed.
TEST(PairedReferencedError, IsFreeOfTheNoiseOfBothAlsoWhereTheyShareIt) {
    constexpr int side = 64, draws = 200;
    constexpr float error = 0.02f;
    std::mt19937 random(8);
    std::normal_distribution<float> normal;
    for (const float shared : {0.0f, 0.9f}) {
        double sum = 0, squares = 0, unpaired = 0;
        for (int draw = 0; draw < draws; ++draw) {
            Image ia(side, side, 1), ib = ia, a = ia, b = ia, mean = ia;
            const auto noise = [&](float& truth, float& test) {
                const float common = normal(random);
                truth = 1.0f + 0.1f * common;
                test = 1.0f + error + 0.1f * (shared * common + std::sqrt(1.0f - shared * shared) * normal(random));
            };
            for (std::size_t i = 0; i < a.values().size(); ++i) {
                noise(a.values()[i], ia.values()[i]);
                noise(b.values()[i], ib.values()[i]);
                mean.values()[i] = 0.5f * (ia.values()[i] + ib.values()[i]);
            }
            ReferencedErrorSettings quick;
            quick.bootstrap.resamples = 40;  // the interval is not looked at here
            const double mse = paired_referenced_error(ia, ib, a, b, 16, quick).mse;
            sum += mse, squares += mse * mse;
            unpaired += referenced_error(mean, a, b, 16, quick).mse;
        }
        const double mse = sum / draws, standard_error = std::sqrt((squares / draws - mse * mse) / (draws - 1));
        // Four standard errors: a correct estimator fails once in 16000 seeds.
        EXPECT_NEAR(mse, error * error, 4 * standard_error) << "shared " << shared;
        EXPECT_LT(standard_error, 0.1 * error * error) << "otherwise the test above proves nothing";
        // What one image against two halves gives: off by the test's variance less twice its covariance with the
        // reference, 0.005 (1 - shared) - 0.005 shared.
        EXPECT_NEAR(unpaired / draws - error * error, 0.005 * (1 - 2 * shared), 2e-4);
    }
}

TEST(PairedReferencedError, MatchesTwoPixelsComputedByHand) {
    Image ia(2, 1, 1), ib(2, 1, 1), a(2, 1, 1), b(2, 1, 1);
    ia.at(0, 0) = 1.0f, ib.at(0, 0) = 2.0f, a.at(0, 0) = 0.5f, b.at(0, 0) = 1.75f;  // 0.5 * 0.25 = 0.125
    ia.at(1, 0) = 1.0f, ib.at(1, 0) = 1.0f, a.at(1, 0) = 2.0f, b.at(1, 0) = 1.25f;  // -1 * -0.25 = 0.25
    const ReferencedError error = paired_referenced_error(ia, ib, a, b, 8);
    EXPECT_DOUBLE_EQ(error.mse, 0.1875);
    EXPECT_DOUBLE_EQ(error.plain_mse, (0.375 * 0.375 + 0.625 * 0.625) / 2);
    EXPECT_DOUBLE_EQ(error.reference_noise_mse, (0.25 * 0.25 + 0.75 * 0.75) / 8);
    EXPECT_DOUBLE_EQ(error.mse, error.plain_mse - error.reference_noise_mse);
}

}  // namespace
}  // namespace plumb
