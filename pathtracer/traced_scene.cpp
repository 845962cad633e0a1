#include "pathtracer/traced_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>
#include <tbb/task_arena.h>

#include "pathtracer/reference_error.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

// Sixteen half units in the last place: three roundings make an interpolated point (pbrt-v4, section 6.8.5), the rest
// is for the differences and the cross product in Embree's test of a triangle that is not a sliver.
constexpr float coordinate_error = 0x1p-20f;

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

glm::vec3 TracedTriangle::error() const {
    const auto largest = [](float x, float y, float z) {
        return std::max(std::abs(x), std::max(std::abs(y), std::abs(z)));
    };
    return coordinate_error * glm::vec3(largest(a.x, b.x, c.x), largest(a.y, b.y, c.y), largest(a.z, b.z, c.z));
}

TracedScene::TracedScene(const Scene& scene) : scene_(scene), parts_(scene.instances.size()) {
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
    for (std::uint32_t i = 0; i < parts_.size(); ++i) add(i);
    rtcCommitScene(embree_scene_);
    check_embree(device_, scene_, "building its tree");
}

TracedScene::~TracedScene() {
    rtcReleaseScene(embree_scene_);
    rtcReleaseDevice(device_);
}

void TracedScene::add(std::uint32_t index) {
    const Instance& instance = scene_.instances[index];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    Part& part = parts_[index];
    part.scene = &scene_;
    part.material = &scene_.materials[mesh.material];
    part.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    part.uvs = mesh.uvs.empty() ? nullptr : &mesh.uvs;
    part.has_textures = part.material->base_colour_texture != no_texture ||
                        part.material->metallic_roughness_texture != no_texture ||
                        part.material->emission_texture != no_texture;
    if (!part.has_textures) part.constant = scene_.surface(*part.material, {});

    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    auto* triangles = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    check_embree(device_, scene_, fmt::format("taking instance '{}'", instance.name));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 world(instance.world_from_object * glm::vec4(mesh.positions[i], 1.0f));
        for (int axis = 0; axis < 3; ++axis) positions[3 * i + axis] = world[axis];
    }
    const bool mirrored = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        glm::uvec3 corners = mesh.triangles[i];
        if (mirrored) std::swap(corners.y, corners.z);
        for (int corner = 0; corner < 3; ++corner) triangles[3 * i + corner] = corners[corner];
    }
    const glm::mat3 normal_matrix = glm::inverseTranspose(glm::mat3(instance.world_from_object));
    part.normals.reserve(mesh.normals.size());
    for (const glm::vec3& normal : mesh.normals) part.normals.push_back(glm::normalize(normal_matrix * normal));
    part.positions = positions;
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

glm::vec2 TracedScene::Part::uv(std::uint32_t triangle, float u, float v) const {
    if (!uvs) return {0.0f, 0.0f};
    const std::uint32_t* corners = triangles + 3 * triangle;
    return (1.0f - u - v) * (*uvs)[corners[0]] + u * (*uvs)[corners[1]] + v * (*uvs)[corners[2]];
}

void TracedScene::reject_holes(const RTCFilterFunctionNArguments* arguments) {
    const auto& part = *static_cast<const Part*>(arguments->geometryUserPtr);
    const unsigned count = arguments->N;
    for (unsigned i = 0; i < count; ++i) {
        if (arguments->valid[i] != -1) continue;
        const glm::vec2 uv = part.uv(RTCHitN_primID(arguments->hit, count, i), RTCHitN_u(arguments->hit, count, i),
                                     RTCHitN_v(arguments->hit, count, i));
        if (!part.scene->is_opaque(*part.material, uv)) arguments->valid[i] = 0;
    }
}

SurfaceHit TracedScene::intersect(const glm::vec3& origin, const glm::vec3& direction, float nearest, float farthest,
                                  RayCoherence coherence) const {
    RTCRayHit query;
    query.ray.org_x = origin.x, query.ray.org_y = origin.y, query.ray.org_z = origin.z;
    query.ray.dir_x = direction.x, query.ray.dir_y = direction.y, query.ray.dir_z = direction.z;
    query.ray.tnear = nearest, query.ray.tfar = farthest;
    query.ray.time = 0.0f, query.ray.mask = 0xffffffffu, query.ray.id = 0, query.ray.flags = 0;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(embree_scene_, query, coherence);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
}

bool TracedScene::occluded(const glm::vec3& origin, const glm::vec3& direction, float farthest,
                           RayCoherence coherence) const {
    RTCRay ray;
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tnear = positive_distance, ray.tfar = farthest;
    ray.time = 0.0f, ray.mask = 0xffffffffu, ray.id = 0, ray.flags = 0;
    embree_occluded(embree_scene_, ray, coherence);
    return ray.tfar < 0.0f;  // Embree sets minus infinity where something is in the way
}

SurfacePoint TracedScene::surface_point(const SurfaceHit& hit, const glm::vec3& ray_direction) const {
    const Part& part = parts_[hit.instance];
    const std::uint32_t* corners = part.triangles + 3 * hit.triangle;
    TracedTriangle triangle;
    triangle.a = part.position(corners[0]), triangle.b = part.position(corners[1]),
    triangle.c = part.position(corners[2]);

    SurfacePoint point;
    point.position = triangle.point(hit.u, hit.v);
    point.position_error = triangle.error();
    point.geometric_normal = glm::normalize(triangle.scaled_normal());
    point.shading_normal = point.geometric_normal;
    if (!part.normals.empty()) {
        const glm::vec3 sum = (1.0f - hit.u - hit.v) * part.normals[corners[0]] + hit.u * part.normals[corners[1]] +
                              hit.v * part.normals[corners[2]];
        const float length = glm::length(sum);
        if (length > 0.0f) point.shading_normal = sum / length;  // opposite corner normals cancel: the face's serves
    }
    const bool back = glm::dot(point.geometric_normal, ray_direction) > 0.0f;
    if (back) {
        point.geometric_normal = -point.geometric_normal;
        point.shading_normal = -point.shading_normal;
    }
    if (!back || part.material->two_sided) {
        if (part.has_textures) {
            const SurfaceSample sample = part.scene->surface(*part.material, part.uv(hit.triangle, hit.u, hit.v));
            point.albedo = sample.albedo, point.emission = sample.emission;
        } else {
            point.albedo = part.constant.albedo, point.emission = part.constant.emission;
        }
    }
    return point;
}

TracedTriangle TracedScene::triangle(std::uint32_t instance, std::uint32_t index) const {
    const Part& part = parts_[instance];
    const std::uint32_t* corners = part.triangles + 3 * index;
    TracedTriangle triangle;
    triangle.a = part.position(corners[0]), triangle.b = part.position(corners[1]),
    triangle.c = part.position(corners[2]);
    if (part.uvs) {
        triangle.uv_a = (*part.uvs)[corners[0]], triangle.uv_b = (*part.uvs)[corners[1]],
        triangle.uv_c = (*part.uvs)[corners[2]];
    }
    return triangle;
}

SurfaceSample TracedScene::surface_sample(std::uint32_t instance, const glm::vec2& uv) const {
    const Part& part = parts_[instance];
    return part.has_textures ? part.scene->surface(*part.material, uv) : part.constant;
}

}  // namespace plumb
