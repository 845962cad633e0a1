// Blurs images that a test makes up, on layers that it makes up.
#pragma once

#include <memory>
#include <random>

#include "rasterizer/bilateral_blur.h"
#include "screen_space_run.h"

namespace plumb {

constexpr float blurred_radius = 1.0f;  // metres, of the blurred quantity

inline Image blur(GlContext& context, const counterpart::Layers& layers, const BilateralBlurSettings& settings,
                  const Image& image, int guard_band = 0) {
    Method method;
    method.gbuffer.guard_band = guard_band;
    const PassDeclaration blur = declare_bilateral_blur({.name = "blur",
                                                         .settings = settings,
                                                         .quantity_radius = blurred_radius,
                                                         .input = "noisy",
                                                         .output = "smooth"});
    const PassDeclaration given = {
        "given noise", {}, {"noisy"}, [&image](const PassResources& resources) -> std::unique_ptr<Pass> {
            upload(resources.planes.create("noisy", image.channels() == 1 ? GL_R32F : GL_RGBA32F, 1), 0, image);
            return nullptr;
        }};
    ScreenSpaceRun run(context, layers, method, {.planes = {"smooth"}}, {given, blur});
    return run.render("smooth", image.channels());
}

// Values from 0 to 1, independent of each other.
inline Image noise(int width, int height, int channels, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Image image(width, height, channels);
    for (float& value : image.values()) value = uniform(generator);
    return image;
}

}  // namespace plumb
