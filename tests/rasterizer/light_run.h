// Runs the passes that make some planes of a view, and keeps the textures: for what no frame hands out, such as cubes,
// and for passes that count.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rasterizer/environment_maps_pass.h"
#include "rasterizer/light_volume_pass.h"
#include "rasterizer/normal_encoding.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/passes.h"
#include "rasterizer/scene_geometry.h"
#include "rasterizer/texture_transfer.h"
#include "rasterizer/view_uniforms.h"

namespace plumb {

class LightRun {
public:
    // `scene` outlives the run. `counts_fragments` of the light volumes.
    LightRun(GlContext& context, const Scene& scene, Method method, const std::vector<std::string>& wanted,
             const View& view, bool counts_fragments = true)
        : context_(context),
          scene_(scene),
          method_(std::move(method)),
          view_(view.with_guard_band(method_.gbuffer.guard_band)),
          planes_(context, view_.width(), view_.height()),
          programs_(context, normal_defines(normal_format_of(method_))),
          view_uniforms_(context) {
        context.make_current();
        quantities_.planes = wanted;
        std::vector<PassDeclaration> declarations = declare_passes(scene, method_, quantities_);
        plan_ = plan_passes(declarations, wanted);
        const PassResources resources{
            context_, scene_, method_, quantities_, planes_, programs_, plan_.read, [this]() -> const SceneGeometry& {
                if (!geometry_) geometry_.emplace(context_, scene_);
                return *geometry_;
            }};
        for (const std::size_t index : plan_.order) {
            const PassDeclaration& declaration = declarations[index];
            names_.push_back(declaration.name);
            if (declaration.name.starts_with("light volumes")) {
                const int layer = declaration.name == "light volumes" ? 0 : 1;
                auto pass = std::make_unique<LightVolumePass>(resources, layer, counts_fragments);
                volumes_.push_back(pass.get());
                passes_.push_back(std::move(pass));
            } else {
                passes_.push_back(declaration.create(resources));
            }
        }
        view_uniforms_.update(view_, view_, method_.gbuffer.guard_band);
    }

    void run() {
        for (std::size_t i = 0; i < passes_.size(); ++i) run_pass(i);
    }
    // Pass by name; whatever it reads must have run before.
    void run(const std::string& name) {
        for (std::size_t i = 0; i < passes_.size(); ++i) {
            if (names_[i] == name) run_pass(i);
        }
    }
    Pass& pass(const std::string& name) {
        for (std::size_t i = 0; i < passes_.size(); ++i) {
            if (names_[i] == name) return *passes_[i];
        }
        throw std::out_of_range("pass '" + name + "' does not run");
    }

    const PlaneTextures& planes() const { return planes_; }
    Image image(const std::string& plane, int channels, int layer = 0, int level = 0) const {
        return read_back(planes_.get(plane), layer, channels, 0, level);
    }
    std::uint64_t fragments_shaded(std::size_t layer = 0) const { return volumes_.at(layer)->fragments_shaded(); }
    std::size_t allocated_bytes() const { return context_.allocated_bytes(); }

private:
    void run_pass(std::size_t index) {
        view_uniforms_.bind();
        passes_[index]->execute({view_, view_});
        context_.check(names_[index]);
    }

    GlContext& context_;
    const Scene& scene_;
    const Method method_;
    Quantities quantities_;
    const View view_;
    PlaneTextures planes_;
    ProgramCache programs_;
    ViewUniforms view_uniforms_;
    PassPlan plan_;
    std::optional<SceneGeometry> geometry_;
    std::vector<std::string> names_;
    std::vector<std::unique_ptr<Pass>> passes_;
    std::vector<const LightVolumePass*> volumes_;
};

}  // namespace plumb
