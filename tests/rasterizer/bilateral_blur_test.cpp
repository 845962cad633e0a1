
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bilateral_blur_counterpart.h"
#include "blur_run.h"
#include "gl_test.h"
#include "random_views.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pipeline.h"
#include "rasterizer/scene_reach.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

using BilateralBlurTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(BilateralBlurTest);

const std::vector<Patch> floor_and_wall = {{{-40.0f, -1.0f, -7.0f}, {80.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 8.0f}},
                                           {{-40.0f, -1.0f, -6.0f}, {80.0f, 0.0f, 0.0f}, {0.0f, 60.0f, 0.0f}}};
const std::vector<Patch> wall = {{{-40.0f, -30.0f, -6.0f}, {80.0f, 0.0f, 0.0f}, {0.0f, 60.0f, 0.0f}}};

TEST_P(BilateralBlurTest, AgreesWithItsCounterpart) {
    const View view = slanted_view(80, 60);
    const BilateralBlurSettings radiosity_default = RadiositySettings{}.blur;
    for (const BilateralBlurSettings& settings :
         {BilateralBlurSettings{}, radiosity_default, BilateralBlurSettings{.radius = 7, .step = 3, .monotonic = false},
          BilateralBlurSettings{.radius = 1, .depth_sharpness = 1.0f}, BilateralBlurSettings{.depth_key_bits = 16},
          BilateralBlurSettings{.depth_sharpness = 0.5f, .depth_key_bits = 8},
          BilateralBlurSettings{.depth_sharpness = 1.0f, .plane_exemption = 0.001f},
          BilateralBlurSettings{.radius = 6,
          .weights = BlurWeights::g3d,
          .depth_sharpness = 0.0f,
          .normal_sharpness = 40.0f,
          .plane_sharpness = 0.5f,
          .plane_exemption = 0.01f}}) {
        for (const counterpart::Layers& layers :
             {layers_of_patches(view, floor_and_wall), counterpart::random_layers(view, 6)}) {
            SCOPED_TRACE(testing::Message() << "radius " << settings.radius << ", step " << settings.step);
            const Image image = noise(80, 60, 4, 11);
            const Image actual = blur(context(), layers, settings, image);
            // The pass sees normals through their 16-bit encoding.
            ScreenSpaceRun encoded(context(), layers, Method{}, {.planes = {"depth"}});
            const Image rows = counterpart::blurred(encoded.layers(), settings, blurred_radius, image, 1, 0);
            const Image expected = counterpart::blurred(encoded.layers(), settings, blurred_radius, rows, 0, 1);
            for (std::size_t i = 0; i < actual.values().size(); ++i) {
                // Positions are good to 1e-6 m and neighbours 1e-2 m apart: the sine off the plane is good to 1e-4,
                // which the sharpness of 1 and the square multiply by up to 4 in a weight.
                ASSERT_NEAR(actual.values()[i], expected.values()[i], 5e-4) << "value " << i;
            }
        }
    }
}

TEST_P(BilateralBlurTest, TheTablesOfG3DAreGaussiansThatAgreeWithTheirCounterpartForEachRadius) {
    const View view = slanted_view(40, 30);
    const counterpart::Layers layers = layers_of_patches(view, floor_and_wall);
    const Image image = noise(40, 30, 1, 11);
    for (int radius = 1; radius <= 6; ++radius) {
        const BilateralBlurSettings settings{.radius = radius, .step = 2, .weights = BlurWeights::g3d};
        const Image actual = blur(context(), layers, settings, image);
        ScreenSpaceRun encoded(context(), layers, Method{}, {.planes = {"depth"}});
        const Image rows = counterpart::blurred(encoded.layers(), settings, blurred_radius, image, 1, 0);
        const Image expected = counterpart::blurred(encoded.layers(), settings, blurred_radius, rows, 0, 1);
        // As above; the tables have six digits.
        for (std::size_t i = 0; i < actual.values().size(); ++i)
            ASSERT_NEAR(actual.values()[i], expected.values()[i], 5e-4) << "radius " << radius << ", value " << i;
    }
}

// What the exemption costs: light leaks between surfaces that touch.
TEST_P(BilateralBlurTest, PointsExemptFromThePlaneAreBlurredAcrossContacts) {
    // A board 2 cm before a wall, both facing the camera.
    const counterpart::Layers layers = layers_of_patches(
        slanted_view(60, 60), {wall[0], {{-1.0f, -1.0f, -5.98f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}}});
    Image image(60, 60, 1);
    const auto on_board = [&](int x, int y) { return layers.depth[0].at(x, y) < 5.99f; };
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 60; ++x) image.at(x, y) = on_board(x, y) ? 1.0f : 0.0f;
    }
    const auto leaked = [&](float exemption) {
        // A pixel is 0.1 m wide there: depth alone would tell nothing.
        const Image actual =
            blur(context(), layers, {.depth_sharpness = 0.0f, .plane_sharpness = 50.0f, .plane_exemption = exemption},
                 image);
        double sum = 0.0;
        for (int y = 0; y < 60; ++y) {
            for (int x = 0; x < 60; ++x) sum += on_board(x, y) ? 0.0 : actual.at(x, y);
        }
        return sum;
    };
    EXPECT_EQ(leaked(0.0f), 0.0);
    EXPECT_GT(leaked(0.02f), 1.0);
}

TEST_P(BilateralBlurTest, AgreesWithItsCounterpartInRandomViewsThroughThePipeline) {
    const std::vector<BilateralBlurSettings> settings_in_turn = {
        {}, {.radius = 7, .step = 3, .monotonic = false}, RadiositySettings{}.blur, {.depth_key_bits = 16}};
    constexpr float radius = 0.5f;
    unsigned seed = 500;
    for (const Scene& scene : {make_cornell(), make_clutter()}) {
        std::size_t turn = 0;
        for (const RandomView& random : random_views(seed, 4, bounds_over_time(scene), 1200)) {
            SCOPED_TRACE(testing::Message() << scene.name << ", " << random);
            Method method;
            method.ao.blur = settings_in_turn[turn++];
            method.direct.emitters = method.direct.shadow.lamps = false;  // light is of no concern
            Quantities quantities{.planes = {"ao", "ao.unfiltered"}, .ao_radius = radius};
            quantities.planes.insert(quantities.planes.end(), planes_of_layers.begin(), planes_of_layers.end());
            Pipeline pipeline(context(), scene, method, quantities, random.view.width(), random.view.height());
            const Frame frame = pipeline.render(random.view).frame;
            const counterpart::Layers layers = layers_of_frame(random.view, frame);
            const Image rows = counterpart::blurred(layers, method.ao.blur, radius, frame.plane("ao.unfiltered"), 1, 0);
            const Image expected = counterpart::blurred(layers, method.ao.blur, radius, rows, 0, 1);
            int wrong = 0;
            for (int y = 0; y < random.view.height(); ++y) {
                for (int x = 0; x < random.view.width(); ++x) {
                    if (layers.depth[0].at(x, y) == 0.0f) continue;  // nothing there, which means nothing
                    // As above; the values differ by at most 1.
                    if (std::abs(frame.plane("ao").at(x, y) - expected.at(x, y)) < 5e-4f || ++wrong > 4) continue;
                    ADD_FAILURE() << "pixel (" << x << ", " << y << "): " << frame.plane("ao").at(x, y) << ", expected "
                                  << expected.at(x, y);
                }
            }
            EXPECT_EQ(wrong, 0);
        }
        seed += 10;
    }
}

TEST_P(BilateralBlurTest, KeysOfFewBitsAreStoredBesideTheDepth) {
    const Scene scene = make_cornell();
    const auto bytes = [&](int bits, int layers) {
        Method method;
        method.ao.enabled = false;
        method.direct.emitters = false;  // no shadow maps
        method.radiosity.blur = {.depth_key_bits = bits};
        method.radiosity.bounces = 2;
        if (layers == 2) method.radiosity.second_layer = SecondLayerIndirect::gather;
        const Pipeline pipeline(context(), scene, method, {.planes = {"irradiance"}}, 16, 16);
        return static_cast<int>(pipeline.gbuffer_bytes_per_pixel());
    };
    for (const int layers : {1, 2}) {
        EXPECT_EQ(bytes(8, layers) - bytes(32, layers), layers);
        EXPECT_EQ(bytes(16, layers) - bytes(32, layers), 2 * layers);
    }
}

TEST_P(BilateralBlurTest, LeavesConstantsAsTheyAreBitForBit) {
    for (const counterpart::Layers& layers : {layers_of_patches(slanted_view(50, 40), floor_and_wall),
                                              counterpart::random_layers(slanted_view(50, 40), 6)}) {
        const Image actual = blur(context(), layers, {.radius = 6}, Image(50, 40, 1, 0.7231f));
        for (const float value : actual.values()) ASSERT_EQ(value, 0.7231f);
    }
}

TEST_P(BilateralBlurTest, LeaksNothingAcrossAStepInDepth) {
    // A board before a wall, both facing the camera: only depth and plane tell them apart. Noise must stay on its own
    // side: what is 0 on the board stays 0 whatever the wall holds, and the other way round.
    const counterpart::Layers layers = layers_of_patches(
        slanted_view(60, 60), {wall[0], {{-1.0f, -1.0f, -4.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}}});
    for (const BilateralBlurSettings& settings :
         {BilateralBlurSettings{}, BilateralBlurSettings{.depth_sharpness = 0.0f},
          BilateralBlurSettings{.plane_sharpness = 0.0f}, BilateralBlurSettings{.monotonic = false}}) {
        for (const bool noise_on_board : {false, true}) {
            Image image = noise(60, 60, 1, 11);
            for (int y = 0; y < 60; ++y) {
                for (int x = 0; x < 60; ++x) {
                    if ((layers.depth[0].at(x, y) < 5.0f) != noise_on_board) image.at(x, y) = 0.0f;
                }
            }
            const Image actual = blur(context(), layers, settings, image);
            double noisy_side = 0.0;
            for (int y = 0; y < 60; ++y) {
                for (int x = 0; x < 60; ++x) {
                    if ((layers.depth[0].at(x, y) < 5.0f) != noise_on_board) {
                        ASSERT_EQ(actual.at(x, y), 0.0f) << "pixel (" << x << ", " << y << ")";
                    } else {
                        noisy_side += actual.at(x, y);
                    }
                }
            }
            EXPECT_GT(noisy_side, 0.0);
        }
    }
}

TEST_P(BilateralBlurTest, LeaksNothingAcrossARightAngle) {
    const counterpart::Layers layers = layers_of_patches(slanted_view(60, 60), floor_and_wall);
    Image image = noise(60, 60, 1, 11);
    const auto is_floor = [&](int x, int y) { return layers.normal[0].at(x, y, 1) > 0.5f; };
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 60; ++x) {
            if (is_floor(x, y)) image.at(x, y) = 0.0f;
        }
    }
    for (const BilateralBlurSettings& settings : {BilateralBlurSettings{}, RadiositySettings{}.blur}) {
        const Image actual = blur(context(), layers, settings, image);
        for (int y = 0; y < 60; ++y) {
            for (int x = 0; x < 60; ++x) {
                // 1e-4: at the default sharpness of 1 a right angle has weight 1 - (1 - cos 90), 0 up to the rounding
                // of the normals to 16 bits.
                if (is_floor(x, y)) {
                    ASSERT_LT(actual.at(x, y), 1e-4f) << "pixel (" << x << ", " << y << ")";
                }
            }
        }
    }
}

TEST_P(BilateralBlurTest, TakesTheNoiseOffAPlane) {
    const counterpart::Layers layers = layers_of_patches(slanted_view(80, 80), wall);
    const auto deviation = [](const Image& image) {
        double sum = 0.0, squares = 0.0;
        for (const float value : image.values()) sum += value, squares += value * value;
        const double mean = sum / static_cast<double>(image.pixel_count());
        return std::sqrt(squares / static_cast<double>(image.pixel_count()) - mean * mean);
    };
    const Image image = noise(80, 80, 1, 11);
    const BilateralBlurSettings settings;
    double weights = 0.0, squares = 0.0;
    for (int i = -settings.radius; i <= settings.radius; ++i) {
        const double weight = std::exp(-0.5 * i * i / (0.25 * settings.radius * settings.radius));
        weights += weight, squares += weight * weight;
    }
    // Independent noise falls by sqrt(sum of squared weights) / (sum of weights) along each axis.
    const double expected = squares / (weights * weights);
    const double ratio = deviation(blur(context(), layers, settings, image)) / deviation(image);
    // 20 %: edge weights on a slightly uneven plane and the one-sided sums along the border, and 6400 pixels of noise.
    EXPECT_NEAR(ratio, expected, 0.2 * expected);
}

TEST_P(BilateralBlurTest, DrawsTheViewWithoutItsGuardBandButReadsTheBand) {
    const counterpart::Layers layers = layers_of_patches(slanted_view(40, 40).with_guard_band(10), wall);
    const Image image = noise(60, 60, 1, 11);
    const Image whole = blur(context(), layers, {}, image), inner = blur(context(), layers, {}, image, 10);
    for (int y = 10; y < 50; ++y) {
        for (int x = 10; x < 50; ++x) ASSERT_EQ(inner.at(x, y), whole.at(x, y)) << x << ", " << y;
    }
}

TEST_P(BilateralBlurTest, ParametersOutOfRangeAreRefused) {
    const counterpart::Layers layers = layers_of_patches(slanted_view(8, 8), wall);
    for (const BilateralBlurSettings& settings :
         {BilateralBlurSettings{.radius = 65}, BilateralBlurSettings{.depth_key_bits = 12},
          BilateralBlurSettings{.step = 0}, BilateralBlurSettings{.depth_sharpness = -1.0f},
          BilateralBlurSettings{.plane_sharpness = INFINITY}, BilateralBlurSettings{.plane_exemption = -1.0f},
          BilateralBlurSettings{.radius = 7, .weights = BlurWeights::g3d}}) {
        EXPECT_THROW(blur(context(), layers, settings, noise(8, 8, 1, 11)), MethodError);
    }
}

}  // namespace
}  // namespace plumb
