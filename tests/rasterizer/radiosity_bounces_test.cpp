// Several bounces within a frame, against the CPU.
#include <gmock/gmock.h>

#include "bilateral_blur_counterpart.h"
#include "gl_test.h"
#include "radiosity_agreement.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

using RadiosityBouncesTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(RadiosityBouncesTest);

constexpr float albedo = 0.5f;  // of all that a ScreenSpaceRun shows

// What later bounces gather is kept as computed, so that each can be compared by itself.
Method exact(const RadiositySettings& radiosity) {
    Method method = unblurred(radiosity);
    method.gbuffer.radiance_format = RadianceFormat::rgba32f;
    return method;
}

Quantities wanted(std::vector<std::string> planes) { return {.planes = std::move(planes)}; }

void expect_reflection(const Image& reflected, const Image& irradiance) {
    ASSERT_EQ(reflected.width(), irradiance.width());
    for (int y = 0; y < reflected.height(); ++y) {
        for (int x = 0; x < reflected.width(); ++x) {
            for (int c = 0; c < 3; ++c) {
                const double expected = albedo / std::numbers::pi * irradiance.at(x, y, c);
                ASSERT_NEAR(reflected.at(x, y, c), expected, 1e-6 * (1.0 + expected));  // a few float roundings
            }
        }
    }
}

const std::vector<RadiositySettings> ways_of_the_second_layer = {
    {.layers = 1, .bounces = 3},
    {.bounces = 3, .second_layer = SecondLayerIndirect::reuse},
    {.bounces = 3, .second_layer = SecondLayerIndirect::gather},
    {.bounces = 3, .second_layer = SecondLayerIndirect::none},
    {.estimator = RadiosityEstimator::nielsen2015, .bounces = 3, .second_layer = SecondLayerIndirect::gather}};

TEST_P(RadiosityBouncesTest, EachGathersWhatTheOneBeforeReflected) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(64, 48), 4);
    for (RadiositySettings settings : ways_of_the_second_layer) {
        settings.samples = 16;
        SCOPED_TRACE(testing::Message() << settings.layers << " layers, second layer "
                                        << static_cast<int>(settings.second_layer));
        const bool gathers = settings.second_layer == SecondLayerIndirect::gather;
        const int senders = settings.layers == 2 && settings.second_layer != SecondLayerIndirect::none ? 2 : 1;
        ScreenSpaceRun run(context(), noise, exact(settings), wanted({"radiosity.3", "indirect.3"}));
        counterpart::Layers sent = run.layers();
        for (int bounce = 1; bounce <= 3; ++bounce) {
            SCOPED_TRACE(testing::Message() << "bounce " << bounce);
            const std::string plane = bounce == 1 ? "radiosity" : "radiosity." + std::to_string(bounce);
            const std::string reflected = "indirect." + std::to_string(bounce);
            const Image gathered = run.render(plane, 4);
            const counterpart::GatheringLayers of{.senders = bounce == 1 ? settings.layers : senders};
            EXPECT_LT(expect_agreement(sent, settings, gathered, gathered, Falloff::hard, of), 0.05);
            expect_reflection(run.render(reflected, 3), gathered);
            sent.radiance[0] = run.render(reflected, 3);
            if (senders < 2 || bounce == 3) continue;
            if (gathers) {
                const Image of_second = run.render(plane, 4, 1);
                counterpart::Layers before = sent;
                before.radiance = bounce == 1
                                      ? run.layers().radiance
                                      : std::vector{run.render("indirect.1", 3), run.render("indirect.1", 3, 1)};
                EXPECT_LT(expect_agreement(before, settings, of_second, of_second, Falloff::hard, {.receiver = 1}),
                          0.05);
            }
            expect_reflection(run.render(reflected, 3, 1), run.render(plane, 4, gathers ? 1 : 0));
            sent.radiance[1] = run.render(reflected, 3, 1);
        }
    }
}

TEST_P(RadiosityBouncesTest, IrradianceAndIndirectAreTheirSums) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(40, 30), 4);
    ScreenSpaceRun run(context(), noise, exact({.bounces = 4}), wanted({"irradiance", "indirect", "confidence"}));
    Image irradiance(40, 30, 3);
    for (const char* plane : {"radiosity", "radiosity.2", "radiosity.3", "radiosity.4"}) {
        const Image one = run.render(plane, 3);
        for (std::size_t i = 0; i < one.values().size(); ++i) irradiance.values()[i] += one.values()[i];
    }
    const Image sum = run.render("irradiance", 3), first = run.render("radiosity", 4),
                confidence = run.render("confidence", 1);
    for (std::size_t i = 0; i < sum.values().size(); ++i) {
        ASSERT_NEAR(sum.values()[i], irradiance.values()[i], 1e-6f * (1.0f + sum.values()[i]));  // float rounding
        ASSERT_EQ(confidence.values()[i / 3], first.values()[i / 3 * 4 + 3]);
    }
    expect_reflection(run.render("indirect", 3), sum);
}

// From within: five walls, the view cuts off the rest.
counterpart::Layers grey_box(const View& view) {
    return layers_of_patches(view, {{{-2.0f, -1.0f, -5.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.0f}},
                                    {{-2.0f, 1.5f, -5.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 6.0f}},
                                    {{-2.0f, -1.0f, -5.0f}, {0.0f, 2.5f, 0.0f}, {0.0f, 0.0f, 6.0f}},
                                    {{2.0f, -1.0f, -5.0f}, {0.0f, 2.5f, 0.0f}, {0.0f, 0.0f, 6.0f}},
                                    {{-2.0f, -1.0f, -5.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 2.5f, 0.0f}}});
}

TEST_P(RadiosityBouncesTest, TheEnergyOfAClosedGreyBoxIsThatOfTheCounterpart) {
    const counterpart::Layers box = grey_box(slanted_view(48, 36));
    const RadiositySettings settings{.samples = 64, .layers = 1, .radius = 3.0f, .bounces = 4};
    ScreenSpaceRun run(context(), box, exact(settings), wanted({"irradiance"}));
    counterpart::Layers sent = run.layers();  // the CPU goes on from its own results
    double before = 0.0;
    for (int bounce = 1; bounce <= 4; ++bounce) {
        const Image gathered = run.render(bounce == 1 ? "radiosity" : "radiosity." + std::to_string(bounce), 4);
        Image reflected(48, 36, 3);
        double expected = 0.0, actual = 0.0;
        for (int y = 0; y < 36; ++y) {
            for (int x = 0; x < 48; ++x) {
                const glm::dvec3 irradiance =
                    counterpart::gathered_irradiance(sent, settings, Falloff::hard, {x, y}).irradiance;
                expected += irradiance.x / (48 * 36);
                actual += gathered.at(x, y) / (48.0 * 36.0);
                for (int c = 0; c < 3; ++c)
                    reflected.at(x, 35 - y, c) = static_cast<float>(albedo / std::numbers::pi * irradiance[c]);
            }
        }
        // One pixel in twenty may take one of its 64 taps from the neighbouring pixel: of what they send, which differs
        // little, and of the hits, a part of 1e-3.
        EXPECT_NEAR(actual, expected, 1e-3 * expected) << "bounce " << bounce;
        EXPECT_GT(expected, 0.1) << "bounce " << bounce;
        // A box that lost nothing would send on albedo times as much; 2 pi / M cos on average sends up to twice that.
        if (bounce > 1) {
            EXPECT_LT(expected, 2.0 * albedo * before) << "bounce " << bounce;
        }
        before = expected;
        sent.radiance[0] = reflected;
    }
}

TEST_P(RadiosityBouncesTest, EachIsBlurredInBothLayers) {
    const counterpart::Layers layers = counterpart::random_layers(slanted_view(60, 45), 8);
    Method method = exact({.bounces = 2, .second_layer = SecondLayerIndirect::gather});
    method.radiosity.blur = {.radius = 3, .normal_sharpness = 1.0f, .plane_sharpness = 0.3f};
    ScreenSpaceRun run(context(), layers, method, wanted({"irradiance"}));
    for (const int layer : {0, 1}) {
        SCOPED_TRACE(testing::Message() << "layer " << layer);
        counterpart::Layers of = run.layers();
        if (layer == 1) std::swap(of.depth[0], of.depth[1]), std::swap(of.normal[0], of.normal[1]);
        const BilateralBlurSettings& settings = method.radiosity.blur;
        const double radius = method.radiosity.radius;
        const Image noisy = run.render("radiosity.unfiltered", 4, layer), actual = run.render("radiosity", 4, layer);
        const Image expected =
            counterpart::blurred(of, settings, radius, counterpart::blurred(of, settings, radius, noisy, 1, 0), 0, 1);
        int changed = 0;
        for (int y = 0; y < 45; ++y) {
            for (int x = 0; x < 60; ++x) {
                if (counterpart::depth_at(of, 0, {x, 44 - y}) == 0.0) continue;
                for (int c = 0; c < 4; ++c) {
                    // Weights are good to 5e-4 (bilateral_blur_test.cpp), values are up to 2 pi.
                    ASSERT_NEAR(actual.at(x, y, c), expected.at(x, y, c), 3e-3) << x << ", " << y;
                }
                changed += std::abs(actual.at(x, y) - noisy.at(x, y)) > 0.01f;
            }
        }
        EXPECT_GT(changed, 200) << "pixels of 2700";
    }
    EXPECT_TRUE(run.planes().has("radiosity.2.unfiltered"));
}

TEST_P(RadiosityBouncesTest, TheFirstDoesNotDependOnHowManyFollowAndCostsNoMore) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(40, 30), 4);
    ScreenSpaceRun one(context(), noise, exact({}), wanted({"indirect.1"})),
        of_many(context(), noise, exact({.bounces = 5}), wanted({"indirect.1"}));
    const Image expected = one.render("indirect.1", 3), actual = of_many.render("indirect.1", 3);
    EXPECT_TRUE(std::ranges::equal(actual.values(), expected.values()));
    EXPECT_TRUE(of_many.planes().has("radiosity"));
    EXPECT_FALSE(of_many.planes().has("radiosity.2"));
}

TEST_P(RadiosityBouncesTest, LaterOnesGatherFromTheGuardBandToo) {
    const counterpart::Layers noise = counterpart::random_layers(slanted_view(64, 56), 9);
    const auto indirect = [&](int guard_band, SecondLayerIndirect second_layer) {
        Method method;
        method.gbuffer.guard_band = guard_band;
        method.radiosity.bounces = 3;
        method.radiosity.second_layer = second_layer;
        ScreenSpaceRun run(context(), noise, method, wanted({"indirect", "confidence"}));
        return run.render("indirect", 3);
    };
    for (const auto second_layer : {SecondLayerIndirect::reuse, SecondLayerIndirect::gather}) {
        const Image everywhere = indirect(0, second_layer), inside = indirect(16, second_layer);
        for (int y = 16; y < 40; ++y) {
            for (int x = 16; x < 48; ++x) ASSERT_EQ(inside.at(x, y), everywhere.at(x, y)) << x << ", " << y;
        }
    }
}

TEST_P(RadiosityBouncesTest, FramesRepeatBitForBitAndAllocateNothing) {
    Method method;
    method.radiosity.bounces = 3;
    method.radiosity.second_layer = SecondLayerIndirect::gather;
    ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(64, 36), 2), method,
                       wanted({"indirect", "indirect.2"}));
    const Image first = run.render("indirect", 3);
    const std::size_t bytes = context().allocated_bytes();
    const Image again = run.render("indirect", 3);
    EXPECT_TRUE(std::ranges::equal(first.values(), again.values()));
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

TEST_P(RadiosityBouncesTest, ABounceThatNobodyMakesIsRefusedWithTheReason) {
    const auto error_of = [&](const RadiositySettings& settings, const std::string& plane) -> std::string {
        try {
            ScreenSpaceRun run(context(), counterpart::random_layers(slanted_view(8, 8), 1), unblurred(settings),
                               wanted({plane}));
        } catch (const MethodError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(error_of({}, "indirect.2"), testing::HasSubstr("method.radiosity.bounces is 1"));
    EXPECT_THAT(error_of({.bounces = 3}, "indirect.4"), testing::HasSubstr("method.radiosity.bounces is 3"));
    EXPECT_EQ(error_of({.bounces = 3}, "indirect.3"), "no error");
    EXPECT_THAT(error_of({.carry = true}, "indirect.1"), testing::HasSubstr("ask for 'indirect'"));
    EXPECT_THAT(error_of({.carry = true}, "indirect.2"), testing::HasSubstr("ask for 'indirect'"));
}

}  // namespace
}  // namespace plumb
