// A frame allocates nothing after its first: no OpenGL object of any kind is made, not even one that is gone again when
// the frame ends.
#include <string>
#include <vector>

#include "gl_test.h"
#include "rasterizer/gl_objects.h"
#include "rasterizer/pipeline.h"
#include "tests/busy_scene.h"

namespace plumb {
namespace {

using AllocationTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(AllocationTest);

struct NamedMethod {
    const char* name;
    Method method;
    std::vector<std::string> planes = {"total", "ao"};
};

Method with_small_maps() {
    Method method;
    ShadowSettings& shadow = method.direct.shadow;
    shadow.cube_size = shadow.emitter_size = shadow.paraboloid_size = 32;
    shadow.map_size = 64;
    method.environment = {.size = 32, .samples = 4};
    method.probe = {.y = 1.0f, .size = 32};
    method.ao.samples = method.radiosity.samples = 4;
    return method;
}

std::vector<NamedMethod> varied_methods() {
    std::vector<NamedMethod> methods;
    const auto add = [&](const char* name, std::vector<std::string> planes, const auto& change) {
        NamedMethod& added = methods.emplace_back(NamedMethod{name, with_small_maps(), std::move(planes)});
        change(added.method);
    };
    add("default", {"total", "ao", "motion"}, [](Method&) {});
    add("stencil volumes, MIP reflections before the environment", {"total"}, [](Method& m) {
        m.direct.local_lights = LocalLights::volume_stencil;
        m.reflections = {.enabled = true, .fallback = ReflectionFallback::environment};
    });
    add("volumes, paraboloids, many rays, a probe of every frame", {"total"}, [](Method& m) {
        m.direct.local_lights = LocalLights::volume;
        m.direct.shadow.point_map = PointShadowMap::dual_paraboloid;
        m.direct.shadow.pcf_radius = 1;
        m.reflections = {.enabled = true,
                         .roughness = ReflectionRoughness::samples,
                         .samples = 40,
                         .fallback = ReflectionFallback::probe};
        m.probe.every_frame = true;
    });
    add("one-pass linear cubes, stored positions, Gaussian blur", {"total", "ao"}, [](Method& m) {
        m.direct.shadow.cube_generation = CubeGeneration::one_pass;
        m.direct.shadow.cube_distance = CubeDistance::linear;
        m.direct.environment = EnvironmentIrradiance::cube;
        m.gbuffer.position = PositionSource::stored;
        m.ao.blur.kind = BlurKind::gaussian_2015;
        m.radiosity.blur.kind = BlurKind::gaussian_2015_listing;
        m.radiosity.bounces = 3;
        m.radiosity.mip_normals_and_radiance = true;
        m.radiosity.second_layer = SecondLayerIndirect::gather;
    });
    add("the demo's composite over carried light, temporal filters, anti-aliasing", {"total"}, [](Method& m) {
        m.gbuffer.guard_band = 6;
        m.composite = {.kind = CompositeKind::demo, .fill = AmbientSource::environment};
        m.radiosity.carry = true;
        m.ao.temporal = {.alpha = 0.9f, .layers = 2};
        m.radiosity.temporal = {.alpha = 0.9f};
        m.ao.blur.depth_key_bits = 8;
        m.antialias.temporal = true;
    });
    add("light filled in from a probe", {"indirect", "confidence"}, [](Method& m) {
        m.radiosity.fill = AmbientSource::probe;
        m.ao.normals = ObscuranceNormals::face;
    });
    add("four layers", {"layer4.depth", "layer3.normal", "layer2.direct"}, [](Method& m) { m.gbuffer.layers = 4; });
    for (const auto& [name, generation] :
         {std::pair{"delay", LayerGeneration::delay}, std::pair{"previous", LayerGeneration::previous},
          std::pair{"predict", LayerGeneration::predict}, std::pair{"reproject", LayerGeneration::reproject}}) {
        add(name, {"total", "ao", "layer2.normal"}, [way = generation](Method& m) {
            m.gbuffer.generation = way;
            m.ao.temporal.alpha = 0.5f;
        });
    }
    return methods;
}

TEST_P(AllocationTest, NoObjectIsMadeAfterTheFirstFrame) {
    constexpr int width = 40, height = 30;
    const Scene scene = make_busy_scene();
    for (const NamedMethod& named : varied_methods()) {
        SCOPED_TRACE(named.name);
        Pipeline pipeline(context(), scene, named.method, {.planes = named.planes}, width, height);
        pipeline.time_passes(busy_frame(0, width, height));
        const std::size_t objects = context().created_objects(), bytes = context().allocated_bytes();
        for (int frame = 1; frame < 3; ++frame) pipeline.time_passes(busy_frame(frame, width, height));
        pipeline.time_passes(busy_frame(10, width, height));  // after a cut
        pipeline.render(busy_frame(11, width, height));       // and read back
        EXPECT_EQ(context().created_objects() - objects, 0u);
        EXPECT_EQ(context().allocated_bytes(), bytes);
    }
}

TEST_P(AllocationTest, ObjectsCountThatTakeNoBytesOrAreGoneAgain) {
    const std::size_t objects = context().created_objects(), bytes = context().allocated_bytes();
    { const GlTexture texture = GlTexture::flat(context(), GL_R8, 4, 4); }
    const GlVertexArray array(context());
    EXPECT_EQ(context().created_objects() - objects, 2u);
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

}  // namespace
}  // namespace plumb
