// Runs the passes of the reflections on layers that a test makes up, through the pipeline's own plan.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "layer_upload.h"
#include "radiance_counterpart.h"
#include "rasterizer/environment_maps_pass.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/reflections.h"
#include "rasterizer/texture_transfer.h"
#include "rasterizer/view_uniforms.h"
#include "reflections_counterpart.h"

namespace plumb {

// Every pixel has this lobe.
inline counterpart::Gloss even_gloss(const View& view, const glm::vec3& f0, float f90, float roughness) {
    counterpart::Gloss gloss{Image(view.width(), view.height(), 3), Image(view.width(), view.height(), 1, f90),
                             Image(view.width(), view.height(), 1, roughness)};
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            for (int c = 0; c < 3; ++c) gloss.f0.at(x, y, c) = f0[c];
        }
    }
    return gloss;
}

// What there is besides the layers for rays to find.
struct ReflectionSurroundings {
    ReflectionSurroundings(const glm::vec3& sky = glm::vec3(0.0f)) { environment.environment.radiance = sky; }

    Scene environment;                   // its environment is that of the scene
    counterpart::Radiance probe = {};    // what a probe sees
    std::optional<Image> indirect = {};  // of the first layer, guard band included
};

// A probe that sees what a test says.
class GivenProbePass final : public Pass {
public:
    GivenProbePass(const PassResources& resources, const counterpart::Radiance& radiance)
        : maps_(resources, "probe", resources.method.probe.size, resources.method.environment.samples) {
        const GlTexture& cube = resources.planes.get("probe.radiance");
        for (int face = 0; face < 6; ++face) {
            Image seen(cube.width(), cube.width(), 3);
            for (int y = 0; y < cube.width(); ++y) {
                for (int x = 0; x < cube.width(); ++x) {
                    const glm::dvec3 value = radiance(counterpart::direction_of(face, x, y, cube.width()));
                    for (int c = 0; c < 3; ++c) seen.at(x, y, c) = static_cast<float>(value[c]);
                }
            }
            upload(cube, face, seen);
        }
    }
    void execute(const PassFrame&) override { maps_.filter(); }

private:
    RadianceMaps maps_;
};

class ReflectionRun {
public:
    ReflectionRun(GlContext& context, counterpart::Layers layers, const counterpart::Gloss& gloss, Method method,
                  Quantities quantities, const ReflectionSurroundings& surroundings = {})
        : context_(context),
          layers_(std::move(layers)),
          method_(std::move(method)),
          quantities_(std::move(quantities)),
          scene_(surroundings.environment),
          planes_(context, layers_.width(), layers_.height()),
          programs_(context, gbuffer_defines(method_)),
          view_uniforms_(context) {
        // Something glossy to reflect and an environment; nothing of it is drawn.
        scene_.materials.resize(1);
        scene_.materials[0].metallic = 1.0f;
        scene_.meshes.resize(1);
        scene_.instances.resize(1);
        upload_layers(planes_, layers_);
        if (surroundings.indirect) upload(planes_.create("indirect", GL_RGBA32F, 1), 0, *surroundings.indirect);
        upload_gloss(gloss);
        view_uniforms_.update(layers_.view, layers_.view, method_.gbuffer.guard_band);
        std::vector<PassDeclaration> declarations = {
            {"given",
             {},
             {"depth", "normal", "direct", "camera_position", "specular", "roughness", "indirect", "layer2.depth",
              "layer2.normal", "layer2.direct", "layer2.camera_position"},
             [](const PassResources&) { return nullptr; }}};
        declarations.push_back(declare_environment_maps(scene_, method_));
        declarations.push_back({"probe", {}, RadianceMaps::outputs("probe"), [&](const PassResources& resources) {
                                    return std::make_unique<GivenProbePass>(resources, surroundings.probe);
                                }});
        const LightSet no_lights(scene_, method_.direct);
        for (PassDeclaration& pass : declare_reflections(scene_, no_lights, method_, quantities_))
            declarations.push_back(std::move(pass));
        const PassPlan plan = plan_passes(declarations, quantities_.planes);
        const PassResources resources{
            context_,  scene_,
            method_,   quantities_,
            planes_,   programs_,
            plan.read, []() -> const SceneGeometry& { throw std::logic_error("no pass here draws geometry"); }};
        for (const std::size_t index : plan.order) {
            if (std::unique_ptr<Pass> pass = declarations[index].create(resources)) passes_.push_back(std::move(pass));
        }
    }

    Image render(const std::string& plane = "reflection", int channels = 3, int layer = 0, int level = 0) {
        context_.make_current();
        view_uniforms_.bind();
        for (const std::unique_ptr<Pass>& pass : passes_) pass->execute({layers_.view, layers_.view});
        context_.check("reflections");
        return read_back(planes_.get(plane), layer, channels, 0, level);
    }

    // What the passes see: normals as their encoding leaves them.
    const counterpart::Layers& layers() const { return layers_; }

private:
    void upload_gloss(const counterpart::Gloss& gloss) {
        const int width = layers_.width(), height = layers_.height();
        Image specular(width, height, 4);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int c = 0; c < 3; ++c) specular.at(x, y, c) = gloss.f0.at(x, y, c);
                specular.at(x, y, 3) = gloss.f90.at(x, y);
            }
        }
        upload(planes_.create("specular", GL_RGBA32F, 1), 0, specular);
        upload(planes_.create("roughness", GL_R32F, 1), 0, gloss.roughness);
    }

    GlContext& context_;
    counterpart::Layers layers_;
    Method method_;
    Quantities quantities_;
    Scene scene_;
    PlaneTextures planes_;
    ProgramCache programs_;
    ViewUniforms view_uniforms_;
    std::vector<std::unique_ptr<Pass>> passes_;
};

}  // namespace plumb
