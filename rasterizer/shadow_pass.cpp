#include "rasterizer/shadow_pass.h"

#include <cmath>
#include <span>

#include <fmt/format.h>

#include "rasterizer/cube_faces.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

constexpr const char* point_texture = "shadow.points";
constexpr const char* paraboloid_texture = "shadow.paraboloids";
constexpr const char* emitter_texture = "shadow.emitters";
constexpr const char* map_texture = "shadow.maps";

glm::mat4 clip_from_world(const ShadowCube& cube, const CubeFace& face) {
    const glm::mat3 camera_from_world = glm::transpose(face.axes());
    glm::mat4 view(camera_from_world);
    view[3] = glm::vec4(-camera_from_world * cube.position, 1.0f);
    glm::mat4 projection(0.0f);  // 90 degrees, infinite, reversed: depth = near / distance
    projection[0][0] = projection[1][1] = 1.0f;
    projection[3][2] = cube.near_plane;
    projection[2][3] = -1.0f;
    return projection * view;
}

// Sine of the angle by which each paraboloid reaches below its horizon: for lookups that are filtered across it.
constexpr float paraboloid_overlap = 0.05f;

// Vertices that a triangle with `segments` on every edge and inside is cut into, at most: rings of 3 n, 3 (n - 2)...
constexpr int patch_vertices(int segments) { return 3 * (segments / 2 + 1) * (segments / 2 + 1) + 1; }

// Radius of the horizon in a paraboloid map, whose half side is 1: two texels are left around it for filtering.
float disc_scale(int size) { return 1.0f - 4.0f / static_cast<float>(size); }

void require_layers(GlContext& context, const char* name, std::size_t layers) {
    GLint most = 0;
    context.gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
    if (layers > static_cast<std::size_t>(most)) {
        throw MethodError(
            fmt::format("{} needs {} layers, this OpenGL has {} at most; lower direct.shadow.emitter_samples, set "
                        "direct.shadow.lamps to false, or take lights out of the scene",
                        name, layers, most));
    }
}

// Lookups compare the receiver's depth with the texels and mix the four answers.
void make_comparing(const GlTexture& texture) {
    const GladGLContext& gl = texture.context().gl;
    gl.TextureParameteri(texture.id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl.TextureParameteri(texture.id(), GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
    gl.TextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

}  // namespace

ShadowPass::ShadowPass(const PassResources& resources)
    : context_(resources.context),
      scene_(resources.scene),
      settings_(resources.method.direct.shadow),
      geometry_(resources.geometry()),
      lights_(scene_, resources.method.direct),
      moving_(scene_, resources.method.direct) {
    add_cubes(resources, point_texture, lights_.point_cubes, settings_.cube_size);
    add_cubes(resources, emitter_texture, lights_.emitter_cubes, settings_.emitter_size);
    add_paraboloids(resources, lights_.point_paraboloids, settings_.paraboloid_size);
    add_maps(resources, lights_.maps, settings_.map_size);
    for (const MaterialVariant& variant : geometry_.variants()) coverage_.push_back(variant.coverage());
    find_programs(resources.programs);
}

bool ShadowPass::is_linear(Projection projection) const {
    if (projection == Projection::paraboloid) return true;
    return projection != Projection::flat && settings_.cube_distance == CubeDistance::linear;
}

void ShadowPass::find_programs(ProgramCache& programs) {
    for (const Target& target : targets_) {
        std::vector<const Program*>& list = programs_[{target.projection, target.clips()}];
        if (!list.empty()) continue;
        for (const MaterialVariant& coverage : coverage_) {
            ShaderDefines defines = coverage.defines();
            std::vector<std::string> files{"shadow.vert"};
            if (target.projection == Projection::whole_cube) files.emplace_back("shadow_cube.geom");
            if (target.projection == Projection::paraboloid) {
                files.insert(files.end(), {"shadow_paraboloid.tesc", "shadow_paraboloid.tese"});
            }
            if (files.size() > 1) defines.emplace_back("PROJECTED_LATER", "1");
            if (is_linear(target.projection)) defines.emplace_back("LINEAR_DISTANCE", "1");
            if (target.clips()) defines.emplace_back("CLIP_PLANE", "1");
            if (coverage.alpha_mask || is_linear(target.projection)) files.emplace_back("shadow.frag");
            list.push_back(&programs.get(files, defines));
        }
    }
}

void ShadowPass::add_cubes(const PassResources& resources, const std::string& name,
                           const std::vector<ShadowCube>& cubes, int size) {
    if (!resources.is_read(name)) return;
    require_layers(context_, name.c_str(), 6 * cubes.size());
    const GlTexture& texture = resources.planes.adopt(
        name, GlTexture::cube_array(context_, GL_DEPTH_COMPONENT32F, size, static_cast<int>(cubes.size())));
    make_comparing(texture);
    const bool one_pass = settings_.cube_generation == CubeGeneration::one_pass;
    if (one_pass)
        framebuffers_.emplace_back(context_, std::span<const GlAttachment>(), GlAttachment{&texture, -1}, name.c_str());
    for (std::size_t i = 0; i < cubes.size(); ++i) {
        const int first_layer = static_cast<int>(6 * i);
        const int emitter_cube = name == emitter_texture ? static_cast<int>(i) : -1;
        if (one_pass) {
            targets_.push_back({.framebuffer = framebuffers_.size() - 1,
                                .projection = Projection::whole_cube,
                                .cube = cubes[i],
                                .first_layer = first_layer,
                                .emitter_cube = emitter_cube});
            continue;
        }
        for (int face = 0; face < 6; ++face) {
            framebuffers_.emplace_back(context_, std::span<const GlAttachment>(),
                                       GlAttachment{&texture, first_layer + face}, name.c_str());
            targets_.push_back(
                {.framebuffer = framebuffers_.size() - 1,
                 .projection = Projection::cube_face,
                 .clip_from_world = clip_from_world(cubes[i], cube_faces[static_cast<std::size_t>(face)]),
                 .cube = cubes[i],
                 .face = face,
                 .emitter_cube = emitter_cube});
        }
    }
}

void ShadowPass::add_paraboloids(const PassResources& resources, const std::vector<ShadowCube>& cubes, int size) {
    if (!resources.is_read(paraboloid_texture)) return;
    require_layers(context_, paraboloid_texture, 2 * cubes.size());
    const GlTexture& texture = resources.planes.adopt(
        paraboloid_texture,
        GlTexture::array(context_, GL_DEPTH_COMPONENT32F, size, size, static_cast<int>(2 * cubes.size())));
    make_comparing(texture);
    for (std::size_t i = 0; i < cubes.size(); ++i) {
        for (int half = 0; half < 2; ++half) {
            framebuffers_.emplace_back(context_, std::span<const GlAttachment>(),
                                       GlAttachment{&texture, static_cast<int>(2 * i) + half}, paraboloid_texture);
            targets_.push_back({.framebuffer = framebuffers_.size() - 1,
                                .projection = Projection::paraboloid,
                                .cube = cubes[i],
                                .side = half == 0 ? 1.0f : -1.0f});
        }
    }
}

void ShadowPass::add_maps(const PassResources& resources, const std::vector<ShadowMap>& maps, int size) {
    if (!resources.is_read(map_texture)) return;
    require_layers(context_, map_texture, maps.size());
    const GlTexture& texture = resources.planes.adopt(
        map_texture, GlTexture::array(context_, GL_DEPTH_COMPONENT32F, size, size, static_cast<int>(maps.size())));
    make_comparing(texture);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        framebuffers_.emplace_back(context_, std::span<const GlAttachment>(),
                                   GlAttachment{&texture, static_cast<int>(i)}, map_texture);
        targets_.push_back({.framebuffer = framebuffers_.size() - 1, .clip_from_world = maps[i].clip_from_world});
    }
}

void ShadowPass::follow_emitters(const PassFrame& frame) {
    if (!moving_.move_to(frame.time, lights_)) return;
    for (Target& target : targets_) {
        if (target.emitter_cube < 0) continue;
        target.cube = lights_.emitter_cubes[static_cast<std::size_t>(target.emitter_cube)];
        if (target.projection == Projection::cube_face)
            target.clip_from_world = clip_from_world(target.cube, cube_faces[static_cast<std::size_t>(target.face)]);
    }
}

void ShadowPass::execute(const PassFrame& frame) {
    follow_emitters(frame);
    const GladGLContext& gl = context_.gl;
    constexpr float infinitely_far = 0.0f;
    for (const GlFramebuffer& framebuffer : framebuffers_) {
        gl.ClearNamedFramebufferfv(framebuffer.id(), GL_DEPTH, 0, &infinitely_far);
    }
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
    geometry_.bind();
    for (const Target& target : targets_) draw(target);
    gl.Disable(GL_DEPTH_TEST);
}

bool ShadowPass::may_see(const Target& target, const Frustum& frustum, const Bounds& box) const {
    switch (target.projection) {
        case Projection::flat:
        case Projection::cube_face:
            return frustum.may_see(box);
        case Projection::whole_cube:
            return true;
        case Projection::paraboloid: {
            // Wholly behind the horizon, and below its overlap, even at the farthest.
            const float height =
                target.side * ((target.side > 0.0f ? box.upper.z : box.lower.z) - target.cube.position.z);
            return height > -paraboloid_overlap * target.cube.range;
        }
    }
    return true;
}

void ShadowPass::set_uniforms(const Program& program, const Target& target) const {
    if (target.projection == Projection::flat || target.projection == Projection::cube_face) {
        program.set("clip_from_world", target.clip_from_world);
    } else {
        program.set("light_position", target.cube.position);
    }
    if (target.projection == Projection::cube_face && is_linear(target.projection)) {
        program.set("light_position", target.cube.position);
    }
    if (target.projection == Projection::whole_cube) {
        program.set("near_plane", target.cube.near_plane);
        program.set("first_layer", target.first_layer);
    }
    if (target.projection == Projection::paraboloid) {
        const auto size = static_cast<float>(settings_.paraboloid_size);
        program.set("side", target.side);
        program.set("overlap", paraboloid_overlap);
        program.set("disc_scale", disc_scale(settings_.paraboloid_size));
        program.set("most_segments", static_cast<float>(settings_.paraboloid_tessellation));
        program.set("segment_angle", 4.0f / std::sqrt(size));
    }
    if (is_linear(target.projection)) program.set("range", target.cube.range);
    if (target.clips()) program.set("front_plane", target.cube.front_plane);
}

void ShadowPass::draw(const Target& target) const {
    const GladGLContext& gl = context_.gl;
    framebuffers_[target.framebuffer].bind();
    const bool clips = target.clips() || target.projection == Projection::paraboloid;
    if (clips) gl.Enable(GL_CLIP_DISTANCE0);
    // Mesa's software rasterisers number the vertices that a draw's patches are cut into with 16 bits (draw_tess.c),
    // and beyond them join wrong ones.
    const int most_patches = 65536 / patch_vertices(settings_.paraboloid_tessellation);
    const std::vector<const Program*>& programs = programs_.at({target.projection, target.clips()});
    const Frustum frustum(target.clip_from_world);
    int variant = -1, material = -1;
    for (const SceneDraw& draw : geometry_.draws()) {
        if (draw.instance == target.cube.ignored_instance || !may_see(target, frustum, draw.bounds)) continue;
        if (draw.variant != variant) {
            const Program& program = *programs[draw.variant];
            program.use();
            set_uniforms(program, target);
        }
        if (draw.variant != variant || draw.material != material) {
            geometry_.bind_textures(scene_.materials[draw.material], coverage_[draw.variant]);
        }
        variant = draw.variant, material = draw.material;
        if (target.projection == Projection::paraboloid) {
            geometry_.draw_patches(draw, most_patches);
        } else {
            geometry_.draw(draw);
        }
    }
    if (clips) gl.Disable(GL_CLIP_DISTANCE0);
}

std::vector<std::string> shadow_textures(const LightSet& lights, LightKinds kinds) {
    std::vector<std::string> names;
    if (!lights.point_cubes.empty()) names.emplace_back(point_texture);
    if (!lights.point_paraboloids.empty()) names.emplace_back(paraboloid_texture);
    if (kinds == LightKinds::all && !lights.emitter_cubes.empty()) names.emplace_back(emitter_texture);
    if (!lights.maps.empty()) names.emplace_back(map_texture);
    return names;
}

ShaderDefines shadow_defines(const LightSet& lights, const ShadowSettings& settings) {
    ShaderDefines defines{{"SHADOW_BIAS", shader_literal(settings.bias)}};
    const auto add_size = [&](const char* name, bool there, int size) {
        if (there) defines.emplace_back(name, fmt::format("{}.0", size));
    };
    add_size("POINT_CUBES", !lights.point_cubes.empty(), settings.cube_size);
    add_size("POINT_PARABOLOIDS", !lights.point_paraboloids.empty(), settings.paraboloid_size);
    add_size("EMITTER_CUBES", !lights.emitter_cubes.empty(), settings.emitter_size);
    add_size("SHADOW_MAPS", !lights.maps.empty(), settings.map_size);
    if (!lights.maps.empty()) defines.emplace_back("PCF_RADIUS", fmt::format("{}", settings.pcf_radius));
    if (settings.cube_distance == CubeDistance::linear) defines.emplace_back("LINEAR_CUBES", "1");
    return defines;
}

PassDeclaration declare_shadows(const LightSet& lights, const Method& method) {
    const ShadowSettings& settings = method.direct.shadow;
    PassDeclaration pass;
    pass.name = "shadows";
    pass.outputs = shadow_textures(lights);
    pass.parameters = {{"direct.shadow.point_map", {point_texture, paraboloid_texture}},
                       {"direct.shadow.cube_generation", {point_texture, emitter_texture}},
                       {"direct.shadow.cube_distance", {point_texture, emitter_texture}},
                       {"direct.shadow.cube_size", {point_texture}},
                       {"direct.shadow.paraboloid_size", {paraboloid_texture}},
                       {"direct.shadow.paraboloid_tessellation", {paraboloid_texture}},
                       {"direct.shadow.map_size", {map_texture}},
                       {"direct.shadow.pcf_radius", {map_texture}},
                       {"direct.shadow.emitter_size", {emitter_texture}},
                       {"direct.shadow.emitter_samples", {emitter_texture}},
                       {"direct.shadow.bias"}};
    pass.create = [](const PassResources& resources) { return std::make_unique<ShadowPass>(resources); };
    struct Group {
        std::size_t count;
        const char* name;
        int size;
        double squares;  // of that size in each
    };
    const Group groups[] = {{lights.point_cubes.size(), "cube", settings.cube_size, 6.0},
                            {lights.point_paraboloids.size(), "pair of paraboloids", settings.paraboloid_size, 2.0},
                            {lights.emitter_cubes.size(), "cube of an emitter", settings.emitter_size, 6.0},
                            {lights.maps.size(), "map", settings.map_size, 1.0}};
    double texels = 0.0;
    for (const Group& group : groups) {
        if (group.count == 0) continue;
        pass.remark +=
            fmt::format("{}{} x {} of {}^2", pass.remark.empty() ? "" : ", ", group.count, group.name, group.size);
        texels += static_cast<double>(group.count) * group.squares * group.size * group.size;
    }
    if (!lights.any_shadows()) {
        pass.disabled = lights.empty() ? "the scene has no lights that cast shadows" : "direct.shadow.lamps is false";
        return pass;
    }
    constexpr double most_bytes = 2.0 * 1024 * 1024 * 1024;
    if (4.0 * texels > most_bytes) {
        throw MethodError(
            fmt::format("method '{}': the shadow maps ({}) take {:.1f} GiB, more than 2; lower "
                        "direct.shadow.cube_size, paraboloid_size, emitter_size, emitter_samples or map_size, or set "
                        "direct.shadow.lamps to false",
                        method.name, pass.remark, 4.0 * texels / (1024.0 * 1024 * 1024)));
    }
    return pass;
}

}  // namespace plumb
