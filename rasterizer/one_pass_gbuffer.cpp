#include "rasterizer/one_pass_gbuffer.h"

#include <array>

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

constexpr std::string_view layer_extension = "GL_ARB_shader_viewport_layer_array";

std::vector<std::string> shader_files(LayerSelection selection) {
    if (selection == LayerSelection::vertex_shader) return {"gbuffer.vert", "gbuffer.frag"};
    return {"gbuffer.vert", "gbuffer.geom", "gbuffer.frag"};
}

}  // namespace

std::string_view to_string(LayerGeneration generation) {
    constexpr std::array<std::string_view, 5> names{"peel", "delay", "previous", "predict", "reproject"};
    return names.at(static_cast<std::size_t>(generation));
}

OnePassGBuffer::OnePassGBuffer(const PassResources& resources)
    : context_(resources.context),
      settings_(resources.method.gbuffer),
      test_(settings_.depth_mapping),
      depth_(create_planes(resources)),
      history_(resources.planes.create_history("depth", std::string(gbuffer_history))),
      buffer_(resources.planes.create(std::string(gbuffer_depth_buffer), GL_DEPTH_COMPONENT32F, layer_count())),
      targets_(gbuffer_targets(resources, depth_, -1)),
      draw_(resources, shader_files(settings_.layer_selection), defines()),
      comparison_draw_(resources, {"gbuffer.vert", "gbuffer.frag"}, {}),
      background_(resources, buffer_),
      layers_target_(context_, targets_.colours, GlAttachment{&buffer_, -1}, "gbuffer"),
      comparison_target_(context_, std::array{GlAttachment{&history_.before(), comparison_layer()}},
                         GlAttachment{&buffer_, comparison_layer()}, "gbuffer comparison") {}

bool OnePassGBuffer::looks_ahead() const {
    return settings_.generation == LayerGeneration::delay || settings_.generation == LayerGeneration::predict;
}

const GlTexture& OnePassGBuffer::create_planes(const PassResources& resources) const {
    if (settings_.layer_selection == LayerSelection::vertex_shader && !context_.info().has_extension(layer_extension)) {
        throw GlError(
            fmt::format("gbuffer.layer_selection is \"vertex_shader\", but this OpenGL ({}) lacks {}; set it to "
                        "\"geometry_shader\"",
                        context_.info().renderer, layer_extension));
    }
    return create_gbuffer_planes(resources, layer_count(), layer_count());
}

ShaderDefines OnePassGBuffer::defines() const {
    ShaderDefines defines = targets_.defines;
    defines.emplace_back("LAYERS_AT_ONCE", fmt::format("{}", layer_count()));
    defines.emplace_back("COMPARISON_LAYER", fmt::format("{}", comparison_layer()));
    if (settings_.layer_selection == LayerSelection::vertex_shader) defines.emplace_back("LAYER_OF_INSTANCE", "1");
    if (settings_.generation == LayerGeneration::reproject) defines.emplace_back("REPROJECT", "1");
    return defines;
}

void OnePassGBuffer::execute(const PassFrame& frame) {
    const GladGLContext& gl = context_.gl;
    history_.trade_places();
    const Frustum frustum(frame.view.clip_from_camera() * frame.view.camera_from_world());
    const Frustum next(frame.next->clip_from_camera() * frame.next->camera_from_world());
    const bool has_history = settings_.generation == LayerGeneration::delay ? frame.foretold : frame.continues;

    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(test_.nearer);
    if (!has_history) draw_comparison(frustum);
    clear_gbuffer(layers_target_, test_);
    history_.before().bind(SceneGeometry::first_free_texture_unit);
    draw_.set("minimum_separation", separation_in_metres(settings_, frame.view.camera()));
    if (settings_.generation == LayerGeneration::reproject) draw_.set("follow_motion", has_history ? 1 : 0);
    const bool instanced = settings_.layer_selection == LayerSelection::vertex_shader;
    draw_.draw(frustum, looks_ahead() ? &next : nullptr, instanced ? layer_count() : 1);
    background_.draw();
    gl.Disable(GL_DEPTH_TEST);
}

void OnePassGBuffer::draw_comparison(const Frustum& frustum) const {
    clear_gbuffer(comparison_target_, test_);
    comparison_draw_.draw(frustum);
}

}  // namespace plumb
