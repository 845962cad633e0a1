// How a TracedScene is built; what it answers stands in traced_scene.cpp and traced_scene_surfaces.cpp.
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>

#include "pathtracer/motion_poses.h"
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

// Whether some point of the triangle may bulge by more than its rounding error (TracedScene::surface_point). Linear in
// the point, what each corner adds is largest at one of the other two.
bool may_bulge(const std::array<glm::vec3, 3>& corners, const std::array<glm::vec3, 3>& normals) {
    const TracedTriangle triangle{corners[0], corners[1], corners[2]};
    const glm::vec3 scaled_normal = triangle.scaled_normal();
    const float length = glm::length(scaled_normal);
    if (!(length > 0.0f)) return false;
    float front = 0.0f, back = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
        const float first = glm::dot(corners[k] - corners[(k + 1) % 3], normals[k]);
        const float second = glm::dot(corners[k] - corners[(k + 2) % 3], normals[k]);
        front += std::max({0.0f, first, second}), back += std::max({0.0f, -first, -second});
    }
    return std::max(front, back) > glm::dot(glm::abs(scaled_normal), triangle.error()) / length;
}

}  // namespace

TracedScene::TracedScene(const Scene& scene, const TimeSpan& span, const char* embree_settings)
    : scene_(scene), textures_(scene.textures), span_(span), parts_(scene.instances.size()) {
    check_indices(scene);
    device_ = rtcNewDevice(embree_settings);
    if (!device_) {
        throw ReferenceError(fmt::format("Embree does not start (error {}); `plumbline doctor` tells what it needs",
                                         static_cast<int>(rtcGetDeviceError(nullptr))));
    }
    embree_scene_ = rtcNewScene(device_);
    // Robust: no ray slips between two triangles that share an edge.
    rtcSetSceneFlags(embree_scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree_scene_, RTC_BUILD_QUALITY_HIGH);
    reserve(span);
    for (std::uint32_t i = 0; i < parts_.size(); ++i) add(i, span);
    for (std::uint32_t i = 0; i < parts_.size(); ++i) attach(i);
    has_normals_ = std::ranges::any_of(normals_, [](const glm::vec3& normal) { return normal != glm::vec3(0.0f); });
    if (anything_moves_) {
        anything_bulges_ = has_normals_;
    } else {
        make_records();
        anything_bulges_ = std::ranges::any_of(
            records_, [](const TriangleRecord& record) { return may_bulge(record.positions, record.normals); });
    }
    if (has_specular_lobes_) specular_albedo_.emplace();
    rtcCommitScene(embree_scene_);
    check_embree(device_, scene_, "building its tree");
}

TracedScene::~TracedScene() {
    if (layered_scene_) rtcReleaseScene(layered_scene_);
    rtcReleaseScene(embree_scene_);
    rtcReleaseDevice(device_);
}

int TracedScene::steps_of(const Instance& instance, const TimeSpan& span) {
    return static_cast<int>(std::min<double>(poses_over(instance, span), most_poses));
}

// Room for all vertices at once: parts point into it.
void TracedScene::reserve(const TimeSpan& span) {
    std::size_t vertices = 0, triangles = 0;
    for (const Instance& instance : scene_.instances) {
        const Mesh& mesh = scene_.meshes[instance.mesh];
        vertices += mesh.positions.size() * static_cast<std::size_t>(steps_of(instance, span));
        triangles += mesh.triangles.size();
    }
    // The floats of records are numbered by int.
    constexpr std::size_t most = std::numeric_limits<int>::max() / (sizeof(TriangleRecord) / sizeof(float));
    if (vertices > most || triangles > most) {
        throw ReferenceError(
            fmt::format("scene '{}': {} vertices and {} triangles in all instances; references take at "
                        "most {} of each: leave parts out",
                        scene_.name, vertices, triangles, most));
    }
    // Embree reads 16 bytes from each position on.
    positions_.reserve(vertices + 1), normals_.reserve(vertices);
    triangles_.reserve(3 * triangles);
}

void TracedScene::add_vertices(const Instance& instance, const Part& part, const TimeSpan& span) {
    const Mesh& mesh = scene_.meshes[instance.mesh];
    for (int step = 0; step < part.steps; ++step) {
        const double at = part.steps == 1 ? 1.0 : static_cast<double>(step) / (part.steps - 1);
        const glm::mat4 pose =
            part.steps == 1 ? instance.world_from_object : instance.pose(span.begin + at * (span.end - span.begin));
        for (const glm::vec3& position : mesh.positions) positions_.emplace_back(pose * glm::vec4(position, 1.0f));
        const glm::mat3 normal_matrix = glm::inverseTranspose(glm::mat3(pose));
        for (const glm::vec3& normal : mesh.normals) normals_.push_back(glm::normalize(normal_matrix * normal));
        normals_.resize(positions_.size(), glm::vec3(0.0f));
    }
}

void TracedScene::add(std::uint32_t index, const TimeSpan& span) {
    const Instance& instance = scene_.instances[index];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    Part& part = parts_[index];
    part.textures = &textures_;
    part.material = &scene_.materials[mesh.material];
    part.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    part.vertex_count = mesh.positions.size();
    part.steps = steps_of(instance, span);
    part.uvs = mesh.uvs.empty() ? nullptr : &mesh.uvs;
    part.has_textures = part.material->base_colour_texture != no_texture ||
                        part.material->metallic_roughness_texture != no_texture ||
                        part.material->emission_texture != no_texture;
    part.is_plain = !part.material->has_specular_lobe() && !part.material->is_transparent();
    anything_moves_ |= part.steps > 1;
    has_textures_ |= part.has_textures;
    has_specular_lobes_ |= part.material->has_specular_lobe();
    has_transparency_ |= part.material->is_transparent();
    // A texture only lowers the roughness.
    const bool may_be_mirror =
        part.material->has_specular_lobe() &&
        (part.material->metallic_roughness_texture != no_texture || ggx_alpha(part.material->roughness) == 0.0f);
    has_delta_lobes_ |= may_be_mirror || part.material->is_transparent();
    if (!part.has_textures) part.constant = scene_.surface(*part.material, {});

    table_.first_triangle.push_back(static_cast<int>(triangles_.size() / 3));
    table_.back_is_lit.push_back(part.material->two_sided ? 1.0f : 0.0f);
    table_.albedo.push_back(part.constant.albedo);
    table_.emission.push_back(part.constant.emission);
    part.positions = positions_.data() + positions_.size();
    part.normals = normals_.data() + normals_.size();
    part.triangles = triangles_.data() + triangles_.size();
    add_vertices(instance, part, span);
    const bool mirrored = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f;
    for (glm::uvec3 corners : mesh.triangles) {
        if (mirrored) std::swap(corners.y, corners.z);
        triangles_.insert(triangles_.end(), {corners.x, corners.y, corners.z});
    }
}

void TracedScene::attach(std::uint32_t index) {
    const Part& part = parts_[index];
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(part.steps));
    for (int step = 0; step < part.steps; ++step) {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(step), RTC_FORMAT_FLOAT3,
                                   part.positions,
                                   static_cast<std::size_t>(step) * part.vertex_count * sizeof(glm::vec3),
                                   sizeof(glm::vec3), part.vertex_count);
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, part.triangles, 0,
                               3 * sizeof(std::uint32_t), part.triangle_count);
    check_embree(device_, scene_, fmt::format("taking instance '{}'", scene_.instances[index].name));
    rtcSetGeometryUserData(geometry, &parts_[index]);
    if (part.material->alpha_mask) {
        rtcSetGeometryIntersectFilterFunction(geometry, &TracedScene::reject_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, &TracedScene::reject_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree_scene_, geometry, index);
    rtcReleaseGeometry(geometry);
}

void TracedScene::make_records() {
    records_.reserve(triangles_.size() / 3);
    for (const Part& part : parts_) {
        for (std::size_t first = 0; first < 3 * std::size_t{part.triangle_count}; first += 3) {
            TriangleRecord& record = records_.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = part.triangles[first + k];
                record.positions[k] = part.positions[vertex], record.normals[k] = part.normals[vertex];
                record.uvs[k] = part.uvs ? (*part.uvs)[vertex] : glm::vec2(0.0f);
            }
        }
    }
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
