#include "rasterizer/shadow_pass.h"

#include <array>

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

constexpr const char* point_texture = "shadow.points";
constexpr const char* emitter_texture = "shadow.emitters";
constexpr const char* map_texture = "shadow.maps";

// Where OpenGL's cube faces look, and which way is up on them.
constexpr std::array<std::pair<glm::vec3, glm::vec3>, 6> cube_faces{{{{1, 0, 0}, {0, -1, 0}},
                                                                     {{-1, 0, 0}, {0, -1, 0}},
                                                                     {{0, 1, 0}, {0, 0, 1}},
                                                                     {{0, -1, 0}, {0, 0, -1}},
                                                                     {{0, 0, 1}, {0, -1, 0}},
                                                                     {{0, 0, -1}, {0, -1, 0}}}};

glm::mat4 clip_from_world(const ShadowCube& cube, int face) {
    const auto& [forward, up] = cube_faces[static_cast<std::size_t>(face)];
    const glm::mat3 axes(glm::cross(forward, up), up, -forward);
    glm::mat4 view(glm::transpose(axes));
    view[3] = glm::vec4(-glm::transpose(axes) * cube.position, 1.0f);
    glm::mat4 projection(0.0f);  // 90 degrees, infinite, reversed: depth = near / distance
    projection[0][0] = projection[1][1] = 1.0f;
    projection[3][2] = cube.near_plane;
    projection[2][3] = -1.0f;
    return projection * view;
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
    : context_(resources.context), scene_(resources.scene), geometry_(resources.geometry()) {
    const ShadowSettings& settings = resources.method.direct.shadow;
    const LightSet lights(scene_, settings);
    add_cubes(resources.planes, point_texture, lights.point_cubes, settings.cube_size);
    add_cubes(resources.planes, emitter_texture, lights.emitter_cubes, settings.emitter_size);
    add_maps(resources.planes, lights.maps, settings.map_size);

    bool any_clips = false;
    for (const Target& target : targets_) any_clips = any_clips || target.clips;
    for (const MaterialVariant& variant : geometry_.variants()) {
        const MaterialVariant coverage = variant.coverage();
        coverage_.push_back(coverage);
        std::vector<std::string> files{"shadow.vert"};
        if (coverage.alpha_mask) files.emplace_back("shadow.frag");
        ShaderDefines defines = coverage.defines();
        programs_.push_back(&resources.programs.get(files, defines));
        if (!any_clips) continue;
        defines.emplace_back("CLIP_PLANE", "1");
        clipping_programs_.push_back(&resources.programs.get(files, defines));
    }
}

void ShadowPass::add_cubes(PlaneTextures& planes, const std::string& name, const std::vector<ShadowCube>& cubes,
                           int size) {
    if (cubes.empty()) return;
    const GlTexture& texture = planes.adopt(
        name, GlTexture::cube_array(context_, GL_DEPTH_COMPONENT32F, size, static_cast<int>(cubes.size())));
    make_comparing(texture);
    for (std::size_t i = 0; i < cubes.size(); ++i) {
        const ShadowCube& cube = cubes[i];
        for (int face = 0; face < 6; ++face) {
            targets_.push_back({GlFramebuffer(context_, {}, {&texture, static_cast<int>(6 * i) + face}, name.c_str()),
                                clip_from_world(cube, face), cube.ignored_instance, cube.front_plane,
                                glm::vec3(cube.front_plane) != glm::vec3(0.0f)});
        }
    }
}

void ShadowPass::add_maps(PlaneTextures& planes, const std::vector<ShadowMap>& maps, int size) {
    if (maps.empty()) return;
    const GlTexture& texture = planes.adopt(
        map_texture, GlTexture::array(context_, GL_DEPTH_COMPONENT32F, size, size, static_cast<int>(maps.size())));
    make_comparing(texture);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        targets_.push_back({GlFramebuffer(context_, {}, {&texture, static_cast<int>(i)}, map_texture),
                            maps[i].clip_from_world,
                            -1,
                            {0.0f, 0.0f, 0.0f, 1.0f},
                            false});
    }
}

void ShadowPass::execute(const PassFrame&) {
    const GladGLContext& gl = context_.gl;
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
    geometry_.bind();
    for (const Target& target : targets_) draw(target);
    gl.Disable(GL_DEPTH_TEST);
}

void ShadowPass::draw(const Target& target) {
    const GladGLContext& gl = context_.gl;
    constexpr float infinitely_far = 0.0f;
    target.framebuffer.bind();
    gl.ClearNamedFramebufferfv(target.framebuffer.id(), GL_DEPTH, 0, &infinitely_far);
    if (target.clips) gl.Enable(GL_CLIP_DISTANCE0);
    const Frustum frustum(target.clip_from_world);
    int variant = -1, material = -1;
    for (const SceneDraw& draw : geometry_.draws()) {
        if (draw.instance == target.ignored_instance || !frustum.may_see(draw.bounds)) continue;
        if (draw.variant != variant) {
            const Program& program = *(target.clips ? clipping_programs_ : programs_)[draw.variant];
            program.use();
            program.set("clip_from_world", target.clip_from_world);
            if (target.clips) program.set("front_plane", target.front_plane);
        }
        if (draw.variant != variant || draw.material != material) {
            geometry_.bind_textures(scene_.materials[draw.material], coverage_[draw.variant]);
        }
        variant = draw.variant, material = draw.material;
        geometry_.draw(draw);
    }
    if (target.clips) gl.Disable(GL_CLIP_DISTANCE0);
}

std::vector<std::string> shadow_textures(const LightSet& lights) {
    std::vector<std::string> names;
    if (!lights.point_cubes.empty()) names.emplace_back(point_texture);
    if (!lights.emitter_cubes.empty()) names.emplace_back(emitter_texture);
    if (!lights.maps.empty()) names.emplace_back(map_texture);
    return names;
}

PassDeclaration declare_shadows(const LightSet& lights, const Method& method) {
    const ShadowSettings& settings = method.direct.shadow;
    PassDeclaration pass;
    pass.name = "shadows";
    pass.outputs = shadow_textures(lights);
    pass.create = [](const PassResources& resources) { return std::make_unique<ShadowPass>(resources); };
    pass.remark =
        fmt::format("{} cubes of {}^2, {} of {}^2, {} maps of {}^2", lights.point_cubes.size(), settings.cube_size,
                    lights.emitter_cubes.size(), settings.emitter_size, lights.maps.size(), settings.map_size);
    if (lights.empty()) {
        pass.disabled = "the scene has no lights that cast shadows";
        return pass;
    }
    const double texels =
        6.0 * static_cast<double>(lights.point_cubes.size()) * settings.cube_size * settings.cube_size +
        6.0 * static_cast<double>(lights.emitter_cubes.size()) * settings.emitter_size * settings.emitter_size +
        1.0 * static_cast<double>(lights.maps.size()) * settings.map_size * settings.map_size;
    constexpr double most_bytes = 2.0 * 1024 * 1024 * 1024;
    if (4.0 * texels > most_bytes) {
        throw MethodError(
            fmt::format("method '{}': the shadow maps ({}) take {:.1f} GiB, more than 2; lower "
                        "direct.shadow.cube_size, emitter_size, emitter_samples or map_size",
                        method.name, pass.remark, 4.0 * texels / (1024.0 * 1024 * 1024)));
    }
    return pass;
}

}  // namespace plumb
