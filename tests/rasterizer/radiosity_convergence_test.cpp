// With samples in the thousands the radiosity comes to its integral over the disc, whatever is counted, wherever the
// taps spread and read, and whoever receives.
#include "gl_test.h"
#include "radiosity_agreement.h"
#include "rasterizer/radiosity_gather.h"

namespace plumb {
namespace {

using RadiosityConvergenceTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(RadiosityConvergenceTest);

constexpr auto nielsen = RadiosityEstimator::nielsen2015;

// What the estimators tend to with more and more taps, divided by all of them: an integral over the disc, here a fine
// grid in radius and angle. In alpha the confidence.
glm::dvec4 limit_of(const counterpart::Layers& layers, const RadiositySettings& settings, counterpart::Pixel pixel,
                    counterpart::GatheringLayers of) {
    constexpr int rings = 100, sectors = 200;
    const double projected =
        layers.view.pixels_per_metre() * settings.radius / counterpart::depth_at(layers, of.receiver, pixel);
    const double radius = settings.spread_pixels > 0 ? settings.spread_pixels : projected;
    const counterpart::SpiralRequest request{.pixel = pixel,
                                             .radius_pixels = radius,
                                             .samples = settings.samples,
                                             .jitter = 0,
                                             .use_mip_chain = settings.use_mip_chain,
                                             .mip_offset = settings.mip_offset,
                                             .minimum_mip_level = settings.minimum_mip_level};
    const bool adds = settings.estimator == nielsen;
    glm::dvec3 sum{0.0};
    double hits = 0.0;
    bool ignored = false;
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sectors; ++j) {
            const double distance = radius * (i + 0.5) / rings, angle = 2.0 * std::numbers::pi * (j + 0.5) / sectors;
            const counterpart::Pixel place{pixel.x + static_cast<int>(std::floor(distance * std::cos(angle) + 0.5)),
                                           pixel.y + static_cast<int>(std::floor(distance * std::sin(angle) + 0.5))};
            if (!counterpart::inside(layers, place)) continue;
            const counterpart::Tap tap{place, counterpart::source_of_tap(layers, place, distance, request)};
            glm::dvec3 best{0.0};
            bool hit = false;
            for (int layer = 0; layer < settings.layers; ++layer) {
                const auto one =
                    counterpart::received_from(layers, settings, Falloff::hard, pixel, tap, layer, of, ignored);
                if (adds) {
                    sum += one.light, hits += one.hit;
                } else {
                    hit |= one.hit;
                    if (glm::dot(one.light, one.light) > glm::dot(best, best)) best = one.light;
                }
            }
            sum += best;
            hits += hit;
        }
    }
    const double taps = static_cast<double>(rings) * sectors * (adds ? settings.layers : 1);
    return {2.0 * std::numbers::pi / taps * sum, hits / taps};
}

// Floor, ceiling, walls and end of a corridor, which light each other, with a shelf across it, so that both layers hold
// something; `board` hangs another surface before the middle of the view. `tilt` turns all normals by so much, more or
// less, so that what lies in one plane is before or behind a point for better reasons than rounding.
counterpart::Layers corridor(float tilt, bool board) {
    std::vector<Patch> patches = {{{-1.0f, -1.0f, -7.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
                                  {{-1.0f, 1.0f, -7.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
                                  {{-1.0f, -1.0f, -7.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
                                  {{1.0f, -1.0f, -7.0f}, {0.0f, 2.0f, 0.0f}, {0.0f, 0.0f, 6.5f}},
                                  {{-1.0f, -1.0f, -5.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}},
                                  {{-1.0f, -0.4f, -4.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.1f, 0.8f}}};
    if (board) patches.push_back({{-0.6f, -0.6f, -2.5f}, {1.2f, 0.0f, 0.0f}, {0.0f, 1.2f, 0.0f}});
    counterpart::Layers layers = layers_of_patches(slanted_view(60, 45), patches);
    for (Image& normals : layers.normal) {
        for (std::size_t i = 0; i < normals.values().size(); i += 3) {
            const glm::vec3 normal(normals.values()[i], normals.values()[i + 1], normals.values()[i + 2]);
            if (normal == glm::vec3(0.0f) || tilt == 0.0f) continue;
            const glm::vec3 turned = glm::normalize(normal + tilt * glm::vec3(0.5f, 0.7f, 0.3f));
            for (int c = 0; c < 3; ++c) normals.values()[i + static_cast<std::size_t>(c)] = turned[c];
        }
    }
    return layers;
}

struct Case {
    const char* name;
    RadiositySettings settings;
    int receiver = 0;   // layer
    float tilt = 0.0f;  // of normals
    int seeds = 4;      // of 1000 taps; coarse texels and few receivers take more
};

// Mean relative errors of irradiance and confidence: 1000 taps, and some seeds of as many, against the limit.
void expect_convergence(GlContext& context, const Case& c) {
    SCOPED_TRACE(c.name);
    RadiositySettings settings = c.settings;
    const bool by_hits = settings.normalisation == RadiosityNormalisation::hits;
    if (c.receiver == 1) settings.bounces = 2, settings.second_layer = SecondLayerIndirect::gather;
    const Quantities quantities{.planes = {c.receiver == 0 ? "radiosity" : "radiosity.2"}};
    const counterpart::GatheringLayers of{.receiver = c.receiver};
    // What the passes see: normals as their encoding leaves them.
    const counterpart::Layers layers =
        ScreenSpaceRun(context, corridor(c.tilt, c.receiver == 1), unblurred(settings), quantities).layers();
    std::vector<std::pair<counterpart::Pixel, glm::dvec4>> limits;
    // Fewer pixels have a second layer.
    const int row_step = c.receiver == 0 ? 9 : 4, column_step = c.receiver == 0 ? 11 : 5;
    for (int y = 4; y < 45; y += row_step) {
        for (int x = 4; x < 60; x += column_step) {
            const counterpart::Pixel pixel{x, y};
            if (counterpart::depth_at(layers, c.receiver, pixel) != 0.0)
                limits.push_back({pixel, limit_of(layers, settings, pixel, of)});
        }
    }
    const auto mean_error = [&](int samples, int seeds = 1) {
        settings.samples = samples;
        ScreenSpaceRun run(context, corridor(c.tilt, c.receiver == 1), unblurred(settings), quantities);
        const Image image = mean_over_seeds(run, "radiosity", 4, seeds, c.receiver);
        glm::dvec2 error{0.0}, reference{0.0};
        int pixels = 0;
        for (const auto& [pixel, limit] : limits) {
            // The quotient of two integrals says nothing where hardly a tap hits.
            if (by_hits && limit.w < 0.1) continue;
            const glm::dvec2 expected(by_hits ? limit.x / limit.w : limit.x, limit.w);
            error +=
                glm::abs(glm::dvec2(image.at(pixel.x, 44 - pixel.y, 0), image.at(pixel.x, 44 - pixel.y, 3)) - expected);
            reference += expected;
            ++pixels;
        }
        EXPECT_GT(pixels, 10) << "wall, floor and board light each other";
        EXPECT_GT(reference.x, 0.5);
        return error / reference;
    };
    const glm::dvec2 few = mean_error(16), many = mean_error(1000), thousands = mean_error(1000, c.seeds);
    for (const int i : {0, 1}) {
        SCOPED_TRACE(i == 0 ? "irradiance" : "confidence");
        // N points spread evenly over a disc miss its edges by some N^(-3/4), 0.6 % of 1000, and what sends is a small
        // part of the disc.
        EXPECT_LT(many[i], 0.03) << "relative error of 1000 taps; of 16: " << few[i];
        EXPECT_LT(many[i], few[i] / 4.0) << few[i];
        // What is left is that of the grid, whose cells are a fraction of a pixel wide at the disc's edge.
        EXPECT_LT(thousands[i], 0.01) << "relative error of " << c.seeds << " seeds of 1000 taps; of one: " << many[i];
        EXPECT_LT(thousands[i], many[i]);
    }
}

TEST_P(RadiosityConvergenceTest, EachEstimatorConvergesToItsIntegralOverTheDisc) {
    for (const RadiosityEstimator estimator : {RadiosityEstimator::mara2016, nielsen}) {
        for (const RadiosityNormalisation normalisation :
             {RadiosityNormalisation::samples, RadiosityNormalisation::hits}) {
            const bool by_hits = normalisation == RadiosityNormalisation::hits;
            SCOPED_TRACE(to_string(estimator));
            expect_convergence(
                context(),
                {by_hits ? "divided by hits" : "divided by samples",
                 {.estimator = estimator, .radius = 2.0f, .normalisation = normalisation, .use_mip_chain = false}});
        }
    }
}

// Through EGL alone: they are the same taps.
TEST(RadiosityConvergence, EveryVariantConvergesToItsIntegralOverTheDisc) {
    for (const Case& c : {
             Case{"tap normals untested", {.radius = 2.0f, .test_tap_normal = false, .use_mip_chain = false}, 0, 0.3f},
             Case{"Nielsen's, tap normals untested",
                  {.estimator = nielsen, .radius = 2.0f, .test_tap_normal = false, .use_mip_chain = false},
                  0,
                  0.3f},
             Case{"over fixed pixels", {.radius = 3.0f, .spread_pixels = 25, .use_mip_chain = false}},
             Case{"Nielsen's over fixed pixels, with the thesis' taps",
                  {.estimator = nielsen,
                  .pattern = TapPattern::nielsen2015,
                  .radius = 3.0f,
                  .spread_pixels = 25,
                  .use_mip_chain = false}},
             Case{"the second layer's points receive",
                  {.radius = 2.0f, .normalisation = RadiosityNormalisation::samples, .use_mip_chain = false},
                  1,
                  0.0f,
                  16},
             Case{"Nielsen's second layer",
                  {.estimator = nielsen,
                  .radius = 2.0f,
                  .normalisation = RadiosityNormalisation::samples,
                  .use_mip_chain = false},
                  1,
                  0.0f,
                  16},
             Case{"with the MIP chain", {.radius = 2.0f, .mip_offset = 1}, 0, 0.0f, 16},
             Case{"coarse", {.radius = 2.0f, .mip_offset = 1, .minimum_mip_level = 2}, 0, 0.0f, 16},
             Case{"points at the taps",
                  {.radius = 2.0f, .mip_offset = 1, .mip_points = MipTapPoint::sao2012},
                  0,
                  0.0f,
                  16},
         })
        expect_convergence(test_context(GlBackend::egl), c);
}

}  // namespace
}  // namespace plumb
