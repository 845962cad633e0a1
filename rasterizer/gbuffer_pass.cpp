#include "rasterizer/gbuffer_pass.h"

#include <algorithm>

#include <fmt/format.h>

#include "rasterizer/one_pass_gbuffer.h"

namespace plumb {
namespace {

ShaderDefines peeling_defines(const GBufferTargets& targets, int layer) {
    ShaderDefines defines = targets.defines;
    if (layer > 0) defines.emplace_back("COMPARISON_LAYER", fmt::format("{}", layer - 1));
    return defines;
}

std::string pass_name(int layer) { return layer == 0 ? "gbuffer" : fmt::format("gbuffer.layer{}", layer + 1); }

}  // namespace

const GlTexture& GBufferPass::depth_buffer(const PassResources& resources, int layer) {
    PlaneTextures& planes = resources.planes;
    if (layer > 0) return planes.get(gbuffer_depth_buffer);
    int layers = 1;
    for (const std::string& plane : gbuffer_outputs(resources.method, 0))
        layers = std::max(layers, resources.layers_of(plane));
    create_gbuffer_planes(resources, layers, 1);
    if (any_layer_is_read(resources, gbuffer_history)) planes.create_history("depth", std::string(gbuffer_history));
    return planes.adopt(std::string(gbuffer_depth_buffer),
                        GlTexture::flat(resources.context, GL_DEPTH_COMPONENT32F, planes.width(), planes.height()));
}

GBufferPass::GBufferPass(const PassResources& resources, int layer)
    : context_(resources.context),
      settings_(resources.method.gbuffer),
      layer_(layer),
      test_(settings_.depth_mapping),
      depth_buffer_(depth_buffer(resources, layer)),
      depth_(resources.planes.get("depth")),
      history_(resources.planes.history_of("depth")),
      targets_(gbuffer_targets(resources, depth_, layer)),
      draw_(resources, {"gbuffer.vert", "gbuffer.frag"}, peeling_defines(targets_, layer)),
      target_(context_, targets_.colours, GlAttachment{&depth_buffer_}, pass_name(layer_).c_str()) {
    if (layer == 0) background_.emplace(resources, depth_buffer_);
}

void GBufferPass::execute(const PassFrame& frame) {
    const GladGLContext& gl = context_.gl;
    if (history_ && layer_ == 0) history_->trade_places();
    clear_gbuffer(target_, test_);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(test_.nearer);
    if (layer_ > 0) {
        depth_.bind(SceneGeometry::first_free_texture_unit);
        draw_.set("minimum_separation", separation_in_metres(settings_, frame.view.camera()));
    }
    draw_.draw(Frustum(frame.view.clip_from_camera() * frame.view.camera_from_world()));
    if (background_) background_->draw();
    gl.Disable(GL_DEPTH_TEST);
}

PassDeclaration declare_gbuffer(const Scene& scene, const Method& method) {
    const bool one_pass = method.gbuffer.generation != LayerGeneration::peel;
    PassDeclaration pass;
    pass.name = pass_name(0);
    pass.outputs = gbuffer_outputs(method, 0);
    pass.parameters = gbuffer_parameters(0);
    if (one_pass) {
        const std::vector<std::string> second = gbuffer_outputs(method, 1);
        pass.outputs.insert(pass.outputs.end(), second.begin(), second.end());
        for (const std::vector<ParameterUse>& uses : {gbuffer_parameters(1), layer_parameters(second)})
            pass.parameters.insert(pass.parameters.end(), uses.begin(), uses.end());
        // What fragments are reprojected to may lie in it.
        if (method.gbuffer.generation == LayerGeneration::reproject)
            pass.parameters.push_back({"gbuffer.guard_band", second});
    }
    pass.kept = {"depth"};
    pass.create = [one_pass](const PassResources& resources) -> std::unique_ptr<Pass> {
        bool second_layer = false;
        for (const std::string& plane : gbuffer_outputs(resources.method, 1))
            second_layer = second_layer || resources.is_read(plane);
        if (one_pass && second_layer) return std::make_unique<OnePassGBuffer>(resources);
        return std::make_unique<GBufferPass>(resources, 0);
    };
    if (method.gbuffer.source == SourceOfStage::truth) pass.disabled = "gbuffer.source is \"truth\"";
    pass.remark =
        fmt::format("{} triangles in {} instances{}", scene.triangle_count(), scene.instances.size(),
                    one_pass ? fmt::format(", both layers at once ({})", to_string(method.gbuffer.generation)) : "");
    return pass;
}

PassDeclaration declare_peeled_layer(const Method& method, int layer) {
    const GBufferSettings& settings = method.gbuffer;
    PassDeclaration pass;
    pass.name = pass_name(layer);
    pass.inputs = {layer_prefix(layer - 1) + "depth"};
    pass.outputs = gbuffer_outputs(method, layer);
    pass.parameters = gbuffer_parameters(layer);
    for (ParameterUse& use : layer_parameters(pass.outputs)) pass.parameters.push_back(std::move(use));
    pass.create = [layer](const PassResources& resources) { return std::make_unique<GBufferPass>(resources, layer); };
    if (settings.source == SourceOfStage::truth) {
        pass.disabled = "gbuffer.source is \"truth\"";
    } else if (settings.layers <= layer) {
        pass.disabled = fmt::format("gbuffer.layers is {}", settings.layers);
    } else if (settings.generation != LayerGeneration::peel) {
        pass.disabled = fmt::format("gbuffer.generation is \"{}\"", to_string(settings.generation));
    }
    pass.remark = fmt::format("peeled {}{} behind layer {}", settings.minimum_separation,
                              settings.separation_unit == SeparationUnit::metres ? " m" : " of the frustum", layer);
    return pass;
}

}  // namespace plumb
