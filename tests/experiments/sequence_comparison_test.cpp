#include "experiments/sequence_comparison.h"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "experiments/config_error.h"
#include "experiments/gate.h"
#include "experiments/image_pairs.h"
#include "experiments/sequence_report.h"
#include "frames/image_error.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr int width = 24, height = 16;
constexpr double float32 = 1e-6;  // values of about 1, stored in single precision

// A wall that nothing moves in front of, lit evenly; a truth in halves without noise.
Frame truth() {
    Frame frame(width, height);
    for (const char* plane : {"ao", "half_a.ao", "half_b.ao"}) frame.set(plane, Image(width, height, 1, 0.5f));
    frame.set("depth", Image(width, height, 1, 2.0f));
    frame.set("motion", Image(width, height, 2));
    Image& normal = frame.set("normal", Image(width, height, 3));
    Image& position = frame.set("position", Image(width, height, 3, -2.0f));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            normal.at(x, y, 2) = 1.0f;
            position.at(x, y, 0) = 0.01f * static_cast<float>(x);
            position.at(x, y, 1) = 0.01f * static_cast<float>(y);
        }
    }
    frame.facts["samples"] = "64";
    return frame;
}

Frame image(float ao) {
    Frame frame(width, height);
    frame.set("ao", Image(width, height, 1, ao));
    return frame;
}

const MeasuredThing& find(const std::vector<MeasuredThing>& things, const std::string& full_name) {
    for (const MeasuredThing& thing : things) {
        if (thing.full_name() == full_name) return thing;
    }
    throw std::out_of_range(full_name);
}

TEST(SequenceComparison, OfOneFrameHasTheMeasuresOfThatFrame) {
    SequenceComparison comparison({});
    comparison.add("a", image(0.75f), truth());
    const auto whole = comparison.whole();
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_DOUBLE_EQ(find(whole, "ao").measure("rmse"), 0.25);
    EXPECT_DOUBLE_EQ(find(whole, "ao").measure("unbiased_rmse"), 0.25);
    EXPECT_TRUE(std::isnan(find(whole, "ao").measure("flicker"))) << "nothing came before";
    EXPECT_THAT(comparison.only_in_reference(), testing::Contains("depth"));
}

TEST(SequenceComparison, PoolsSquaresOverFramesAndMeasuresFlicker) {
    SequenceComparison comparison({});
    // Errors of 0.1, 0.2 and -0.2: mean square 0.03; changes of 0.1 and -0.4: mean square 0.085.
    comparison.add("1", image(0.6f), truth());
    comparison.add("2", image(0.7f), truth());
    comparison.add("3", image(0.3f), truth());
    const auto whole = comparison.whole();
    const MeasuredThing& ao = find(whole, "ao");
    EXPECT_NEAR(ao.measure("rmse"), std::sqrt(0.03), float32);
    EXPECT_NEAR(ao.measure("unbiased_rmse"), std::sqrt(0.03), float32);
    EXPECT_NEAR(ao.measure("psnr"), -10 * std::log10(0.03), 1e-4) << "ao's range is 1";
    EXPECT_NEAR(ao.measure("maximum"), 0.2, float32);
    EXPECT_NEAR(ao.measure("bias"), 0.1 / 3, float32);
    EXPECT_NEAR(ao.measure("flicker"), std::sqrt(0.085), float32);
    EXPECT_NEAR(ao.measure("truth_warping"), 0.0, float32);
    EXPECT_EQ(ao.measure("values"), 3.0 * width * height);
    EXPECT_EQ(ao.measure("flicker_trustworthy"), 1.0);
    EXPECT_NEAR(comparison.frames()[2].things[0].measure("flicker"), 0.4, float32);
    EXPECT_TRUE(std::isnan(ao.measure("temporal_variance"))) << "three frames of eight";
}

TEST(SequenceComparison, MeasuresRegionsAndGbuffers) {
    SequenceSettings settings;
    settings.regions = true;
    SequenceComparison comparison(settings);
    for (int frame = 0; frame < 2; ++frame) {
        Frame test = image(0.5f);
        // A tenth of 16 pixels: the border is where pixel centres are nearer than 1.6 pixels, two wide.
        for (int y = 0; y < height; ++y) test.plane("ao").at(0, y) = 1.0f;
        test.set("depth", Image(width, height, 1, 2.02f));
        comparison.add("f", test, truth());
    }
    const auto whole = comparison.whole();
    const double border = 2.0 * width * 2 + 2.0 * (height - 4) * 2;
    EXPECT_NEAR(find(whole, "ao@border").measure("mse"), 0.25 * height / border, float32);
    EXPECT_NEAR(find(whole, "ao@border").measure("unbiased_mse"), 0.25 * height / border, float32);
    EXPECT_EQ(find(whole, "ao@rest").measure("rmse"), 0.0);
    EXPECT_NEAR(find(whole, "layer1").measure("depth_error_mean"), 0.01, float32);
    EXPECT_EQ(find(whole, "layer1").measure("agreement"), 0.0);
    EXPECT_NEAR(find(whole, "layer1").measure("depth_error_p95_lower"), 0.01, 1e-5) << "a thousandth of it at most";
    EXPECT_EQ(find(whole, "layer1").measure("hit_agreement_upper"), 1.0);
    EXPECT_THROW(find(whole, "ao@newly_seen"), std::out_of_range) << "nothing is newly seen";
    EXPECT_TRUE(whole.front().region.empty());
    EXPECT_FALSE(whole.back().region.empty());
}

TEST(SequenceComparison, TellsFlickerOfRegions) {
    SequenceSettings settings;
    settings.regions = true;
    SequenceComparison comparison(settings);
    for (int frame = 0; frame < 3; ++frame) {
        Frame test = image(0.5f);
        // Grows in the first column, which the border holds.
        for (int y = 0; y < height; ++y) test.plane("ao").at(0, y) += 0.25f * static_cast<float>(frame);
        comparison.add("f", test, truth());
    }
    const auto whole = comparison.whole();
    const double border = 2.0 * width * 2 + 2.0 * (height - 4) * 2;
    EXPECT_NEAR(find(whole, "ao@border").measure("flicker"), 0.25 * std::sqrt(height / border), float32);
    EXPECT_NEAR(find(whole, "ao@rest").measure("flicker"), 0.0, float32);
    EXPECT_NEAR(find(whole, "ao").measure("flicker"), 0.25 * std::sqrt(1.0 / width), float32);
}

TEST(SequenceReport, PrintsWhatThereIsAndJsonHasAllOfIt) {
    SequenceSettings settings;
    settings.regions = true;
    SequenceComparison comparison(settings);
    comparison.add("frame_1", image(0.5f), truth());
    comparison.add("frame_2", image(0.75f), truth());
    const auto whole = comparison.whole();
    EXPECT_THAT(print_frames(comparison.frames(), whole),
                AllOf(HasSubstr("frame_1"), HasSubstr("all"), HasSubstr("0.25 [0.25, 0.25]"), Not(HasSubstr("FLIP"))));
    EXPECT_THAT(print_measures(whole), AllOf(HasSubstr("flicker_trustworthy"), HasSubstr("border"), HasSubstr("rest")));
    const auto json = json_of(whole);
    EXPECT_DOUBLE_EQ(json["planes"]["ao"]["flicker"].get<double>(), 0.25);
    EXPECT_TRUE(json["regions"]["ao"].contains("border"));
    EXPECT_FALSE(json["planes"]["ao"].contains("flip"));
    EXPECT_EQ(json_of(comparison.frames())[0]["planes"]["ao"]["psnr"], "inf");
}

TEST(Gate, HoldsMeasuresOfPlanesRegionsLayersAndSequences) {
    const std::vector<MeasuredThing> things = {{"ao", "", {{"rmse", 0.1}, {"flicker", 0.02}, {"flip", NAN}}},
                                               {"layer1", "", {{"agreement", 0.9}}},
                                               {"ao", "border", {{"rmse", 0.3}, {"flicker", 0.04}}}};
    const auto failed = [&](const std::string& above, const std::string& below = "") {
        std::vector<Limit> limits = parse_limits(above, true);
        for (const Limit& limit : parse_limits(below, false)) limits.push_back(limit);
        return breaches(things, limits);
    };
    EXPECT_THAT(failed("rmse=0.1,flicker=0.03,rmse@border=0.3", "agreement=0.9"), IsEmpty());
    EXPECT_THAT(failed("rmse=0.05"), ElementsAre("ao: rmse = 0.1 is above 0.05"));
    EXPECT_THAT(failed("rmse@border=0.2,flicker=0.01"),
                ElementsAre("ao: rmse@border = 0.3 is above 0.2", "ao: flicker = 0.02 is above 0.01"));
    EXPECT_THAT(failed("flicker@border=0.03"), ElementsAre("ao: flicker@border = 0.04 is above 0.03"));
    EXPECT_THAT(failed("", "agreement=0.95"), ElementsAre("layer1: agreement = 0.9 is below 0.95"));
    EXPECT_THAT(failed("flip=1"), ElementsAre(HasSubstr("ao: flip does not exist")));
    EXPECT_THAT(failed("rmse@silhouettes=1"), ElementsAre(HasSubstr("rmse@silhouettes does not exist")));
    EXPECT_THAT(failed("temporal_variance=1"), ElementsAre(HasSubstr("temporal_variance does not exist")));
    EXPECT_THROW(parse_limits("rmse@boarder=1", true), ConfigError);
    EXPECT_THROW(parse_limits("agreement@border=1", true), ConfigError) << "of whole G-buffers only";
    EXPECT_THROW(parse_limits("rsme=1", true), ConfigError);
    EXPECT_THROW(parse_limits("rmse=", true), ConfigError);
}

void touch(const std::filesystem::path& file) { std::ofstream(file) << '\n'; }

TEST(ImagePairs, AreFilesOfTheSameNameInTheOrderOfTheirNumbers) {
    const TemporaryFolder folder;
    for (const char* side : {"a", "b"}) std::filesystem::create_directory(folder.path / side);
    for (const char* name : {"f10.exr", "f9.exr", "f009b.exr", "extra.png", "notes.txt"})
        touch(folder.path / "a" / name);
    for (const char* name : {"f9.exr", "f10.exr", "f009b.exr", "f11.exr"}) touch(folder.path / "b" / name);
    const ImagePairs pairs = find_pairs(folder.path / "a", folder.path / "b");
    ASSERT_EQ(pairs.pairs.size(), 3u);
    EXPECT_EQ(pairs.pairs[0].name, "f9.exr");
    EXPECT_EQ(pairs.pairs[1].name, "f009b.exr");
    EXPECT_EQ(pairs.pairs[2].name, "f10.exr");
    EXPECT_THAT(pairs.only_in_test, ElementsAre("extra.png"));
    EXPECT_THAT(pairs.only_in_reference, ElementsAre("f11.exr"));
    EXPECT_THROW(find_pairs(folder.path / "a", folder.path / "b" / "f9.exr"), ImageError);
    std::filesystem::create_directory(folder.path / "c");
    EXPECT_THROW(find_pairs(folder.path / "a", folder.path / "c"), ImageError) << "empty";
    touch(folder.path / "c" / "other.exr");
    EXPECT_THROW(find_pairs(folder.path / "a", folder.path / "c"), ImageError) << "no name in common";
    EXPECT_EQ(find_pairs(folder.path / "a" / "f9.exr", folder.path / "c" / "other.exr").pairs.size(), 1u);
}

}  // namespace
}  // namespace plumb
