// Motions against matrices and cubics written out by hand.
#include "scenes/motion.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "scenes/scene.h"
#include "scenes/scene_error.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::HasSubstr;

// Float matrices of metres: a few roundings of values up to 10.
constexpr float rounding = 5e-6f;

float difference(const glm::mat4& a, const glm::mat4& b) {
    float largest = 0.0f;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
    }
    return largest;
}

glm::quat turn(float degrees, const glm::vec3& axis) {
    return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

// Three keys, unevenly spaced, about three different axes.
Motion tumbling(MotionInterpolation interpolation) {
    Motion motion;
    motion.interpolation = interpolation;
    motion.rest = glm::translate(glm::mat4(1.0f), glm::vec3(1, 2, 3));
    motion.pivot = {1.0f, 2.5f, 3.0f};
    motion.keys = {{1.0f, {0, 0, 0}, turn(20, {0, 1, 0}), {1, 1, 1}},
                   {2.0f, {1, 0, 0}, turn(110, {1, 1, 0}), {2, 1, 1}},
                   {4.0f, {1, 3, 0}, turn(200, {1, 0, 2}), {1, 0.5f, 3}},
                   {4.5f, {0, 3, 1}, turn(90, {0, 0, 1}), {1, 1, 1}}};
    return motion;
}

TEST(Motion, PassesThroughItsKeysAndStandsStillOutside) {
    for (const auto interpolation : {MotionInterpolation::linear, MotionInterpolation::smooth}) {
        const Motion motion = tumbling(interpolation);
        for (const MotionKey& key : motion.keys) {
            glm::mat4 expected = glm::translate(glm::mat4(1.0f), motion.pivot + key.translation);
            expected = expected * glm::mat4_cast(key.rotation) * glm::scale(glm::mat4(1.0f), key.scale);
            expected = expected * glm::translate(glm::mat4(1.0f), -motion.pivot) * motion.rest;
            EXPECT_LT(difference(motion.pose(key.time), expected), rounding) << key.time;
        }
        EXPECT_EQ(motion.pose(-7.0), motion.pose(1.0));
        EXPECT_EQ(motion.pose(99.0), motion.pose(4.5));
    }
}

TEST(Motion, ItsPivotOnlyTranslates) {
    Motion motion = tumbling(MotionInterpolation::linear);
    for (const double time : {1.25, 1.5, 3.0, 4.1}) {
        const glm::vec4 pivot = motion.pose(time) * glm::inverse(motion.rest) * glm::vec4(motion.pivot, 1.0f);
        const MotionKey &a = motion.keys[time < 2.0 ? 0 : time < 4.0 ? 1 : 2], &b = *(&a + 1);
        const auto s = static_cast<float>((time - a.time) / (b.time - a.time));
        const glm::vec3 expected = motion.pivot + (1.0f - s) * a.translation + s * b.translation;
        EXPECT_LT(glm::distance(glm::vec3(pivot), expected), rounding) << time;
    }
}

TEST(Motion, LinearTurnsAtConstantSpeedTheWayItIsWritten) {
    for (const float angle : {90.0f, 180.0f, 270.0f, -300.0f}) {
        Motion motion;
        motion.interpolation = MotionInterpolation::linear;
        motion.keys = {{.time = 0.0f}, {.time = 2.0f, .rotation = turn(angle, {1, 2, 3})}};
        for (const float s : {0.0f, 0.1f, 0.5f, 0.9f, 1.0f}) {
            const glm::mat4 expected = glm::rotate(glm::mat4(1.0f), glm::radians(s * angle), glm::vec3(1, 2, 3));
            EXPECT_LT(difference(motion.pose(2.0 * static_cast<double>(s)), expected), rounding) << angle << " " << s;
        }
    }
}

// With one axis the quaternion curve must be the cubic of the angle with the slopes of Catmull and Rom.
TEST(Motion, SmoothTurnAboutOneAxisIsTheCubicOfItsAngle) {
    Motion motion;
    const double times[] = {0.0, 1.0, 3.0, 3.5}, angles[] = {0.0, 80.0, 200.0, 150.0};  // degrees
    for (int i = 0; i < 4; ++i) {
        motion.keys.push_back(
            {.time = static_cast<float>(times[i]), .rotation = turn(static_cast<float>(angles[i]), {0, 1, 0})});
    }
    const double slope_1 = 200.0 / 3.0, slope_2 = 70.0 / 2.5, span = 2.0;
    for (const double s : {0.0, 0.2, 0.5, 0.8, 1.0}) {
        // The cubic through 80 and 200 degrees with those slopes, from its Bezier points.
        const double b0 = 80.0, b1 = 80.0 + slope_1 * span / 3.0, b2 = 200.0 - slope_2 * span / 3.0, b3 = 200.0;
        const double r = 1.0 - s;
        const double angle = r * r * r * b0 + 3.0 * r * r * s * b1 + 3.0 * r * s * s * b2 + s * s * s * b3;
        const glm::mat4 expected =
            glm::rotate(glm::mat4(1.0f), static_cast<float>(glm::radians(angle)), glm::vec3(0, 1, 0));
        EXPECT_LT(difference(motion.pose(1.0 + span * s), expected), rounding) << s;
    }
}

TEST(Motion, SmoothKeepsItsVelocityAtKeys) {
    const Motion motion = tumbling(MotionInterpolation::smooth);
    // A central difference over 2 ms of motions of some m/s and rad/s, with accelerations of some 10 / s^2, is good to
    // 0.02 / s; float matrices add 1e-6 / 1e-3 s.
    constexpr double step = 1e-3;
    const auto velocity = [&](double from, double to) {
        return (motion.pose(to) - motion.pose(from)) * static_cast<float>(1.0 / (to - from));
    };
    for (const double time : {2.0, 4.0}) {
        const glm::mat4 before = velocity(time - step, time), after = velocity(time, time + step);
        EXPECT_LT(difference(before, after), 0.05f) << time;
        EXPECT_GT(difference(before, glm::mat4(0.0f)), 0.5f) << time;  // it does move
    }
}

// How fast the orientations of the poses differ, over steps of a millisecond: a bound that holds, and is not idle. That
// of a linear motion is its constant speed.
TEST(Motion, NeverTurnsFasterThanItSays) {
    for (const auto interpolation : {MotionInterpolation::linear, MotionInterpolation::smooth}) {
        Motion motion = tumbling(interpolation);
        for (MotionKey& key : motion.keys) key.scale = glm::vec3(1.0f);
        motion.rest = glm::mat4(1.0f);
        const auto orientation = [&](double time) { return glm::dquat(glm::quat_cast(motion.pose(time))); };
        for (const auto& [begin, end] : {std::pair{0.0, 5.0}, std::pair{1.2, 1.9}, std::pair{2.5, 4.2}}) {
            constexpr double step = 1e-3;
            double fastest = 0.0;
            for (double time = begin; time + step <= end; time += step) {
                const glm::dquat turned = glm::conjugate(orientation(time)) * orientation(time + step);
                fastest = std::max(fastest, 2.0 * glm::length(glm::dvec3(turned.x, turned.y, turned.z)) / step);
            }
            const double bound = motion.fastest_turn(begin, end);
            // 2e-3: half a milliradian or more, of which orientations in float tell 1e-7.
            EXPECT_LE(fastest, 1.002 * bound) << begin << " to " << end;
            EXPECT_GE(fastest, (interpolation == MotionInterpolation::linear ? 0.99 : 0.33) * bound) << begin;
        }
        EXPECT_EQ(motion.fastest_turn(-3.0, 1.0), 0.0);
        EXPECT_EQ(motion.fastest_turn(4.5, 9.0), 0.0);
    }
}

TEST(Motion, ScaleStaysPositiveAndLinearScaleIsGeometric) {
    Motion motion;
    motion.keys = {
        {.time = 0.0f, .scale = {1, 1, 1}}, {.time = 1.0f, .scale = {0.01f, 1, 1}}, {.time = 1.1f, .scale = {9, 1, 1}}};
    for (double time = 0.0; time <= 1.1; time += 0.01) EXPECT_GT(motion.pose(time)[0][0], 0.0f) << time;
    motion.interpolation = MotionInterpolation::linear;
    EXPECT_NEAR(motion.pose(0.5)[0][0], 0.1f, 1e-6f);  // sqrt(1 * 0.01)
}

std::string complaint(const Motion& motion) {
    return message_of<SceneError>([&] { motion.check(); });
}

TEST(Motion, RefusesWhatIsNoMotion) {
    const Motion good = tumbling(MotionInterpolation::smooth);
    EXPECT_NO_THROW(good.check());
    Motion bad = good;
    bad.keys[2].time = 2.0f;
    EXPECT_THAT(complaint(bad), HasSubstr("key 2 at 2 s does not come after key 1"));
    bad = good;
    bad.keys[1].rotation = glm::quat(2, 0, 0, 0);
    EXPECT_THAT(complaint(bad), HasSubstr("rotation of key 1 has length 2"));
    bad = good;
    bad.keys[1].scale.y = 0.0f;
    EXPECT_THAT(complaint(bad), HasSubstr("scale (2, 0, 1) of key 1"));
    bad = good;
    bad.keys[3].translation.x = std::nanf("");
    EXPECT_THAT(complaint(bad), HasSubstr("key 3"));
    bad = good;
    bad.keys[1].rotation = turn(20, {0, 1, 0}) * turn(360, {0, 0, 1});
    EXPECT_THAT(complaint(bad), HasSubstr("whole turn"));
    bad = good;
    bad.rest[0][0] = -1.0f;
    EXPECT_THAT(complaint(bad), HasSubstr("determinant -1"));
}

TEST(Motion, MovesTheSceneButNotWhatStandsStill) {
    Scene scene;
    scene.materials = {Material{}};
    scene.meshes = {{"m", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {{0, 1, 2}}, 0}};
    const glm::mat4 place = glm::translate(glm::mat4(1.0f), glm::vec3(0.1f, 0.2f, 0.3f));
    scene.instances = {{"still", 0, place}, {"moving", 0, glm::mat4(1.0f)}};
    scene.instances[1].motion.keys = {{.time = 0.0f}, {.time = 1.0f, .translation = {5, 0, 0}}};
    const std::uint64_t before = scene.content_hash();
    EXPECT_FALSE(scene.instances[0].moves());
    EXPECT_EQ(scene.instances[0].pose(0.5), place);
    scene.move_to(1.0);
    EXPECT_EQ(scene.instances[0].world_from_object, place);
    EXPECT_EQ(scene.instances[1].world_from_object, scene.instances[1].pose(1.0));
    EXPECT_FLOAT_EQ(scene.bounds().upper.x, 6.0f);
    EXPECT_NE(scene.content_hash(), before);
    scene.move_to(0.0);
    EXPECT_EQ(scene.content_hash(), before);
}

}  // namespace
}  // namespace plumb
