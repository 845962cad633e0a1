#include "rasterizer/gbuffer_pass.h"

#include <array>
#include <limits>

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

// The shared hardware depth buffer; not a plane that a pass could read.
constexpr std::string_view depth_buffer_name = "gbuffer.depth_buffer";

constexpr std::array<std::pair<const char*, GLenum>, 5> plane_formats{{{"depth", GL_R32F},
                                                                       {"normal", GL_RG16},
                                                                       {"albedo", GL_RGBA16F},
                                                                       {"emission", GL_RGBA16F},
                                                                       {"displacement", GL_RGBA32F}}};

std::string layer_name(const char* plane, int layer) {
    return layer == 0 ? plane : std::string(second_layer_prefix) + plane;
}

std::vector<std::string> outputs(int layer) {
    std::vector<std::string> names;
    names.reserve(plane_formats.size());
    for (const auto& [plane, format] : plane_formats) names.push_back(layer_name(plane, layer));
    return names;
}

}  // namespace

GBufferPass::GBufferPass(const PassResources& resources, int layer)
    : context_(resources.context), scene_(resources.scene), geometry_(resources.geometry()), layer_(layer) {
    if (layer == 0) create_planes(resources);
    first_depth_ = &resources.planes.get("depth");
    depth_buffer_ = &resources.planes.get(depth_buffer_name);
    create_targets(resources);
}

void GBufferPass::create_planes(const PassResources& resources) {
    PlaneTextures& planes = resources.planes;
    // Depth is attached whatever else is; its second layer exists where the second layer's pass runs at all.
    int layers = 1;
    for (const std::string& plane : outputs(1)) layers = resources.is_read(plane) ? 2 : layers;
    for (const auto& [plane, format] : plane_formats) {
        if (format == GL_R32F) {
            planes.create(plane, format, layers);
        } else if (resources.is_read(plane) || resources.layers_of(plane) == 2) {
            planes.create(plane, format, resources.layers_of(plane));
        }
    }
    planes.adopt(std::string(depth_buffer_name),
                 GlTexture::flat(context_, GL_DEPTH_COMPONENT32F, planes.width(), planes.height()));
}

void GBufferPass::create_targets(const PassResources& resources) {
    std::vector<GlAttachment> colours;
    ShaderDefines defines;
    for (const auto& [plane, switch_name] :
         {std::pair{"depth", ""}, std::pair{"normal", "WRITE_NORMAL"}, std::pair{"albedo", "WRITE_ALBEDO"},
          std::pair{"emission", "WRITE_EMISSION"}, std::pair{"displacement", "WRITE_DISPLACEMENT"}}) {
        const bool is_depth = std::string_view(plane) == "depth";
        if (!is_depth && !resources.is_read(layer_name(plane, layer_))) continue;
        if (!is_depth) defines.emplace_back(switch_name, fmt::format("{}", colours.size()));
        colours.push_back({&resources.planes.get(plane), layer_});
    }
    if (resources.is_read(layer_name("displacement", layer_))) defines.emplace_back("DISPLACEMENT", "1");
    target_planes_ = static_cast<GLint>(colours.size());
    const GlAttachment depth{depth_buffer_};
    target_ = GlFramebuffer(context_, colours, depth, layer_ == 0 ? "gbuffer" : "gbuffer.layer2");
    if (layer_ == 1) defines.emplace_back("PEEL", "1");
    for (const MaterialVariant& variant : geometry_.variants()) {
        ShaderDefines all = defines;
        for (auto& define : variant.defines()) all.push_back(std::move(define));
        const Program& program = resources.programs.get({"gbuffer.vert", "gbuffer.frag"}, all);
        if (layer_ == 1) program.set("minimum_separation", resources.method.gbuffer.minimum_separation);
        programs_.push_back(&program);
    }
    if (layer_ == 0 && resources.is_read("emission") && !scene_.environment.is_black()) {
        environment_.emplace(context_, scene_);
        background_.emplace(context_, resources.programs, "background.frag", environment_->radiance_defines(0));
        background_target_ = GlFramebuffer(context_, std::array{colours.back()}, depth, "gbuffer background");
    }
}

void GBufferPass::execute(const PassFrame& frame) {
    const GladGLContext& gl = context_.gl;
    constexpr std::array<float, 4> nothing{};
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr std::array<float, 4> infinitely_far{infinity, infinity, infinity, infinity};
    target_.bind();
    for (GLint i = 0; i < target_planes_; ++i) {
        gl.ClearNamedFramebufferfv(target_.id(), GL_COLOR, i, i == 0 ? infinitely_far.data() : nothing.data());
    }
    gl.ClearNamedFramebufferfv(target_.id(), GL_DEPTH, 0, nothing.data());

    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_GREATER);
    draw_scene(Frustum(frame.view.clip_from_camera() * frame.view.camera_from_world()));
    if (background_) draw_background();
    gl.Disable(GL_DEPTH_TEST);
}

void GBufferPass::draw_scene(const Frustum& frustum) const {
    geometry_.bind();
    if (layer_ == 1) first_depth_->bind(SceneGeometry::first_free_texture_unit);
    int variant = -1, material = -1;
    for (const SceneDraw& draw : geometry_.draws()) {
        if (!frustum.may_see(draw.bounds)) continue;
        if (draw.variant != variant) programs_[draw.variant]->use();
        if (draw.variant != variant || draw.material != material) {
            geometry_.bind_textures(scene_.materials[draw.material], geometry_.variants()[draw.variant]);
        }
        variant = draw.variant, material = draw.material;
        geometry_.draw(draw);
    }
}

void GBufferPass::draw_background() const {
    // The triangle lies at depth 0, infinitely far: equal only where nothing was drawn.
    context_.gl.DepthFunc(GL_GEQUAL);
    context_.gl.DepthMask(GL_FALSE);
    environment_->set_radiance(background_->program(), 0);
    background_->draw(background_target_);
    context_.gl.DepthMask(GL_TRUE);
}

PassDeclaration declare_gbuffer(const Scene& scene, const Method& method) {
    PassDeclaration pass;
    pass.name = "gbuffer";
    pass.outputs = outputs(0);
    pass.create = [](const PassResources& resources) { return std::make_unique<GBufferPass>(resources, 0); };
    if (method.gbuffer.source == SourceOfStage::truth) pass.disabled = "gbuffer.source is \"truth\"";
    pass.remark = fmt::format("{} triangles in {} instances", scene.triangle_count(), scene.instances.size());
    return pass;
}

PassDeclaration declare_second_layer(const Method& method) {
    PassDeclaration pass;
    pass.name = "gbuffer.layer2";
    pass.inputs = {"depth"};
    pass.outputs = outputs(1);
    pass.create = [](const PassResources& resources) { return std::make_unique<GBufferPass>(resources, 1); };
    if (method.gbuffer.source == SourceOfStage::truth) {
        pass.disabled = "gbuffer.source is \"truth\"";
    } else if (method.gbuffer.layers < 2) {
        pass.disabled = "gbuffer.layers is 1";
    }
    pass.remark = fmt::format("peeled {} m behind the first layer", method.gbuffer.minimum_separation);
    return pass;
}

}  // namespace plumb
