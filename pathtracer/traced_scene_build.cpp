// How a TracedScene is built; what is asked of it stands in traced_scene.cpp.
#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>

#include "pathtracer/reference_error.h"
#include "pathtracer/traced_scene.h"
#include "scenes/ggx.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

void check_embree(RTCDevice device, const Scene& scene, std::string_view step) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    throw ReferenceError(fmt::format("scene '{}': Embree failed while {} (error {}{})", scene.name, step,
                                     static_cast<int>(error),
                                     error == RTC_ERROR_OUT_OF_MEMORY ? ": out of memory" : ""));
}

void check_indices(const Scene& scene) {
    const auto check = [&](std::string_view what, const std::string& name, auto index, std::size_t count,
                           std::string_view of) {
        if (index >= 0 && static_cast<std::size_t>(index) < count) return;
        throw SceneError(fmt::format("scene '{}': {} '{}' uses {} {}, but there are {}; correct the index", scene.name,
                                     what, name, of, index, count));
    };
    for (const Instance& instance : scene.instances) {
        check("instance", instance.name, instance.mesh, scene.meshes.size(), "mesh");
    }
    for (const Mesh& mesh : scene.meshes) {
        check("mesh", mesh.name, mesh.material, scene.materials.size(), "material");
        const auto check_size = [&](std::string_view what, std::size_t size) {
            if (size == 0 || size == mesh.positions.size()) return;
            throw SceneError(
                fmt::format("scene '{}': mesh '{}' has {} positions but {} {}; give one per position or none",
                            scene.name, mesh.name, mesh.positions.size(), size, what));
        };
        check_size("normals", mesh.normals.size());
        check_size("texture coordinates", mesh.uvs.size());
        for (const glm::uvec3& triangle : mesh.triangles) {
            const unsigned largest = std::max({triangle.x, triangle.y, triangle.z});
            check("mesh", mesh.name, static_cast<long long>(largest), mesh.positions.size(), "vertex");
        }
    }
}

}  // namespace

TracedScene::TracedScene(const Scene& scene, const TimeSpan& span)
    : scene_(scene), span_(span), parts_(scene.instances.size()) {
    check_indices(scene);
    device_ = rtcNewDevice(nullptr);
    if (!device_) {
        throw ReferenceError(fmt::format("Embree does not start (error {}); `plumbline doctor` tells what it needs",
                                         static_cast<int>(rtcGetDeviceError(nullptr))));
    }
    embree_scene_ = rtcNewScene(device_);
    // Robust: no ray slips between two triangles that share an edge.
    rtcSetSceneFlags(embree_scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree_scene_, RTC_BUILD_QUALITY_HIGH);
    for (std::uint32_t i = 0; i < parts_.size(); ++i) add(i, span);
    if (has_specular_lobes_) specular_albedo_.emplace();
    rtcCommitScene(embree_scene_);
    check_embree(device_, scene_, "building its tree");
}

TracedScene::~TracedScene() {
    if (layered_scene_) rtcReleaseScene(layered_scene_);
    rtcReleaseScene(embree_scene_);
    rtcReleaseDevice(device_);
}

void TracedScene::set_positions(RTCGeometry geometry, const Instance& instance, Part& part, const TimeSpan& span) {
    const Mesh& mesh = scene_.meshes[instance.mesh];
    part.normals.reserve(mesh.normals.size() * static_cast<std::size_t>(part.steps));
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(part.steps));
    for (int step = 0; step < part.steps; ++step) {
        const double at = part.steps == 1 ? 1.0 : static_cast<double>(step) / (part.steps - 1);
        const glm::mat4 pose =
            part.steps == 1 ? instance.world_from_object : instance.pose(span.begin + at * (span.end - span.begin));
        auto* positions =
            static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(step),
                                                        RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
        check_embree(device_, scene_, fmt::format("taking instance '{}'", instance.name));
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const glm::vec3 world(pose * glm::vec4(mesh.positions[i], 1.0f));
            for (int axis = 0; axis < 3; ++axis) positions[3 * i + axis] = world[axis];
        }
        part.positions.push_back(positions);
        part.still = positions;
        const glm::mat3 normal_matrix = glm::inverseTranspose(glm::mat3(pose));
        for (const glm::vec3& normal : mesh.normals) part.normals.push_back(glm::normalize(normal_matrix * normal));
    }
}

void TracedScene::add(std::uint32_t index, const TimeSpan& span) {
    // Poses of a moving instance over the time span: a quarter turn between two of them bulges by less than a fiftieth
    // of its radius.
    constexpr int poses = 9;
    const Instance& instance = scene_.instances[index];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    Part& part = parts_[index];
    part.scene = &scene_;
    part.material = &scene_.materials[mesh.material];
    part.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    part.vertex_count = mesh.positions.size();
    part.steps = instance.moves() && span.end > span.begin ? poses : 1;
    part.uvs = mesh.uvs.empty() ? nullptr : &mesh.uvs;
    part.has_textures = part.material->base_colour_texture != no_texture ||
                        part.material->metallic_roughness_texture != no_texture ||
                        part.material->emission_texture != no_texture;
    part.is_plain = !part.material->has_specular_lobe() && !part.material->is_transparent();
    anything_moves_ |= part.steps > 1;
    has_specular_lobes_ |= part.material->has_specular_lobe();
    has_transparency_ |= part.material->is_transparent();
    // A texture only lowers the roughness.
    const bool may_be_mirror =
        part.material->has_specular_lobe() &&
        (part.material->metallic_roughness_texture != no_texture || ggx_alpha(part.material->roughness) == 0.0f);
    has_delta_lobes_ |= may_be_mirror || part.material->is_transparent();
    if (!part.has_textures) part.constant = scene_.surface(*part.material, {});

    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    set_positions(geometry, instance, part, span);
    auto* triangles = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    check_embree(device_, scene_, fmt::format("taking instance '{}'", instance.name));
    const bool mirrored = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        glm::uvec3 corners = mesh.triangles[i];
        if (mirrored) std::swap(corners.y, corners.z);
        for (int corner = 0; corner < 3; ++corner) triangles[3 * i + corner] = corners[corner];
    }
    part.triangles = triangles;

    rtcSetGeometryUserData(geometry, &part);
    if (part.material->alpha_mask) {
        rtcSetGeometryIntersectFilterFunction(geometry, &TracedScene::reject_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, &TracedScene::reject_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree_scene_, geometry, index);
    rtcReleaseGeometry(geometry);
}

// The same geometry once more, in a tree whose queries may bring a filter: such queries cost more, also without one.
RTCScene TracedScene::scene_for(const OracleLayers* layers) const {
    if (!layers) return embree_scene_;
    std::call_once(layered_scene_made_, [this] {
        layered_scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(layered_scene_, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | filter_per_query));
        rtcSetSceneBuildQuality(layered_scene_, RTC_BUILD_QUALITY_HIGH);
        for (unsigned i = 0; i < parts_.size(); ++i) {
            rtcAttachGeometryByID(layered_scene_, rtcGetGeometry(embree_scene_, i), i);
        }
        rtcCommitScene(layered_scene_);
        check_embree(device_, scene_, "building its tree for the layers of a view");
    });
    return layered_scene_;
}

}  // namespace plumb
