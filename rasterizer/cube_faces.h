// The six faces of OpenGL's cube maps.
#pragma once

#include <array>

#include <glm/glm.hpp>

namespace plumb {

// Where a face looks, and which way is up on it (towards growing t).
struct CubeFace {
    glm::vec3 forward, up;

    // Columns right, up, backwards: those of a camera that sees the face.
    glm::mat3 axes() const { return {glm::cross(forward, up), up, -forward}; }
};

constexpr std::array<CubeFace, 6> cube_faces{{{{1, 0, 0}, {0, -1, 0}},
                                              {{-1, 0, 0}, {0, -1, 0}},
                                              {{0, 1, 0}, {0, 0, 1}},
                                              {{0, -1, 0}, {0, 0, -1}},
                                              {{0, 0, 1}, {0, -1, 0}},
                                              {{0, 0, -1}, {0, -1, 0}}}};

}  // namespace plumb
