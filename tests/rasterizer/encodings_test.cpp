// What each encoding of the G-buffer keeps, and what it costs.
#include <cmath>

#include <fmt/format.h>

#include "gl_test.h"
#include "rasterizer/normal_encoding.h"
#include "rasterizer/pipeline.h"
#include "scenes/builtin.h"

namespace plumb {
namespace {

using EncodingsTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(EncodingsTest);

constexpr int width = 96, height = 72;

struct Rendered {
    Frame frame;
    std::size_t bytes;
};

Rendered render(GlContext& context, const Scene& scene, const Method& method, std::vector<std::string> planes) {
    Quantities quantities;
    quantities.planes = std::move(planes);
    Pipeline pipeline(context, scene, method, quantities, width, height);
    Frame frame = pipeline.render(View(scene.cameras[0], width, height)).frame;
    return {std::move(frame), pipeline.gbuffer_bytes_per_pixel()};
}

Method with_normals(NormalFormat format) {
    Method method;
    method.direct.shadow.emitter_size = 64;
    method.ao.samples = method.radiosity.samples = 8;
    method.gbuffer.normal_format = format;
    return method;
}

glm::dvec3 vector_at(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

TEST_P(EncodingsTest, NormalsKeepTheirStatedPrecision) {
    const Scene scene = make_colonnade();
    const Frame exact = render(context(), scene, with_normals(NormalFormat::rgb32f), {"depth", "normal"}).frame;
    const View view(scene.cameras[0], width, height);
    const glm::dmat3 camera_from_world(glm::mat3(view.camera_from_world()));
    struct Case {
        NormalFormat format;
        double degrees;  // the table of normal_encoding.h
    };
    // Rounding to b bits after the point moves a component by 2^-(b+1), truncation, which OpenGL allows, by 2^-b;
    // three of them, or two and their lengthening (the octahedral map stretches by up to 2, 0.5 n + 0.5 by 2).
    for (const auto& [format, degrees] :
         {Case{NormalFormat::oct32, 0.004}, Case{NormalFormat::oct16, 1.0}, Case{NormalFormat::rgb16f, 0.03},
          Case{NormalFormat::rgb10a2, 0.1}, Case{NormalFormat::r11g11b10f, 2.2}, Case{NormalFormat::xy8, 180.0}}) {
        const Frame frame = render(context(), scene, with_normals(format), {"normal"}).frame;
        double worst = 0.0;
        int compared = 0, mirrored = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                if (std::isinf(exact.plane("depth").at(x, y))) continue;
                glm::dvec3 n = vector_at(exact.plane("normal"), x, y);
                const glm::dvec3 m = vector_at(frame.plane("normal"), x, y);
                ASSERT_NEAR(glm::length(m), 1.0, 1e-5);
                ++compared;
                double error = degrees_between(n, m);
                if (format == NormalFormat::xy8) {
                    // Leaning away from the viewer: its mirror image comes back. The root magnifies a rounding of
                    // either component by 1 / 255 by the tangent of the angle to the view axis; where nothing is left
                    // of n_z it makes the root of twice the rounding of it.
                    glm::dvec3 in_camera = camera_from_world * n;
                    mirrored += in_camera.z < -0.2;
                    in_camera.z = std::abs(in_camera.z);
                    error = degrees_between(in_camera, camera_from_world * m);
                    const double rounding = std::sqrt(2.0) / 255.0;
                    const double of_z =
                        std::min(2.0 * rounding / std::max(in_camera.z, 1e-9), std::sqrt(2.0 * rounding));
                    ASSERT_LT(error, glm::degrees(of_z + rounding)) << x << ", " << y;
                }
                worst = std::max(worst, error);
            }
        }
        EXPECT_GT(compared, width * height / 2);
        EXPECT_LE(worst, degrees) << texture_format(format);
        if (format == NormalFormat::xy8) {
            EXPECT_GT(mirrored, 10) << "the view has too few normals that lean away";
        }
    }
}

// Through EGL alone: what takes time is compiling shaders, and both compile the same.
TEST(Encodings, EveryPassReadsEveryNormalFormat) {
    GlContext& context = test_context(GlBackend::egl);
    const Scene scene = make_cornell();
    const std::vector<std::string> planes{"total", "ao", "indirect", "layer2.direct"};
    const Frame exact = render(context, scene, with_normals(NormalFormat::rgb32f), planes).frame;
    for (const NormalFormat format : {NormalFormat::oct32, NormalFormat::oct16, NormalFormat::rgb16f,
                                      NormalFormat::rgb10a2, NormalFormat::r11g11b10f, NormalFormat::xy8}) {
        const Frame frame = render(context, scene, with_normals(format), planes).frame;
        for (const std::string& plane : planes) {
            const auto a = frame.plane(plane).values(), b = exact.plane(plane).values();
            double difference = 0.0, sum = 0.0;
            for (std::size_t i = 0; i < a.size(); ++i) difference += std::abs(a[i] - b[i]), sum += std::abs(b[i]);
            // A format misread turns normals by tens of degrees; 1.6 degrees change cosines by less than 3 % where they
            // are above one half. Mirrored normals (xy8) are few in this view.
            EXPECT_LT(difference, 0.03 * sum) << plane << ", format " << static_cast<int>(format);
        }
    }
}

// The passes that only some methods have: reflections and highlights, light volumes, and the filter over frames.
TEST(Encodings, PassesOfFurtherMethodsReadNormalsHoweverTheyAreEncoded) {
    GlContext& context = test_context(GlBackend::egl);
    Scene scene = make_cornell();
    // Wide lobes, so that reflections and highlights change as slowly with the normal as cosines do.
    for (Material& material : scene.materials) {
        material.dielectric_reflectance = 0.08f, material.roughness = 1.0f;
        material.emission = glm::vec3(0.0f);  // one shader less to compile for each format
    }
    const Bounds room = scene.bounds();
    scene.point_lights.push_back({"lamp", room.centre(), glm::vec3(1.0f)});
    const std::vector<std::string> planes{"reflection", "reflection.lamps", "direct", "ao", "ao.history_weight"};
    const auto second_frame = [&](NormalFormat format) {
        Method method = with_normals(format);
        method.radiosity.enabled = false;
        method.reflections.enabled = true;
        method.reflections.roughness = ReflectionRoughness::mirror;
        method.direct.local_lights = LocalLights::volume_stencil;
        method.direct.shadow.lamps = false;
        method.ao.blur.radius = 0;
        // What lies off the plane through a pixel by a millimetre counts less, so that the filter looks at normals.
        method.ao.temporal = {.alpha = 0.5f, .reject_from = 0.0f, .reject_to = 0.02f};
        Quantities quantities;
        quantities.planes = planes;
        Camera camera = scene.cameras[0];
        const View first(camera, width, height);
        camera.world_from_camera[3].x += 0.02f;
        const View second(camera, width, height);
        Pipeline pipeline(context, scene, method, quantities, width, height);
        pipeline.render(first);
        return pipeline.render(second, &first).frame;
    };
    const Frame exact = second_frame(NormalFormat::rgb32f);
    // One for each way of decoding.
    for (const NormalFormat format : {NormalFormat::oct32, NormalFormat::rgb10a2, NormalFormat::xy8}) {
        const Frame frame = second_frame(format);
        for (const std::string& plane : planes) {
            const auto a = frame.plane(plane).values(), b = exact.plane(plane).values();
            double difference = 0.0, sum = 0.0;
            for (std::size_t i = 0; i < a.size(); ++i) difference += std::abs(a[i] - b[i]), sum += std::abs(b[i]);
            EXPECT_GT(sum, 1.0) << plane;
            // As above; what rays hit changes by edges besides.
            EXPECT_LT(difference, 0.05 * sum) << plane << ", format " << static_cast<int>(format);
        }
    }
}

// Through EGL alone: what takes time is compiling shaders, and both compile the same.
TEST(Encodings, StoredPositionsAreThoseOfTheDepth) {
    GlContext& context = test_context(GlBackend::egl);
    const Scene scene = make_clutter();
    for (const int guard_band : {0, 16}) {
        Method from_depth, stored;
        from_depth.gbuffer.guard_band = stored.gbuffer.guard_band = guard_band;
        stored.gbuffer.position = PositionSource::stored;
        const auto a = render(context, scene, from_depth, {"ao", "indirect"});
        const auto b = render(context, scene, stored, {"ao", "indirect"});
        EXPECT_EQ(b.bytes, a.bytes + std::size_t{2} * 16u);
        for (const std::string plane : {"ao", "indirect"}) {
            const auto x = a.frame.plane(plane).values(), y = b.frame.plane(plane).values();
            std::size_t different = 0;
            for (std::size_t i = 0; i < x.size(); ++i) different += std::abs(x[i] - y[i]) > 1e-3f;
            // Positions agree to some 1e-7, sums over taps to 1e-5; a tap on the edge of the radius, of the hemisphere
            // or of the filter's weights may fall on the other side.
            EXPECT_LT(different, x.size() / 200) << plane;
        }
    }
}

// A half float has 11 bits, so that points a metre away are off by up to a quarter of a millimetre, and by half a
// millimetre from two metres on: less than the bias, but what is summed is no longer the same.
TEST(Encodings, PositionsOfHalfFloatsTakeHalfTheBytesAndErr) {
    GlContext& context = test_context(GlBackend::egl);
    const Scene scene = make_clutter();
    Method stored, half;
    stored.gbuffer.position = PositionSource::stored, half.gbuffer.position = PositionSource::stored_16;
    const auto a = render(context, scene, stored, {"ao"}), b = render(context, scene, half, {"ao"});
    EXPECT_EQ(b.bytes, a.bytes - std::size_t{2} * 8u);
    const auto x = a.frame.plane("ao").values(), y = b.frame.plane("ao").values();
    double difference = 0.0;
    std::size_t different = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        different += x[i] != y[i];
        difference += std::abs(x[i] - y[i]) / static_cast<double>(x.size());
    }
    EXPECT_GT(different, x.size() / 4);
    EXPECT_LT(difference, 0.02) << "the same picture, a little off";
}

TEST_P(EncodingsTest, RadianceKeepsTheBitsOfItsFormat) {
    const Scene scene = make_cornell();
    Method exact;
    exact.gbuffer.radiance_format = RadianceFormat::rgba32f;
    const Rendered reference = render(context(), scene, exact, {"direct", "layer2.direct"});
    struct Case {
        RadianceFormat format;
        std::array<float, 3> relative;  // half a unit of 10, or 6 and 5 bits after the point; truncation: a whole one
        std::size_t bytes;
    };
    for (const auto& [format, relative, bytes] :
         {Case{RadianceFormat::rgba16f, {1.0f / 1024, 1.0f / 1024, 1.0f / 1024}, 8},
          Case{RadianceFormat::r11g11b10f, {1.0f / 64, 1.0f / 64, 1.0f / 32}, 4}}) {
        Method method;
        method.gbuffer.radiance_format = format;
        const Rendered rendered = render(context(), scene, method, {"direct", "layer2.direct"});
        EXPECT_EQ(rendered.bytes, reference.bytes - 2u * (16u - bytes));
        for (const std::string plane : {"direct", "layer2.direct"}) {
            const auto a = rendered.frame.plane(plane).values(), b = reference.frame.plane(plane).values();
            for (std::size_t i = 0; i < a.size(); ++i)  // below 6e-5 the formats are denormal
                ASSERT_NEAR(a[i], b[i], relative[i % 3] * b[i] + 6e-5f) << plane << ", value " << i;
        }
    }
}

TEST_P(EncodingsTest, BytesAreThoseOfTheTextures) {
    const Scene scene = make_cornell();
    const std::vector<std::string> planes{"depth",        "normal",        "albedo",
                                          "layer2.depth", "layer2.normal", "layer2.albedo"};
    const auto bytes = [&](const Method& method) { return render(context(), scene, method, planes).bytes; };
    Method method;
    EXPECT_EQ(bytes(method), 2u * (4 + 4 + 8) + 4);  // depth, normal, albedo; one depth buffer for both layers
    method.gbuffer.normal_format = NormalFormat::xy8;
    EXPECT_EQ(bytes(method), 2u * (4 + 2 + 8) + 4);
    method.gbuffer.normal_format = NormalFormat::oct32;
    method.gbuffer.generation = LayerGeneration::reproject;
    EXPECT_EQ(bytes(method), 2u * (4 + 4 + 8) + 2 * 4 + 2 * 4);  // the last frame's depth; a depth buffer per layer
    method.gbuffer.generation = LayerGeneration::delay;
    EXPECT_EQ(bytes(method), 3u * (4 + 4 + 8) + 3 * 4 + 3 * 4);
}

// Standard depth resolves far surfaces worse, but not those of this room: near 0.05 m.
TEST_P(EncodingsTest, TheDepthMappingChangesNoLayerOfARoom) {
    const Scene scene = make_clutter();
    Method reversed, standard;
    standard.gbuffer.depth_mapping = DepthMapping::standard;
    const std::vector<std::string> planes{"depth", "layer2.depth", "emission"};
    const Frame a = render(context(), scene, reversed, planes).frame,
                b = render(context(), scene, standard, planes).frame;
    for (const std::string& plane : planes) {
        const auto x = a.plane(plane).values(), y = b.plane(plane).values();
        std::size_t different = 0;
        for (std::size_t i = 0; i < x.size(); ++i) different += !(x[i] == y[i] || std::abs(x[i] - y[i]) < 1e-3f);
        // Surfaces that touch.
        EXPECT_LE(different, x.size() / 1000) << plane;
    }
}

// Environment behind everything, whatever the mapping: where nothing is drawn, the depth is the farthest.
TEST_P(EncodingsTest, TheSkyIsSeenWithEitherDepthMappingAndGeneration) {
    const Scene scene = make_colonnade();
    Frame first;
    for (const DepthMapping mapping : {DepthMapping::reversed, DepthMapping::standard}) {
        for (const LayerGeneration generation : {LayerGeneration::peel, LayerGeneration::delay}) {
            Method method;
            method.gbuffer.depth_mapping = mapping;
            method.gbuffer.generation = generation;
            const Frame frame = render(context(), scene, method, {"emission", "layer2.depth"}).frame;
            if (first.plane_names().empty()) first = frame;
            const std::span<const float> a = frame.plane("emission").values(), b = first.plane("emission").values();
            std::size_t different = 0, lit = 0;
            for (std::size_t i = 0; i < a.size(); ++i) different += std::abs(a[i] - b[i]) > 1e-3f, lit += b[i] > 0.0f;
            EXPECT_GT(lit, 100u) << "no sky in this view";
            EXPECT_LE(different, a.size() / 1000);
        }
    }
}

}  // namespace
}  // namespace plumb
