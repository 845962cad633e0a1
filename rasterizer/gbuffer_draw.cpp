#include "rasterizer/gbuffer_draw.h"

#include <algorithm>
#include <array>
#include <limits>

#include "rasterizer/specular_albedo_texture.h"

namespace plumb {
namespace {

constexpr GLuint specular_albedo_unit = SceneGeometry::first_free_texture_unit + 1;  // the comparison's is the first

}  // namespace

DepthTest::DepthTest(DepthMapping mapping)
    : farthest(mapping == DepthMapping::reversed ? 0.0f : 1.0f),
      nearer(mapping == DepthMapping::reversed ? GL_GREATER : GL_LESS) {
    if (mapping == DepthMapping::standard) defines.emplace_back("STANDARD_DEPTH", "1");
}

void clear_gbuffer(const GlFramebuffer& target, const DepthTest& test) {
    const GladGLContext& gl = target.context().gl;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr std::array<float, 4> nothing{}, infinitely_far{infinity, infinity, infinity, infinity};
    constexpr std::array<GLuint, 4> no_number{};
    target.bind();
    GLint location = 0;
    for (const GLenum format : target.colour_formats()) {
        if (holds_integers(format)) {
            gl.ClearNamedFramebufferuiv(target.id(), GL_COLOR, location, no_number.data());
        } else {
            gl.ClearNamedFramebufferfv(target.id(), GL_COLOR, location,
                                       location == 0 ? infinitely_far.data() : nothing.data());
        }
        ++location;
    }
    gl.ClearNamedFramebufferfv(target.id(), GL_DEPTH, 0, &test.farthest);
}

GBufferDraw::GBufferDraw(const PassResources& resources, const std::vector<std::string>& files,
                         const ShaderDefines& defines)
    : scene_(resources.scene), geometry_(resources.geometry()) {
    const DepthTest test(resources.method.gbuffer.depth_mapping);
    ShaderDefines of_table;
    if (std::ranges::any_of(defines, [](const auto& define) { return define.first == "WRITE_DIFFUSE_ALBEDO"; })) {
        specular_albedo_ = &specular_albedo_table(resources.context, resources.planes);
        of_table = SpecularAlbedoTexture::defines(specular_albedo_unit);
    }
    for (const MaterialVariant& variant : geometry_.variants()) {
        ShaderDefines all = defines;
        for (const auto& define : variant.defines()) all.push_back(define);
        for (const auto& define : test.defines) all.push_back(define);
        for (const auto& define : of_table) all.push_back(define);
        if (geometry_.anything_moves()) all.emplace_back("MOVING", "1");
        programs_.push_back(&resources.programs.get(files, all));
    }
}

void GBufferDraw::draw(const Frustum& frustum, const Frustum* next, int copies) const {
    geometry_.bind();
    if (specular_albedo_) specular_albedo_->bind(specular_albedo_unit);
    int variant = -1, material = -1;
    for (const SceneDraw& draw : geometry_.draws()) {
        if (!frustum.may_see(draw.bounds) && !(next && next->may_see(draw.next_bounds))) continue;
        if (draw.variant != variant) programs_[draw.variant]->use();
        if (draw.variant != variant || draw.material != material) {
            geometry_.bind_textures(scene_.materials[draw.material], geometry_.variants()[draw.variant]);
        }
        variant = draw.variant, material = draw.material;
        geometry_.draw(draw, copies);
    }
}

BackgroundDraw::BackgroundDraw(const PassResources& resources, const GlTexture& depth_buffer)
    : context_(resources.context), test_(resources.method.gbuffer.depth_mapping) {
    if (!resources.is_read("emission") || resources.scene.environment.is_black()) return;
    environment_.emplace(context_, resources.scene);
    draw_.emplace(context_, resources.programs, "background.frag", environment_->radiance_defines(0));
    target_ = GlFramebuffer(context_, std::array{GlAttachment{&resources.planes.get("emission")}},
                            GlAttachment{&depth_buffer}, "gbuffer background");
}

void BackgroundDraw::draw() const {
    if (!draw_) return;
    const GladGLContext& gl = context_.gl;
    // The triangle lies infinitely far away: equal only where nothing was drawn.
    gl.DepthFunc(GL_EQUAL);
    gl.DepthRangef(test_.farthest, test_.farthest);
    gl.DepthMask(GL_FALSE);
    environment_->set_radiance(draw_->program(), 0);
    draw_->draw(target_);
    gl.DepthMask(GL_TRUE);
    gl.DepthRangef(0.0f, 1.0f);
}

}  // namespace plumb
