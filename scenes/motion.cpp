#include "scenes/motion.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/finite.h"
#include "scenes/keyed_curve.h"

namespace plumb {
namespace {

using KeyTime = BasicKeySpan<double>;

// The turn of a unit quaternion as axis * half angle, the half angle in [0, pi].
glm::dvec3 logarithm(const glm::dquat& q) {
    const glm::dvec3 axis(q.x, q.y, q.z);
    const double sine = glm::length(axis);
    return sine > 0.0 ? axis * (std::atan2(sine, q.w) / sine) : glm::dvec3(0.0);
}

glm::dquat exponential(const glm::dvec3& turn) {
    const double half_angle = glm::length(turn);
    const double factor = half_angle > 0.0 ? std::sin(half_angle) / half_angle : 1.0;
    return {std::cos(half_angle), factor * turn.x, factor * turn.y, factor * turn.z};
}

class PoseAtTime {
public:
    PoseAtTime(const Motion& motion, double time)
        : motion_(motion), keys_(motion.keys), span_(find_key_span(keys_, time)) {}

    glm::dmat4 world_from_rest() const {
        const glm::dvec3 pivot(motion_.pivot);
        const glm::dvec3 translation = between([](const MotionKey& key) { return glm::dvec3(key.translation); });
        const glm::dvec3 scale =
            glm::exp(between([](const MotionKey& key) { return glm::log(glm::dvec3(key.scale)); }));
        glm::dmat3 linear = glm::mat3_cast(rotation());
        for (int axis = 0; axis < 3; ++axis) linear[axis] *= scale[axis];
        glm::dmat4 pose(linear);
        pose[3] = glm::dvec4(pivot + translation - linear * pivot, 1.0);
        return pose;
    }

    // Radians per second that the turn between the two keys never exceeds. The Bernstein polynomials' derivatives weigh
    // the three turns of a smooth one with numbers that are positive and sum to three.
    double fastest_turn() const {
        if (!(span_.duration > 0.0)) return 0.0;
        const auto angle = [](const glm::dvec3& half_turn) { return 2.0 * glm::length(half_turn); };
        if (motion_.interpolation == MotionInterpolation::linear) {
            return angle(turn(span_.from, span_.to)) / span_.duration;
        }
        const SmoothTurn turns = smooth_turn();
        return 3.0 * std::max({angle(turns.first), angle(turns.second), angle(turns.third)}) / span_.duration;
    }

private:
    // Turns that, one after the other, lead from one key to the next.
    struct SmoothTurn {
        glm::dvec3 first, second, third;
    };

    template <typename Value>
    glm::dvec3 between(Value value) const {
        if (motion_.interpolation == MotionInterpolation::smooth) return catmull_rom(keys_, span_, value);
        return glm::mix(value(keys_[span_.from]), value(keys_[span_.to]), span_.s);
    }

    glm::dquat orientation(std::size_t key) const { return glm::normalize(glm::dquat(keys_[key].rotation)); }
    glm::dvec3 turn(std::size_t from, std::size_t to) const {
        return logarithm(glm::conjugate(orientation(from)) * orientation(to));
    }
    // Half the angular velocity at a key, in the object's axes: the mean over the two spans beside it.
    glm::dvec3 angular_velocity(std::size_t key) const {
        const std::size_t before = key == 0 ? 0 : key - 1, next = std::min(key + 1, keys_.size() - 1);
        if (before == next) return glm::dvec3(0.0);
        return (turn(before, key) + turn(key, next)) / static_cast<double>(keys_[next].time - keys_[before].time);
    }

    glm::dquat rotation() const {
        const double s = span_.s;
        const glm::dquat start = orientation(span_.from);
        if (motion_.interpolation == MotionInterpolation::linear) {
            return start * exponential(s * turn(span_.from, span_.to));
        }
        const auto [first, second, third] = smooth_turn();
        const double rest = 1.0 - s;
        return start * exponential((1.0 - rest * rest * rest) * first) * exponential((3.0 - 2.0 * s) * s * s * second) *
               exponential(s * s * s * third);
    }
    SmoothTurn smooth_turn() const {
        const glm::dvec3 first = span_.duration / 3.0 * angular_velocity(span_.from);
        const glm::dvec3 third = span_.duration / 3.0 * angular_velocity(span_.to);
        const glm::dvec3 second =
            logarithm(glm::conjugate(exponential(first)) * glm::conjugate(orientation(span_.from)) *
                      orientation(span_.to) * glm::conjugate(exponential(third)));
        return {first, second, third};
    }

    const Motion& motion_;
    const std::vector<MotionKey>& keys_;
    KeyTime span_;
};

}  // namespace

glm::mat4 Motion::pose(double time) const {
    return glm::mat4(PoseAtTime(*this, time).world_from_rest() * glm::dmat4(rest));
}

double Motion::fastest_turn(double begin, double end) const {
    double fastest = 0.0;
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (keys[i].time > begin && keys[i - 1].time < end) {
            fastest = std::max(fastest, PoseAtTime(*this, keys[i - 1].time).fastest_turn());
        }
    }
    return fastest;
}

void Motion::check() const {
    check_key_times(keys, "motion");
    const float determinant = glm::determinant(glm::mat3(rest));
    if (!(determinant > 0.0f && std::isfinite(determinant) && finite(glm::vec3(rest[3])) && finite(pivot))) {
        throw SceneError(
            fmt::format("its rest pose has determinant {} and its pivot is ({}, {}, {}); they must be "
                        "finite, and a pose must not mirror or flatten",
                        determinant, pivot.x, pivot.y, pivot.z));
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto& [time, translation, rotation, scale] = keys[i];
        if (!(std::isfinite(time) && finite(translation))) {
            throw SceneError(fmt::format("motion: key {} at {} s is moved by ({}, {}, {}); both must be finite", i,
                                         time, translation.x, translation.y, translation.z));
        }
        // 1e-3: what a quaternion typed with four digits is off.
        if (!(std::abs(glm::length(rotation) - 1.0f) < 1e-3f)) {
            throw SceneError(
                fmt::format("motion: the rotation of key {} has length {}, not 1", i, glm::length(rotation)));
        }
        if (!(finite(scale) && glm::all(glm::greaterThan(scale, glm::vec3(0.0f))))) {
            throw SceneError(
                fmt::format("motion: the scale ({}, {}, {}) of key {} must be positive", scale.x, scale.y, scale.z, i));
        }
        // Within 2 acos(0.9999) = 1.6 degrees of a whole turn the axis is what rounding left of it.
        if (i > 0 && glm::dot(keys[i - 1].rotation, rotation) < -0.9999f) {
            throw SceneError(
                fmt::format("motion: from key {} to key {} is a whole turn, about no certain axis; put "
                            "another key between them",
                            i - 1, i));
        }
    }
}

}  // namespace plumb
