#include "experiments/result_files.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/experiments/sample_results.h"

namespace plumb {
namespace {

using testing::HasSubstr;

TEST(ResultsCsv, HasOneLinePerRowAndAsManyFieldsAsTheHeader) {
    RunResults results = sample_results();
    results.rows[0].measures[0].second = std::numeric_limits<double>::quiet_NaN();
    std::istringstream lines(print_csv(results));
    std::string header, line;
    std::getline(lines, header);
    const auto fields = std::ranges::count(header, ',');
    int count = 0;
    while (std::getline(lines, line)) {
        ++count;
        EXPECT_EQ(std::ranges::count(line, ','), fields) << line;
    }
    EXPECT_EQ(count, 6);
    EXPECT_THAT(header, HasSubstr(",rmse,"));
}

TEST(ResultsCsv, QuotesFieldsThatHoldCommasOrQuotes) {
    RunResults results = sample_results();
    results.rows[0].method = "one, \"tuned\"";
    EXPECT_THAT(print_csv(results), HasSubstr(",\"one, \"\"tuned\"\"\","));
}

TEST(ResultFiles, TellIntervalsRegionsStabilityAndFidelity) {
    RunResults results = sample_results();
    ResultRow& row = results.rows[0];
    row.regions = {{"border", 40, 0.04, 0.03, 0.05}};
    row.regions[0].measures = {{"flip", 0.125}, {"flip_lower", 0.0625}};
    row.stability = sample_stability(0.01);
    row.fidelity = {{"depth_error_mean", 0.5}};
    row.seeds = 4, row.over_seeds = {{"mae", {0.5, 0.25, 0.75}}};
    const std::string csv = print_csv(results);
    std::istringstream lines(csv);
    std::string header, line;
    std::getline(lines, header), std::getline(lines, line);
    const auto fields = [](const std::string& text) {
        std::vector<std::string> list;
        std::istringstream stream(text);
        for (std::string field; std::getline(stream, field, ',');) list.push_back(field);
        return list;
    };
    const auto names = fields(header), values = fields(line);
    const auto value_of = [&](const std::string& name) {
        const auto place = std::ranges::find(names, name) - names.begin();
        return place < std::ssize(values) ? values[static_cast<std::size_t>(place)] : "no column " + name;
    };
    EXPECT_EQ(value_of("flip_border"), "0.125");
    EXPECT_EQ(value_of("unbiased_mse_border"), "0.04");
    EXPECT_EQ(value_of("flicker"), "0.01");
    EXPECT_EQ(value_of("flicker_lower"), "0.009");
    EXPECT_EQ(value_of("method_warping_upper"), "0.55");
    EXPECT_EQ(value_of("temporal_variance"), "0.01");
    EXPECT_EQ(value_of("temporal_variance_lower"), "0.009");
    EXPECT_EQ(value_of("depth_error_mean"), "0.5");
    for (const char* name : {"mae_lower", "psnr_upper", "ssim_lower", "p99_upper", "relative_mse_tev_lower"})
        EXPECT_EQ(value_of(name), "0") << name;

    const auto json = nlohmann::json::parse(print_json(results))["rows"][0];
    EXPECT_EQ(json["regions"]["border"]["measures"]["flip_lower"], 0.0625);
    EXPECT_EQ(json["regions"]["border"]["unbiased_mse"], 0.04);
    EXPECT_EQ(json["stability"]["truth_warping"], 0.4);
    EXPECT_EQ(json["stability"]["trustworthy"], true);
    EXPECT_EQ(json["gbuffer"]["depth_error_mean"], 0.5);
    EXPECT_EQ(json["seeds"]["mae_lower"], 0.25);
}

TEST(ResultsJson, HoldsEveryParameterAndNullForWhatIsNoNumber) {
    RunResults results = sample_results();
    results.rows[0].measures[0].second = std::numeric_limits<double>::infinity();
    const auto json = nlohmann::json::parse(print_json(results));
    EXPECT_EQ(json["rows"].size(), 6u);
    EXPECT_TRUE(json["rows"][0]["measures"].begin().value().is_number() ||
                json["rows"][0]["measures"].begin().value().is_null());
    EXPECT_TRUE(json["rows"][0]["measures"][results.rows[0].measures[0].first].is_null());
    for (const std::string& name : method_parameter_names())
        EXPECT_TRUE(json["rows"][0]["parameters"].contains(name)) << name;
    EXPECT_EQ(json["rows"][0]["milliseconds"]["passes"]["ao"], 1.2);
    EXPECT_EQ(json["gl"]["renderer"], "a renderer");
    EXPECT_EQ(json["gl"]["timer"], "glFinish and the steady clock");
    EXPECT_TRUE(json["program"].contains("git"));
    EXPECT_TRUE(json["machine"].contains("cpu"));
}

}  // namespace
}  // namespace plumb
