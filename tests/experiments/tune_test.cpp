#include "experiments/tune.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/method_file.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::HasSubstr;

Method start() { return load_method("one_layer"); }

// A bowl whose lowest point is at intensity 1.3 and 17 samples, and time that grows with the samples.
TuningCost bowl(const Method& method) {
    return {0.1 + std::pow(std::log(method.ao.intensity / 1.3), 2) + 0.001 * std::pow(method.ao.samples - 17.0, 2),
            static_cast<double>(method.ao.samples)};
}

std::vector<FreeParameter> parameters() {
    return {parse_free_parameter("ao.intensity=0.1..10", start()), parse_free_parameter("ao.samples=4..40", start())};
}

TEST(Tune, FindsTheLowestPointOfABowl) {
    const TuningResult result = tune(start(), parameters(), {.steps = 7, .passes = 5, .budget = 0.0}, bowl);
    // Five passes narrow the range to 0.6^4 of its width in the last: its seven values lie a factor of 1.10 apart.
    EXPECT_NEAR(std::log(result.best.method.ao.intensity / 1.3), 0.0, 0.05);
    EXPECT_EQ(result.best.method.ao.samples, 17);
    EXPECT_LT(result.best.cost.error, result.start.cost.error);
}

TEST(Tune, KeepsTheBudgetAndNeverLosesToItsStart) {
    const TuningResult cheap = tune(start(), parameters(), {.steps = 7, .passes = 3, .budget = 10.5}, bowl);
    EXPECT_TRUE(cheap.best.within_budget);
    EXPECT_EQ(cheap.best.method.ao.samples, 10) << "the nearest to 17 that is tried and keeps the budget";
    const auto at_start = [](const Method& method) {
        return TuningCost{method_hash(method) == method_hash(start()) ? 1.0 : 2.0, 1.0};
    };
    EXPECT_EQ(method_hash(tune(start(), parameters(), {}, at_start).best.method), method_hash(start()));
}

TEST(Tune, WhereNothingKeepsTheBudgetTheFastestIsTheBestAndSaysSo) {
    const TuningResult result = tune(start(), parameters(), {.steps = 3, .passes = 2, .budget = 1.0}, bowl);
    EXPECT_FALSE(result.best.within_budget);
    EXPECT_EQ(result.best.method.ao.samples, 4);
}

TEST(Tune, AnErrorThatIsLostInTheTruthsNoiseNeverWins) {
    const auto lost_at_the_bottom = [](const Method& method) {
        TuningCost cost = bowl(method);
        if (cost.error < 0.15) cost.error = 0.0, cost.refusal = "too noisy";
        return cost;
    };
    const TuningResult result =
        tune(start(), parameters(), {.steps = 7, .passes = 3, .budget = 0.0}, lost_at_the_bottom);
    EXPECT_TRUE(result.best.cost.told());
    EXPECT_GE(result.best.cost.error, 0.15);
    EXPECT_TRUE(std::ranges::any_of(result.trials, [](const TuningTrial& trial) { return !trial.cost.told(); }))
        << "or else nothing was tested";
    // Neither for being fast where nothing keeps the budget.
    const auto lost_where_fast = [](const Method& method) {
        TuningCost cost = bowl(method);
        if (method.ao.samples < 8) cost.refusal = "too noisy";
        return cost;
    };
    const TuningResult slow = tune(start(), parameters(), {.steps = 7, .passes = 1, .budget = 1.0}, lost_where_fast);
    EXPECT_TRUE(slow.best.cost.told());
    const auto lost = [](const Method&) { return TuningCost{0.0, 1.0, "too noisy"}; };
    EXPECT_THAT(message_of<ConfigError>([&] { tune(start(), parameters(), {}, lost); }),
                testing::AllOf(HasSubstr("too noisy"), HasSubstr("[reference]")));
}

TEST(Tune, TriesEachCombinationOnceAndChoicesByName) {
    const std::vector<FreeParameter> normals = {parse_free_parameter("ao.normals=interpolated|face", start())};
    int calls = 0;
    const TuningResult result =
        tune(start(), normals, {.steps = 3, .passes = 4, .budget = 0.0}, [&](const Method& method) {
            ++calls;
            return TuningCost{method.ao.normals == ObscuranceNormals::face ? 0.5 : 1.0, 1.0};
        });
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(result.trials.size(), 2u);
    EXPECT_EQ(result.best.cost.error, 0.5);
}

TEST(Tune, MistakesAreToldWithTheRemedy) {
    const auto failure = [](const std::string& text) {
        return message_of<ConfigError>([&] { parse_free_parameter(text, start()); });
    };
    EXPECT_THAT(failure("ao.intensity"), HasSubstr("name=low..high"));
    EXPECT_THAT(failure("ao.intensity=2..1"), HasSubstr("lower one"));
    EXPECT_THAT(failure("ao.intensty=1..2"), HasSubstr("'ao.intensity'"));
    EXPECT_THAT(failure("ao.samples=0..9"), HasSubstr("ao.samples"));
    EXPECT_THAT(failure("ao.samples=4..many"), HasSubstr("'many' is no number"));
    EXPECT_THAT(failure("ao.normals=face"), HasSubstr("two values at least"));
    EXPECT_THAT(failure("gbuffer.generation=delay|predict"), HasSubstr("gbuffer.layers = 1"))
        << "what has no effect cannot be tuned";
    EXPECT_THAT(message_of<ConfigError>([&] { tune(start(), {}, {}, bowl); }), HasSubstr("nothing to tune"));
}

}  // namespace
}  // namespace plumb
