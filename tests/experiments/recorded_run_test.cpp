#include "experiments/recorded_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/result_files.h"
#include "tests/experiments/second_layer_sample.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* experiment_text = R"(planes = ["ao"]
methods = ["tuned/mine.toml", {name = "more", base = "tuned/mine.toml", ao.samples = 9}]
[[scenes]]
scene = "cornell"
)";

// As a run of that experiment would have left it.
RunResults results_of(const TemporaryFolder& folder) {
    Method tuned = load_method("two_layers");
    tuned.name = "mine", tuned.ao.intensity = 0.75f;
    folder.write("tuned/mine.toml", print_method(tuned));
    const std::filesystem::path file = folder.path / "e.toml";
    RunResults results = second_layer_results();
    results.experiment = parse_experiment(parse_config(experiment_text, file.string()), file);
    results.experiment_text = experiment_text;
    return results;
}

TEST(RecordedRun, HasItsMethodsWhereTheirFilesAreGone) {
    const TemporaryFolder folder;
    const RunResults results = results_of(folder);
    folder.write("results.json", print_json(results));
    std::filesystem::remove_all(folder.path / "tuned");
    const RecordedRun recorded = read_recorded_run(folder.path / "results.json");
    ASSERT_EQ(recorded.experiment.methods.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_EQ(method_hash(recorded.experiment.methods[i]), method_hash(results.experiment.methods[i]));
}

TEST(RecordedRun, IsHeldAgainstEveryValueOfARowButItsTimes) {
    const TemporaryFolder folder;
    RunResults results = results_of(folder);
    results.rows[0].regions = {{"border", 40, 0.01, 0.008, 0.012}};
    folder.write("results.json", print_json(results));
    const RecordedRun recorded = read_recorded_run(folder.path / "results.json");
    const int rows = static_cast<int>(results.rows.size());
    EXPECT_EQ(difference(recorded, results).same, rows);
    EXPECT_EQ(difference(recorded, results).rows, rows);

    RunResults again = results;
    again.rows[0].timing.median *= 2.0;
    EXPECT_EQ(difference(recorded, again).same, rows) << "times never come out the same";
    again.rows[0].regions[0].mse_upper *= 1.0 + 1e-15;
    again.rows[1].mse_lower *= 1.0 + 1e-15;
    again.rows.back().parameters.ao.samples = 99;  // the path tracer's: it has no parameters
    again.rows.erase(again.rows.begin() + 2);
    const RunDifference apart = difference(recorded, again);
    EXPECT_EQ(apart.same, rows - 3);
    EXPECT_THAT(apart.rows_apart, ElementsAre(HasSubstr("front / ao / one: regions.border.upper was 0.012"),
                                              HasSubstr("front / ao / two: unbiased_mse.lower was"),
                                              HasSubstr("left / ao / one: is not there any more")));
}

TEST(RecordedRun, AFileThatIsNoneIsToldWithTheReason) {
    const TemporaryFolder folder;
    const auto message_of_text = [&](const std::string& text) {
        const auto file = folder.write("results.json", text);
        return message_of<ConfigError>([&] { read_recorded_run(file); });
    };
    EXPECT_THAT(message_of_text("{\"rows\": ["), HasSubstr("only a part of a file"));
    EXPECT_THAT(message_of_text("{}"), HasSubstr("experiment_text"));
    RunResults of_a_library_call = second_layer_results();
    EXPECT_THAT(message_of_text(print_json(of_a_library_call)), HasSubstr("its experiment is empty"));
}

}  // namespace
}  // namespace plumb
