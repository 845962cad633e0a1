#include "scenes/camera.h"

#include <random>

#include <gmock/gmock.h>

#include "scenes/camera_path.h"
#include "scenes/scene_error.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::HasSubstr;

Camera random_camera(std::mt19937& random) {
    std::uniform_real_distribution<float> coordinate(-10.0f, 10.0f), fov(0.2f, 2.4f);
    const glm::vec3 eye(coordinate(random), coordinate(random), coordinate(random));
    const glm::vec3 target =
        eye + glm::vec3(1.0f + std::abs(coordinate(random)), coordinate(random), coordinate(random));
    return Camera::look_at("random", eye, target, fov(random));
}

TEST(View, ProjectsAPointOnAPixelsRayBackToThatPixel) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int i = 0; i < 200; ++i) {
        const View view(random_camera(random), 320, 180);
        const float x = 320.0f * unit(random), y = 180.0f * unit(random), distance = 0.5f + 20.0f * unit(random);
        const Ray ray = view.pixel_ray(x, y);
        EXPECT_NEAR(glm::length(ray.direction), 1.0f, 1e-6f);
        const glm::vec3 projected = view.project(ray.origin + distance * ray.direction);
        // 0.01 px: float coordinates near 30 m round at 2e-6 m, 320 px over at most 1 m at the nearest half metre.
        EXPECT_NEAR(projected.x, x, 0.01f) << view.camera().vertical_fov;
        EXPECT_NEAR(projected.y, y, 0.01f);
        const glm::vec3 in_camera = view.camera_space_point(x, y, projected.z);
        const glm::vec3 back = glm::vec3(view.camera().world_from_camera * glm::vec4(in_camera, 1.0f));
        EXPECT_NEAR(glm::distance(back, ray.origin + distance * ray.direction), 0.0f, 1e-4f);  // ten roundings at 30 m
    }
}

TEST(View, ImageAxesPointRightAndDown) {
    const View view(Camera::look_at("c", {0, 0, 0}, {0, 0, -1}, 1.0f), 100, 100);
    EXPECT_GT(view.project({0.1f, 0.0f, -1.0f}).x, 50.0f);
    EXPECT_LT(view.project({0.0f, 0.1f, -1.0f}).y, 50.0f);
    EXPECT_FLOAT_EQ(view.project({0.0f, 0.0f, -3.0f}).z, 3.0f);
}

TEST(View, GuardBandShiftsPixelsByItsWidthAndKeepsTheirRays) {
    std::mt19937 random(2);
    for (int i = 0; i < 50; ++i) {
        const View view(random_camera(random), 64, 48);
        const View wide = view.with_guard_band(13);
        EXPECT_EQ(wide.width(), 90);
        EXPECT_EQ(wide.height(), 74);
        // A few roundings of float: the guard band recomputes the same half widths by one product.
        EXPECT_NEAR(wide.pixels_per_metre(), view.pixels_per_metre(), 1e-5f * view.pixels_per_metre());
        for (const auto& [x, y] : {std::pair(0.5f, 0.5f), std::pair(63.5f, 20.5f), std::pair(31.0f, 47.5f)}) {
            const glm::vec3 narrow = view.pixel_ray(x, y).direction;
            const glm::vec3 same = wide.pixel_ray(x + 13.0f, y + 13.0f).direction;
            EXPECT_NEAR(glm::distance(narrow, same), 0.0f, 1e-6f);
        }
    }
}

TEST(View, ClipCoordinatesAgreeWithProject) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int i = 0; i < 100; ++i) {
        const View view(random_camera(random), 200, 100);
        const glm::vec3 in_camera =
            view.camera_space_point(200 * unit(random), 100 * unit(random), 0.2f + 50 * unit(random));
        const glm::vec4 clip = view.clip_from_camera() * glm::vec4(in_camera, 1.0f);
        const glm::vec3 ndc = glm::vec3(clip) / clip.w;
        const glm::vec3 projected =
            view.project(glm::vec3(view.camera().world_from_camera * glm::vec4(in_camera, 1.0f)));
        EXPECT_NEAR(0.5f * (ndc.x + 1.0f) * 200.0f, projected.x, 0.02f);  // px; rounding as in the round trip above
        EXPECT_NEAR(0.5f * (1.0f - ndc.y) * 100.0f, projected.y, 0.02f);
        EXPECT_NEAR(clip.w, projected.z, 1e-4f);
    }
}

TEST(View, LensRaysOfAPixelMeetOnItsPixelRayAtTheFocusDistance) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int i = 0; i < 100; ++i) {
        Camera camera = random_camera(random);
        camera.aperture_radius = 0.3f * unit(random);
        camera.focus_distance = 0.5f + 10.0f * unit(random);
        const View view(camera, 320, 180);
        const float x = 320.0f * unit(random), y = 180.0f * unit(random);
        const glm::mat4 camera_from_world = glm::inverse(camera.world_from_camera);
        for (const glm::vec2& lens : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(-0.6f, 0.7f)}) {
            const Ray ray = view.lens_ray(x, y, lens);
            EXPECT_NEAR(glm::length(ray.direction), 1.0f, 1e-6f);
            // Where the ray crosses the focal plane, by intersection with the plane in world space.
            const glm::vec3 axis = -glm::vec3(camera.world_from_camera[2]);
            const float distance = (camera.focus_distance - glm::dot(ray.origin - camera.position(), axis)) /
                                   glm::dot(ray.direction, axis);
            const glm::vec3 seen = view.project(ray.origin + distance * ray.direction);
            // 0.01 px, as in the test of project() above.
            EXPECT_NEAR(seen.x, x, 0.01f) << camera.aperture_radius << " " << camera.focus_distance;
            EXPECT_NEAR(seen.y, y, 0.01f);
            EXPECT_NEAR(seen.z, camera.focus_distance, 1e-4f);
            const glm::vec3 start(camera_from_world * glm::vec4(ray.origin, 1.0f));
            EXPECT_NEAR(glm::distance(start, glm::vec3(camera.aperture_radius * lens, 0.0f)), 0.0f, 1e-5f);
        }
    }
}

TEST(View, LensRaysOfAPinholeArePixelRaysToTheBit) {
    std::mt19937 random(4);
    const View view(random_camera(random), 64, 48);
    for (const float x : {0.5f, 31.25f, 63.5f}) {
        const Ray pinhole = view.pixel_ray(x, 17.5f), lens = view.lens_ray(x, 17.5f, {0.3f, -0.8f});
        EXPECT_EQ(lens.origin, pinhole.origin);
        EXPECT_EQ(lens.direction, pinhole.direction);
    }
}

// A point at depth d off the focal plane f blurs to a disc of radius A |d - f| / (f d), in units of the image at 1 m:
// the thin lens equation, with which real lenses are calculated.
TEST(View, CircleOfConfusionIsThatOfAThinLens) {
    Camera camera;
    camera.aperture_radius = 0.05f;
    camera.focus_distance = 2.0f;
    const View view(camera, 1000, 1000);
    for (const float depth : {1.0f, 3.0f, 8.0f}) {
        // The pixel whose ray through the lens' edge hits the point on the axis at this depth.
        const float expected = 500.0f + view.pixels_per_metre() * 0.05f * (2.0f - depth) / (2.0f * depth);
        const Ray ray = view.lens_ray(expected, 500.0f, {-1.0f, 0.0f});
        const glm::vec3 hit = ray.origin + depth / -ray.direction.z * ray.direction;
        EXPECT_NEAR(hit.x, 0.0f, 1e-5f) << depth;  // float rounding at 8 m
    }
}

TEST(View, DepthIsReversedBetweenNearAndFar) {
    Camera camera;
    camera.near_plane = 0.25f;
    camera.far_plane = 40.0f;
    const glm::mat4 clip = View(camera, 10, 10).clip_from_camera();
    const auto depth = [&](float z) {
        const glm::vec4 p = clip * glm::vec4(0.0f, 0.0f, -z, 1.0f);
        return p.z / p.w;
    };
    EXPECT_NEAR(depth(0.25f), 1.0f, 1e-6f);
    EXPECT_NEAR(depth(40.0f), 0.0f, 1e-6f);
    EXPECT_GT(depth(1.0f), depth(2.0f));
}

TEST(View, RefusesWhatCannotBeSeenThrough) {
    Camera camera;
    camera.name = "flat";
    EXPECT_THAT(message_of<SceneError>([&] { View(camera, 0, 10); }), HasSubstr("0x10"));
    camera.near_plane = 0.0f;
    EXPECT_THAT(message_of<SceneError>([&] { View(camera, 10, 10); }), HasSubstr("near 0"));
    Camera bad_lens;
    bad_lens.aperture_radius = -1.0f;
    EXPECT_THAT(message_of<SceneError>([&] { View(bad_lens, 10, 10); }), HasSubstr("aperture radius -1"));
    bad_lens.aperture_radius = 1.0f, bad_lens.focus_distance = 0.0f;
    EXPECT_THAT(message_of<SceneError>([&] { View(bad_lens, 10, 10); }), HasSubstr("focus distance 0"));
    EXPECT_THAT(message_of<SceneError>([] { Camera::look_at("up", {0, 0, 0}, {0, 1, 0}, 1.0f); }), HasSubstr("'up'"));
}

CameraPath test_path() {
    CameraPath path{"p", 1.0f, 0.1f, 10.0f, {}};
    path.keys = {{0.0f, {0, 0, 0}, {0, 0, -5}},
                 {1.0f, {1, 0, 0}, {1, 0, -5}},
                 {3.0f, {2, 1, 0}, {2, 0, -5}},
                 {3.5f, {2, 2, 1}, {0, 0, -5}}};
    return path;
}

TEST(CameraPath, PassesThroughItsKeys) {
    const CameraPath path = test_path();
    for (const CameraKey& key : path.keys) {
        EXPECT_NEAR(glm::distance(path.at(key.time).position(), key.eye), 0.0f, 1e-5f) << key.time;
    }
    EXPECT_EQ(path.at(-1.0f).position(), path.keys.front().eye);
    EXPECT_NEAR(glm::distance(path.at(99.0f).position(), path.keys.back().eye), 0.0f, 1e-5f);
}

TEST(CameraPath, FocusFollowsTheTargetUnlessGiven) {
    CameraPath path = test_path();
    path.aperture_radius = 0.01f;
    EXPECT_FLOAT_EQ(path.at(3.0f).focus_distance, glm::distance(path.keys[2].eye, path.keys[2].target));
    EXPECT_EQ(path.at(3.0f).aperture_radius, 0.01f);
    path.focus_distance = 7.0f;
    EXPECT_EQ(path.at(3.0f).focus_distance, 7.0f);
}

TEST(CameraPath, SpeedIsContinuousAtKeys) {
    const CameraPath path = test_path();
    constexpr float h = 1e-3f;
    for (std::size_t i = 1; i + 1 < path.keys.size(); ++i) {
        const float t = path.keys[i].time;
        const glm::vec3 before = (path.at(t).position() - path.at(t - h).position()) / h;
        const glm::vec3 after = (path.at(t + h).position() - path.at(t).position()) / h;
        // One-sided differences are off by half the acceleration (below 20 m/s^2 here) times h, and by float rounding /
        // h.
        EXPECT_NEAR(glm::distance(before, after), 0.0f, 0.025f) << "key " << i;
    }
}

TEST(CameraPath, RefusesKeysOutOfOrder) {
    CameraPath path = test_path();
    path.keys[2].time = 0.5f;
    EXPECT_THAT(message_of<SceneError>([&] { path.at(0.0f); }), HasSubstr("key 2"));
    path.keys.clear();
    EXPECT_THAT(message_of<SceneError>([&] { path.at(0.0f); }), HasSubstr("no keys"));
}

}  // namespace
}  // namespace plumb
