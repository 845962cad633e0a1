#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "gl_test.h"
#include "rasterizer/pipeline.h"
#include "ray_caster.h"
#include "scenes/builtin.h"
#include "tests/bright_sky.h"

namespace plumb {
namespace {

using GBufferTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(GBufferTest);

Frame render(GlContext& context, const Scene& scene, const View& view, const Method& method,
             std::vector<std::string> planes, const View* previous = nullptr) {
    Quantities quantities;
    quantities.planes = std::move(planes);
    return Pipeline(context, scene, method, quantities, view.width(), view.height()).render(view, previous).frame;
}

Method two_layers(float separation, int guard_band = 0) {
    Method method;
    method.gbuffer.layers = 2;
    method.gbuffer.minimum_separation = separation;
    method.gbuffer.guard_band = guard_band;
    return method;
}

const std::vector<std::string> all_planes{"depth",        "normal",        "albedo",        "emission",
                                          "layer2.depth", "layer2.normal", "layer2.albedo", "layer2.emission"};

glm::dvec3 vector_at(const Image& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// Compares one layer where it is away from edges of either layer. Counts rather than failing per pixel, and prints the
// first.
void expect_layer(const Frame& frame, const std::string& prefix, const std::vector<CastHit>& expected,
                  const std::vector<bool>& compared) {
    int wrong = 0, count = 0;
    std::string first;
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * frame.width() + x;
            if (!compared[i]) continue;
            ++count;
            const CastHit& hit = expected[i];
            const float depth = frame.plane(prefix + "depth").at(x, y);
            const glm::dvec3 normal = vector_at(frame.plane(prefix + "normal"), x, y);
            const glm::dvec3 albedo = vector_at(frame.plane(prefix + "albedo"), x, y);
            const glm::dvec3 emission = vector_at(frame.plane(prefix + "emission"), x, y);
            std::string problem;
            if (!hit.hit) {
                if (!std::isinf(depth) || normal != glm::dvec3(0.0) || albedo != glm::dvec3(0.0))
                    problem = "not background";
            } else if (!(std::abs(depth - hit.depth) <= 1e-4 * hit.depth)) {
                // Float depth resolves some 1e-6; interpolation over a triangle clipped close to the camera costs the
                // rest.
                problem = fmt::format("depth {} instead of {}", depth, hit.depth);
            } else if (glm::dot(normal, hit.normal) < std::cos(glm::radians(0.1))) {
                // 16-bit octahedral normals keep 0.003 degrees, interpolation in float less.
                problem =
                    fmt::format("normal off by {} degrees", glm::degrees(std::acos(glm::dot(normal, hit.normal))));
            } else if (glm::length(albedo - hit.albedo) > 0.5 / 255.0) {
                // Half floats keep 1/4096 of a value below 1; bilinear weights on the GPU have at least 8 bits.
                problem = fmt::format("albedo {} instead of {}", albedo.x, hit.albedo.x);
            } else if (glm::length(emission - hit.emission) > 1e-3 * glm::length(hit.emission)) {
                problem = fmt::format("emission {} instead of {}", emission.x, hit.emission.x);
            }
            if (problem.empty()) continue;
            if (wrong++ == 0) first = fmt::format("pixel ({}, {}): {}", x, y, problem);
        }
    }
    EXPECT_GT(count, frame.width() * frame.height() / 3) << prefix << ": too few pixels away from edges";
    EXPECT_EQ(wrong, 0) << prefix << "of " << count << " pixels; first " << first;
}

void expect_both_layers(GlContext& context, const Scene& scene, const View& view, float separation) {
    const Frame frame = render(context, scene, view, two_layers(separation), all_planes);
    const RayCaster::Layers layers = RayCaster(scene).layers(view, separation);
    const std::vector<bool> first = away_from_edges(layers.first, view.width(), view.height());
    std::vector<bool> both = away_from_edges(layers.second, view.width(), view.height());
    for (std::size_t i = 0; i < both.size(); ++i) both[i] = both[i] && first[i];
    expect_layer(frame, "", layers.first, first);
    expect_layer(frame, "layer2.", layers.second, both);
}

TEST_P(GBufferTest, AgreesWithARayCasterOnTheCornellBox) {
    const Scene scene = make_cornell();
    for (const Camera& camera : scene.cameras) {
        SCOPED_TRACE(camera.name);
        expect_both_layers(context(), scene, View(camera, 64, 48), 0.1f);
    }
}

// One of everything: smooth normals, a mirrored and unevenly scaled instance, textures with each wrap, masks from both
// kinds of texture, a one-sided surface seen from behind, metal.
Scene make_menagerie() {
    Scene scene;
    scene.name = "menagerie";
    const auto texture = [&](int size, TextureWrap wrap_u, TextureWrap wrap_v, auto colour) {
        Texture t;
        t.name = "texture";
        t.width = size, t.height = size;
        t.wrap_u = wrap_u, t.wrap_v = wrap_v;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const glm::vec4 c = colour(x, y);
                for (int k = 0; k < 4; ++k) t.texels.push_back(half(c[k]));
            }
        }
        scene.textures.push_back(t);
    };
    texture(8, TextureWrap::repeat, TextureWrap::mirror,
            [](int x, int y) { return glm::vec4(0.1f * x, 0.1f * y, 0.5f, x < 4 ? 1.0f : 0.0f); });
    texture(4, TextureWrap::clamp, TextureWrap::clamp,
            [](int x, int y) { return glm::vec4(y < 2 ? 1.0f : 0.0f, 0.25f * x, 0.2f + 0.1f * y, 1.0f); });
    const auto material = [&](auto change) {
        Material m;
        m.base_colour = {0.9f, 0.7f, 0.8f};
        change(m);
        scene.materials.push_back(m);
        return static_cast<int>(scene.materials.size()) - 1;
    };
    const int textured = material([](Material& m) { m.base_colour_texture = 0; });
    const int masked = material([](Material& m) { m.base_colour_texture = 0, m.alpha_mask = true; });
    const int separately_masked =
        material([](Material& m) { m.alpha_mask = true, m.alpha_texture = 1, m.alpha_channel = 0; });
    const int metal = material([](Material& m) { m.metallic = 0.9f, m.metallic_roughness_texture = 1; });
    const int one_sided = material([](Material& m) { m.two_sided = false, m.emission = {3, 2, 1}; });
    const int glowing = material([](Material& m) { m.emission = {3, 2, 1}, m.emission_texture = 1; });
    const auto quad = [&](int with, const glm::mat4& place, bool flip = false) {
        Mesh mesh;
        mesh.material = with;
        mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        mesh.uvs = {{-0.7f, 2.3f}, {1.6f, 2.3f}, {1.6f, -0.4f}, {-0.7f, -0.4f}};
        mesh.triangles =
            flip ? std::vector<glm::uvec3>{{0, 2, 1}, {0, 3, 2}} : std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}};
        scene.instances.push_back({"quad", static_cast<int>(scene.meshes.size()), place});
        scene.meshes.push_back(mesh);
    };
    const auto at = [](float x, float y, float z, float turn = 0.3f) {
        return glm::rotate(glm::translate(glm::mat4(1.0f), {x, y, z}), turn, glm::vec3(0.2f, 1.0f, 0.1f));
    };
    quad(textured, at(-2.4f, 1.2f, -6.0f));
    quad(masked, at(0.0f, 1.2f, -6.0f));
    quad(separately_masked, at(2.4f, 1.2f, -6.0f));
    quad(metal, at(-2.4f, -1.2f, -6.0f));
    quad(one_sided, at(0.0f, -1.2f, -6.0f), true);
    quad(glowing, at(2.4f, -1.2f, -6.0f));
    quad(textured, glm::scale(at(0.0f, 0.0f, -9.0f), glm::vec3(4.0f, 3.0f, 1.0f)));

    Mesh ball;  // smooth normals, coarse
    ball.material = textured;
    constexpr int rings = 12, sectors = 20;
    for (int i = 0; i <= rings; ++i) {
        for (int j = 0; j <= sectors; ++j) {
            const float theta = 3.14159265f * static_cast<float>(i) / rings;
            const float phi = 2.0f * 3.14159265f * static_cast<float>(j) / sectors;
            const glm::vec3 p(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            ball.positions.push_back(p), ball.normals.push_back(p);
            ball.uvs.push_back({static_cast<float>(j) / sectors, static_cast<float>(i) / rings});
        }
    }
    for (unsigned i = 0; i < rings; ++i) {
        for (unsigned j = 0; j < sectors; ++j) {
            const unsigned a = i * (sectors + 1) + j, b = a + sectors + 1;
            if (i > 0) ball.triangles.push_back({a, a + 1, b});
            if (i + 1 < rings) ball.triangles.push_back({a + 1, b + 1, b});
        }
    }
    scene.instances.push_back({"ball", static_cast<int>(scene.meshes.size()),
                               glm::scale(at(-0.9f, 0.2f, -4.0f), glm::vec3(0.5f, 0.9f, 0.5f))});
    scene.instances.push_back({"mirrored ball", static_cast<int>(scene.meshes.size()),
                               glm::scale(at(1.2f, 0.2f, -4.0f), glm::vec3(-0.6f, 0.4f, 0.5f))});
    scene.meshes.push_back(ball);
    return scene;
}

Camera menagerie_camera() { return Camera::look_at("front", {0.2f, 0.1f, 0.3f}, {0.0f, 0.0f, -6.0f}, 0.9f); }

TEST_P(GBufferTest, AgreesWithARayCasterOnEveryKindOfMaterial) {
    const Scene scene = make_menagerie();
    expect_both_layers(context(), scene, View(menagerie_camera(), 128, 96), 0.2f);
}

TEST_P(GBufferTest, SecondLayerKeepsTheMinimumSeparation) {
    const Scene scene = make_menagerie();
    const View view(menagerie_camera(), 160, 120);
    for (const float separation : {0.01f, 0.5f, 3.0f}) {
        const Frame frame = render(context(), scene, view, two_layers(separation), {"depth", "layer2.depth"});
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                const float first = frame.plane("depth").at(x, y), second = frame.plane("layer2.depth").at(x, y);
                ASSERT_TRUE(second > first + separation || std::isinf(second))
                    << x << ", " << y << ": " << first << " " << second;
            }
        }
    }
}

TEST_P(GBufferTest, GuardBandChangesNoPixelOfTheView) {
    const Scene scene = make_menagerie();
    const View view(menagerie_camera(), 96, 64);
    const Frame plain = render(context(), scene, view, two_layers(0.2f), all_planes);
    const Frame guarded = render(context(), scene, view, two_layers(0.2f, 24), all_planes);
    const RayCaster::Layers layers = RayCaster(scene).layers(view, 0.2);
    const std::vector<bool> compared = away_from_edges(layers.first, view.width(), view.height());
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const float a = plain.plane("depth").at(x, y), b = guarded.plane("depth").at(x, y);
            if (!compared[static_cast<std::size_t>(y) * view.width() + x] || a == b) continue;
            // Another viewport rounds the pixel's place differently: some 1e-6 of a pixel.
            ASSERT_NEAR(a, b, 1e-5f * a) << x << ", " << y;
        }
    }
}

TEST_P(GBufferTest, MotionIsTheProjectedDisplacement) {
    const Scene scene = make_menagerie();
    const Camera now = menagerie_camera();
    const Camera before = Camera::look_at("before", {-0.3f, 0.25f, 0.5f}, {0.3f, -0.2f, -6.0f}, 1.0f);
    for (const int guard_band : {0, 16}) {
        const View view(now, 96, 64), previous(before, 96, 64);
        const Frame frame =
            render(context(), scene, view, two_layers(0.2f, guard_band),
                   {"position", "motion", "layer2.position", "layer2.motion", "depth", "layer2.depth"}, &previous);
        for (const std::string prefix : {"", "layer2."}) {
            for (int y = 0; y < view.height(); ++y) {
                for (int x = 0; x < view.width(); ++x) {
                    const glm::vec3 here(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.0f);
                    const bool hit = !std::isinf(frame.plane(prefix + "depth").at(x, y));
                    const glm::vec3 there =
                        hit ? previous.project(glm::vec3(vector_at(frame.plane(prefix + "position"), x, y)))
                            : previous.project(before.position() + view.pixel_ray(here.x, here.y).direction);
                    const Image& motion = frame.plane(prefix + "motion");
                    // Float positions resolve a few 1e-7 of the distance, some 1e-4 of a pixel at this size.
                    ASSERT_NEAR(motion.at(x, y, 0), there.x - here.x, 2e-3f) << prefix << x << ", " << y;
                    ASSERT_NEAR(motion.at(x, y, 1), there.y - here.y, 2e-3f) << prefix << x << ", " << y;
                }
            }
        }
    }
}

TEST_P(GBufferTest, NothingMovesWithoutAPreviousView) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[1], 64, 48);
    const Frame frame = render(context(), scene, view, two_layers(0.1f), {"motion"});
    for (const float value : frame.plane("motion").values()) ASSERT_NEAR(value, 0.0f, 1e-4f);
}

TEST_P(GBufferTest, EnvironmentShinesWhereNothingIs) {
    Scene scene = make_menagerie();
    Texture sky;
    sky.width = 16, sky.height = 8;
    sky.wrap_v = TextureWrap::clamp;
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 16; ++x) {
            for (const float value : {0.2f * x, 0.3f * y, 1.0f, 1.0f}) sky.texels.push_back(half(value));
        }
    }
    scene.environment = {{2.0f, 1.0f, 0.5f}, static_cast<int>(scene.textures.size()), 0.7f};
    scene.textures.push_back(sky);
    Camera camera = menagerie_camera();
    camera.vertical_fov = 2.0f;
    const View view(camera, 64, 48);
    const Frame frame =
        render(context(), scene, view, two_layers(0.2f), {"depth", "emission", "layer2.depth", "layer2.emission"});
    int background = 0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (!std::isinf(frame.plane("depth").at(x, y))) continue;
            ++background;
            const Ray ray = view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const glm::dvec3 expected(scene.environment_radiance(ray.direction));
            // Half floats keep 2.4e-4 of a value; the rest is the drivers' arc tangent.
            ASSERT_LT(glm::length(vector_at(frame.plane("emission"), x, y) - expected),
                      2e-3 * glm::length(expected) + 1e-3)
                << x << ", " << y;
            ASSERT_EQ(vector_at(frame.plane("layer2.emission"), x, y), glm::dvec3(0.0));
        }
    }
    EXPECT_GT(background, 500);
}

TEST_P(GBufferTest, ASunBrighterThanHalfFloatsIsNotCut) {
    const Scene scene = floor_below_bright_sky("exr");
    const glm::vec3 eye(0.0f, 2.0f, 0.0f);
    const View view(Camera::look_at("sun", eye, eye + sun_direction(scene), 1e-3f), 4, 4);
    const Frame frame = render(context(), scene, view, {}, {"emission", "total"});
    for (const std::string plane : {"emission", "total"}) {
        // 1 %: the view spans a thousandth of a radian, 0.3 % of the texel, over which the sun fades as a tent.
        for (const float value : frame.plane(plane).values())
            ASSERT_NEAR(value, sun_radiance, 0.01f * sun_radiance) << plane;
    }
}

TEST(GBuffer, EglAndOsMesaAgree) {
    const Scene scene = make_menagerie();
    const View view(menagerie_camera(), 160, 120);
    const Frame egl = render(test_context(GlBackend::egl), scene, view, two_layers(0.2f), all_planes);
    const Frame osmesa = render(test_context(GlBackend::osmesa), scene, view, two_layers(0.2f), all_planes);
    for (const std::string& plane : all_planes) {
        const auto a = egl.plane(plane).values(), b = osmesa.plane(plane).values();
        std::size_t different = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            different += !(a[i] == b[i] || std::abs(a[i] - b[i]) <= 1e-4f * std::max(1.0f, std::abs(a[i])));
        }
        // Where EGL runs on a GPU, silhouettes fall on other pixels; on Mesa both are the same bits.
        EXPECT_LE(different, test_context(GlBackend::egl).info().software ? 0 : a.size() / 50) << plane;
    }
}

}  // namespace
}  // namespace plumb
