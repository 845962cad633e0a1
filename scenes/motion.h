// The motion of an object: poses at keys in time, and what lies between them.
#pragma once

#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb {

// Where an object is, seen from where it rests.
struct MotionKey {
    float time = 0.0f;                           // seconds
    glm::vec3 translation{0.0f};                 // metres
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  // unit length, about the pivot; w first
    glm::vec3 scale{1.0f};                       // positive, about the pivot, along the axes of the rest pose
};

enum class MotionInterpolation {
    linear,  // straight at constant speed from key to key, turning about one axis at constant angular speed
    smooth,  // velocity and angular velocity are continuous: Catmull-Rom curves, as camera paths are
};

// world_from_object at a time is translate(pivot + translation) rotate scale translate(-pivot) rest. With the identity
// as `rest` and the origin as pivot keys are poses; else they are relative to where the object was put.
//   Before the first key and after the last the object stands still. Between keys the logarithm of the scale is
//   interpolated, so that it stays positive. Rotations are interpolated as they are written, q and -q being one
//   orientation but two ways to get there: from 0 to 270 degrees about an axis it is 270, not -90.
//   Source of the smooth rotation: Kim, Kim, Shin 1995, "A General Construction Scheme for Unit Quaternion Curves with
//   Simple High Order Derivatives": a Hermite curve by cumulative Bernstein polynomials; about one fixed axis it is the
//   Catmull-Rom curve of the angle.
struct Motion {
    MotionInterpolation interpolation = MotionInterpolation::smooth;
    glm::mat4 rest{1.0f};
    glm::vec3 pivot{0.0f};        // world space, at rest
    std::vector<MotionKey> keys;  // times strictly increasing

    // Needs a key.
    glm::mat4 pose(double time) const;
    // Radians per second that it never turns faster than between two times. Needs a key.
    double fastest_turn(double begin, double end) const;
    // Throws SceneError where times do not increase, a value is not finite, a rotation is not of unit length, a scale
    // is not positive, `rest` mirrors or flattens, or the turn from one key to the next is a whole one, whose axis
    // nobody can tell.
    void check() const;
};

}  // namespace plumb
