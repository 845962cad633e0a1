// Runs the temporal filter alone, on planes that a test makes up.
#pragma once

#include <memory>
#include <set>
#include <string>

#include "rasterizer/normal_encoding.h"
#include "rasterizer/temporal_filter.h"
#include "rasterizer/texture_transfer.h"
#include "rasterizer/view_uniforms.h"

namespace plumb {

// A wall across the view, before which nothing moves.
class FilterRun {
public:
    FilterRun(GlContext& context, const View& view, const TemporalFilterSettings& settings)
        : view_(view),
          planes_(context, view.width(), view.height()),
          programs_(context),
          view_uniforms_(context),
          context_(context) {
        const glm::vec2 normal = encode_normal(glm::vec3(view.camera().world_from_camera[2]));  // towards the camera
        Image normals(view.width(), view.height(), 2, normal.x);
        for (std::size_t i = 1; i < normals.values().size(); i += 2) normals.values()[i] = normal.y;
        for (const std::string plane : {"depth", "previous_depth"})
            upload(planes_.create(plane, GL_R32F, 1), 0, Image(view.width(), view.height(), 1, 5.0f));
        upload(planes_.create("normal", GL_RG16, 1), 0, normals);
        planes_.create("noisy", GL_R32F, 1);
        const PassResources resources{context, scene_, method_, quantities_, planes_, programs_, read_, {}};
        const TemporalFilterRequest request{
            .name = "filter", .group = "filter", .settings = settings, .input = "noisy", .output = "smooth"};
        pass_ = std::make_unique<TemporalFilterPass>(resources, request);
    }

    Image next(const Image& noisy) {
        upload(planes_.get("noisy"), 0, noisy);
        context_.make_current();
        view_uniforms_.update(view_, view_, 0, nullptr, frame_);
        view_uniforms_.bind();
        pass_->execute({view_, view_, nullptr, nullptr, frame_ > 0, false, frame_});
        ++frame_;
        return read_back(planes_.get("smooth"), 0, 1);
    }

private:
    View view_;
    Scene scene_;
    Method method_;
    Quantities quantities_;
    PlaneTextures planes_;
    ProgramCache programs_;
    ViewUniforms view_uniforms_;
    std::set<std::string, std::less<>> read_;
    std::unique_ptr<Pass> pass_;
    GlContext& context_;
    int frame_ = 0;
};

}  // namespace plumb
