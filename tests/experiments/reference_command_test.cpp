// `plumbline reference` from the outside: shards, merging, and what its options do to the planes.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frames/exr.h"
#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using Arguments = std::vector<std::string>;

Arguments operator+(Arguments a, const Arguments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

class ReferenceCommand : public testing::Test {
protected:
    // A small view of the Cornell box: an odd size, so that tiles and vectors are cut off.
    Arguments command(const Arguments& more) const {
        return Arguments{"reference", "cornell", "--size", "37", "21", "--output", folder_.path.string()} + more;
    }
    ProgramRun run(const Arguments& more) const { return run_plumbline(command(more)); }
    void expect_fine(const Arguments& more) const {
        const ProgramRun result = run(more);
        EXPECT_EQ(result.exit_code, 0) << result.output;
    }
    void expect_refused(const Arguments& more, const testing::Matcher<const std::string&>& message) const {
        const ProgramRun result = run(more);
        EXPECT_EQ(result.exit_code, 2) << result.output;
        EXPECT_THAT(result.output, message);
    }
    std::string file(const std::string& name) const { return (folder_.path / name).string(); }
    Frame frame(const std::string& view = "front") const {
        return read_exr(file("cornell." + view + ".reference.exr"));
    }
    // Bits, not values: infinities, signed zeros and NaNs included.
    static void expect_same_bits(const Frame& a, const Frame& b) {
        ASSERT_EQ(a.plane_names(), b.plane_names());
        for (const std::string& plane : a.plane_names()) {
            const auto as_bytes = [](const Image& image) { return std::as_bytes(image.values()); };
            EXPECT_TRUE(std::ranges::equal(as_bytes(a.plane(plane)), as_bytes(b.plane(plane)))) << plane;
        }
    }
    static double mean(const Frame& frame, const std::string& plane) {
        double sum = 0.0;
        for (const float value : frame.plane(plane).values()) sum += value;
        return sum / static_cast<double>(frame.plane(plane).values().size());
    }

    TemporaryFolder folder_;
};

class Shards : public ReferenceCommand, public testing::WithParamInterface<Arguments> {};

TEST_P(Shards, ThreeUnevenShardsMergeToTheBitsOfOneRun) {
    const Arguments planes = Arguments{"--planes", "ao,direct,indirect,reflection,total,depth"} + GetParam();
    expect_fine(planes + Arguments{"--samples", "34"});
    const Frame one = frame();
    for (const char* samples : {"0..2", "2..20", "20..34"}) {
        const ProgramRun shard = run(planes + Arguments{"--samples", samples});
        EXPECT_EQ(shard.exit_code, 0) << shard.output;
        EXPECT_THAT(shard.output, AllOf(HasSubstr(".shard"), HasSubstr("--merge"), Not(HasSubstr("--samples"))));
    }
    std::filesystem::remove(file("cornell.front.reference.exr"));
    // In any order.
    const ProgramRun merged =
        run(planes + Arguments{"--merge", file("cornell_front.20-34.shard"), file("cornell_front.0-2.shard"),
                               file("cornell_front.2-20.shard")});
    EXPECT_EQ(merged.exit_code, 0) << merged.output;
    EXPECT_THAT(merged.output, AllOf(HasSubstr("34 samples per pixel of 3 shards"), HasSubstr("standard error: ao ")));
    expect_same_bits(one, frame());
    EXPECT_EQ(frame().facts.at("samples"), "34");
    const auto files = std::filesystem::directory_iterator(folder_.path);
    EXPECT_TRUE(std::none_of(begin(files), end(files), [](const auto& entry) {
        return entry.path().extension() == ".partial" || entry.path().string().find(".tmp") != std::string::npos;
    })) << "checkpoints and temporary files are gone";
}

INSTANTIATE_TEST_SUITE_P(Of, Shards,
                         testing::Values(Arguments{}, Arguments{"--antialias"},
                                         Arguments{"--roulette", "1", "--bounces", "6"},
                                         Arguments{"--points", "random", "--threads", "1"}));

TEST_F(ReferenceCommand, TheCommandThatAShardPrintsMergesTheShards) {
    std::string merge;
    for (const char* samples : {"--samples=0..4", "--samples=4..8"}) {
        const ProgramRun shard = run({"--planes", "ao", samples});
        EXPECT_EQ(shard.exit_code, 0) << shard.output;
        merge = shard.output.substr(shard.output.find("  plumbline reference") + 2);
    }
    const std::string program = PLUMBLINE_PROGRAM;
    merge = "'" + program + "'" + merge.substr(std::string("plumbline").size());
    merge.pop_back();  // the line's end
    const ProgramRun merged = run_shell(merge);
    EXPECT_EQ(merged.exit_code, 0) << merge << merged.output;
    EXPECT_THAT(merged.output, HasSubstr("8 samples per pixel of 2 shards"));
}

TEST_F(ReferenceCommand, ShardsThatDoNotBelongTogetherAreRefusedAndNothingIsWritten) {
    const Arguments planes = {"--planes", "ao"};
    expect_fine(planes + Arguments{"--samples", "2", "--seed", "5"});
    const Frame good = frame();
    for (const char* samples : {"0..4", "2..8", "8..10"}) expect_fine(planes + Arguments{"--samples", samples});
    const std::string first = file("cornell_front.0-4.shard"), overlapping = file("cornell_front.2-8.shard"),
                      last = file("cornell_front.8-10.shard");
    const auto merge = [&](const Arguments& shards) { return planes + Arguments{"--merge"} + shards; };
    expect_refused(merge({first, last}), AllOf(HasSubstr(last), HasSubstr("begins with sample 8, but 4 is the next")));
    expect_refused(merge({first, overlapping}), AllOf(HasSubstr(overlapping), HasSubstr("overlap")));
    expect_refused(merge({first, first}), AllOf(HasSubstr(first), HasSubstr("overlap")));
    expect_refused(merge({last}), AllOf(HasSubstr(last), HasSubstr("0 is the next")));
    expect_refused(merge({file("no.shard")}), HasSubstr("no.shard"));

    // Of other settings, of another view, damaged, and no shard at all; each is named, and so is what to do.
    expect_refused(Arguments{"--seed", "2"} + merge({first}),
                   AllOf(HasSubstr(first), HasSubstr("other settings"), HasSubstr("all other options")));
    expect_refused(Arguments{"--view", "gap"} + merge({first}), AllOf(HasSubstr(first), HasSubstr("another view")));
    expect_refused(Arguments{"--shutter", "0..0.1"} + merge({first}), HasSubstr(first));
    std::filesystem::copy_file(first, file("cut.shard"));
    std::filesystem::resize_file(file("cut.shard"), std::filesystem::file_size(first) - 9);
    expect_refused(merge({file("cut.shard")}), AllOf(HasSubstr("cut.shard"), HasSubstr("cut off")));
    std::filesystem::copy_file(first, file("damaged.shard"));
    std::fstream(file("damaged.shard"), std::ios::in | std::ios::out | std::ios::binary).seekp(1000).put('\x5a');
    expect_refused(merge({file("damaged.shard")}), AllOf(HasSubstr("damaged.shard"), HasSubstr("is damaged")));
    std::ofstream(file("text.shard")) << "no shard";
    expect_refused(merge({first, file("text.shard")}), AllOf(HasSubstr("text.shard"), HasSubstr("not a checkpoint")));
    expect_same_bits(good, frame());
}

TEST_F(ReferenceCommand, WrongUseIsExplained) {
    expect_refused({"--samples", "3..6"}, HasSubstr("must be even"));
    expect_refused({"--samples", "8..8"}, HasSubstr("the end beyond the first"));
    expect_refused({"--samples", "8-16"}, HasSubstr("FIRST..END"));
    expect_refused({"--samples", "0"}, HasSubstr("between 2 and"));
    expect_refused({"--samples", "0..8", "--target-error", "0.1"}, HasSubstr("does not go with a shard"));
    expect_refused({"--shutter", "0.2..0.1"}, HasSubstr("OPEN..CLOSE"));
    expect_refused({"--shutter", "0..1", "--time", "1"}, HasSubstr("excludes"));
    expect_refused({"--oracle-guard-band", "3"}, HasSubstr("requires --oracle"));
    expect_refused({"--oracle", "1", "--emitters", "both"}, HasSubstr("excludes"));
    expect_refused({"--emitters", "lamps"}, HasSubstr("directions"));
    expect_refused({"--points", "halton"}, HasSubstr("sobol"));
    expect_refused({"--path", "straff"}, HasSubstr("strafe"));
    expect_refused({"--path", "strafe", "--view", "front"}, HasSubstr("excludes"));
}

TEST_F(ReferenceCommand, EstimatorOptionsChangeTheNoiseAndNotTheLight) {
    const Arguments base = {"--planes", "total", "--bounces", "4", "--samples", "256"};
    expect_fine(base);
    const Frame standard = frame();
    for (const Arguments& change : {Arguments{"--emitters", "lights"}, Arguments{"--roulette", "1"},
                                    Arguments{"--points", "random"}, Arguments{"--emitters", "directions"}}) {
        expect_fine(base + change);
        const Frame other = frame();
        EXPECT_NE(other.plane("total").at(18, 10), standard.plane("total").at(18, 10)) << change[1];
        // The image's mean, of 777 pixels with 256 samples of relative deviation 1 to 10 each (the light is small for
        // directions), is good to 10 / sqrt(777 * 256) = 2.2 %; three of it.
        EXPECT_NEAR(mean(other, "total") / mean(standard, "total"), 1.0, 0.067) << change[1];
    }
}

TEST_F(ReferenceCommand, AnOracleOfMoreLayersComesNearerToTheTruth) {
    // A scene of thin gaps and occluders just off a surface, which go on beyond the view.
    const auto mean_ao = [&](const Arguments& more) {
        const Arguments base = {"reference", "clutter",      "--view",   "shelf",    "--size",
                                "48",        "27",           "--planes", "ao",       "--samples",
                                "128",       "--separation", "0.02",     "--output", folder_.path.string()};
        const ProgramRun result = run_plumbline(base + more);
        EXPECT_EQ(result.exit_code, 0) << result.output;
        return mean(read_exr(file("clutter.shelf.reference.exr")), "ao");
    };
    const double truth = mean_ao({});
    double last = 2.0;
    // Geometry that is not met opens the view of the sky, so each of these sees less of it than the one before.
    for (const Arguments& oracle : {Arguments{"--oracle", "1"}, Arguments{"--oracle", "2"}, Arguments{"--oracle", "0"},
                                    Arguments{"--oracle", "0", "--oracle-guard-band", "200"}}) {
        const double ao = mean_ao(oracle);
        EXPECT_LT(ao, last) << oracle[1];
        EXPECT_GE(ao, truth) << oracle[1];
        last = ao;
    }
    EXPECT_EQ(read_exr(file("clutter.shelf.reference.exr")).facts.at("oracle_layers"), "all");
}

TEST_F(ReferenceCommand, AnOpenShutterBlursACameraPathAndAStillCameraIsLeftSharp) {
    const std::string blurred = "strafe_0_7s", still = "front";
    const Arguments base = {"--planes", "emission,motion", "--samples", "64"};
    expect_fine(base + Arguments{"--path", "strafe", "--shutter", "0.5..0.7"});
    const Frame moving = frame(blurred);
    expect_fine(base + Arguments{"--path", "strafe", "--time", "0.7"});
    EXPECT_GT(moving.plane("motion").at(18, 10, 0) * moving.plane("motion").at(18, 10, 0), 0.0f)
        << "motion is that while the shutter is open";
    // The light's edge is spread over pixels that it does not reach at an instant.
    const auto lit = [](const Frame& of) {
        const auto values = of.plane("emission").values();
        return std::ranges::count_if(values, [](float value) { return value > 0.0f; });
    };
    EXPECT_GT(lit(moving), lit(frame(blurred)));
    EXPECT_EQ(moving.facts.at("shutter"), "0.5..0.7");

    expect_fine(base + Arguments{"--shutter", "0.5..0.7"});
    const Frame shut = frame(still);
    expect_fine(base);
    EXPECT_EQ(lit(shut), lit(frame(still)));
}

}  // namespace
}  // namespace plumb
