#include "rasterizer/pipeline.h"

#include <optional>

#include <fmt/format.h>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/instance_motion.h"
#include "rasterizer/normal_encoding.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/pass_timer.h"
#include "rasterizer/passes.h"
#include "rasterizer/plane_reader.h"
#include "rasterizer/sample_spiral.h"
#include "rasterizer/scene_geometry.h"
#include "rasterizer/temporal_antialias.h"
#include "rasterizer/view_uniforms.h"

namespace plumb {
namespace {

std::vector<std::string> planes_to_make(const Quantities& quantities) {
    std::vector<std::string> planes;
    for (const std::string& plane : quantities.planes) {
        for (std::string& behind : planes_behind(plane)) planes.push_back(std::move(behind));
    }
    return planes;
}

}  // namespace

struct Pipeline::Implementation {
    Implementation(GlContext& context_in, const Scene& scene_in, const Method& method_in,
                   const Quantities& quantities_in, int width_in, int height_in)
        : context(context_in),
          scene(scene_in),
          method(method_in),
          quantities(quantities_in),
          width(width_in),
          height(height_in),
          declarations(declare_passes(scene, method, quantities)),
          plan(plan_passes(declarations, planes_to_make(quantities))),
          offsets(plan.read.contains(aliased_plane) ? jitter_offsets(method.antialias) : std::vector{glm::vec2(0.0f)}),
          planes(context, width + 2 * method.gbuffer.guard_band, height + 2 * method.gbuffer.guard_band,
                 plan.lifetimes),
          programs(context, gbuffer_defines(method)),
          view_uniforms(context),
          instance_motions(context, scene),
          timer(context, plan.order.size()) {
        context.make_current();
        const PassResources resources{
            context, scene, method, quantities, planes, programs, plan.read, [this]() -> const SceneGeometry& {
                if (!geometry) geometry.emplace(context, scene);
                return *geometry;
            }};
        // In the order of execution, so that a pass takes the memory of planes that those before it have done with.
        for (std::size_t i = 0; i < plan.order.size(); ++i) {
            const PassDeclaration& declaration = declarations[plan.order[i]];
            passes.push_back(declaration.create(resources));
            context.check("making of " + declaration.name);
            for (const PlaneLifetimes::Ended& ended : plan.lifetimes.ended_after[i]) planes.give_up(ended);
        }
    }

    // Leaves times in `timer`.
    void run(const FrameRequest& request) {
        const View& view = request.now.view;
        if (view.width() != width || view.height() != height) {
            throw MethodError(
                fmt::format("the pipeline was made for views of {}x{}, this one is {}x{}; make another one", width,
                            height, view.width(), view.height()));
        }
        context.make_current();
        const Moment& previous = request.previous ? *request.previous : request.now;
        const bool continues = rendered_ == previous;
        frame_number_ = continues ? frame_number_ + 1 : 0;
        shown_ = with_jitter(view, frame_number_);
        const View wide = shown_->with_guard_band(method.gbuffer.guard_band);
        // After a cut the frame before was not rendered: let its pixels be where this frame's are.
        const View wide_previous = with_jitter(previous.view, continues ? frame_number_ - 1 : frame_number_)
                                       .with_guard_band(method.gbuffer.guard_band);
        // Who predicts the next frame must not be told it.
        const bool predicts = method.gbuffer.generation == LayerGeneration::predict;
        const Moment* next = request.next && !predicts ? &*request.next : nullptr;
        const View wide_next = with_jitter(next ? next->view : extrapolate(previous.view, view), frame_number_ + 1)
                                   .with_guard_band(method.gbuffer.guard_band);
        view_uniforms.update(wide, wide_previous, method.gbuffer.guard_band, &wide_next, frame_number_,
                             pattern_shift(request.seed));
        instance_motions.update(request.now, previous);
        instance_motions.bind();
        if (geometry) geometry->move_to(request.now, previous, next);
        // What was foretold was drawn with the offset of the frame that would follow.
        const bool foretold = foretold_ == request.now && (continues || offsets.size() == 1);
        const PassFrame frame{wide,      wide_previous, request.truth, &wide_next,
                              continues, foretold,      frame_number_, request.now.time};
        // Whatever throws below leaves no history.
        forget();
        for (std::size_t i = 0; i < passes.size(); ++i) {
            view_uniforms.bind();
            timer.begin(i);
            passes[i]->execute(frame);
            timer.end(i);
            context.check(declarations[plan.order[i]].name);
        }
        rendered_ = request.now;
        if (request.next) {
            foretold_ = request.next;
        } else if (previous == request.now) {
            foretold_ = request.now;
        }
    }

    void forget() { rendered_.reset(), foretold_.reset(); }

    // The view of the last frame as it was rendered.
    const View& shown() const { return *shown_; }

    std::vector<PassTiming> timings() const {
        std::vector<PassTiming> result;
        const std::vector<double> milliseconds = timer.milliseconds();
        for (std::size_t i = 0; i < passes.size(); ++i) {
            result.push_back({declarations[plan.order[i]].name, milliseconds[i]});
        }
        return result;
    }

    GlContext& context;
    const Scene& scene;
    const Method method;
    const Quantities quantities;
    const int width, height;
    const std::vector<PassDeclaration> declarations;
    const PassPlan plan;
    const std::vector<glm::vec2> offsets;  // of the views of successive frames, repeating; pixels
    PlaneTextures planes;
    ProgramCache programs;
    ViewUniforms view_uniforms;
    InstanceMotions instance_motions;
    std::optional<SceneGeometry> geometry;
    std::vector<std::unique_ptr<Pass>> passes;
    PassTimer timer;

private:
    View with_jitter(const View& view, int frame) const {
        return view.with_offset(view.offset() + offsets[static_cast<std::size_t>(frame) % offsets.size()]);
    }

    std::optional<View> shown_;
    int frame_number_ = 0;            // since the last cut
    std::optional<Moment> rendered_;  // the frame before
    std::optional<Moment> foretold_;  // what it was told to come next
};

Pipeline::Pipeline(GlContext& context, const Scene& scene, const Method& method, const Quantities& quantities,
                   int width, int height)
    : implementation_(std::make_unique<Implementation>(context, scene, method, quantities, width, height)) {}

void Pipeline::forget() { implementation_->forget(); }

Pipeline::~Pipeline() = default;

const std::vector<PassDecision>& Pipeline::decisions() const { return implementation_->plan.decisions; }

std::size_t Pipeline::gbuffer_bytes_per_pixel() const {
    std::size_t bytes = 0;
    for (const auto& [name, texture] : implementation_->planes.all()) {
        if (belongs_to_gbuffer(name))
            bytes += bytes_per_texel(texture->format()) * static_cast<std::size_t>(texture->layers());
    }
    return bytes;
}

std::size_t Pipeline::shadow_map_bytes() const {
    std::size_t bytes = 0;
    for (const auto& [name, texture] : implementation_->planes.all()) {
        if (name.starts_with("shadow.")) bytes += texture->bytes();
    }
    return bytes;
}

RasterResult Pipeline::render(const FrameRequest& request) {
    Implementation& self = *implementation_;
    self.run(request);
    const View& view = request.now.view;
    RasterResult result;
    result.timings = self.timings();
    for (const PassTiming& timing : result.timings) result.milliseconds += timing.milliseconds;
    result.frame = Frame(view.width(), view.height());
    for (const std::string& plane : self.quantities.planes) {
        result.frame.set(plane, read_plane(self.planes, plane, self.shown(), self.method.gbuffer.guard_band,
                                           normal_format_of(self.method)));
    }
    result.frame.facts["renderer"] = self.context.info().renderer;
    result.frame.facts["method"] = self.method.name;
    result.frame.facts["view"] = view.camera().name;
    result.frame.facts["scene"] = self.scene.name;
    return result;
}

std::vector<PassTiming> Pipeline::time_passes(const FrameRequest& request) {
    implementation_->run(request);
    return implementation_->timings();
}

RasterResult Pipeline::render(const View& view, const View* previous, const Frame* truth) {
    FrameRequest request{.now = {view}, .truth = truth};
    if (previous) request.previous = Moment{*previous};
    return render(request);
}

std::vector<PassTiming> Pipeline::time_passes(const View& view, const Frame* truth) {
    return time_passes({.now = {view}, .truth = truth});
}

}  // namespace plumb
