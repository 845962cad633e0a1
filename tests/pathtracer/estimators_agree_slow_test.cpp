// Ways of rendering agree (see estimator_comparisons.h) also where the noise of several bounces, or of directions that
// seldom find the light, takes minutes to average below the bias that has to be seen.
#include <gtest/gtest.h>

#include "tests/pathtracer/estimator_comparisons.h"
#include "tests/pathtracer/lit_room.h"

namespace plumb {
namespace {

std::vector<Comparison> comparisons() {
    const Way lights = by(EmitterSampling::lights), directions = by(EmitterSampling::directions),
              both = by(EmitterSampling::both);
    const std::vector<std::string> indirect = {"indirect"}, all = {"indirect", "reflection", "total"};
    return {
        {room(), lights, both, indirect, 3, 16384},
        {room(), directions, both, indirect, 3, 49152},
        {open_air(), lights, both, indirect, 1, 65536},
        {open_air(), directions, both, indirect, 1, 32768},
        {open_air(), half_a, half_b, indirect, 1, 32768},
        {glossy_room(), lights, both, all, 2, 16384},
        {glossy_room(), directions, both, all, 2, 32768},
        {room_with_a_pane(), lights, both, indirect, 2, 16384},
        {room_with_a_pane(), directions, both, indirect, 2, 49152},
        {glossy_room(), roulette_after(0), roulette_after(1), all, 4, 16384},
    };
}

class EstimatorsAgreeSlowly : public testing::TestWithParam<int> {};

TEST_P(EstimatorsAgreeSlowly, AndWouldNotWithABiasOfOnePercent) {
    expect_agreement(comparisons()[static_cast<std::size_t>(GetParam())]);
}

INSTANTIATE_TEST_SUITE_P(All, EstimatorsAgreeSlowly, testing::Range(0, static_cast<int>(comparisons().size())),
                         [](const auto& test) {
                             return test_name(comparisons()[static_cast<std::size_t>(test.param)]);
                         });

// An image takes half of the light samples from the panel and the sun.
TEST(Superposition, WithAnEnvironmentImageHoldsOnAverage) {
    expect_superposition({"direct", "reflection"}, 0, 4096, Sky::image);
}

TEST(Superposition, OfAllKindsOfLightHoldsOnAverageAfterABounce) {
    expect_superposition({"indirect", "reflection"}, 1, 8192);
}

}  // namespace
}  // namespace plumb
