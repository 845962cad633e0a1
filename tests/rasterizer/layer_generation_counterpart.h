// The second layer that one geometry pass finds, on the CPU, from the rule of rasterizer/one_pass_gbuffer.h: of all
// surfaces on a pixel's ray the nearest one that lies more than the separation behind the comparison. Rays are cast
// through the scene as it stands at each moment; nothing is taken from what the passes compute.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "rasterizer/method.h"
#include "rasterizer/moment.h"
#include "ray_caster.h"

namespace plumb::counterpart {

// The scene at a moment, as rays see it.
class Snapshot {
public:
    Snapshot(const Scene& scene, const View& view, std::vector<glm::dmat4> poses)
        : view_(view), poses_(std::move(poses)), scene_(posed(scene, poses_)), caster_(scene_) {}

    static Snapshot at(const Scene& scene, const Moment& moment) {
        std::vector<glm::dmat4> poses;
        for (const Instance& instance : scene.instances) poses.emplace_back(moment.pose(instance));
        return Snapshot(scene, moment.view, std::move(poses));
    }
    // What follows `now` where camera and instances go on as they moved since `before`.
    static Snapshot foreseen(const Scene& scene, const Snapshot& before, const Snapshot& now) {
        const auto gone_on = [](const glm::dmat4& from, const glm::dmat4& to) { return to * glm::inverse(from) * to; };
        std::vector<glm::dmat4> poses;
        for (std::size_t i = 0; i < now.poses_.size(); ++i) poses.push_back(gone_on(before.poses_[i], now.poses_[i]));
        Camera camera = now.view_.camera();
        camera.world_from_camera = glm::mat4(
            gone_on(glm::dmat4(before.view_.camera().world_from_camera), glm::dmat4(camera.world_from_camera)));
        return Snapshot(scene, View(camera, now.view_.width(), now.view_.height()), std::move(poses));
    }

    Snapshot(const Snapshot&) = delete;
    Snapshot& operator=(const Snapshot&) = delete;

    const View& view() const { return view_; }
    const glm::dmat4& pose(int instance) const { return poses_[static_cast<std::size_t>(instance)]; }

    // All surfaces that are seen through a place of the image if each hides nothing, nearest first.
    std::vector<CastHit> surfaces(const glm::dvec2& place) const {
        std::vector<CastHit> hits;
        while (std::optional<CastHit> hit = next(place, hits.empty() ? 0.0 : hits.back().depth)) hits.push_back(*hit);
        return hits;
    }
    // Of the first layer; +infinity: nothing is there.
    double first_depth(const glm::dvec2& place) const {
        const auto known = first_depths_.find({place.x, place.y});
        if (known != first_depths_.end()) return known->second;
        const std::optional<CastHit> hit = next(place, 0.0);
        return first_depths_[{place.x, place.y}] = hit ? hit->depth : std::numeric_limits<double>::infinity();
    }
    // Where a world point is seen, and its depth.
    glm::dvec3 seen(const glm::dvec3& world) const {
        const glm::dvec3 p(glm::inverse(glm::dmat4(view_.camera().world_from_camera)) * glm::dvec4(world, 1.0));
        const double pixels_per_metre = 0.5 * view_.height() / std::tan(0.5 * view_.camera().vertical_fov);
        return {0.5 * view_.width() + pixels_per_metre * p.x / -p.z,
                0.5 * view_.height() - pixels_per_metre * p.y / -p.z, -p.z};
    }

private:
    static Scene posed(Scene scene, const std::vector<glm::dmat4>& poses) {
        for (std::size_t i = 0; i < poses.size(); ++i) scene.instances[i].world_from_object = glm::mat4(poses[i]);
        return scene;
    }
    std::optional<CastHit> next(const glm::dvec2& place, double behind) const {
        const double metres_per_pixel = std::tan(0.5 * view_.camera().vertical_fov) / (0.5 * view_.height());
        const glm::dvec3 in_camera(metres_per_pixel * (place.x - 0.5 * view_.width()),
                                   metres_per_pixel * (0.5 * view_.height() - place.y), -1.0);
        const glm::dmat4 world_from_camera(view_.camera().world_from_camera);
        // Not of unit length: the distance along it is the depth.
        const glm::dvec3 direction = glm::dmat3(world_from_camera) * in_camera;
        // A nanometre: not the same surface again.
        const double nearest = std::max<double>(view_.camera().near_plane, behind + 1e-9);
        CastHit hit = caster_.cast(glm::dvec3(world_from_camera[3]), direction, nearest, view_.camera().far_plane);
        if (!hit.hit) return {};
        hit.depth = hit.distance;
        return hit;
    }

    View view_;
    std::vector<glm::dmat4> poses_;
    Scene scene_;
    RayCaster caster_;
    mutable std::map<std::pair<double, double>, double> first_depths_;
};

// What the second layer holds at a pixel.
struct SecondLayer {
    double depth = std::numeric_limits<double>::infinity();
    int instance = -1;       // -1: nothing
    bool ambiguous = false;  // rounding of depths, or the rasterizer's sub-pixel grid, may find another surface
};

// How a variant compares: with the first layer of `frame`, at the fragment's pixel or, where it follows motion, at the
// one where the fragment's point was seen then.
struct Comparison {
    const Snapshot& frame;
    bool follows_motion = false;
};

// As seen `offset` pixels from where the pixels' centres are, in this frame and in the one compared with.
inline SecondLayer second_layer(const Snapshot& now, const Comparison& comparison, double separation, glm::ivec2 pixel,
                                const glm::dvec2& offset) {
    SecondLayer result;
    const glm::dvec2 place = glm::dvec2(pixel) + 0.5 + offset;
    for (const CastHit& surface : now.surfaces(place)) {
        double depth = surface.depth;
        glm::dvec2 compared_at = place;
        if (comparison.follows_motion) {
            const glm::dmat4 then_from_now =
                comparison.frame.pose(surface.instance) * glm::inverse(now.pose(surface.instance));
            const glm::dvec3 seen = comparison.frame.seen(glm::dvec3(then_from_now * glm::dvec4(surface.point, 1.0)));
            const View& view = comparison.frame.view();
            const bool inside =
                seen.z > 0.0 && seen.x >= 0.0 && seen.y >= 0.0 && seen.x < view.width() && seen.y < view.height();
            if (!inside) continue;
            depth = seen.z;
            compared_at = glm::floor(glm::dvec2(seen)) + 0.5 + offset;
        }
        const double distance = depth - comparison.frame.first_depth(compared_at) - separation;
        // Depth in float, interpolated, is good to 1e-5 of it.
        result.ambiguous |= std::abs(distance) < 2e-5 * depth;
        if (!(distance > 0.0)) continue;
        result.depth = surface.depth, result.instance = surface.instance;
        return result;
    }
    return result;
}

// The rasterizer snaps vertices to 1/256 of a pixel: what a fiftieth of one changes, it may see otherwise.
inline SecondLayer second_layer(const Snapshot& now, const Comparison& comparison, double separation,
                                glm::ivec2 pixel) {
    SecondLayer result = second_layer(now, comparison, separation, pixel, glm::dvec2(0.0));
    constexpr double aside = 0.02;
    for (const glm::dvec2& offset :
         {glm::dvec2(-aside, -aside), glm::dvec2(aside, -aside), glm::dvec2(-aside, aside), glm::dvec2(aside, aside)}) {
        const SecondLayer other = second_layer(now, comparison, separation, pixel, offset);
        const bool same = other.instance == result.instance &&
                          (result.instance < 0 || std::abs(other.depth - result.depth) < 0.02 * result.depth);
        result.ambiguous |= other.ambiguous || !same;
    }
    return result;
}

}  // namespace plumb::counterpart
