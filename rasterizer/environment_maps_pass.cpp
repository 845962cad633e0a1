#include "rasterizer/environment_maps_pass.h"

#include <algorithm>

#include <fmt/format.h>

namespace plumb {
namespace {

constexpr GLuint source_environment_unit = 0;

// Directions per texel and axis, so that no texel of the equirectangular image is skipped.
int supersamples(const Scene& scene, int size) {
    const int columns = scene.textures[static_cast<std::size_t>(scene.environment.texture)].width;
    return std::clamp((columns + 4 * size - 1) / (4 * size), 1, 16);
}

ShaderDefines defines(const Scene& scene, const EnvironmentLight& environment, int size) {
    ShaderDefines result = environment.radiance_defines(source_environment_unit);
    result.emplace_back("SUPERSAMPLES", fmt::format("{}", supersamples(scene, size)));
    return result;
}

}  // namespace

EnvironmentMapsPass::EnvironmentMapsPass(const PassResources& resources)
    : context_(resources.context),
      source_(resources.scene.environment),
      environment_(resources.context, resources.scene),
      maps_(resources, "environment", resources.method.environment.size, resources.method.environment.samples),
      size_(static_cast<float>(resources.method.environment.size)) {
    if (source_.texture == no_texture) return;
    draw_.emplace(context_, resources.programs, "environment_cube.frag",
                  defines(resources.scene, environment_, resources.method.environment.size));
}

void EnvironmentMapsPass::execute(const PassFrame&) {
    if (!made_) make();
}

void EnvironmentMapsPass::make() {
    if (draw_) {
        environment_.set_radiance(draw_->program(), source_environment_unit);
        draw_->program().set("size", size_);
    }
    for (int face = 0; face < 6; ++face) {
        if (draw_) {
            draw_->program().set("face", face);
            draw_->draw(maps_.face(face));
        } else {
            const glm::vec4 radiance(source_.radiance, 1.0f);
            context_.gl.ClearNamedFramebufferfv(maps_.face(face).id(), GL_COLOR, 0, &radiance.x);
        }
    }
    maps_.filter();
    made_ = true;
}

PassDeclaration declare_environment_maps(const Scene& scene, const Method& method) {
    PassDeclaration pass;
    pass.name = "environment maps";
    pass.outputs = RadianceMaps::outputs("environment");
    // Each texel of a uniform environment is like any other.
    if (scene.environment.texture != no_texture)
        pass.parameters = {{"environment.size"}, {"environment.samples", {"environment.prefiltered"}}};
    pass.create = [](const PassResources& resources) { return std::make_unique<EnvironmentMapsPass>(resources); };
    if (scene.environment.is_black()) pass.disabled = "the scene has no environment";
    pass.remark = fmt::format("cubes of {}^2, {} directions per texel, once", method.environment.size,
                              method.environment.samples);
    return pass;
}

}  // namespace plumb
