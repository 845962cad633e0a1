// The work that costs are told by: always the same, and of both kinds.
#include "rasterizer/calibrating_workload.h"

#include <algorithm>
#include <cmath>

#include "rasterizer/texture_transfer.h"
#include "tests/rasterizer/gl_test.h"

namespace plumb {
namespace {

class CalibratingWorkloadTest : public GlTest {};

TEST_P(CalibratingWorkloadTest, LeavesTheSamePictureEveryTime) {
    CalibratingWorkload first(context()), second(context());
    first.draw(), second.draw(), second.draw();
    const Image a = read_back(first.result(), 0, 4), b = read_back(second.result(), 0, 4);
    EXPECT_TRUE(std::ranges::equal(a.values(), b.values()));
}

TEST_P(CalibratingWorkloadTest, ReachesItsTapsThroughTheTriangles) {
    CalibratingWorkload workload(context());
    workload.draw();
    const Image image = read_back(workload.result(), 0, 4);
    std::size_t gathered = 0, finite = 0;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            gathered += image.at(x, y, 0) > 0.0f ? 1 : 0;
            finite += std::isfinite(image.at(x, y, 0)) && image.at(x, y, 3) == 1.0f ? 1 : 0;
        }
    }
    const std::size_t pixels = static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
    EXPECT_EQ(finite, pixels);
    // Where nothing was drawn the gather finds no normal and stays black. The field spans 0.7 of the height at 0.35 of
    // bumps to either side; two thirds is what it covers at the least.
    EXPECT_GT(gathered, pixels * 2 / 3);
}

TEST_P(CalibratingWorkloadTest, TellsTheTimeOfDoingItOnce) {
    CalibratingWorkload workload(context());
    // How long it takes is the machine's business; that it takes some time and that an impatient clock works too is
    // not.
    EXPECT_GT(workload.milliseconds(), 0.0);
    EXPECT_GT(workload.milliseconds(0.0), 0.0);
}

TEST_P(CalibratingWorkloadTest, LeavesNoDepthTestBehind) {
    CalibratingWorkload workload(context());
    workload.draw();
    EXPECT_FALSE(context().gl.IsEnabled(GL_DEPTH_TEST)) << "the passes that follow draw without one";
}

PLUMBLINE_BOTH_BACKENDS(CalibratingWorkloadTest);

}  // namespace
}  // namespace plumb
