// The exact G-buffer against analytic geometry.
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "pathtracer/reference_error.h"
#include "scenes/builtin.h"
#include "tests/pathtracer/test_scenes.h"

namespace plumb {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// A square facing +Z at depth `depth` of a camera in the origin.
std::vector<glm::vec3> screen(float depth, float half = 50.0f) {
    return {{-half, -half, -depth}, {half, -half, -depth}, {half, half, -depth}, {-half, half, -depth}};
}

View forward_view(int size = 16) { return view_of({0, 0, 0}, {0, 0, -1}, 1.0f, size); }

void expect_depth(const Frame& frame, const std::string& plane, float expected) {
    for (const float value : frame.plane(plane).values()) {
        if (std::isinf(expected)) {
            EXPECT_EQ(value, expected) << plane;
        } else {
            EXPECT_NEAR(value, expected, 2e-6f * expected) << plane;  // a few roundings of float32
        }
    }
}

TEST(GBuffer, LayersOfParallelPlanesObeyTheMinimumSeparation) {
    Scene scene;
    const int red = add_material(scene, {0.8f, 0.1f, 0.1f}), green = add_material(scene, {0.1f, 0.8f, 0.1f});
    add_quads(scene, red, {screen(2.0f)});
    add_quads(scene, green, {screen(2.3f), screen(3.0f)});
    const PathTracer tracer(scene);
    const struct {
        float separation, second, third;
    } cases[] = {{0.0f, 2.3f, 3.0f}, {0.29f, 2.3f, 3.0f}, {0.31f, 3.0f, infinity}, {1.01f, infinity, infinity}};
    for (const auto& expected : cases) {
        const Frame frame = tracer.gbuffer(forward_view(), {.layers = 3, .minimum_separation = expected.separation});
        expect_depth(frame, "depth", 2.0f);
        expect_depth(frame, "layer2.depth", expected.second);
        expect_depth(frame, "layer3.depth", expected.third);
        const bool hit = !std::isinf(expected.second);
        EXPECT_EQ(frame.plane("layer2.albedo").at(3, 4, 1), hit ? 0.8f : 0.0f);
        EXPECT_EQ(frame.plane("layer2.instance").at(3, 4), hit ? 1.0f : -1.0f);
        EXPECT_EQ(frame.plane("layer2.normal").at(3, 4, 2), hit ? 1.0f : 0.0f);
    }
}

TEST(GBuffer, RenderGivesTheSameLayers) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[0], 48, 40);
    const PathTracer tracer(scene);
    auto settings = settings_for({"depth", "normal", "albedo", "position", "motion", "instance", "layer2.depth",
                                  "layer2.normal", "layer2.albedo", "layer2.emission"},
                                 2);
    settings.minimum_separation = 0.05f;
    const Frame rendered = tracer.render(view, settings).frame;
    const Frame gbuffer = tracer.gbuffer(view, {.layers = 2, .minimum_separation = 0.05f});
    for (const std::string& plane : settings.quantities.planes) {
        const auto a = rendered.plane(plane).values(), b = gbuffer.plane(plane).values();
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << plane;
    }
}

TEST(GBuffer, OfNothingIsInfiniteDepthAndZeroElse) {
    const Scene scene;
    const Frame frame = PathTracer(scene).gbuffer(forward_view(4));
    expect_depth(frame, "depth", infinity);
    expect_depth(frame, "layer2.depth", infinity);
    for (const char* plane : {"normal", "albedo", "position", "motion", "emission"}) {
        for (const float value : frame.plane(plane).values()) EXPECT_EQ(value, 0.0f) << plane;
    }
    for (const float value : frame.plane("instance").values()) EXPECT_EQ(value, -1.0f);
}

TEST(GBuffer, ClipsAtTheNearAndTheFarPlaneByDepth) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), {screen(1.0f), screen(2.0f), screen(4.0f)});
    Camera camera = Camera::look_at("clip", {0, 0, 0}, {0, 0, -1}, 1.5f);
    camera.near_plane = 1.01f, camera.far_plane = 3.99f;  // wide: distances at the corners exceed depth by a third
    const Frame frame = PathTracer(scene).gbuffer(View(camera, 16, 16));
    expect_depth(frame, "depth", 2.0f);
    expect_depth(frame, "layer2.depth", infinity);
}

TEST(GBuffer, NormalsFaceTheViewerAlsoOnBacksAndInMirrors) {
    // Corner normals tilted 0.2 rad from the face's, so that face and shading normals can be told apart.
    const glm::vec3 tilted = glm::normalize(glm::vec3(std::sin(0.2f), 0.0f, std::cos(0.2f)));
    for (const bool mirrored : {false, true}) {
        for (const bool behind : {false, true}) {
            Scene scene;
            const glm::mat4 transform = glm::scale(glm::mat4(1.0f), glm::vec3(mirrored ? -2.0f : 2.0f, 1.0f, 1.0f));
            add_quads(scene, add_material(scene, glm::vec3(0.5f), {}, false), {screen(0.0f)}, transform);
            scene.meshes[0].normals.assign(4, tilted);
            const View view = view_of({0, 0, behind ? -2.0f : 2.0f}, {0, 0, 0}, 0.1f, 4);
            const Frame frame = PathTracer(scene).gbuffer(view, {.layers = 1});
            // Normals go by the inverse transpose: x is halved, and mirrored with the geometry.
            glm::vec3 expected = glm::normalize(glm::vec3((mirrored ? -0.5f : 0.5f) * tilted.x, 0.0f, tilted.z));
            if (behind) expected = -expected;
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(frame.plane("normal").at(1, 2, c), expected[c], 1e-6f) << mirrored << behind << c;
            }
            // A mirror keeps front and back: the one-sided back stays black.
            EXPECT_EQ(frame.plane("albedo").at(1, 2, 0), behind ? 0.0f : 0.5f) << mirrored << behind;
        }
    }
}

TEST(GBuffer, AlphaMaskedHolesAreNoSurfaceInAnyLayer) {
    Scene scene;
    const int mask = add_material(scene, glm::vec3(0.5f)), solid = add_material(scene, glm::vec3(0.9f));
    Texture texture;
    texture.width = texture.height = 1;
    texture.texels = {half(1.0f), half(1.0f), half(1.0f), half(0.4f)};
    scene.textures.push_back(texture);
    scene.materials[mask].base_colour_texture = 0, scene.materials[mask].alpha_mask = true;
    add_quads(scene, mask, {screen(1.0f), screen(2.5f)});
    add_quads(scene, solid, {screen(2.0f), screen(3.0f)});
    const Frame frame = PathTracer(scene).gbuffer(forward_view());
    expect_depth(frame, "depth", 2.0f);
    expect_depth(frame, "layer2.depth", 3.0f);
}

TEST(GBuffer, MotionIsPositionBeforeMinusPositionNow) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), {screen(4.0f)});
    const View now = forward_view(), before = view_of({0.25f, -0.5f, 0}, {0.25f, -0.5f, -1}, 1.0f);
    const PathTracer tracer(scene);
    const Frame frame = tracer.gbuffer(now, {.layers = 1, .previous_view = &before});
    // The camera was further right and lower: points were seen further left and higher (rows count downwards).
    const float pixels = now.pixels_per_metre() / 4.0f;
    for (int i = 0; i < 16; ++i) {
        EXPECT_NEAR(frame.plane("motion").at(i, 5, 0), -0.25f * pixels, 1e-4f);
        EXPECT_NEAR(frame.plane("motion").at(i, 5, 1), -0.5f * pixels, 1e-4f);
    }
    const Frame still = tracer.gbuffer(now, {.layers = 1, .previous_view = &now});
    for (const float value : still.plane("motion").values()) EXPECT_EQ(value, 0.0f);
    const View away = view_of({0, 0, 0}, {0, 0, 1}, 1.0f);  // the surface was behind the camera
    const Frame turned = tracer.gbuffer(now, {.layers = 1, .previous_view = &away});
    for (const float value : turned.plane("motion").values()) EXPECT_EQ(value, infinity);
}

// A square at depth 4 moves by (1, 0.5, 0) while the camera stands still: a point of it was that much to the left and
// below, which is pixels_per_metre / depth pixels for each metre.
TEST(GBuffer, MotionOfAMovingInstanceIsItsOwn) {
    Scene scene;
    const int white = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, white, {screen(4.0f, 30.0f)});
    scene.instances[0].motion.keys = {{.time = 0.0f}, {.time = 2.0f, .translation = {1.0f, 0.5f, 0.0f}}};
    scene.instances[0].motion.interpolation = MotionInterpolation::linear;
    scene.move_to(2.0);
    const View view = forward_view();
    const Frame frame = PathTracer(scene, {0.0, 2.0}).gbuffer(view);
    const float pixels = view.pixels_per_metre() / 4.0f;
    for (int i = 0; i < view.width(); ++i) {
        // 1e-4 pixels: roundings of positions some 30 m wide.
        EXPECT_NEAR(frame.plane("motion").at(i, 5, 0), -pixels, 1e-4f * 30.0f);
        EXPECT_NEAR(frame.plane("motion").at(i, 5, 1), 0.5f * pixels, 1e-4f * 30.0f);
    }
}

// Before a wall at depth 4 a square of half a metre at depth 2 hides what the previous camera, one metre to the right,
// saw behind it; what that camera did not frame was not seen either.
TEST(GBuffer, SeenBeforeIsWhatThePreviousCameraFramedAndNothingHid) {
    Scene scene;
    const int white = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, white, {screen(4.0f)});
    add_quads(scene, white, {screen(2.0f, 0.5f)});
    const View now = forward_view(64), before = view_of({1, 0, 0}, {1, 0, -1}, 1.0f, 64);
    const Frame frame = PathTracer(scene).gbuffer(now, {.previous_view = &before});
    const float half_angle = std::tan(0.5f);
    int hidden = 0, outside = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::vec3 p = colour_at(frame.plane("position"), x, y);
            const glm::vec3 from_before = p - glm::vec3(1, 0, 0);
            const glm::vec2 on_screen = glm::vec2(from_before) / (-from_before.z * half_angle);
            const bool framed = std::abs(on_screen.x) < 1.0f && std::abs(on_screen.y) < 1.0f;
            const glm::vec2 crossing = glm::vec2(1, 0) + glm::vec2(from_before) * (2.0f / -from_before.z);
            const bool behind = p.z < -3.0f && std::abs(crossing.x) < 0.5f && std::abs(crossing.y) < 0.5f;
            // Within rounding of an edge either answer is right.
            const float to_edge =
                std::min(std::abs(std::abs(crossing.x) - 0.5f), std::abs(std::abs(crossing.y) - 0.5f));
            const float to_frame =
                std::min(std::abs(std::abs(on_screen.x) - 1.0f), std::abs(std::abs(on_screen.y) - 1.0f));
            if (to_edge < 1e-4f || to_frame < 1e-4f) continue;
            hidden += framed && behind ? 1 : 0, outside += framed ? 0 : 1;
            EXPECT_EQ(frame.plane("seen_before").at(x, y), framed && !behind ? 1.0f : 0.0f) << x << ", " << y;
        }
    }
    EXPECT_GT(hidden, 50);
    EXPECT_GT(outside, 100);
}

// The same with the square in the past only: it left for another place when the span began.
TEST(GBuffer, SeenBeforeAsksTheSceneAsItStoodThen) {
    Scene scene;
    const int white = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, white, {screen(4.0f)});
    add_quads(scene, white, {screen(2.0f, 0.5f)});
    scene.instances[1].motion.keys = {{.time = 0.0f}, {.time = 1.0f, .translation = {100.0f, 0.0f, 0.0f}}};
    scene.move_to(1.0);
    const View view = forward_view(64);
    const Frame frame = PathTracer(scene, {0.0, 1.0}).gbuffer(view);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::vec3 p = colour_at(frame.plane("position"), x, y);
            EXPECT_NEAR(p.z, -4.0f, 1e-4f);
            const float edge = std::max(std::abs(p.x), std::abs(p.y));  // the square's shadow on the wall is 1 m wide
            if (std::abs(edge - 1.0f) < 1e-4f) continue;
            EXPECT_EQ(frame.plane("seen_before").at(x, y), edge > 1.0f ? 1.0f : 0.0f) << x << ", " << y;
        }
    }
}

// Nothing but sky behind the square, which has left for another place: what lies infinitely far away was seen where the
// square was not.
TEST(GBuffer, BackgroundWasSeenBeforeWhereNothingStoodBeforeIt) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), {screen(2.0f, 0.5f)});
    scene.instances[0].motion.keys = {{.time = 0.0f}, {.time = 1.0f, .translation = {100.0f, 0.0f, 0.0f}}};
    scene.move_to(1.0);
    // The previous camera stood where this one does but looked a little aside: what it did not frame it did not see.
    const View view = forward_view(64), aside = view_of({0, 0, 0}, {0.2f, 0, -1}, 1.0f, 64);
    const glm::vec3 axis = glm::normalize(glm::vec3(0.2f, 0, -1)), across = glm::normalize(glm::vec3(1, 0, 0.2f));
    const Frame frame = PathTracer(scene, {0.0, 1.0}).gbuffer(view, {.layers = 1, .previous_view = &aside});
    int seen = 0, hidden = 0, outside = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            ASSERT_EQ(frame.plane("instance").at(x, y), -1.0f);
            const glm::vec3 direction =
                view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f).direction;
            const glm::vec2 crossing = glm::vec2(direction) * (2.0f / -direction.z);
            const float to_square = std::max(std::abs(crossing.x), std::abs(crossing.y)) - 0.5f;
            const glm::vec2 on_screen =
                glm::vec2(glm::dot(direction, across), direction.y) / (glm::dot(direction, axis) * std::tan(0.5f));
            const float to_frame = std::max(std::abs(on_screen.x), std::abs(on_screen.y)) - 1.0f;
            if (std::abs(to_square) < 1e-4f || std::abs(to_frame) < 1e-4f) continue;  // either answer is right
            const bool expected = to_square > 0.0f && to_frame < 0.0f;
            EXPECT_EQ(frame.plane("seen_before").at(x, y), expected ? 1.0f : 0.0f) << x << ", " << y;
            seen += expected ? 1 : 0, hidden += to_square < 0.0f ? 1 : 0, outside += to_frame > 0.0f ? 1 : 0;
        }
    }
    EXPECT_GT(seen, 1000);
    EXPECT_GT(hidden, 100);
    EXPECT_GT(outside, 100);
}

// What the square hides now, and the previous camera, one metre to the right, saw past it or did not.
TEST(GBuffer, TheSecondLayerWasSeenBeforeWhereThePreviousCameraLookedPastTheFirst) {
    Scene scene;
    const int white = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, white, {screen(4.0f)});
    add_quads(scene, white, {screen(2.0f, 0.7f)});
    const View now = forward_view(64), before = view_of({1, 0, 0}, {1, 0, -1}, 1.0f, 64);
    const PathTracer tracer(scene);
    const Frame frame = tracer.gbuffer(now, {.previous_view = &before}), still = tracer.gbuffer(now);
    int seen = 0, hidden = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            if (std::isinf(frame.plane("layer2.depth").at(x, y))) continue;
            EXPECT_EQ(still.plane("layer2.seen_before").at(x, y), 0.0f) << x << ", " << y;
            const glm::vec3 from_before = colour_at(frame.plane("layer2.position"), x, y) - glm::vec3(1, 0, 0);
            const glm::vec2 on_screen = glm::vec2(from_before) / (-from_before.z * std::tan(0.5f));
            const glm::vec2 crossing = glm::vec2(1, 0) + glm::vec2(from_before) * (2.0f / -from_before.z);
            const float to_square = std::max(std::abs(crossing.x), std::abs(crossing.y)) - 0.7f;
            const float to_frame = std::max(std::abs(on_screen.x), std::abs(on_screen.y)) - 1.0f;
            if (std::abs(to_square) < 1e-4f || std::abs(to_frame) < 1e-4f) continue;  // either answer is right
            const bool expected = to_square > 0.0f && to_frame < 0.0f;
            EXPECT_EQ(frame.plane("layer2.seen_before").at(x, y), expected ? 1.0f : 0.0f) << x << ", " << y;
            seen += expected ? 1 : 0, hidden += to_square < 0.0f ? 1 : 0;
        }
    }
    EXPECT_GT(seen, 50);
    EXPECT_GT(hidden, 50);
}

TEST(GBuffer, PositionAgreesWithDepthAndTheCamera) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[1], 32, 24);
    const Frame frame = PathTracer(scene).gbuffer(view, {.layers = 1});
    for (int y = 0; y < frame.height(); ++y) {
        for (int x = 0; x < frame.width(); ++x) {
            const float depth = frame.plane("depth").at(x, y);
            if (std::isinf(depth)) continue;
            const glm::vec3 seen = view.project(colour_at(frame.plane("position"), x, y));
            // Micrometres of a metre, some 100 pixels wide: 1e-4 pixels of rounding, with room for grazing angles.
            EXPECT_NEAR(seen.x, static_cast<float>(x) + 0.5f, 2e-3f);
            EXPECT_NEAR(seen.y, static_cast<float>(y) + 0.5f, 2e-3f);
            EXPECT_NEAR(seen.z, depth, 2e-5f * depth);
        }
    }
}

TEST(Silhouettes, AreFoundAtStepsAndFoldsButNotOnFlatGround) {
    Scene scene;
    const int grey = add_material(scene, glm::vec3(0.5f));
    add_quads(scene, grey, {floor_quad(20.0f), {{-20, 0, -5}, {20, 0, -5}, {20, 9, -5}, {-20, 9, -5}}});
    const View view = view_of({0, 1, 3}, {0, 1, 0}, 1.0f, 64);
    const Frame frame = PathTracer(scene).gbuffer(view, {.layers = 1});
    const Image mask = silhouettes(frame, view);
    // The fold lies at depth 8, 1 m below the axis; elsewhere the ground is seen as flat as at 13 degrees.
    const int fold = static_cast<int>(32.0f + view.pixels_per_metre() / 8.0f);
    for (int y = 0; y < 64; ++y) EXPECT_EQ(mask.at(20, y), std::abs(y - fold) <= 0 || y == fold - 1 ? 1.0f : 0.0f) << y;

    add_quads(scene, grey, {{{-1, 0.5f, 0}, {0, 0.5f, 0}, {0, 1.5f, 0}, {-1, 1.5f, 0}}});
    const Frame with_card = PathTracer(scene).gbuffer(view, {.layers = 1});
    const Image edges = silhouettes(with_card, view);
    const Image& instance = with_card.plane("instance");
    for (int x = 1; x < 64; ++x) {
        if (instance.at(x, 32) != instance.at(x - 1, 32)) {
            EXPECT_EQ(edges.at(x, 32), 1.0f);
            EXPECT_EQ(edges.at(x - 1, 32), 1.0f);
        }
    }
}

// Which of two coincident surfaces a ray hits depends on the order of a tree's leaves, so the tree itself must not
// depend on how many threads built it.
TEST(GBuffer, CoincidentSurfacesAreToldApartAlikeHoweverManyThreadsBuildTheTree) {
    Scene scene = make_colonnade();
    const std::vector<Instance> instances = scene.instances;
    scene.instances.insert(scene.instances.end(), instances.begin(), instances.end());
    const View view(scene.cameras[0], 64, 48);
    const auto gbuffer_built_by = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return PathTracer(scene).gbuffer(view);
    };
    expect_same_bits(gbuffer_built_by(1), gbuffer_built_by(2));
}

TEST(GBuffer, RefusesSenselessSettings) {
    const Scene scene;
    const PathTracer tracer(scene);
    EXPECT_THROW(tracer.gbuffer(forward_view(), {.layers = 0}), ReferenceError);
    EXPECT_THROW(tracer.gbuffer(forward_view(), {.layers = 2, .minimum_separation = -1.0f}), ReferenceError);
    EXPECT_THROW(tracer.gbuffer(forward_view(), {}, -1), ReferenceError);
}

}  // namespace
}  // namespace plumb
