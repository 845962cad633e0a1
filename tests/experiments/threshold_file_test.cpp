// Thresholds and check files as text: what they mean, and how their mistakes are told.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/check_file.h"
#include "experiments/thresholds.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string valid = R"([[thresholds]]
name = "ao"
kind = "error"
plane = "ao"
method = "two_layers"
fail_above = 0.2
reason = "because"
)";

ThresholdSet parse(const std::string& text) {
    const ConfigValue table = parse_config(text, "t.toml");
    ConfigReader reader(table, "t.toml");
    ThresholdSet set = read_thresholds(reader);
    reader.finish();
    return set;
}

std::string parse_failure(const std::string& text) {
    return message_of<ConfigError>([&] { parse(text); });
}

// `valid` with one line replaced.
std::string with_line(int line, const std::string& replacement) {
    std::istringstream lines(valid);
    std::string text;
    int number = 1;
    for (std::string one; std::getline(lines, one); ++number)
        text.append(number == line ? replacement : one).append("\n");
    return text;
}

TEST(Thresholds, ReadWithDefaults) {
    const Threshold threshold = parse(valid).thresholds.at(0);
    EXPECT_EQ(threshold.name, "ao");
    EXPECT_EQ(threshold.kind, ThresholdKind::error);
    EXPECT_EQ(threshold.measure, "rmse");
    EXPECT_EQ(threshold.rows.scene, "*");
    EXPECT_EQ(threshold.rows.view, "*");
    EXPECT_EQ(threshold.rows.path, "") << "an error is that of views unless a path is named";
    EXPECT_EQ(threshold.rows.truth, "full");
    EXPECT_EQ(threshold.over, OverRows::worst);
    EXPECT_TRUE(threshold.fails_above);
    EXPECT_EQ(threshold.limit, 0.2);
    EXPECT_FALSE(threshold.calibrated.has_value());
}

TEST(Thresholds, RatiosAreMeansOverRowsByDefault) {
    EXPECT_EQ(parse(with_line(3, "kind = \"benefit\"\nrelative_to = \"one_layer\"")).thresholds.at(0).over,
              OverRows::mean);
    EXPECT_EQ(parse(with_line(3, "kind = \"cost\"")).thresholds.at(0).over, OverRows::mean);
}

TEST(Thresholds, FlickerIsThatOfPaths) {
    const Threshold threshold = parse(with_line(3, "kind = \"flicker\"")).thresholds.at(0);
    EXPECT_EQ(threshold.rows.path, "*");
    EXPECT_EQ(threshold.rows.view, "");
    EXPECT_EQ(threshold.measure, "flicker");
    EXPECT_EQ(parse(with_line(3, "kind = \"flicker\"\nregion = \"border\"")).thresholds.at(0).region, "border");
}

TEST(Thresholds, WaitForCalibrationWhereTheLimitSaysSo) {
    const Threshold threshold = parse(with_line(6, "fail_below = \"calibrate\"")).thresholds.at(0);
    EXPECT_FALSE(threshold.limit.has_value());
    EXPECT_FALSE(threshold.fails_above);
}

TEST(Thresholds, MistakesAreReportedWithTheirLine) {
    EXPECT_THAT(parse_failure(with_line(7, "")), AllOf(HasSubstr("t.toml:1"), HasSubstr("'reason' is missing")));
    EXPECT_THAT(parse_failure(with_line(7, "reason = \"  \"")),
                AllOf(HasSubstr("t.toml:7"), HasSubstr("must say why")));
    EXPECT_THAT(parse_failure(with_line(3, "kind = \"eror\"")),
                AllOf(HasSubstr("t.toml:3"), HasSubstr("did you mean 'error'?")));
    EXPECT_THAT(parse_failure(with_line(6, "")),
                AllOf(HasSubstr("t.toml:1"), HasSubstr("either fail_above or fail_below")));
    EXPECT_THAT(parse_failure(with_line(6, "fail_above = 1\nfail_below = 0")),
                HasSubstr("either fail_above or fail_below"));
    EXPECT_THAT(parse_failure(with_line(6, "fail_above = \"high\"")),
                AllOf(HasSubstr("t.toml:6"), HasSubstr("must be a number or \"calibrate\"")));
    EXPECT_THAT(parse_failure(valid + "measure = \"rsme\"\n"),
                AllOf(HasSubstr("t.toml:8"), HasSubstr("did you mean 'rmse'?")));
    EXPECT_THAT(parse_failure(valid + "region = \"boarder\"\nmeasure = \"ssim\"\n"),
                AllOf(HasSubstr("t.toml:8"), HasSubstr("did you mean 'border'?")));
    EXPECT_THAT(parse_failure(valid + "region = \"border\"\nmeasure = \"ms_ssim\"\n"),
                AllOf(HasSubstr("t.toml:8"), HasSubstr("such as ssim")));
    EXPECT_THAT(parse_failure(valid + "region = \"border\"\nmeasure = \"normal_angle_mean\"\n"),
                HasSubstr("only measured over whole views"));
    EXPECT_THAT(parse_failure(with_line(3, "kind = \"benefit\"")), HasSubstr("'relative_to' is missing"));
    EXPECT_THAT(parse_failure(with_line(3, "kind = \"cost\"\nmeasure = \"rmse\"")),
                AllOf(HasSubstr("t.toml:4"), HasSubstr("unknown key")));
    EXPECT_THAT(parse_failure(valid + "path = \"strafe\"\nview = \"front\"\n"),
                AllOf(HasSubstr("t.toml:9"), HasSubstr("unknown key")))
        << "a row is either of a view or of a path";
    EXPECT_THAT(parse_failure(valid + valid),
                AllOf(HasSubstr("t.toml:9"), HasSubstr("two thresholds are called 'ao'")));
}

TEST(Thresholds, SurvivePrintingAndReading) {
    ThresholdSet set = parse(valid + R"(view = "front"
truth = "within*"
over = "mean"
region = "silhouettes"
calibrated = { runs = 10, mean = 0.123456789, spread = 0.00123, least = 0.12, greatest = 0.13 }
[[thresholds]]
name = "quotes \" and \\ and ü"
kind = "benefit"
path = "strafe"
plane = "total"
method = "two_layers"
relative_to = "one_layer"
measure = "flicker"
fail_below = -1e-7
reason = "a\nb\tc"
[[thresholds]]
name = "time"
kind = "cost"
plane = "ao"
method = "*"
fail_above = "calibrate"
reason = "r"
[calibration]
machines = ["a \"fast\" one", "another"]
date = "2026-01-31T23:59:59Z"
workload = 3
)");
    const ThresholdSet again = parse(print_thresholds(set));
    ASSERT_EQ(again.thresholds.size(), 3u);
    EXPECT_EQ(print_thresholds(again), print_thresholds(set));
    EXPECT_EQ(again.thresholds[0].calibrated->mean, 0.123456789);
    EXPECT_EQ(again.thresholds[0].rows.view, "front");
    EXPECT_EQ(again.thresholds[0].region, "silhouettes");
    EXPECT_EQ(again.thresholds[1].name, "quotes \" and \\ and ü");
    EXPECT_EQ(again.thresholds[1].reason, "a\nb\tc");
    EXPECT_EQ(again.thresholds[1].limit, -1e-7);
    EXPECT_EQ(again.thresholds[1].rows.path, "strafe");
    EXPECT_FALSE(again.thresholds[2].limit.has_value());
    EXPECT_THAT(again.calibration->machines, testing::ElementsAre("a \"fast\" one", "another"));
    EXPECT_EQ(again.calibration->workload, 3);
}

TEST(Patterns, StarsStandForAnyLetters) {
    EXPECT_TRUE(matches_pattern("*", ""));
    EXPECT_TRUE(matches_pattern("*", "front"));
    EXPECT_TRUE(matches_pattern("within*", "within 0.3 m"));
    EXPECT_TRUE(matches_pattern("*layers*", "two_layers"));
    EXPECT_TRUE(matches_pattern("a*b*c", "a-b-b-c"));
    EXPECT_TRUE(matches_pattern("", ""));
    EXPECT_FALSE(matches_pattern("", "front"));
    EXPECT_FALSE(matches_pattern("front", "fronts"));
    EXPECT_FALSE(matches_pattern("a*b*c", "a-b-b-cd"));
    EXPECT_FALSE(matches_pattern("two", "two_layers"));
}

// A check file in a folder of its own, with thresholds beside it.
class CheckFileTest : public testing::Test {
protected:
    static inline const std::string experiment = R"(planes = ["ao"]
methods = ["one_layer", {name = "mine", base = "two_layers", ao.samples = 6}]
thresholds = "limits.toml"
[[scenes]]
scene = "cornell"
method.ao.bias = 0.001
)";
    static inline const std::string must_fail = R"([[must_fail]]
name = "broken"
threshold = "ao"
method = { base = "mine", ao.intensity = 0.2 }
)";

    CheckFile load(const std::string& check, const std::string& thresholds) {
        write("check.toml", check), write("limits.toml", thresholds);
        return load_check_file(folder_.path / "check.toml");
    }
    std::string failure(const std::string& check, const std::string& thresholds) {
        return message_of<ConfigError>([&] { load(check, thresholds); });
    }
    void write(const std::string& name, const std::string& text) { std::ofstream(folder_.path / name) << text; }

    TemporaryFolder folder_;
    const std::string limits_ = with_line(5, "method = \"mine\"");
};

TEST_F(CheckFileTest, HoldsExperimentThresholdsAndBrokenMethods) {
    const CheckFile check = load(experiment + must_fail, limits_);
    EXPECT_EQ(check.experiment.methods.size(), 2u) << "broken methods are no part of the experiment";
    EXPECT_EQ(check.thresholds_file, folder_.path / "limits.toml");
    ASSERT_EQ(check.must_fail.size(), 1u);
    EXPECT_EQ(check.must_fail[0].method.name, "broken");
    EXPECT_EQ(check.must_fail[0].method.ao.samples, 6) << "from its base";
    EXPECT_FLOAT_EQ(check.must_fail[0].method.ao.intensity, 0.2f);
    EXPECT_THAT(without_limit(check), testing::IsEmpty());
}

TEST_F(CheckFileTest, ThresholdsMayStandInTheSameFile) {
    std::string text = experiment + must_fail + limits_;
    text.erase(text.find("thresholds ="), text.find("[[scenes]]") - text.find("thresholds ="));
    const CheckFile check = load(text, "");
    EXPECT_TRUE(check.thresholds_file.empty());
    EXPECT_EQ(check.set.thresholds.size(), 1u);
}

TEST_F(CheckFileTest, MistakesNameTheFileThatHoldsThem) {
    EXPECT_THAT(failure(experiment, limits_),
                AllOf(HasSubstr("check.toml"), HasSubstr("nothing proves that this gate")));
    EXPECT_THAT(failure(experiment + must_fail, ""), HasSubstr("limits.toml"));
    EXPECT_THAT(failure(experiment + must_fail, with_line(4, "plane = \"a0\"")),
                AllOf(HasSubstr("limits.toml:1"), HasSubstr("plane 'a0'"), HasSubstr("did you mean 'ao'?")));
    EXPECT_THAT(failure(experiment + must_fail, with_line(5, "method = \"mien\"")),
                AllOf(HasSubstr("method 'mien'"), HasSubstr("did you mean 'mine'?")));
    EXPECT_THAT(failure(experiment + must_fail, limits_ + "scene = \"cornel\"\n"),
                AllOf(HasSubstr("scene 'cornel'"), HasSubstr("did you mean 'cornell'?")));
    EXPECT_THAT(failure(experiment + "[[must_fail]]\nname = \"b\"\nthreshold = \"a0\"\nmethod = { base = \"mine\" }\n",
                        limits_),
                AllOf(HasSubstr("check.toml:9"), HasSubstr("did you mean 'ao'?")));
    EXPECT_THAT(failure(experiment + "[[must_fail]]\nname = \"b\"\nthreshold = \"ao\"\nmethod = { base = \"mine\" }\n",
                        limits_),
                AllOf(HasSubstr("check.toml:10"), HasSubstr("breaks nothing")));
    EXPECT_THAT(failure(experiment + "[[must_fail]]\nname = \"mine\"\nthreshold = \"ao\"\n"
                                     "method = { base = \"mine\", ao.samples = 1 }\n",
                        limits_),
                AllOf(HasSubstr("check.toml:8"), HasSubstr("another method")));
    EXPECT_THAT(failure(experiment + "[[must_fail]]\nname = \"b\"\nthreshold = \"ao\"\n"
                                     "method = { base = \"mine\", ao.bias = 0.5 }\n",
                        limits_),
                AllOf(HasSubstr("check.toml:10"), HasSubstr("scene 'cornell' sets the same parameter"),
                      HasSubstr("ao.bias = 0.001 instead of 0.5")));
    EXPECT_THAT(failure(experiment + must_fail + "[[must_fails]]\n", limits_),
                AllOf(HasSubstr("check.toml:11"), HasSubstr("unknown key")));
}

TEST_F(CheckFileTest, TheGateOfThisRepositoryIsValid) {
    const CheckFile check = load_check_file(PLUMBLINE_SOURCE_DIR "/experiments/ci.toml");
    EXPECT_GE(check.set.thresholds.size(), 15u);
    EXPECT_THAT(without_limit(check), testing::IsEmpty()) << "it is calibrated";
    EXPECT_GE(check.must_fail.size(), 4u) << "one for each kind of limit";
}

}  // namespace
}  // namespace plumb
