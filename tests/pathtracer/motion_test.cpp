// The shutter: moving surfaces, moving emitters, turning surfaces, a moving camera; and what knows no shutter.
#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pathtracer/reference_error.h"
#include "pathtracer/traced_scene.h"
#include "tests/pathtracer/closed_forms.h"
#include "tests/pathtracer/effects_scenes.h"

namespace plumb {
namespace {

using closed_form::pi;

// Sees |x|, |y| <= 1 at z = -2.
View forward_view(int size = 16) { return view_of({0, 0, 0}, {0, 0, -1}, 2.0f * std::atan(0.5f), size); }

ReferenceSettings shutter_settings(const View& at_opening, std::vector<std::string> planes, int samples,
                                   int bounces = 0) {
    ReferenceSettings settings = settings_for(std::move(planes), samples, bounces);
    settings.view_at_shutter_opening = at_opening;
    return settings;
}

// Lets the last instance move by `translation` and turn by `angle` about `axis` from time `begin` to time `end`.
void let_move(Scene& scene, double begin, double end, const glm::vec3& translation, float angle = 0.0f,
              const glm::vec3& axis = {0, 0, 1}, const glm::vec3& pivot = {0, 0, 0}) {
    Instance& instance = scene.instances.back();
    Motion& motion = instance.motion;
    motion.interpolation = MotionInterpolation::linear;
    motion.rest = instance.world_from_object, motion.pivot = pivot;
    motion.keys.push_back({.time = static_cast<float>(begin)});
    motion.keys.push_back(
        {.time = static_cast<float>(end), .translation = translation, .rotation = glm::angleAxis(angle, axis)});
    motion.check();
}

// The times of a pixel's samples are stratified, half by half: of N / 2 samples over a part of the time the number is
// right to within 2.
constexpr int samples = 1024;
constexpr double time_error = 2.0 / (0.5 * samples) + 1e-6;

// The share of [0, 1] in which lower < position + speed t < upper.
double share_of_time(double position, double speed, double lower, double upper) {
    const double a = (lower - position) / speed, b = (upper - position) / speed;
    return std::max(0.0, std::min(1.0, std::max(a, b)) - std::max(0.0, std::min(a, b)));
}

TEST(Shutter, AMovingSquareCoversEachPixelForItsShareOfTheTime) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)),
              {{{-0.9f, -0.5f, -2}, {-0.2f, -0.5f, -2}, {-0.2f, 0.6f, -2}, {-0.9f, 0.6f, -2}}});
    let_move(scene, 0.0, 1.0, {1.3f, 0, 0});
    // Open over the whole motion, and over its second half only.
    for (const TimeSpan span : {TimeSpan{0.0, 1.0}, TimeSpan{0.5, 1.0}}) {
        const double start = 1.3 * span.begin, speed = 1.3 * (span.end - span.begin);
        const View view = forward_view();
        const Frame frame = PathTracer(scene, span).render(view, shutter_settings(view, {"emission"}, samples)).frame;
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const glm::dvec3 point = PixelRay(view, x, y).on_plane({0, 0, 1}, -2.0);
                const bool in_band = point.y > -0.5 && point.y < 0.6;
                const double expected = in_band ? share_of_time(point.x - start, -speed, -0.9, -0.2) : 0.0;
                EXPECT_NEAR(frame.plane("emission").at(x, y), expected, time_error) << x << ", " << y;
            }
        }
    }
}

TEST(Shutter, AMovingCameraSweepsOverWhatStandsStill) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)),
              {{{-0.4f, -9, -2}, {0.3f, -9, -2}, {0.3f, 9, -2}, {-0.4f, 9, -2}}});
    const View opening = view_of({-0.5f, 0, 0}, {-0.5f, 0, -1}, 2.0f * std::atan(0.5f));
    const View closing = view_of({0.4f, 0, 0}, {0.4f, 0, -1}, 2.0f * std::atan(0.5f));
    const Frame frame =
        PathTracer(scene, {0.0, 1.0}).render(closing, shutter_settings(opening, {"emission"}, samples)).frame;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const double at = PixelRay(opening, x, y).on_plane({0, 0, 1}, -2.0).x;
            EXPECT_NEAR(frame.plane("emission").at(x, y), share_of_time(at, 0.9, -0.4, 0.3), time_error) << x;
        }
    }
}

// Where camera and square move alike nothing smears: each pixel sees it always or never. Where they move against each
// other, the smear is that of both together.
TEST(Shutter, ACameraMovesRelativeToWhatItSees) {
    for (const double along : {1.0, -1.0}) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)),
                  {{{-0.45f, -9, -2}, {0.25f, -9, -2}, {0.25f, 9, -2}, {-0.45f, 9, -2}}});
        let_move(scene, 0.0, 1.0, {0.5f, 0, 0});
        const View opening = forward_view();
        const glm::vec3 eye(static_cast<float>(0.5 * along), 0, 0);
        const View closing = view_of(eye, eye + glm::vec3(0, 0, -1), 2.0f * std::atan(0.5f));
        const Frame frame =
            PathTracer(scene, {0.0, 1.0}).render(closing, shutter_settings(opening, {"emission"}, samples)).frame;
        int lit = 0, smeared = 0;
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                const double at = PixelRay(opening, x, y).on_plane({0, 0, 1}, -2.0).x;
                const float value = frame.plane("emission").at(x, y);
                const bool inside = at > -0.45 && at < 0.25;
                if (along > 0.0) {
                    EXPECT_EQ(value, inside ? 1.0f : 0.0f) << x;
                } else {
                    EXPECT_NEAR(value, share_of_time(at, -1.0, -0.45, 0.25), time_error) << x;
                }
                lit += inside ? 1 : 0, smeared += value > 0.0f && value < 1.0f ? 1 : 0;
            }
        }
        EXPECT_GT(lit, 50);
        EXPECT_EQ(smeared > 50, along < 0.0) << smeared;
    }
}

// Primary rays go from their direction at the opening to that at the closing in a straight line: a strip's edge at x =
// b z is passed where the mixed direction's x - b z, which is linear in time, is 0.
TEST(Shutter, ATurningCameraSweepsOverWhatStandsStill) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)),
              {{{-0.4f, -9, -2}, {0.3f, -9, -2}, {0.3f, 9, -2}, {-0.4f, 9, -2}}});
    const auto turned = [](float angle) {
        return view_of({0, 0, 0}, {std::sin(angle), 0, -std::cos(angle)}, 2.0f * std::atan(0.5f));
    };
    const View opening = turned(-0.15f), closing = turned(0.35f);
    const Frame frame =
        PathTracer(scene, {0.0, 1.0}).render(closing, shutter_settings(opening, {"emission"}, samples)).frame;
    int partly = 0;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const glm::dvec3 from = PixelRay(opening, x, y).direction, to = PixelRay(closing, x, y).direction;
            const auto passes = [&](double edge) {
                const double slope = edge / -2.0, before = from.x - slope * from.z, after = to.x - slope * to.z;
                return std::clamp(before / (before - after), 0.0, 1.0);  // rays turn towards +x
            };
            const double expected = passes(0.3) - passes(-0.4);
            EXPECT_NEAR(frame.plane("emission").at(x, y), expected, time_error) << x << ", " << y;
            partly += expected > 0.0 && expected < 1.0 ? 1 : 0;
        }
    }
    EXPECT_GT(partly, 100);
}

// A half plane that turns by a right angle about the view's axis: what lies at an angle behind its edge is covered once
// the edge has passed. Poses in between are those of nine moments, joined straight: the edge is off by 1e-4 rad.
TEST(Shutter, ATurningEdgeSweepsAnglesEvenly) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)),
              {{{-9, -9, -2}, {9, -9, -2}, {9, 0, -2}, {-9, 0, -2}}});
    let_move(scene, 0.0, 1.0, {0, 0, 0}, static_cast<float>(pi / 2.0));
    const View view = forward_view();
    const Frame frame = PathTracer(scene, {0.0, 1.0}).render(view, shutter_settings(view, {"emission"}, samples)).frame;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const glm::dvec3 point = PixelRay(view, x, y).on_plane({0, 0, 1}, -2.0);
            // At first below y = 0, in the end right of x = 0.
            const double angle = std::atan2(point.y, point.x);
            double expected = 0.0;
            if (point.x > 0.0) expected = point.y < 0.0 ? 1.0 : 1.0 - angle / (pi / 2.0);
            if (point.x < 0.0 && point.y < 0.0) expected = (angle + pi) / (pi / 2.0);
            EXPECT_NEAR(frame.plane("emission").at(x, y), expected, time_error + 2e-4) << x << ", " << y;
        }
    }
}

// Lets the last instance spin about the view's axis, by that many turns in the second from 0 to 1.
void let_spin(Scene& scene, double turns, MotionInterpolation interpolation = MotionInterpolation::linear) {
    Motion& motion = scene.instances.back().motion;
    motion.interpolation = interpolation;
    motion.rest = scene.instances.back().world_from_object;
    const int keys = static_cast<int>(std::ceil(3.0 * turns)) + 1;  // a third of a turn apart at most
    for (int i = 0; i < keys; ++i) {
        const double time = static_cast<double>(i) / (keys - 1);
        motion.keys.push_back(
            {.time = static_cast<float>(time),
             .rotation = glm::angleAxis(static_cast<float>(2.0 * pi * turns * time), glm::vec3(0, 0, 1))});
    }
    motion.check();
}

// A wheel of two turns while the shutter is open: every point of it is where the motion has it, but for the bulge of a
// circle over its chord. With a 32nd of a turn between poses that is (pi / 16)^2 / 8 of the radius, 0.0049.
TEST(TimeSpan, PosesOfASpinningWheelAreWhereItIs) {
    for (const auto interpolation : {MotionInterpolation::linear, MotionInterpolation::smooth}) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(0.5f)), {{{0, 0, -2}, {1, 0, -2}, {0, 1, -2}, {-1, 0, -2}}});
        let_spin(scene, 2.0, interpolation);
        const TimeSpan span{0.0, 1.0};
        const TracedScene traced(scene, span);
        double largest = 0.0;
        for (int i = 0; i <= 1000; ++i) {
            const double time = i / 1000.0;
            const glm::mat4 pose = scene.instances[0].motion.pose(time);
            const TracedTriangle moved = traced.triangle(0, 0, static_cast<float>(time));
            const glm::vec3 corners[] = {moved.a, moved.b, moved.c};
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::vec3 exact(pose * glm::vec4(scene.meshes[0].positions[k], 1.0f));
                largest = std::max(largest, static_cast<double>(glm::distance(exact, corners[k])));
            }
        }
        EXPECT_LE(largest, 0.0049);
        EXPECT_GE(largest, 0.002) << "a bound that is far from the truth is wrong as well";
    }
}

// Half a plane that spins covers each pixel for half of the time. 1e-3: of edges between two poses, as above.
TEST(Shutter, ASpinningHalfPlaneCoversHalfOfTheTime) {
    for (const double turns : {1.0, 2.0, 4.0}) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)),
                  {{{-9, -9, -2}, {9, -9, -2}, {9, 0, -2}, {-9, 0, -2}}});
        let_spin(scene, turns);
        const View view = forward_view();
        const Frame frame =
            PathTracer(scene, {0.0, 1.0}).render(view, shutter_settings(view, {"emission"}, samples)).frame;
        for (const float value : frame.plane("emission").values()) {
            EXPECT_NEAR(value, 0.5, 2.0 * turns * time_error + 1e-3) << turns << " turns";
        }
    }
}

TEST(Shutter, RefusesATurnThatItsPosesDoNotShow) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), {floor_quad(1.0f)});
    scene.instances.back().name = "fan";
    let_spin(scene, 9.0);
    const View view = forward_view(4);
    const auto rendered = [&](const TimeSpan& span, bool has_shutter) {
        auto settings = settings_for({"ao"}, 2);
        if (has_shutter) settings.view_at_shutter_opening = view;
        PathTracer(scene, span).render(view, settings);
    };
    EXPECT_THAT(
        [&] {
            rendered({0.0, 1.0}, true);
        },
        testing::ThrowsMessage<ReferenceError>(
            testing::AllOf(testing::HasSubstr("'fan'"), testing::HasSubstr("shorter time"))));
    rendered({0.0, 0.4}, true);
    rendered({0.0, 1.0}, false);  // only the ends are looked at
}

// Inside a glowing box that lies between the planes every ray meets a wall, however far the camera turns.
TEST(Shutter, ATurningCameraKeepsItsNearAndFarPlanes) {
    for (const float angle : {0.3f, 1.5f}) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(1.0f)), room_quads());
        const auto turned = [&](float by) {
            View view = view_of({0, 0, 0}, {std::sin(by), 0, -std::cos(by)}, 1.2f, 8);
            Camera camera = view.camera();
            camera.near_plane = 0.02f, camera.far_plane = 3.0f;
            return View(camera, 8, 8);
        };
        const View opening = turned(0.0f), closing = turned(angle);
        const Frame frame =
            PathTracer(scene, {0.0, 1.0}).render(closing, shutter_settings(opening, {"emission"}, 64)).frame;
        for (const float value : frame.plane("emission").values()) EXPECT_EQ(value, 1.0f) << angle;
    }
}

TEST(Shutter, RefusesATurnOfTheCameraByARightAngle) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), room_quads());
    const PathTracer tracer(scene, {0.0, 1.0});
    const View opening = forward_view(4);
    const auto rendered_until = [&](float angle, const glm::vec3& axis) {
        Camera camera = opening.camera();
        camera.world_from_camera = glm::rotate(camera.world_from_camera, glm::radians(angle), axis);
        const View closing(camera, 4, 4);
        tracer.render(closing, shutter_settings(opening, {"emission"}, 2));
    };
    for (const glm::vec3 axis : {glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(1, 2, -3)}) {
        EXPECT_THAT([&] { rendered_until(91.0f, axis); },
                    testing::ThrowsMessage<ReferenceError>(
                        testing::AllOf(testing::HasSubstr("91.0 degrees"), testing::HasSubstr("shorter time"))));
        rendered_until(89.0f, axis);
    }
}

// A tilting mirror-smooth lid would do as well; a lit one shows whether normals turn along: under a parallel light the
// mean of cos(angle) over angles -0.6 to 0.6 is sin(0.6) / 0.6.
TEST(Shutter, NormalsTurnWithTheirSurface) {
    for (const bool smooth : {false, true}) {
        Scene scene;
        add_quads(scene, add_material(scene, glm::vec3(0.5f)), {{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}},
                  glm::rotate(glm::mat4(1.0f), -0.6f, {0, 1, 0}));
        if (smooth) scene.meshes.back().normals.assign(4, {0, 0, 1});
        let_move(scene, 0.0, 1.0, {0, 0, 0}, 1.2f, {0, 1, 0});
        scene.directional_lights.push_back({"sun", {0, 0, -1}, glm::vec3(2.0f)});
        const View view = view_of({0, 0, 2}, {0, 0, 0}, 0.3f, 8);
        const Frame frame =
            PathTracer(scene, {0.0, 1.0}).render(view, shutter_settings(view, {"direct"}, samples)).frame;
        for (const float value : frame.plane("direct").values()) {
            // Steps of 0.15 rad, joined straight: a chord's length is short of 1 by 0.15^2 / 12 on average where
            // normals are not made unit length again; they are, and 1e-3 is left for the angle along the chord.
            EXPECT_NEAR(value, 0.5 / pi * 2.0 * std::sin(0.6) / 0.6, 1e-3 * 0.3) << "smooth: " << smooth;
        }
    }
}

class MovingEmitter : public testing::TestWithParam<EmitterSampling> {};

TEST_P(MovingEmitter, GivesTheTimeAverageOfLambertsFormula) {
    const closed_form::Polygon panel = {{-1.2, 1, -0.5}, {-0.4, 1, -0.5}, {-0.4, 1, 0.5}, {-1.2, 1, 0.5}};
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), {floor_quad(9.0f)});
    add_polygon(scene, add_material(scene, glm::vec3(0.0f), glm::vec3(2.0f)), panel);
    let_move(scene, 1.0, 2.0, {1.4f, -0.5f, 0});
    const View view = view_of({0.3f, 0.4f, 0.8f}, {0.1f, 0.0f, 0.1f}, 0.5f, 8);
    ReferenceSettings settings = shutter_settings(view, {"direct"}, 12288);
    settings.emitter_sampling = GetParam();
    const Frame frame = PathTracer(scene, {1.0, 2.0}).render(view, settings).frame;
    expect_mean(frame, "direct", [&](int x, int y) {
        const glm::dvec3 point = PixelRay(view, x, y).on_plane({0, 1, 0}, 0.0);
        return closed_form::integrate(
            [&](double time) {
                closed_form::Polygon moved = panel;
                for (glm::dvec3& corner : moved) corner += time * glm::dvec3(1.4, -0.5, 0.0);
                return 0.5 / pi * 2.0 * closed_form::polygon_irradiance(point, {0, 1, 0}, moved);
            },
            0.0, 1.0, 200);
    });
}

// A pane, an occluder and a sampled point light know the time of their path as well: the shadow of a moving bar.
TEST(Shutter, MovingOccludersShadowForTheirShareOfTheTime) {
    Scene scene;
    add_quads(scene, add_material(scene, glm::vec3(0.5f)), {{{-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}}});
    // Beside the view, towards the sun that shines along (1, 0, -1).
    const int pane = add_pane(scene, glm::vec3(0.25f));
    add_quads(scene, pane, {{{-3.0f, -9, -1}, {-2.6f, -9, -1}, {-2.6f, 9, -1}, {-3.0f, 9, -1}}});
    let_move(scene, 0.0, 1.0, {1.5f, 0, 0});
    const glm::vec3 sun = glm::normalize(glm::vec3(1, 0, -1));
    scene.directional_lights.push_back({"sun", sun, glm::vec3(2.0f)});
    // From far away, so that the pane is beside what the camera sees.
    const View view = view_of({3, 0, 0}, {0, 0, -2}, 0.4f, 16);
    const Frame frame = PathTracer(scene, {0.0, 1.0}).render(view, shutter_settings(view, {"direct"}, samples)).frame;
    const double lit = 0.5 / pi * 2.0 * std::sqrt(0.5);
    int shadowed = 0;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            // The sun's ray to a point passes z = -1 one metre further left.
            const double at = PixelRay(view, x, y).on_plane({0, 0, 1}, -2.0).x - 1.0;
            const double share = share_of_time(at, -1.5, -3.0, -2.6);
            shadowed += share > 0.1 ? 1 : 0;
            EXPECT_NEAR(frame.plane("direct").at(x, y), lit * (1.0 - 0.75 * share), lit * time_error) << x << ", " << y;
        }
    }
    EXPECT_GT(shadowed, 30);
}

INSTANTIATE_TEST_SUITE_P(All, MovingEmitter, testing::ValuesIn(all_strategies),
                         [](const auto& test) { return name_of(test.param); });

Scene scene_in_motion() {
    Scene scene;
    add_quads(scene, add_dielectric(scene, {0.5f, 0.6f, 0.7f}, 0.5f), {floor_quad(2.0f)});
    add_quads(scene, add_material(scene, glm::vec3(0.3f)), {floor_quad(0.4f, 0.4f)});
    let_move(scene, 0.0, 2.0, {0.5f, 0.2f, 0}, 1.0f, {0, 1, 0}, {0.1f, 0, 0});
    add_quads(scene, add_material(scene, glm::vec3(0.2f), glm::vec3(3.0f)), {floor_quad(0.3f, 1.0f)});
    let_move(scene, 0.0, 2.0, {-0.7f, 0.3f, 0.2f}, -0.5f, {1, 0, 0}, {0, 1, 0});
    return scene;
}
View motion_view() { return view_of({0.3f, 1.0f, 2.5f}, {0, 0.2f, 0}, 0.7f, 24); }
const std::vector<std::string> every_plane = {"ao",    "direct", "indirect", "irradiance", "reflection", "emission",
                                              "total", "depth",  "normal",   "albedo",     "position",   "instance"};

// Without a shutter everything is seen at the end of the time span, wherever the scene stood when it was handed over.
TEST(TimeSpan, ShowsItsEndWhereNoShutterIsOpen) {
    Scene moved = scene_in_motion();
    moved.move_to(1.3);
    const Scene scene = scene_in_motion();
    const auto settings = settings_for(every_plane, 64, 2);
    const Frame expected = PathTracer(moved).render(motion_view(), settings).frame;
    const Frame frame = PathTracer(scene, {0.4, 1.3}).render(motion_view(), settings).frame;
    for (const std::string& plane : every_plane) {
        const Image &a = frame.plane(plane), &b = expected.plane(plane);
        double largest = 0.0, difference = 0.0;
        int apart = 0;
        for (std::size_t i = 0; i < a.values().size(); ++i) {
            if (std::isinf(b.values()[i]) && a.values()[i] == b.values()[i]) continue;
            const double off = std::abs(static_cast<double>(a.values()[i]) - b.values()[i]);
            largest = std::max(largest, std::abs(static_cast<double>(b.values()[i])));
            difference = std::max(difference, off);
            apart += off > 1e-4 * std::max(1.0, std::abs(static_cast<double>(b.values()[i]))) ? 1 : 0;
        }
        // Embree finds points of moving triangles by another formula than those of still ones, so that a ray may pass
        // an edge on its other side; of 576 pixels with 64 samples hardly one.
        EXPECT_LE(apart, static_cast<int>(a.values().size() / 100))
            << plane << ": up to " << difference << " of " << largest;
    }
}

TEST(TimeSpan, OfNoLengthIsTheSceneAsItStands) {
    Scene scene = scene_in_motion();
    scene.move_to(0.8);
    const auto settings = settings_for(every_plane, 8, 2);
    expect_same_bits(PathTracer(scene, {0.3, 0.3}).render(motion_view(), settings).frame,
                     PathTracer(scene).render(motion_view(), settings).frame);
}

// A shutter over a scene where nothing moves is no shutter, but for where points are sampled.
TEST(TimeSpan, MakesNoDifferenceToWhatStandsStill) {
    Scene scene = scene_in_motion();
    for (Instance& instance : scene.instances) instance.motion.keys.clear();
    const auto settings = shutter_settings(motion_view(), every_plane, 8, 2);
    expect_same_bits(PathTracer(scene, {0.0, 1.0}).render(motion_view(), settings).frame,
                     PathTracer(scene).render(motion_view(), settings).frame);
}

}  // namespace
}  // namespace plumb
