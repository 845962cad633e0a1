// A wall 2 m away that faces a camera panning to the right, one pixel 0.01 m wide: the wall moves left. Surface point s
// (in pixels of the wall) is seen in pixel s - camera.
#pragma once

#include <functional>

#include "frames/frame.h"

namespace plumb::test {

inline constexpr int wall_width = 16, wall_height = 8;

inline Frame wall(double camera, const std::function<double(double)>& value) {
    Frame frame(wall_width, wall_height);
    Image &plane = frame.set("direct", Image(wall_width, wall_height, 1)),
          &position = frame.set("position", Image(wall_width, wall_height, 3));
    frame.set("depth", Image(wall_width, wall_height, 1, 2.0f));
    frame.set("motion", Image(wall_width, wall_height, 2));
    for (int y = 0; y < wall_height; ++y) {
        for (int x = 0; x < wall_width; ++x) {
            plane.at(x, y) = static_cast<float>(value(x + camera));
            position.at(x, y, 0) = static_cast<float>(0.01 * (x + camera));
            position.at(x, y, 1) = static_cast<float>(-0.01 * y);
            position.at(x, y, 2) = -2.0f;
        }
    }
    return frame;
}

// Of all pixels; a camera that panned by `x` pixels since the frame before.
inline Frame with_motion(Frame frame, double x) {
    for (int j = 0; j < frame.height(); ++j) {
        for (int i = 0; i < frame.width(); ++i) frame.plane("motion").at(i, j, 0) = static_cast<float>(x);
    }
    return frame;
}

inline double texture(double s) { return 0.5 + 0.03 * s; }

}  // namespace plumb::test
