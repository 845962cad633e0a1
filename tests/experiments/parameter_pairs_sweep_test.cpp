// A parameter that changes no pixel is refused, and one that is refused changes none: all pairs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "parameter_pairs.h"
#include "tests/busy_scene.h"

namespace plumb {
namespace {

using testing::IsEmpty;

// A part of them at a time, so that a failure does not take the others along.
constexpr std::size_t parts = 4;

void judge(const std::vector<ParameterPair>& pairs, std::size_t part) {
    const std::unique_ptr<GlContext> context = GlContext::create();
    const PairVerdicts verdicts = judge_pairs(*context, make_busy_scene(), pairs, part, parts);
    EXPECT_THAT(verdicts.silent, IsEmpty()) << "of " << verdicts.compared;
    EXPECT_THAT(verdicts.slander, IsEmpty()) << "of " << verdicts.compared;
}

class ParameterPairsWithin : public testing::TestWithParam<std::tuple<std::string, std::size_t>> {};

TEST_P(ParameterPairsWithin, ChangeAPixelUnlessTheyAreRefused) {
    judge(pairs_within(std::get<0>(GetParam())), std::get<1>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Groups, ParameterPairsWithin,
                         testing::Combine(testing::ValuesIn(parameter_groups()), testing::Range<std::size_t>(0, parts)),
                         [](const auto& part) {
                             return std::get<0>(part.param) + "_" + std::to_string(std::get<1>(part.param));
                         });

class ParameterPairsWithPlanes : public testing::TestWithParam<std::size_t> {};

TEST_P(ParameterPairsWithPlanes, ChangeAPixelUnlessTheyAreRefused) { judge(pairs_with_planes(), GetParam()); }

INSTANTIATE_TEST_SUITE_P(Parts, ParameterPairsWithPlanes, testing::Range<std::size_t>(0, parts));

}  // namespace
}  // namespace plumb
