// radiosity.emitters_shine: what emissive surfaces send through taps, and what may not be combined with it.
#include <cmath>

#include "gl_test.h"
#include "light_scenes.h"
#include "radiosity_agreement.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

using EmittersShineTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(EmittersShineTest);

Scene make_glowing_corner() {
    Scene scene = make_corner();
    Material glow;
    glow.base_colour = {0.0f, 0.0f, 0.0f};
    glow.emission = {3.0f, 2.0f, 1.0f};
    scene.materials.push_back(glow);
    add_quad(scene, 2, {-0.6f, 0.0f, -0.4f}, {0.0f, 0.5f, 0.0f}, {0.6f, 0.0f, 0.2f});
    return scene;
}

Method shining_method(int layers) {
    Method method;
    method.ao.enabled = false;
    method.gbuffer.layers = method.radiosity.layers = method.ao.layers = layers;
    method.direct.emitters = false;
    method.radiosity.emitters_shine = true;
    method.radiosity.radius = 2.0f;
    return method;
}

// The same taps carry the same light, whether it is called emission or handed in as reflected light.
TEST_P(EmittersShineTest, EmissionIsGatheredAsReflectedLightWouldBe) {
    const Scene scene = make_glowing_corner();
    const View view = corner_view();
    const Frame shining =
        render(context(), scene, view, {"irradiance", "direct", "emission", "depth"}, shining_method(1));
    for (const float value : shining.plane("direct").values()) ASSERT_EQ(value, 0.0f) << "emitters are left out";
    Frame truth(view.width(), view.height());
    Image reflected = shining.plane("emission");
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (!std::isinf(shining.plane("depth").at(x, y))) continue;
            for (float& value : reflected.pixel(x, y)) value = 0.0f;
        }
    }
    truth.set("direct", reflected);
    Method given = shining_method(1);
    given.radiosity.emitters_shine = false;
    given.direct.source = SourceOfStage::truth;
    Quantities quantities;
    quantities.planes = {"irradiance"};
    Pipeline pipeline(context(), scene, given, quantities, view.width(), view.height());
    const Image expected = pipeline.render({.now = {view}, .truth = &truth}).frame.plane("irradiance");
    double largest = 0.0;
    for (std::size_t i = 0; i < expected.values().size(); ++i) {
        // The truth keeps what is handed in, which has been read from half floats: nothing is rounded anew.
        ASSERT_NEAR(shining.plane("irradiance").values()[i], expected.values()[i], 1e-6) << i;
        largest = std::max(largest, static_cast<double>(expected.values()[i]));
    }
    EXPECT_GT(largest, 0.1);
}

// What each tap brings is what its surface reflects and emits, of both layers.
TEST_P(EmittersShineTest, TapsBringDirectLightAndEmissionAsTheCounterpartHasIt) {
    Scene scene = make_glowing_corner();
    add_quad(scene, 0, {-1.2f, 0.0f, 0.5f}, {1.6f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f});
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {2.0f, 3.0f, 4.0f}});
    const View view = corner_view();
    Method method = shining_method(2);
    method.direct.shadow.lamps = false;
    method.gbuffer.radiance_format = RadianceFormat::rgba32f;
    method.radiosity.blur.radius = 0;
    std::vector<std::string> planes = planes_of_layers;
    for (const char* plane : {"irradiance", "confidence", "emission", "layer2.emission"}) planes.emplace_back(plane);
    const Frame frame = render(context(), scene, view, planes, method);
    counterpart::Layers layers = layers_of_frame(view, frame);
    double emitted = 0.0;
    for (int layer = 0; layer < 2; ++layer) {
        const Image& emission = frame.plane(layer == 0 ? "emission" : "layer2.emission");
        for (std::size_t i = 0; i < emission.values().size(); ++i) {
            layers.radiance[layer].values()[i] += emission.values()[i];
            emitted += layer == 1 ? emission.values()[i] : 0.0;
        }
    }
    EXPECT_GT(emitted, 100.0) << "the second layer glows";
    EXPECT_LT(expect_agreement(layers, method.radiosity, frame.plane("irradiance"), frame.plane("confidence")), 0.3);
}

// Hidden behind a pane the emitter is in the second layer only.
TEST_P(EmittersShineTest, EmittersOfTheSecondLayerShineToo) {
    Scene scene = make_glowing_corner();
    add_quad(scene, 0, {-1.2f, 0.0f, 0.5f}, {1.6f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f});
    const View view = corner_view();
    const auto brightness = [&](int layers) {
        double sum = 0.0;
        const Image image = render(context(), scene, view, {"irradiance"}, shining_method(layers)).plane("irradiance");
        for (const float value : image.values()) sum += value;
        return sum;
    };
    EXPECT_GT(brightness(2), 1.5 * brightness(1));
}

TEST_P(EmittersShineTest, LightIsNotCountedTwice) {
    const Scene scene = make_glowing_corner();
    Method method = shining_method(1);
    method.direct.emitters = true;
    EXPECT_THROW(render(context(), scene, corner_view(), {"irradiance"}, method), MethodError);
    method.direct.emitters = false;
    method.direct.source = SourceOfStage::truth;
    EXPECT_THROW(render(context(), scene, corner_view(), {"irradiance"}, method), MethodError);
}

}  // namespace
}  // namespace plumb
