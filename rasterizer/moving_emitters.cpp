#include "rasterizer/moving_emitters.h"

#include <algorithm>

#include "rasterizer/scene_reach.h"

namespace plumb {
namespace {

glm::vec3 moved_point(const glm::dmat4& motion, const glm::vec3& point) {
    return glm::vec3(motion * glm::dvec4(point, 1.0));
}

// How areas as vectors, and with them normals, are turned and scaled.
glm::dmat3 cofactors(const glm::dmat4& motion) {
    const glm::dmat3 linear(motion);
    return glm::determinant(linear) * glm::transpose(glm::inverse(linear));
}

EmitterPiece moved_piece(const glm::dmat4& motion, const EmitterPiece& piece, bool is_disc) {
    EmitterPiece moved = piece;
    moved.a = moved_point(motion, piece.a);
    if (is_disc) {
        moved.b = glm::vec3(cofactors(motion) * glm::dvec3(piece.b));
    } else {
        moved.b = moved_point(motion, piece.b), moved.c = moved_point(motion, piece.c);
    }
    return moved;
}

glm::vec4 moved_plane(const glm::dmat4& motion, const glm::vec4& plane) {
    if (glm::vec3(plane) == glm::vec3(0.0f)) return plane;  // stands for none
    const glm::dvec4 moved = glm::transpose(glm::inverse(motion)) * glm::dvec4(plane);
    return glm::vec4(moved / glm::length(glm::dvec3(moved)));
}

}  // namespace

MovingEmitters::MovingEmitters(const Scene& scene, const DirectSettings& direct)
    : linear_cubes_(direct.shadow.cube_distance == CubeDistance::linear) {
    if (!direct.emitters || std::ranges::none_of(scene.instances, &Instance::moves)) return;
    bounds_ = bounds_over_time(scene);
    std::size_t pieces = 0, cubes = 0;
    for (EmitterLight& emitter : find_emitters(scene, direct.shadow.emitter_samples)) {
        const Instance& instance = scene.instances[static_cast<std::size_t>(emitter.instance)];
        const std::size_t first_piece = pieces, first_cube = cubes;
        pieces += emitter.pieces.size(), cubes += emitter.sample_points.size();
        if (instance.moves())
            emitters_.push_back({&instance, std::move(emitter), first_piece, first_cube, instance.world_from_object});
    }
}

bool MovingEmitters::move_to(const std::optional<double>& time, LightSet& lights) {
    bool changed = false;
    for (Emitter& emitter : emitters_) {
        const glm::mat4& reference = emitter.instance->world_from_object;
        const glm::mat4 pose = time ? emitter.instance->pose(*time) : reference;
        if (pose == emitter.pose) continue;
        changed = true;
        emitter.pose = pose;
        const glm::dmat4 motion =
            pose == reference ? glm::dmat4(1.0) : glm::dmat4(pose) * glm::inverse(glm::dmat4(reference));
        for (std::size_t i = 0; i < emitter.found.pieces.size(); ++i) {
            lights.pieces[emitter.first_piece + i] = moved_piece(motion, emitter.found.pieces[i], emitter.found.discs);
        }
        for (std::size_t i = 0; i < emitter.found.sample_points.size(); ++i) {
            ShadowCube& cube = lights.emitter_cubes[emitter.first_cube + i];
            cube.position = moved_point(motion, emitter.found.sample_points[i]);
            cube.range = reach(bounds_, cube.position);
            cube.front_plane = moved_plane(motion, emitter.found.front_plane);
            lights.emitter_cube_records[emitter.first_cube + i] = {cube.position,
                                                                   linear_cubes_ ? cube.range : cube.near_plane};
        }
    }
    return changed;
}

}  // namespace plumb
