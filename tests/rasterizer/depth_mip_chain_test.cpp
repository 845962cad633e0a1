#include "rasterizer/depth_mip_chain.h"

#include <gtest/gtest.h>

#include "gl_test.h"
#include "screen_space_run.h"

namespace plumb {
namespace {

using DepthMipChainTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(DepthMipChainTest);

TEST_P(DepthMipChainTest, EveryTexelIsThePixelThatRotatedGridStepsLeadTo) {
    for (const glm::ivec2 size : {glm::ivec2(101, 67), glm::ivec2(64, 64), glm::ivec2(7, 90)}) {
        ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(size.x, size.y), 3), {},
                           {.planes = {"depth_mip_chain", "layer2.depth_mip_chain"}});
        for (int layer = 0; layer < 2; ++layer) {
            const Image depth = run.render("depth", 1, layer);
            for (int level = 0; level <= coarsest_mip(size.x, size.y); ++level) {
                const Image chain = run.render("depth_mip_chain", 1, layer, level);
                ASSERT_EQ(chain.width(), size.x >> level);
                for (int y = 0; y < chain.height(); ++y) {
                    for (int x = 0; x < chain.width(); ++x) {
                        const counterpart::Pixel source = counterpart::pixel_of_texel({x, y}, level);
                        // Copies: bit for bit.
                        ASSERT_EQ(chain.at(x, chain.height() - 1 - y), depth.at(source.x, size.y - 1 - source.y))
                            << size.x << "x" << size.y << ", layer " << layer << ", level " << level << ", texel (" << x
                            << ", " << y << ")";
                    }
                }
            }
        }
    }
}

TEST_P(DepthMipChainTest, TheSecondLayerIsMadeOnlyWhereItIsRead) {
    ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(32, 32), 3), {},
                       {.planes = {"depth_mip_chain"}});
    EXPECT_EQ(run.planes().get("depth_mip_chain").layers(), 1);
}

TEST(DepthMipChain, ItsCoarsestLevelStillHasATexel) {
    EXPECT_EQ(coarsest_mip(1280, 720), 5);
    EXPECT_EQ(coarsest_mip(32, 720), 5);
    EXPECT_EQ(coarsest_mip(31, 720), 4);
    EXPECT_EQ(coarsest_mip(500, 1), 0);
}

}  // namespace
}  // namespace plumb
