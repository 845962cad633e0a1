// `plumbline check` as a build runs it, at thumbnail size: from limits that wait for calibration to a gate that fails.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Nothing here depends on how noisy so small a truth is.
constexpr const char* experiment = R"(name = "thumbnail"
planes = ["ao"]
resolution = [64, 36]
methods = ["two_layers"]
path_tracer_samples = []
thresholds = "limits.toml"
[reference]
samples = 64
most_noise = 10.0
[timing]
repetitions = 1
[[scenes]]
scene = "cornell"
views = ["front"]
ao_radius = 0.1
minimum_separation = 0.03
method.ao.bias = 0.001
)";

constexpr const char* must_fail = R"([[must_fail]]
name = "hardly any obscurance"
threshold = "obscurance"
method = { base = "two_layers", ao.intensity = 0.05 }
)";

constexpr const char* limits = R"([[thresholds]]
name = "obscurance"
kind = "error"
plane = "ao"
method = "two_layers"
fail_above = "calibrate"
reason = "a reason with \"quotes\""
)";

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

class CheckCommand : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder;
        write("check.toml", std::string(experiment) + must_fail);
        write("limits.toml", limits);
        uncalibrated_ = check("check.toml", "uncalibrated");
        calibration_ = check("check.toml", "calibration", {"--calibrate", "--repetitions", "2"});
        calibrated_limits_ = text_of(folder_->path / "limits.toml");
    }
    static void TearDownTestSuite() {
        delete folder_;
        folder_ = nullptr;
    }
    static void write(const std::string& name, const std::string& text) { std::ofstream(folder_->path / name) << text; }
    static ProgramRun check(const std::string& file, const std::string& output, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments = {"check",       (folder_->path / file).string(),
                                              "--output",    (folder_->path / output).string(),
                                              "--cache-dir", (folder_->path / "cache").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_plumbline(arguments);
    }
    // With other limits, other broken methods.
    static ProgramRun check_with(const std::string& name, const std::string& limits_text, const std::string& broken) {
        write(name + ".toml", replaced(experiment, "limits.toml", name + "_limits.toml") + broken);
        write(name + "_limits.toml", limits_text);
        return check(name + ".toml", name);
    }
    static nlohmann::json json_of(const std::string& output) {
        return nlohmann::json::parse(text_of(folder_->path / output / "check.json"));
    }
    // The calibrated limit times `factor`.
    static std::string scaled_limits(double factor) {
        const std::string key = "fail_above = ";
        const std::size_t start = calibrated_limits_.find(key) + key.size();
        const std::size_t end = calibrated_limits_.find('\n', start);
        std::string text = calibrated_limits_;
        return text.replace(start, end - start, std::to_string(factor * std::stod(text.substr(start, end - start))));
    }

    static TemporaryFolder* folder_;
    static ProgramRun uncalibrated_, calibration_;
    static std::string calibrated_limits_;
};

TemporaryFolder* CheckCommand::folder_ = nullptr;
ProgramRun CheckCommand::uncalibrated_, CheckCommand::calibration_;
std::string CheckCommand::calibrated_limits_;

TEST_F(CheckCommand, AsksForCalibrationWhereLimitsAreMissing) {
    EXPECT_EQ(uncalibrated_.exit_code, 2) << uncalibrated_.output;
    EXPECT_THAT(uncalibrated_.output, AllOf(HasSubstr("'obscurance'"), HasSubstr("--calibrate")));
    EXPECT_FALSE(std::filesystem::exists(folder_->path / "uncalibrated/junit.xml"));
}

TEST_F(CheckCommand, CalibratesWithReasonsKept) {
    EXPECT_EQ(calibration_.exit_code, 0) << calibration_.output;
    EXPECT_THAT(calibrated_limits_, AllOf(HasSubstr("reason = \"a reason with \\\"quotes\\\"\""), HasSubstr("runs = 2"),
                                          HasSubstr("spread = 0"), HasSubstr("2 runs: "), HasSubstr(", no load added")))
        << "two runs of the same build draw the same image";
}

TEST_F(CheckCommand, PassesItsOwnCalibration) {
    const ProgramRun run = check("check.toml", "passing");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output,
                AllOf(HasSubstr("Disk: at most"), HasSubstr("kept"),
                      HasSubstr("Proof: 'hardly any obscurance' breaks 'obscurance'"), HasSubstr("PASSED")));
    const nlohmann::json json = json_of("passing");
    EXPECT_EQ(json["thresholds"][0]["verdict"], "kept");
    EXPECT_EQ(json["thresholds"][0]["moved"], false);
    EXPECT_EQ(json["must_fail"][0]["proven"], true);
    EXPECT_THAT(text_of(folder_->path / "passing/junit.xml"), HasSubstr("failures=\"0\" errors=\"0\""));
    EXPECT_TRUE(std::filesystem::exists(folder_->path / "passing/index.html"));
}

TEST_F(CheckCommand, FailsWhereALimitBreaks) {
    const ProgramRun run = check_with("tight", scaled_limits(0.5), must_fail);
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("BREACHED"), HasSubstr("a reason with \"quotes\""), HasSubstr("FAILED")));
    EXPECT_THAT(text_of(folder_->path / "tight/junit.xml"), HasSubstr("failures=\"1\" errors=\"0\""));
}

TEST_F(CheckCommand, FailsWhereItCouldNot) {
    const ProgramRun run = check_with("toothless", scaled_limits(100.0), must_fail);
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_THAT(run.output, HasSubstr("NO PROOF: 'hardly any obscurance' the gate cannot fail"));
    EXPECT_EQ(json_of("toothless")["thresholds"][0]["verdict"], "kept");
}

TEST_F(CheckCommand, AThresholdWithoutARowIsWrongUse) {
    const std::string nowhere =
        "[[thresholds]]\nname = \"nowhere\"\nkind = \"error\"\nview = \"back\"\nplane = \"ao\"\n"
        "method = \"two_layers\"\nfail_above = 1\nreason = \"r\"\n";
    const ProgramRun run = check_with("nowhere", scaled_limits(1.0) + nowhere, must_fail);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_THAT(run.output, AllOf(HasSubstr("NO ROW"), HasSubstr("view 'back'"), HasSubstr("view front")));
    EXPECT_THAT(text_of(folder_->path / "nowhere/junit.xml"), HasSubstr("failures=\"0\" errors=\"1\""));
}

TEST_F(CheckCommand, TellsCostByTheWorkload) {
    // A limit that no machine breaks; whether the broken method breaks the other one is above.
    const std::string cost =
        "[[thresholds]]\nname = \"cost\"\nkind = \"cost\"\nplane = \"ao\"\nmethod = \"two_layers\"\n"
        "fail_above = 1e9\nreason = \"r\"\n";
    const ProgramRun run = check_with("cost", scaled_limits(1.0) + cost, must_fail);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const nlohmann::json json = json_of("cost");
    ASSERT_EQ(json["costs"].size(), 1u);
    EXPECT_EQ(json["costs"][0]["method"], "two_layers");
    EXPECT_GT(json["costs"][0]["ratio"].get<double>(), 0.0);
    EXPECT_EQ(json["thresholds"][1]["value"], json["costs"][0]["ratio"]);
    const std::string other_workload = replaced(scaled_limits(1.0), "workload = ", "workload = 999") + cost;
    const ProgramRun refused = check_with("other_workload", other_workload, must_fail);
    EXPECT_EQ(refused.exit_code, 2) << refused.output;
    EXPECT_THAT(refused.output, AllOf(HasSubstr("version 999"), HasSubstr("--calibrate")));
}

TEST_F(CheckCommand, LeavesNoVerdictOfARunBefore) {
    std::filesystem::create_directories(folder_->path / "stale");
    write("stale/junit.xml", "old");
    write("stale.toml",
          replaced(replaced(experiment, "\"cornell\"", "\"no_such_scene\""), "limits.toml", "stale_limits.toml") +
              std::string(must_fail));
    write("stale_limits.toml", scaled_limits(1.0));
    const ProgramRun run = check("stale.toml", "stale");
    EXPECT_EQ(run.exit_code, 1) << run.output;
    EXPECT_THAT(text_of(folder_->path / "stale/junit.xml"),
                AllOf(HasSubstr("no_such_scene"), testing::Not(HasSubstr("old"))));
}

TEST_F(CheckCommand, WrongUseSaysWhatToDo) {
    EXPECT_EQ(check("missing.toml", "missing").exit_code, 2);
    const ProgramRun add = check("check.toml", "add", {"--add"});
    EXPECT_EQ(add.exit_code, 2);
    EXPECT_THAT(add.output, HasSubstr("--calibrate"));
    std::string inline_limits =
        replaced(experiment, "thresholds = \"limits.toml\"\n", "") + must_fail + scaled_limits(1.0);
    write("inline.toml", inline_limits);
    const ProgramRun run = check("inline.toml", "inline", {"--calibrate"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.output, HasSubstr("thresholds = \"FILE.toml\""));
}

}  // namespace
}  // namespace plumb
