// With samples in the thousands every estimator of ambient obscurance comes to its integral over the disc.
#include "ambient_obscurance_agreement.h"
#include "gl_test.h"

namespace plumb {
namespace {

using Estimator = AmbientObscuranceEstimator;
using Case = ObscuranceCase;
using ObscuranceConvergenceTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(ObscuranceConvergenceTest);

// Floor, ceiling, walls and end of a corridor, with a shelf across it: something near every point.
std::vector<Patch> corridor() {
    return {{{-1.0f, -1.0f, -7.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
            {{-1.0f, 1.0f, -7.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
            {{-1.0f, -1.0f, -7.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
            {{1.0f, -1.0f, -7.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
            {{-1.0f, -1.0f, -5.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}},
            {{-1.0f, -0.4f, -4.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.1f, 0.8f}}};
}

// Mean error of 1000 taps, and of four seeds of as many, against the limit of many taps.
void expect_convergence(GlContext& context, const Case& c) {
    SCOPED_TRACE(c.name);
    const counterpart::Layers layers = layers_of_patches(slanted_view(60, 45), corridor());
    AmbientObscuranceSettings settings = c.settings;
    const Quantities quantities = ambient_visibility_within(2.0f, c.falloff);
    std::vector<std::pair<counterpart::Pixel, double>> limits;
    double obscured = 0.0;
    for (int y = 4; y < 45; y += 9) {
        for (int x = 4; x < 60; x += 11) {
            const double expected = counterpart::limit_of_many_taps(layers, settings, quantities, {x, y}).visibility;
            limits.push_back({{x, y}, expected});
            obscured += 1.0 - expected;
        }
    }
    EXPECT_GT(obscured, 0.05 * static_cast<double>(limits.size()));
    // Of visibilities, whose curve bends little over the noise of a thousand taps.
    const auto mean_error = [&](int samples, int seeds = 1) {
        settings.samples = samples;
        ScreenSpaceRun run(context, layers, unblurred(settings), quantities);
        const Image ao = mean_over_seeds(run, "ao", 1, seeds);
        double error = 0.0;
        for (const auto& [pixel, expected] : limits) error += std::abs(ao.at(pixel.x, 44 - pixel.y) - expected);
        return error / obscured;
    };
    const double few = mean_error(16), many = mean_error(1000), thousands = mean_error(1000, 4);
    // As the taps of radiosity: N points miss edges by some N^(-3/4).
    EXPECT_LT(many, 0.03) << "relative error of 1000 taps; of 16: " << few;
    EXPECT_LT(many, few / 4.0) << few;
    EXPECT_LT(thousands, 0.01) << "relative error of 4 seeds of 1000 taps; of one: " << many;
    EXPECT_LT(thousands, many);
}

TEST_P(ObscuranceConvergenceTest, ConvergesToItsIntegralOverTheDisc) {
    expect_convergence(context(), {"the paper's", {.use_mip_chain = false}});
    expect_convergence(context(), {"the paper's, with the MIP chain", {}});
}

// Through EGL alone: they are the same taps.
TEST(ObscuranceConvergence, EveryEstimatorConvergesToItsIntegralOverTheDisc) {
    for (Case c :
         std::vector<Case>{{"linear", {.estimator = Estimator::linear}},
                           {"one layer", {.layers = 1}},
                           {"normals of faces", {.normals = ObscuranceNormals::face}},
                           {"the thesis' taps", {.pattern = TapPattern::nielsen2015}},
                           {"over fixed pixels", {.spread_pixels = 30}},
                           {"the demo's", {.estimator = Estimator::g3d_demo}},
                           {"SAO", {.estimator = Estimator::sao2012, .intensity = 0.3f}, Falloff::cubic},
                           {"SAO undivided", {.estimator = Estimator::sao2012_undivided, .intensity = 0.1f}},
                           {"Alchemy",
                            {.estimator = Estimator::alchemy2011,
                            .bias = 0.005f,
                            .epsilon = 0.1f,
                            .intensity = 0.3f,
                            .exponent = 2.0f},
                            Falloff::hard},
                           {"Nielsen's thesis",
                            {.estimator = Estimator::nielsen2015, .bias = 0.001f, .epsilon = 0.3f, .intensity = 0.1f},
                            Falloff::hard}}) {
        c.settings.use_mip_chain = false;
        expect_convergence(test_context(GlBackend::egl), c);
    }
}

// What far taps read of the chain is not what lies there, but what they come to is as sure.
TEST(ObscuranceConvergence, TheMipChainConvergesToTheIntegralOfWhatItHolds) {
    for (const Case& c :
         {Case{"coarse from the first pixel on", {.mip_offset = 0}}, Case{"one layer", {.layers = 1, .mip_offset = 1}},
          Case{"normals of faces", {.normals = ObscuranceNormals::face, .mip_offset = 1}},
          Case{"points at the taps", {.mip_offset = 1, .mip_points = MipTapPoint::sao2012}}})
        expect_convergence(test_context(GlBackend::egl), c);
}

}  // namespace
}  // namespace plumb
