#include "rasterizer/light_volume_pass.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "rasterizer/frustum.h"
#include "rasterizer/shadow_pass.h"

namespace plumb {
namespace {

// Texture units of lit_surface.glsl.
constexpr GLuint volume_depth_unit = 0, volume_normal_unit = 1;
// A hardware depth buffer; not a plane that a pass could read. Both layers use it in turn.
constexpr const char* depth_stencil_name = "light_volumes.depth_stencil";

constexpr int sphere_subdivisions = 1;  // 80 triangles, 6 % more pixels than the sphere itself
constexpr int cone_sides = 16;

std::string plane_name(int layer) { return layer_prefix(layer) + "local_irradiance"; }

float extent_of(const VolumeMesh& mesh) {
    float extent = 0.0f;
    for (const glm::vec3& p : mesh.positions) extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return extent;
}

}  // namespace

LightVolumePass::LightVolumePass(const PassResources& resources, int layer, bool counts_fragments)
    : context_(resources.context),
      layer_(layer),
      uses_stencil_(resources.method.direct.local_lights == LocalLights::volume_stencil),
      faces_(uses_stencil_ ? VolumeFaces::back : resources.method.direct.volume_faces),
      lights_(resources, LightKinds::lamps),
      vertex_array_(context_),
      depth_(resources.planes.get("depth")),
      normal_(resources.planes.get("normal")) {
    const DirectSettings& direct = resources.method.direct;
    upload(LightVolumes(resources.scene, direct.volume_threshold, direct.volume_radius), resources.programs,
           lights_.shadow_defines(), counts_fragments);
    if (uses_stencil_) {
        stencil_program_ = &resources.programs.get({"light_volume.vert", "light_volume_stencil.frag"});
        depth_draw_.emplace(context_, resources.programs, "light_volume_depth.frag");
    }
    create_targets(resources.planes, resources.layers_of("local_irradiance"));
    if (counts_fragments) {
        fragment_counter_ = GlBuffer(context_, sizeof(GLuint), nullptr, GL_DYNAMIC_STORAGE_BIT);
    }
}

void LightVolumePass::upload(const LightVolumes& volumes, ProgramCache& programs, const ShaderDefines& shadows,
                             bool counts_fragments) {
    const VolumeMesh sphere = enclosing_sphere(sphere_subdivisions), cone = enclosing_cone(cone_sides);
    std::vector<glm::vec3> positions = sphere.positions;
    positions.insert(positions.end(), cone.positions.begin(), cone.positions.end());
    std::vector<std::uint32_t> indices = sphere.indices;
    indices.insert(indices.end(), cone.indices.begin(), cone.indices.end());
    std::vector<LightVolume> instances;
    const auto add_group = [&](const char* kind, std::size_t count, const VolumeMesh& mesh,
                               const std::vector<LightVolume>& group_volumes) {
        if (group_volumes.empty()) return;
        ShaderDefines defines = shadows;
        defines.emplace_back(kind, fmt::format("{}", count));
        if (counts_fragments) defines.emplace_back("COUNT_FRAGMENTS", "1");
        const bool is_cone = &mesh == &cone;
        Group& group = groups_.emplace_back(Group{&programs.get({"light_volume.vert", "light_volume.frag"}, defines),
                                                  static_cast<GLsizei>(mesh.indices.size()),
                                                  is_cone ? sphere.indices.size() : 0,
                                                  is_cone ? static_cast<GLint>(sphere.positions.size()) : 0,
                                                  static_cast<GLuint>(instances.size()),
                                                  {}});
        for (const LightVolume& volume : group_volumes) {
            group.bounds.push_back(volume_bounds(volume, extent_of(mesh)));
        }
        instances.insert(instances.end(), group_volumes.begin(), group_volumes.end());
    };
    add_group("POINT_LIGHTS", lights_.lights().points.size(), sphere, volumes.point_spheres);
    add_group("SPOT_LIGHTS", lights_.lights().spots.size(), sphere, volumes.spot_spheres);
    add_group("SPOT_LIGHTS", lights_.lights().spots.size(), cone, volumes.spot_cones);
    mesh_vertices_ = GlBuffer::from(context_, positions);
    mesh_indices_ = GlBuffer::from(context_, indices);
    instances_ = GlBuffer::from(context_, instances);

    const GladGLContext& gl = context_.gl;
    const GLuint array = vertex_array_.id();
    gl.VertexArrayVertexBuffer(array, 0, mesh_vertices_.id(), 0, sizeof(glm::vec3));
    gl.VertexArrayVertexBuffer(array, 1, instances_.id(), 0, sizeof(LightVolume));
    gl.VertexArrayElementBuffer(array, mesh_indices_.id());
    gl.VertexArrayBindingDivisor(array, 1, 1);
    for (GLuint location = 0; location <= 5; ++location) {
        gl.EnableVertexArrayAttrib(array, location);
        gl.VertexArrayAttribBinding(array, location, location == 0 ? 0 : 1);
    }
    gl.VertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
    for (GLuint column = 0; column < 4; ++column) {
        gl.VertexArrayAttribFormat(array, 1 + column, 4, GL_FLOAT, GL_FALSE, column * sizeof(glm::vec4));
    }
    gl.VertexArrayAttribIFormat(array, 5, 1, GL_INT, offsetof(LightVolume, light));
}

void LightVolumePass::create_targets(PlaneTextures& planes, int layers) {
    if (!planes.has("local_irradiance")) planes.create("local_irradiance", GL_RGBA32F, layers);
    GlAttachment depth_stencil;
    if (uses_stencil_) {
        if (!planes.has(depth_stencil_name)) {
            planes.adopt(depth_stencil_name,
                         GlTexture::flat(context_, GL_DEPTH32F_STENCIL8, planes.width(), planes.height()));
        }
        depth_stencil.texture = &planes.get(depth_stencil_name);
    }
    target_ = GlFramebuffer(context_, std::array{GlAttachment{&planes.get("local_irradiance"), layer_}}, depth_stencil,
                            "light volumes");
}

void LightVolumePass::execute(const PassFrame& frame) {
    const GladGLContext& gl = context_.gl;
    constexpr std::array<float, 4> nothing{};
    gl.ClearNamedFramebufferfv(target_.id(), GL_COLOR, 0, nothing.data());
    if (fragment_counter_.id() != 0) {
        constexpr GLuint zero = 0;
        fragment_counter_.write(0, sizeof(zero), &zero);
        fragment_counter_.bind(GL_ATOMIC_COUNTER_BUFFER, 0);
    }
    depth_.bind(volume_depth_unit);
    normal_.bind(volume_normal_unit);
    lights_.bind();
    for (const Group& group : groups_) group.program->set("layer", layer_);
    if (uses_stencil_) draw_depth();

    target_.bind();
    vertex_array_.bind();
    gl.BlendEquation(GL_FUNC_ADD);
    gl.BlendFunc(GL_ONE, GL_ONE);
    gl.Enable(GL_BLEND);
    if (faces_ != VolumeFaces::both) gl.Enable(GL_CULL_FACE);
    gl.FrontFace(GL_CCW);
    gl.CullFace(faces_ == VolumeFaces::front ? GL_BACK : GL_FRONT);
    gl.Enable(GL_DEPTH_CLAMP);  // a volume may reach through the near plane
    if (uses_stencil_) {
        draw_by_stencil(Frustum(frame.view.clip_from_camera() * frame.view.camera_from_world()));
    } else {
        draw_whole_groups();
    }
    gl.Disable(GL_DEPTH_CLAMP);
    gl.Disable(GL_CULL_FACE);
    gl.Disable(GL_BLEND);
}

void LightVolumePass::draw_depth() const {
    const GladGLContext& gl = context_.gl;
    gl.ClearNamedFramebufferfi(target_.id(), GL_DEPTH_STENCIL, 0, 0.0f, 0);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_ALWAYS);
    gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    depth_draw_->program().set("layer", layer_);
    depth_draw_->draw(target_);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.Disable(GL_DEPTH_TEST);
}

void LightVolumePass::draw_instances(const Group& group, std::size_t first, std::size_t count) const {
    // OpenGL takes the offset into the bound buffer in the place of a pointer.
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* offset = reinterpret_cast<const void*>(group.first_index * sizeof(std::uint32_t));
    context_.gl.DrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLES, group.index_count, GL_UNSIGNED_INT, offset,
                                                            static_cast<GLsizei>(count), group.first_vertex,
                                                            group.first_instance + static_cast<GLuint>(first));
}

void LightVolumePass::draw_whole_groups() const {
    for (const Group& group : groups_) {
        group.program->use();
        draw_instances(group, 0, group.bounds.size());
    }
}

void LightVolumePass::draw_by_stencil(const Frustum& frustum) const {
    const GladGLContext& gl = context_.gl;
    gl.Enable(GL_STENCIL_TEST);
    gl.DepthMask(GL_FALSE);
    gl.DepthFunc(GL_GREATER);  // reversed: fails for what lies behind the surface
    for (const Group& group : groups_) {
        for (std::size_t i = 0; i < group.bounds.size(); ++i) {
            if (!frustum.may_see(group.bounds[i])) continue;
            gl.Enable(GL_DEPTH_TEST);
            gl.Disable(GL_CULL_FACE);
            gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
            gl.StencilFunc(GL_ALWAYS, 0, 0xff);
            gl.StencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
            gl.StencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
            stencil_program_->use();
            draw_instances(group, i, 1);

            gl.Disable(GL_DEPTH_TEST);
            gl.Enable(GL_CULL_FACE);
            gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
            gl.StencilFunc(GL_NOTEQUAL, 0, 0xff);
            gl.StencilOp(GL_KEEP, GL_ZERO, GL_ZERO);
            group.program->use();
            draw_instances(group, i, 1);
        }
    }
    gl.DepthMask(GL_TRUE);
    gl.Disable(GL_STENCIL_TEST);
}

std::uint64_t LightVolumePass::fragments_shaded() const {
    GLuint count = 0;
    context_.gl.GetNamedBufferSubData(fragment_counter_.id(), 0, sizeof(count), &count);
    return count;
}

bool uses_light_volumes(const Scene& scene, const Method& method) {
    return method.direct.local_lights != LocalLights::fullscreen &&
           !(scene.point_lights.empty() && scene.spot_lights.empty());
}

PassDeclaration declare_light_volumes(const Scene& scene, const LightSet& lights, const Method& method, int layer) {
    const std::string prefix = layer_prefix(layer);
    PassDeclaration pass;
    pass.name = layer == 0 ? "light volumes" : "light volumes.layer2";
    pass.inputs = {prefix + "depth", prefix + "normal"};
    for (std::string& texture : shadow_textures(lights, LightKinds::lamps)) pass.inputs.push_back(std::move(texture));
    pass.outputs = {plane_name(layer)};
    pass.parameters = {{"direct.volume_threshold"}, {"direct.volume_radius"}, {"direct.volume_faces"}};
    pass.create = [layer](const PassResources& resources) {
        return std::make_unique<LightVolumePass>(resources, layer);
    };
    pass.remark = fmt::format("{} point and {} spot lights down to {} W/m^2{}", scene.point_lights.size(),
                              scene.spot_lights.size(), method.direct.volume_threshold,
                              method.direct.local_lights == LocalLights::volume_stencil ? ", by stencil" : "");
    if (method.direct.local_lights == LocalLights::fullscreen) {
        pass.disabled = "direct.local_lights is \"fullscreen\"";
    } else if (!uses_light_volumes(scene, method)) {
        pass.disabled = "the scene has no point or spot lights";
    } else if (layer == 0 && method.direct.source == SourceOfStage::truth) {
        pass.disabled = "direct.source is \"truth\"";
    } else if (layer == 1 && method.gbuffer.layers < 2) {
        pass.disabled = "gbuffer.layers is 1";
    }
    return pass;
}

}  // namespace plumb
