#include "rasterizer/scene_geometry.h"

#include <algorithm>
#include <cstdint>
#include <tuple>

#include <fmt/format.h>

#include "rasterizer/instance_motion.h"
#include "rasterizer/scene_texture.h"

namespace plumb {
namespace {

struct Vertex {
    glm::vec3 position, normal;
    glm::vec2 uv;
};

// std140 layout of InstanceBlock in scene.glsl.
struct InstanceBlock {
    glm::mat4 world_from_object;
    glm::vec4 normal_columns[3];  // mat3: inverse transpose of the upper left part
    glm::vec4 base_colour_and_metallic;
    glm::vec4 emission_and_roughness;
    float alpha_cutoff;
    int alpha_channel;
    int two_sided;
    float dielectric_reflectance;
    glm::mat4 next_world_from_object;
    std::uint32_t moving_number;
    std::uint32_t padding_at_end[3];
};
static_assert(sizeof(InstanceBlock) == 240);
constexpr GLuint instance_binding = 1;

struct MeshRange {
    GLint first_vertex = 0;
    std::size_t first_index = 0;
    GLsizei index_count = 0;
};

// OpenGL takes an offset into the bound index buffer in the place of a pointer.
const void* index_offset(std::size_t index) {
    return reinterpret_cast<const void*>(index * sizeof(std::uint32_t));  // NOLINT(performance-no-int-to-ptr)
}

void append_shared(const Mesh& mesh, std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        vertices.push_back({mesh.positions[i], mesh.normals[i], mesh.uvs.empty() ? glm::vec2(0.0f) : mesh.uvs[i]});
    }
    for (const glm::uvec3& triangle : mesh.triangles)
        indices.insert(indices.end(), {triangle.x, triangle.y, triangle.z});
}

void append_with_face_normals(const Mesh& mesh, std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices) {
    std::uint32_t next = 0;
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[triangle.x]), b(mesh.positions[triangle.y]), c(mesh.positions[triangle.z]);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double length = glm::length(normal);
        if (!(length > 0.0)) continue;  // covers no pixel
        for (int k = 0; k < 3; ++k) {
            const glm::vec2 uv = mesh.uvs.empty() ? glm::vec2(0.0f) : mesh.uvs[triangle[k]];
            vertices.push_back({mesh.positions[triangle[k]], glm::vec3(normal / length), uv});
            indices.push_back(next++);
        }
    }
}

Bounds world_bounds(const Mesh& mesh, const glm::mat4& world_from_object) {
    Bounds bounds;
    for (const glm::vec3& p : mesh.positions) bounds.add(glm::vec3(world_from_object * glm::vec4(p, 1.0f)));
    return bounds;
}

// Of the box's corners: not tight, but eight points a frame whatever the mesh.
Bounds world_bounds(const Bounds& object, const glm::mat4& world_from_object) {
    Bounds bounds;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p((corner & 1 ? object.upper : object.lower).x, (corner & 2 ? object.upper : object.lower).y,
                          (corner & 4 ? object.upper : object.lower).z);
        bounds.add(glm::vec3(world_from_object * glm::vec4(p, 1.0f)));
    }
    return bounds;
}

InstanceBlock instance_block(const Material& material, const glm::mat4& now, const glm::mat4& next, int moving_number) {
    // Inverted in double precision: scales of 1e-3 and less make the determinant tiny.
    const glm::mat3 normal_matrix(glm::transpose(glm::inverse(glm::dmat3(glm::mat3(now)))));
    InstanceBlock block{};
    block.world_from_object = now;
    for (int column = 0; column < 3; ++column) block.normal_columns[column] = glm::vec4(normal_matrix[column], 0.0f);
    block.base_colour_and_metallic = glm::vec4(material.base_colour, material.metallic);
    block.emission_and_roughness = glm::vec4(material.emission, material.roughness);
    block.alpha_cutoff = material.alpha_cutoff;
    block.alpha_channel = material.alpha_texture != no_texture ? material.alpha_channel : 3;
    block.two_sided = material.two_sided ? 1 : 0;
    block.dielectric_reflectance = material.dielectric_reflectance;
    block.next_world_from_object = next;
    block.moving_number = static_cast<std::uint32_t>(moving_number);
    return block;
}

}  // namespace

MaterialVariant variant_of(const Material& material) {
    MaterialVariant variant;
    variant.base_colour_texture = material.base_colour_texture != no_texture;
    variant.metallic_roughness_texture = material.metallic_roughness_texture != no_texture;
    variant.emission = material.is_emissive();
    variant.emission_texture = variant.emission && material.emission_texture != no_texture;
    variant.alpha_texture = material.alpha_mask && material.alpha_texture != no_texture;
    variant.alpha_mask = material.alpha_mask && (variant.alpha_texture || variant.base_colour_texture);
    return variant;
}

ShaderDefines MaterialVariant::defines() const {
    ShaderDefines defines;
    const auto add = [&](bool present, const char* name) {
        if (present) defines.emplace_back(name, "1");
    };
    add(base_colour_texture, "BASE_COLOUR_TEXTURE");
    add(metallic_roughness_texture, "METALLIC_ROUGHNESS_TEXTURE");
    add(emission, "EMISSION");
    add(emission_texture, "EMISSION_TEXTURE");
    add(alpha_mask, "ALPHA_MASK");
    add(alpha_texture, "ALPHA_TEXTURE");
    add(needs_texture_coordinates(), "TEXTURE_COORDINATES");
    return defines;
}

MaterialVariant MaterialVariant::coverage() const {
    MaterialVariant result;
    result.alpha_mask = alpha_mask;
    result.alpha_texture = alpha_texture;
    result.base_colour_texture = alpha_mask && !alpha_texture;
    return result;
}

SceneGeometry::SceneGeometry(GlContext& context, const Scene& scene)
    : context_(context), scene_(scene), moving_numbers_(moving_instance_numbers(scene)), vertex_array_(context) {
    upload_meshes();
    upload_instances();
    upload_textures();
    find_moving();
    context_.check("upload of the scene");
}

void SceneGeometry::upload_meshes() {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<MeshRange> ranges;
    for (const Mesh& mesh : scene_.meshes) {
        MeshRange range{static_cast<GLint>(vertices.size()), indices.size(), 0};
        if (mesh.normals.empty()) {
            append_with_face_normals(mesh, vertices, indices);
        } else {
            append_shared(mesh, vertices, indices);
        }
        range.index_count = static_cast<GLsizei>(indices.size() - range.first_index);
        ranges.push_back(range);
    }
    vertices_ = GlBuffer::from(context_, vertices);
    indices_ = GlBuffer::from(context_, indices);

    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
        const Instance& instance = scene_.instances[i];
        const Mesh& mesh = scene_.meshes[instance.mesh];
        const Material& material = scene_.materials[mesh.material];
        const MeshRange& range = ranges[instance.mesh];
        if (range.index_count == 0) continue;
        const MaterialVariant variant = variant_of(material);
        auto known = std::ranges::find(variants_, variant);
        if (known == variants_.end()) known = variants_.insert(variants_.end(), variant);
        SceneDraw draw;
        draw.instance = static_cast<int>(i);
        draw.material = mesh.material;
        draw.variant = static_cast<int>(known - variants_.begin());
        draw.mirrored = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f;
        draw.index_count = range.index_count;
        draw.first_index = range.first_index;
        draw.first_vertex = range.first_vertex;
        draw.bounds = draw.next_bounds = world_bounds(mesh, instance.world_from_object);
        draws_.push_back(draw);
    }
    std::ranges::stable_sort(draws_, {}, [](const SceneDraw& draw) { return std::tuple(draw.variant, draw.material); });

    const GladGLContext& gl = context_.gl;
    const GLuint array = vertex_array_.id();
    gl.VertexArrayVertexBuffer(array, 0, vertices_.id(), 0, sizeof(Vertex));
    gl.VertexArrayElementBuffer(array, indices_.id());
    const auto attribute = [&](GLuint location, GLint components, std::size_t offset) {
        gl.EnableVertexArrayAttrib(array, location);
        gl.VertexArrayAttribFormat(array, location, components, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
        gl.VertexArrayAttribBinding(array, location, 0);
    };
    attribute(0, 3, offsetof(Vertex, position));
    attribute(1, 3, offsetof(Vertex, normal));
    attribute(2, 2, offsetof(Vertex, uv));
}

void SceneGeometry::upload_instances() {
    GLint alignment = 1;
    context_.gl.GetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    const auto aligned = static_cast<std::size_t>(alignment);
    instance_stride_ = (sizeof(InstanceBlock) + aligned - 1) / aligned * aligned;
    std::vector<std::byte> bytes(instance_stride_ * scene_.instances.size());
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
        const Instance& instance = scene_.instances[i];
        const glm::mat4& pose = instance.world_from_object;
        const InstanceBlock block =
            instance_block(scene_.materials[scene_.meshes[instance.mesh].material], pose, pose, moving_numbers_[i]);
        std::copy_n(reinterpret_cast<const std::byte*>(&block), sizeof(block), &bytes[i * instance_stride_]);
    }
    instances_ = GlBuffer(context_, bytes.size(), bytes.data(), GL_DYNAMIC_STORAGE_BIT);
}

void SceneGeometry::find_moving() {
    for (std::size_t i = 0; i < draws_.size(); ++i) {
        const Instance& instance = scene_.instances[draws_[i].instance];
        if (!instance.moves()) continue;
        const glm::mat4& pose = instance.world_from_object;
        moving_.push_back({i, world_bounds(scene_.meshes[instance.mesh], glm::mat4(1.0f)), {pose, pose}});
    }
}

void SceneGeometry::move_to(const Moment& now, const Moment& previous, const Moment* next) {
    for (MovingDraw& moving : moving_) {
        SceneDraw& draw = draws_[moving.draw];
        const Instance& instance = scene_.instances[draw.instance];
        Poses poses{now.pose(instance), {}};
        poses.next = next ? next->pose(instance) : extrapolate(previous.pose(instance), poses.now);
        if (poses == moving.poses) continue;
        moving.poses = poses;
        draw.bounds = world_bounds(moving.object_bounds, poses.now);
        draw.next_bounds = world_bounds(moving.object_bounds, poses.next);
        const InstanceBlock block = instance_block(scene_.materials[draw.material], poses.now, poses.next,
                                                   moving_numbers_[static_cast<std::size_t>(draw.instance)]);
        instances_.write(static_cast<std::size_t>(draw.instance) * instance_stride_, sizeof(block), &block);
    }
}

void SceneGeometry::upload_textures() {
    for (const Texture& texture : scene_.textures) textures_.push_back(upload(context_, texture));
}

void SceneGeometry::bind_textures(const Material& material, const MaterialVariant& variant) const {
    if (variant.base_colour_texture) textures_[material.base_colour_texture].bind(0);
    if (variant.metallic_roughness_texture) textures_[material.metallic_roughness_texture].bind(1);
    if (variant.emission_texture) textures_[material.emission_texture].bind(2);
    if (variant.alpha_texture) textures_[material.alpha_texture].bind(3);
}

void SceneGeometry::bind_instance(const SceneDraw& draw) const {
    const GladGLContext& gl = context_.gl;
    gl.BindBufferRange(GL_UNIFORM_BUFFER, instance_binding, instances_.id(),
                       static_cast<GLintptr>(static_cast<std::size_t>(draw.instance) * instance_stride_),
                       sizeof(InstanceBlock));
    gl.FrontFace(draw.mirrored ? GL_CW : GL_CCW);
}

void SceneGeometry::draw(const SceneDraw& draw, int copies) const {
    bind_instance(draw);
    context_.gl.DrawElementsInstancedBaseVertex(GL_TRIANGLES, draw.index_count, GL_UNSIGNED_INT,
                                                index_offset(draw.first_index), copies, draw.first_vertex);
}

void SceneGeometry::draw_patches(const SceneDraw& draw, int most_patches) const {
    bind_instance(draw);
    for (GLsizei index = 0; index < draw.index_count; index += 3 * most_patches) {
        context_.gl.DrawElementsBaseVertex(GL_PATCHES, std::min(3 * most_patches, draw.index_count - index),
                                           GL_UNSIGNED_INT, index_offset(draw.first_index + index), draw.first_vertex);
    }
}

}  // namespace plumb
