// What it takes for history to be kept: the distance from a point's plane, or that of points as the sources have it.
#include <algorithm>

#include <fmt/format.h>

#include "gl_test.h"
#include "temporal_walk.h"

namespace plumb {
namespace {

using TemporalRejectionTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(TemporalRejectionTest);

constexpr int width = 120, height = 90;

// What the sources' distance of points costs: at the paper's limit of 1 cm slanted surfaces lose their history to the
// half pixel that a point is off the grid, and no surface gains any.
TEST_P(TemporalRejectionTest, TheDistanceOfPointsRejectsSlantedSurfacesThatTheirPlaneKeeps) {
    const TemporalWalk walk(width, height);
    const auto weights = [&](HistoryRejection rejection) {
        Method method = with_small_shadows({});
        method.gbuffer.minimum_separation = 0.05f;
        method.ao.temporal = {
            .alpha = 0.85f, .rejection = rejection, .reject_from = 0.01f, .reject_to = 0.01f, .layers = 2};
        Pipeline pipeline(context(), walk.scene, method, {.planes = {"ao.history_weight"}}, width, height);
        pipeline.render(walk.frame(0));
        return pipeline.render(walk.frame(1)).frame.plane("ao.history_weight");
    };
    const auto kept = [](const Image& weight) {
        return std::ranges::count_if(weight.values(), [](float value) { return value > 0.5f * 0.85f; });
    };
    const auto from_plane = kept(weights(HistoryRejection::plane)),
               from_point = kept(weights(HistoryRejection::mara2016));
    fmt::print("within 1 cm: {} of {} pixels keep their history by the plane's distance, {} by the point's\n",
               from_plane, width * height, from_point);
    EXPECT_GT(from_plane, width * height / 2);
    EXPECT_LT(from_point, from_plane * 9 / 10);
    EXPECT_GT(from_point, 0);
}

}  // namespace
}  // namespace plumb
