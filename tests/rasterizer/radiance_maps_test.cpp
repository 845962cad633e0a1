// Radiance maps of the environment and of probes against integrals over directions, and how shaders read them.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "gl_test.h"
#include "light_run.h"
#include "light_scenes.h"
#include "radiance_counterpart.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/specular_albedo_texture.h"
#include "ray_caster.h"
#include "scenes/specular_albedo.h"

namespace plumb {
namespace {

using RadianceMapsTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(RadianceMapsTest);

using counterpart::direction_of, counterpart::irradiance, counterpart::prefiltered, counterpart::Radiance;
constexpr double pi = glm::pi<double>();

Scene make_sky_scene() {
    Scene scene = make_corner();
    counterpart::give_sky(scene);
    return scene;
}

View small_view() { return View(corner_view().camera(), 32, 24); }

LightRun run_of(GlContext& context, const Scene& scene, const Method& method, const std::string& name) {
    return {context, scene, method, RadianceMaps::outputs(name), small_view()};
}

// The corners of a square face, and as many more at random as make `count`.
std::vector<glm::ivec2> some_texels(std::mt19937& generator, int size, int count) {
    std::vector<glm::ivec2> texels{{0, 0}, {size - 1, 0}, {0, size - 1}, {size - 1, size - 1}};
    std::uniform_int_distribution<int> any(0, size - 1);
    while (static_cast<int>(texels.size()) < count) {
        const int x = any(generator);
        texels.emplace_back(x, any(generator));
    }
    return texels;
}

// Compares texels of each face and level with the integrals: the corners and, at random, some of the others.
void expect_maps(const LightRun& run, const std::string& name, const Radiance& radiance, double irradiance_tolerance,
                 double lobe_tolerance, int rows = 120, int texels = 24) {
    std::mt19937 generator(static_cast<unsigned>(rows));
    for (int face = 0; face < 6; ++face) {
        const Image irradiances = run.image(name + ".irradiance", 3, face);
        for (const glm::ivec2& texel : some_texels(generator, irradiances.width(), texels)) {
            const int x = texel.x, y = texel.y;
            const glm::dvec3 expected = irradiance(radiance, direction_of(face, x, y, 16), rows, rows);
            EXPECT_LT(glm::length(vector_at(irradiances, x, y) - expected),
                      irradiance_tolerance * glm::length(expected))
                << "face " << face << " at " << x << ", " << y << ": " << irradiances.at(x, y) << " for " << expected.x;
        }
        for (int level = 1; level < prefiltered_levels; ++level) {
            const Image lobes = run.image(name + ".prefiltered", 3, face, level);
            const double roughness = static_cast<double>(level) / (prefiltered_levels - 1);
            const int size = lobes.width();
            for (const glm::ivec2& texel : some_texels(generator, size, texels / 2)) {
                const int x = texel.x, y = texel.y;
                const glm::dvec3 expected =
                    prefiltered(radiance, direction_of(face, x, y, size), roughness * roughness, 5 * rows);
                EXPECT_LT(glm::length(vector_at(lobes, x, y) - expected), lobe_tolerance * glm::length(expected))
                    << "face " << face << " level " << level << ": " << lobes.at(x, y) << " for " << expected.x;
            }
        }
    }
}

TEST_P(RadianceMapsTest, TheEnvironmentIsIntegratedForDiffuseAndGlossySurfaces) {
    const Scene scene = make_sky_scene();
    Method method = plain_method();
    method.environment.size = 64;
    LightRun run = run_of(context(), scene, method, "environment");
    run.run();
    // Texels of 1.4 degrees and, for irradiance, 2.8: a part in a hundred of a glow 13 degrees wide. Lobes besides have
    // the 256 samples' error and the MIP levels' box filter.
    expect_maps(
        run, "environment", [&](const glm::dvec3& d) { return glm::dvec3(scene.environment_radiance(d)); }, 0.01, 0.04);
    for (int face = 0; face < 6; ++face) {
        const Image seen = run.image("environment.radiance", 3, face),
                    copy = run.image("environment.prefiltered", 3, face);
        EXPECT_TRUE(std::ranges::equal(seen.values(), copy.values())) << "roughness 0 is a mirror";
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const glm::dvec3 expected(scene.environment_radiance(direction_of(face, x, y, 64)));
                ASSERT_LT(glm::length(vector_at(seen, x, y) - expected), 0.01 * glm::length(expected))
                    << "face " << face << " at " << x << ", " << y;
            }
        }
    }
}

// With thousands of directions per texel what is left is the cubes' resolution. Through EGL alone: it takes a second.
TEST(RadianceMaps, GlossyLevelsConvergeToTheLobesIntegral) {
    const Scene scene = make_sky_scene();
    const Radiance sky = [&](const glm::dvec3& d) { return glm::dvec3(scene.environment_radiance(d)); };
    const auto error_with = [&](int samples) {
        Method method = plain_method();
        method.environment = {.size = 64, .samples = samples};
        LightRun run = run_of(test_context(GlBackend::egl), scene, method, "environment");
        run.run();
        double error = 0.0, sum = 0.0;
        for (int level = 1; level < prefiltered_levels; ++level) {
            const double roughness = static_cast<double>(level) / (prefiltered_levels - 1);
            for (const int face : {0, 3, 4}) {
                const Image lobes = run.image("environment.prefiltered", 3, face, level);
                const int size = lobes.width();
                for (const auto& [x, y] :
                     {std::pair{0, size / 2}, std::pair{size / 2, size / 3}, std::pair{size - 1, 0}}) {
                    const glm::dvec3 expected =
                        prefiltered(sky, direction_of(face, x, y, size), roughness * roughness, 400);
                    error += glm::length(vector_at(lobes, x, y) - expected);
                    sum += glm::length(expected);
                }
            }
        }
        return error / sum;
    };
    const double few = error_with(32), thousands = error_with(4096);
    // Texels of 1.4 degrees average the sky, whose glow is 13 degrees wide: some 1e-3.
    EXPECT_LT(thousands, 3e-3) << few;
    EXPECT_LT(thousands, few / 4.0);
}

// A sky of all nine polynomials of order 2 and less, none of them along an axis of the others, seen by a ball: each
// pixel against the convolution with the clamped cosine (Ramamoorthi, Hanrahan 2001), written out.
TEST_P(RadianceMapsTest, HarmonicsGiveEachPixelTheIrradianceOfItsNormal) {
    using Basis = std::array<double, 9>;
    const auto basis = [](const glm::dvec3& d) {
        const double first = std::sqrt(3.0 / (4.0 * pi)), mixed = std::sqrt(15.0 / (4.0 * pi));
        return Basis{std::sqrt(1.0 / (4.0 * pi)),
                     first * d.y,
                     first * d.z,
                     first * d.x,
                     mixed * d.x * d.y,
                     mixed * d.y * d.z,
                     std::sqrt(5.0 / (16.0 * pi)) * (3.0 * d.z * d.z - 1.0),
                     mixed * d.x * d.z,
                     0.5 * mixed * (d.x * d.x - d.y * d.y)};
    };
    // What the clamped cosine leaves of each order: pi, 2 pi / 3, pi / 4.
    const Basis kept{pi, 2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4, pi / 4, pi / 4, pi / 4, pi / 4};
    const Basis weights{4.0, 0.9, -0.7, 0.5, 0.6, -0.5, 0.4, 0.7, -0.6};  // no radiance is negative
    const auto sum_of = [&](const Basis& factors, const glm::dvec3& d) {
        const Basis values = basis(d);
        double sum = 0.0;
        for (std::size_t k = 0; k < 9; ++k) sum += factors[k] * weights[k] * values[k];
        return sum;
    };
    Basis ones;
    ones.fill(1.0);
    Scene scene = make_corner();
    const Mesh ball = make_ball(24, 0.9f, {0.2f, 0.9f, 0.1f});
    scene.instances.push_back({"ball", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(ball);
    Texture sky;
    sky.width = 512, sky.height = 256, sky.wrap_v = TextureWrap::clamp;
    for (int y = 0; y < sky.height; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            // As Scene::environment_radiance reads it: columns from -z over +x, rows from +y down.
            const double longitude = 2.0 * pi * ((x + 0.5) / sky.width - 0.5), polar = pi * (y + 0.5) / sky.height;
            const glm::dvec3 d(std::sin(polar) * std::sin(longitude), std::cos(polar),
                               -std::sin(polar) * std::cos(longitude));
            const auto value = static_cast<float>(sum_of(ones, d));
            ASSERT_GT(value, 0.0f);
            for (const float channel : {value, 2.0f * value, 0.5f * value, 1.0f}) sky.texels.push_back(half(channel));
        }
    }
    scene.environment = {glm::vec3(1.0f), static_cast<int>(scene.textures.size()), 0.0f};
    scene.textures.push_back(sky);
    const View view = corner_view();
    Method method = plain_method();
    method.gbuffer.radiance_format = RadianceFormat::rgba32f;
    const Frame frame = render(context(), scene, view, {"direct", "albedo", "normal", "depth"}, method);
    int compared = 0, wrong = 0;
    std::array<int, 9> tells{};  // pixels in which a missing polynomial would show
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (std::isinf(frame.plane("depth").at(x, y))) continue;
            ++compared;
            const glm::dvec3 n = vector_at(frame.plane("normal"), x, y);
            const double expected = sum_of(kept, n);
            const glm::dvec3 found = vector_at(frame.plane("direct"), x, y),
                             reflected = vector_at(frame.plane("albedo"), x, y) / pi * glm::dvec3(1.0, 2.0, 0.5);
            // Half floats of the sky and its bilinear texels of 0.7 degrees: 1e-3 of the brightest.
            constexpr double tolerance = 2e-3;
            wrong += glm::length(found - reflected * expected) > tolerance * glm::length(reflected) * kept[0] * 2.0;
            for (std::size_t k = 0; k < 9; ++k)
                tells[k] += std::abs(kept[k] * weights[k] * basis(n)[k]) > 10.0 * tolerance * kept[0] * 2.0;
        }
    }
    EXPECT_GT(compared, 4000);
    EXPECT_EQ(wrong, 0);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_GT(tells[k], 200) << "polynomial " << k;
}

TEST_P(RadianceMapsTest, AConstantEnvironmentStaysExactlyWhatItIs) {
    Scene scene = make_corner();
    scene.environment.radiance = {0.5f, 0.75f, 1.25f};
    LightRun run = run_of(context(), scene, plain_method(), "environment");
    run.run();
    for (int face = 0; face < 6; ++face) {
        const Image irradiances = run.image("environment.irradiance", 3, face);
        EXPECT_NEAR(irradiances.at(5, 9, 1), 0.75 * pi, 1e-5);  // sums of floats
        for (int level = 0; level < prefiltered_levels; ++level) {
            EXPECT_NEAR(run.image("environment.prefiltered", 3, face, level).at(1, 2, 2), 1.25f, 1e-5f);
        }
    }
}

TEST_P(RadianceMapsTest, DirectLightMayReadTheIrradianceCubeInsteadOfHarmonics) {
    const Scene scene = make_sky_scene();
    const View view = corner_view();
    Method method = plain_method();
    const Frame harmonics = render(context(), scene, view, {"direct", "albedo", "normal", "depth"}, method);
    method.direct.environment = EnvironmentIrradiance::cube;
    const Image cube = render(context(), scene, view, {"direct"}, method).plane("direct");
    const auto sky = [&](const glm::dvec3& d) { return glm::dvec3(scene.environment_radiance(d)); };
    double worst_cube = 0.0, worst_harmonics = 0.0;
    std::mt19937 generator(7);
    std::uniform_int_distribution<int> column(0, view.width() - 1), row(0, view.height() - 1);
    for (int i = 0; i < 100; ++i) {
        const int x = column(generator), y = row(generator);
        if (std::isinf(harmonics.plane("depth").at(x, y))) continue;
        const glm::dvec3 expected = vector_at(harmonics.plane("albedo"), x, y) / pi *
                                    irradiance(sky, vector_at(harmonics.plane("normal"), x, y));
        const auto error = [&](const Image& image) {
            return glm::length(vector_at(image, x, y) - expected) / glm::length(expected);
        };
        worst_cube = std::max(worst_cube, error(cube));
        worst_harmonics = std::max(worst_harmonics, error(harmonics.plane("direct")));
    }
    // The cube's texels are 5.6 degrees wide; order 2 misses what a small bright glow sends.
    EXPECT_LT(worst_cube, 0.015);
    EXPECT_LT(worst_harmonics, 0.1);
}

TEST_P(RadianceMapsTest, SizesThatCannotBeHalvedAreErrors) {
    Method method = plain_method();
    method.environment.size = 96;
    EXPECT_THROW(run_of(context(), make_sky_scene(), method, "environment"), MethodError);
}

Method probe_method(const glm::vec3& position, int size) {
    Method method = plain_method();
    method.probe.x = position.x, method.probe.y = position.y, method.probe.z = position.z;
    method.probe.size = size;
    return method;
}

TEST_P(RadianceMapsTest, AProbeInsideAnEmitterSeesItsRadianceEverywhere) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].base_colour = {0.0f, 0.0f, 0.0f};
    scene.materials[0].emission = {2.0f, 0.5f, 0.25f};
    scene.meshes.push_back(make_ball(12, 1.5f, {1.0f, 2.0f, 3.0f}));
    scene.instances.push_back({"shell", 0, glm::mat4(1.0f)});
    LightRun run = run_of(context(), scene, probe_method({1.2f, 1.9f, 3.1f}, 32), "probe");
    run.run();
    for (int face = 0; face < 6; ++face) {
        const Image seen = run.image("probe.radiance", 3, face);
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x) ASSERT_EQ(vector_at(seen, x, y), glm::dvec3(2.0, 0.5, 0.25)) << face;
        }
        EXPECT_NEAR(run.image("probe.irradiance", 3, face).at(3, 8), 2.0 * pi, 1e-4);  // sums of floats
        for (int level = 0; level < prefiltered_levels; ++level) {
            EXPECT_NEAR(run.image("probe.prefiltered", 3, face, level).at(0, 0, 1), 0.5f, 1e-5f) << level;
        }
    }
}

// Every texel of a probe among balls and walls against a ray with the lamp's light worked out by hand, and the maps
// against integrals over such rays.
TEST_P(RadianceMapsTest, AProbeSeesTheLitScene) {
    Scene scene = make_corner();
    Mesh ball = make_ball(6, 0.3f, {-0.5f, 0.5f, 0.0f});
    scene.instances.push_back({"ball", static_cast<int>(scene.meshes.size()), glm::mat4(1.0f)});
    scene.meshes.push_back(ball);
    scene.environment.radiance = {0.2f, 0.3f, 0.4f};
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    const glm::vec3 position(0.5f, 0.8f, 0.6f);
    constexpr int size = 32;
    Method method = probe_method(position, size);
    method.direct.shadow.lamps = false;
    LightRun run = run_of(context(), scene, method, "probe");
    run.run();
    const RayCaster caster(scene);
    const Radiance radiance = [&](const glm::dvec3& d) {
        const CastHit hit = caster.cast(glm::dvec3(position), d, 1e-3, 1e3);
        if (!hit.hit) return glm::dvec3(scene.environment.radiance);
        const PointLight& lamp = scene.point_lights[0];
        const glm::dvec3 to_light = glm::dvec3(lamp.position) - hit.point;
        const double distance = glm::length(to_light);
        const glm::dvec3 arriving =
            glm::dvec3(lamp.intensity) * std::max(0.0, glm::dot(hit.normal, to_light)) / std::pow(distance, 3.0) +
            pi * glm::dvec3(scene.environment.radiance);
        return hit.emission + hit.albedo / pi * arriving;
    };
    int wrong = 0;
    for (int face = 0; face < 6; ++face) {
        const Image seen = run.image("probe.radiance", 3, face);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const glm::dvec3 expected = radiance(direction_of(face, x, y, size));
                // Half floats of direct light and albedo.
                wrong += glm::length(vector_at(seen, x, y) - expected) > 3e-3 * glm::length(expected);
            }
        }
    }
    // Silhouettes, where the rasterizer's grid of 1/256 pixel may show the other side.
    EXPECT_LE(wrong, 6 * size * size / 200);
    // Texels of 2.8 degrees across bright edges.
    expect_maps(run, "probe", radiance, 0.02, 0.12, 50);
}

TEST_P(RadianceMapsTest, AProbeOfEveryFrameIsTheSameAgainAndOneOfTheFirstLetsItsMemoryGo) {
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    Method method = probe_method({0.5f, 0.8f, 0.6f}, 32);
    method.direct.shadow.cube_size = 64;
    LightRun once = run_of(context(), scene, method, "probe");
    const std::size_t before = once.allocated_bytes();
    once.run();
    EXPECT_LT(once.allocated_bytes(), before);
    method.probe.every_frame = true;
    LightRun always = run_of(context(), scene, method, "probe");
    always.run();
    const Image first = always.image("probe.irradiance", 3, 2);
    const std::size_t after_first = always.allocated_bytes();
    always.run();
    EXPECT_EQ(always.allocated_bytes(), after_first);
    EXPECT_TRUE(std::ranges::equal(always.image("probe.irradiance", 3, 2).values(), first.values()));
    EXPECT_TRUE(std::ranges::equal(once.image("probe.irradiance", 3, 2).values(), first.values()));
}

// A shader that reads the maps as later passes do: row y holds roughness and cosine of the split sum, and a lobe.
TEST_P(RadianceMapsTest, ShadersReadTheMapsAndTheSplitSum) {
    const Scene scene = make_sky_scene();
    Method method = plain_method();
    method.environment.size = 64;
    LightRun run = run_of(context(), scene, method, "environment");
    run.run();
    constexpr std::string_view reading_shader = R"(
        #include "radiance_maps.glsl"
        #include "specular_albedo.glsl"
        layout(binding = 0) uniform samplerCube prefiltered;
        layout(binding = 1) uniform samplerCube irradiance;
        layout(location = 0) out vec4 result;
        void main() {
            vec2 at = gl_FragCoord.xy / 32.0;
            result.xy = specular_split(at.x, max(at.y * at.y, 0.001));
            result.z = glossy_radiance(prefiltered, normalize(vec3(at.x, 0.4, -0.3)), at.y).r;
            result.w = diffuse_irradiance(irradiance, normalize(vec3(at.x, 0.4, at.y))).r;
        })";
    // Lines that the loader looks for start at the margin.
    std::string unindented;
    for (std::size_t i = 0, line_start = 1; i < reading_shader.size(); ++i) {
        if (line_start && reading_shader[i] == ' ') continue;
        line_start = reading_shader[i] == '\n';
        unindented += reading_shader[i];
    }
    const Program program(context(), {"fullscreen.vert", "reading.frag"}, SpecularAlbedoTexture::defines(2),
                          [&](std::string_view file) -> std::string_view {
                              return file == "reading.frag" ? std::string_view(unindented) : embedded_shader(file);
                          });
    const GlTexture result = GlTexture::flat(context(), GL_RGBA32F, 32, 32);
    const GlFramebuffer target(context(), std::array{GlAttachment{&result}}, {}, "reading");
    const SpecularAlbedoTexture split(context());
    const GlVertexArray nothing(context());
    run.planes().get("environment.prefiltered").bind(0);
    run.planes().get("environment.irradiance").bind(1);
    split.bind(2);
    target.bind();
    program.use();
    nothing.bind();
    context().gl.DrawArrays(GL_TRIANGLES, 0, 3);
    const Image image = read_back(result, 0, 4);
    const SpecularAlbedo albedo;
    const Radiance sky = [&](const glm::dvec3& d) { return glm::dvec3(scene.environment_radiance(d)); };
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / 32.0f, v = (31.5f - static_cast<float>(y)) / 32.0f;
            const glm::vec2 expected = albedo.split(u, std::max(v * v, 0.001f));
            // Bilinear weights of 8 bits between entries that differ by a tenth at most.
            ASSERT_NEAR(image.at(x, y, 0), expected.x, 2e-3f) << u << " " << v;
            ASSERT_NEAR(image.at(x, y, 1), expected.y, 2e-3f) << u << " " << v;
            if (x % 15 != 3 || y % 13 != 4) continue;
            const double diffuse = irradiance(sky, glm::normalize(glm::dvec3(u, 0.4, v))).x;
            EXPECT_NEAR(image.at(x, y, 3), diffuse, 0.015 * diffuse);
            const double lobe = prefiltered(sky, glm::normalize(glm::dvec3(u, 0.4, -0.3)), v * v).x;
            // Mixed between two levels of roughness.
            EXPECT_NEAR(image.at(x, y, 2), lobe, 0.05 * lobe) << "roughness " << v;
        }
    }
}

}  // namespace
}  // namespace plumb
