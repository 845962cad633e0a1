#include "experiments/result_files.h"

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "experiments/run_json.h"
#include "tests/experiments/sample_results.h"

namespace plumb {
namespace {

using testing::AllOf;
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

// A CSV file without quotes, a map from column to field for each line.
std::vector<std::map<std::string, std::string>> read_csv(const std::string& csv) {
    const auto fields = [](const std::string& text) {
        std::vector<std::string> list;
        std::istringstream stream(text);
        for (std::string field; std::getline(stream, field, ',');) list.push_back(field);
        list.resize(static_cast<std::size_t>(std::ranges::count(text, ',')) + 1);  // the last may be empty
        return list;
    };
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = fields(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(lines, line)) {
        const std::vector<std::string> values = fields(line);
        EXPECT_EQ(values.size(), names.size()) << line;
        auto& row = rows.emplace_back();
        for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values.at(i);
    }
    return rows;
}

TEST(ResultFiles, TellIntervalsRegionsStabilityAndFidelity) {
    RunResults results = sample_results();
    ResultRow& row = results.rows[0];
    row.regions = {{"border", 40, 0.04, 0.03, 0.05}, {"silhouette", 7, 0.09, 0.08, 0.10}};
    row.regions[0].measures = {{"flip", 0.125},   {"flip_lower", 0.0625}, {"relative_mse_tev_upper", 0.5},
                               {"ms_ssim", 0.75}, {"unbiased_rmse", 0.2}, {"rmse_lower", 0.1}};
    row.regions[0].stability = sample_stability(0.02);
    row.regions[1].measured = false;
    row.stability = sample_stability(0.01);
    row.lag = Estimate{5.5, 5.25, 5.75};
    row.fidelity = {{"depth_error_mean", 0.5}};
    row.seeds = 4, row.over_seeds = {{"mae", {0.5, 0.25, 0.75}}};
    const auto whole = read_csv(print_csv(results)).at(0);
    EXPECT_EQ(whole.at("flicker"), "0.01");
    EXPECT_EQ(whole.at("flicker_lower"), "0.009");
    EXPECT_EQ(whole.at("method_warping_upper"), "0.55");
    EXPECT_EQ(whole.at("temporal_variance"), "0.01");
    EXPECT_EQ(whole.at("temporal_variance_lower"), "0.009");
    EXPECT_EQ(whole.at("lag"), "5.5");
    EXPECT_EQ(whole.at("lag_upper"), "5.75");
    EXPECT_EQ(whole.at("depth_error_mean"), "0.5");
    for (const char* name : {"mae_lower", "psnr_upper", "ssim_lower", "p99_upper", "relative_mse_tev_lower"})
        EXPECT_EQ(whole.at(name), "0") << name;

    const auto regions = read_csv(print_regions_csv(results));
    ASSERT_EQ(regions.size(), 2u) << "one row of results has regions";
    const auto& border = regions[0];
    EXPECT_EQ(border.at("scene") + border.at("view") + border.at("plane") + border.at("method"), "cornellfrontaoone");
    EXPECT_EQ(border.at("region"), "border");
    EXPECT_EQ(border.at("pixels"), "40");
    EXPECT_EQ(border.at("measured"), "1");
    EXPECT_EQ(border.at("flip"), "0.125");
    EXPECT_EQ(border.at("flip_lower"), "0.0625");
    EXPECT_EQ(border.at("relative_mse_tev_upper"), "0.5");
    EXPECT_EQ(border.at("ms_ssim"), "0.75");
    EXPECT_EQ(border.at("unbiased_rmse"), "0.2");
    EXPECT_EQ(border.at("rmse_lower"), "0.1");
    EXPECT_EQ(border.at("flicker_upper"), "0.022");
    EXPECT_EQ(border.at("truth_warping_lower"), "0.36");
    EXPECT_EQ(border.at("temporal_variance_upper"), "0.011");
    EXPECT_EQ(border.at("mae"), "") << "not measured";
    EXPECT_EQ(regions[1].at("measured"), "0");
    EXPECT_EQ(regions[1].at("flicker"), "");
    // As of the whole: whoever reads one file reads the other.
    for (const std::string& name : measure_names()) EXPECT_TRUE(border.contains(name) && whole.contains(name)) << name;

    const auto json = nlohmann::json::parse(print_json(results))["rows"][0];
    EXPECT_EQ(json["regions"]["border"]["measures"]["flip_lower"], 0.0625);
    EXPECT_EQ(json["lag"]["lower"], 5.25);
    EXPECT_EQ(json["regions"]["border"]["unbiased_mse"], 0.04);
    EXPECT_EQ(json["stability"]["truth_warping"], 0.4);
    EXPECT_EQ(json["stability"]["trustworthy"], true);
    EXPECT_EQ(json["gbuffer"]["depth_error_mean"], 0.5);
    EXPECT_EQ(json["seeds"]["mae_lower"], 0.25);
}

TEST(ResultFiles, TellOfOraclesWhatTheTruthWasLimitedTo) {
    RunResults results = sample_results();
    results.rows.resize(3);
    results.rows[1].oracle.layers = 0, results.rows[2].oracle.bounces = 2;
    const auto csv = read_csv(print_csv(results));
    EXPECT_EQ(csv.at(0).at("oracle_layers") + csv.at(0).at("oracle_bounces"), "");
    EXPECT_EQ(csv.at(1).at("oracle_layers"), "0");
    EXPECT_EQ(csv.at(1).at("oracle_bounces"), "");
    EXPECT_EQ(csv.at(2).at("oracle_layers"), "");
    EXPECT_EQ(csv.at(2).at("oracle_bounces"), "2");
    const nlohmann::json json = nlohmann::json::parse(print_json(results));
    EXPECT_TRUE(json["rows"][0].contains("parameters"));
    EXPECT_EQ(json["rows"][1]["oracle_layers"], 0);
    EXPECT_FALSE(json["rows"][1].contains("oracle_bounces"));
    EXPECT_EQ(json["rows"][2]["oracle_bounces"], 2);
    EXPECT_FALSE(json["rows"][2].contains("oracle_layers") || json["rows"][2].contains("parameters"));
}

TEST(ResultsJson, HasALineForEachRowAndIsReadAsBefore) {
    RunResults results = sample_results();
    results.rows[1].regions = {{"border", 40, 0.04, 0.03, 0.05}};
    results.rows[2].frames = {{0.0, 0.1, 0.2}, {0.1, 0.2, 0.3}};
    const std::string text = print_json(results);
    const nlohmann::ordered_json json = nlohmann::ordered_json::parse(text);
    std::istringstream lines(text);
    std::vector<std::string> all;
    for (std::string line; std::getline(lines, line);) all.push_back(line);
    for (const auto& row : json["rows"]) {
        const std::string comma = row == json["rows"].back() ? "" : ",";
        EXPECT_EQ(std::ranges::count(all, "    " + row.dump() + comma), 1);
    }
    EXPECT_THAT(text, AllOf(HasSubstr("\n  \"interrupted\": false,\n"), HasSubstr("\n    \"planes\": [\"ao\"],\n"),
                            HasSubstr("\n  \"failures\": [],\n")));
}

TEST(PrintJsonLines, KeepsEveryValueAndReplacesBytesThatAreNoText) {
    const nlohmann::ordered_json json = {
        {"a", 0.1}, {"b", {{"c", {1, 2}}, {"d", {{"e", nullptr}}}}}, {"f", {{{"g", 1}}}}};
    EXPECT_EQ(print_json_lines(json),
              "{\n  \"a\": 0.1,\n  \"b\": {\n    \"c\": [1,2],\n    \"d\": {\"e\":null}\n  },\n"
              "  \"f\": [\n    {\"g\":1}\n  ]\n}\n");
    EXPECT_THAT(print_json_lines({{"file", "\xff.toml"}}), HasSubstr("\xEF\xBF\xBD.toml"));
    EXPECT_EQ(print_json_lines(nlohmann::ordered_json::object()), "{}\n");
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
