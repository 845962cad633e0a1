// What the methods that come with the program, and the dearest ones, take of OpenGL's memory.
#include <functional>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "demanding_method.h"
#include "experiments/method_file.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

constexpr double bound = 400.0;  // MiB

TEST(MethodMemory, TwoLayersAt720LinesStayBelow400Mebibytes) {
    const std::unique_ptr<GlContext> context = GlContext::create();
    MethodList methods = builtin_methods();
    Method everything = with_everything_on();
    everything.name = "everything on";
    methods.push_back(everything);
    methods.push_back(dearest_method());
    for (const LayerGeneration generation : {LayerGeneration::delay, LayerGeneration::reproject}) {
        Method one_pass = *find_method(methods, "two_layers");
        one_pass.gbuffer.generation = generation;
        one_pass.name = generation == LayerGeneration::delay ? "delay" : "reproject";
        methods.push_back(one_pass);
    }
    std::vector<std::pair<std::string, Scene>> scenes = {{"glossy, moving clutter", make_demanding_scene()}};
    for (const std::string& name : builtin_scene_names()) scenes.emplace_back(name, make_builtin_scene(name));
    for (const auto& [scene_name, scene] : scenes) {
        for (const Method& method : methods) {
            const double mebibytes = mebibytes_of(*context, scene, method);
            fmt::print("{} in {}: {:.0f} MiB\n", method.name, scene_name, mebibytes);
            EXPECT_LT(mebibytes, bound) << method.name << " in " << scene_name;
        }
    }
}

// What README.md says of the dearest method in other formats and sizes.
TEST(MethodMemory, EachFormatOfTheDearestMethodStaysBelow400MebibytesToo) {
    const std::unique_ptr<GlContext> context = GlContext::create();
    const Scene scene = make_demanding_scene();
    const auto mebibytes = [&](const char* what, const std::function<void(Method&)>& change) {
        Method method = dearest_method();
        change(method);
        const double taken = mebibytes_of(*context, scene, method);
        fmt::print("{}: {:.1f} MiB\n", what, taken);
        return taken;
    };
    const double dearest = mebibytes("dearest", [](Method&) {});
    for (const auto& [name, position] :
         {std::pair{"stored", PositionSource::stored}, {"stored_16", PositionSource::stored_16}})
        EXPECT_LT(mebibytes(name, [position = position](Method& m) { m.gbuffer.position = position; }), bound);
    for (const auto& [name, format] : {std::pair{"oct16", NormalFormat::oct16},
                                       {"rgb32f", NormalFormat::rgb32f},
                                       {"rgb16f", NormalFormat::rgb16f},
                                       {"r11g11b10f", NormalFormat::r11g11b10f},
                                       {"rgb10a2", NormalFormat::rgb10a2},
                                       {"xy8", NormalFormat::xy8}})
        EXPECT_LT(mebibytes(name, [format = format](Method& m) { m.gbuffer.normal_format = format; }), bound);
    for (const auto& [name, format] :
         {std::pair{"rgba32f", RadianceFormat::rgba32f}, {"radiance in r11g11b10f", RadianceFormat::r11g11b10f}})
        EXPECT_LT(mebibytes(name, [format = format](Method& m) { m.gbuffer.radiance_format = format; }), bound);
    EXPECT_LT(mebibytes("gbuffer.guard_band = 16", [](Method& m) { m.gbuffer.guard_band = 16; }), bound);
    // Each further bounce keeps a plane of 16 bytes a pixel for each layer that receives light; what the planes held in
    // the frame before takes the memory of others.
    EXPECT_NEAR(mebibytes("radiosity.bounces = 3", [](Method& m) { m.radiosity.bounces = 3; }) - dearest, 28.0, 15.0);
    EXPECT_GT(mebibytes("stored positions, normals in rgb32f and radiance in rgba32f",
                        [](Method& m) {
                            m.gbuffer.position = PositionSource::stored;
                            m.gbuffer.normal_format = NormalFormat::rgb32f;
                            m.gbuffer.radiance_format = RadianceFormat::rgba32f;
                        }),
              bound);
}

}  // namespace
}  // namespace plumb
