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
    EXPECT_TRUE(json["program"].contains("git"));
    EXPECT_TRUE(json["machine"].contains("cpu"));
}

}  // namespace
}  // namespace plumb
