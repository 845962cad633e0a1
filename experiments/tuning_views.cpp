#include "experiments/tuning_views.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/method_timing.h"
#include "experiments/reference_renderer.h"
#include "experiments/row_measurement.h"
#include "experiments/settling.h"
#include "experiments/view_truths.h"
#include "metrics/comparison.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/pipeline.h"

namespace plumb {
namespace {

TuningCost error_of(const Image& image, const Truth& truth, const std::string& plane, double most_noise) {
    if (!has_halves(*truth.frame, plane)) return {pixel_errors(image, truth.frame->plane(plane), 1.0).rmse, 0.0};
    Frame test(image.width(), image.height());
    test.set(plane, image);
    ReferencedErrorSettings settings;
    settings.noise_limit = most_noise;
    settings.bootstrap.resamples = 100;  // of the interval only whether it excludes zero is asked
    const ReferencedError error = referenced_error(test, *truth.frame, plane, truth.samples, settings);
    if (!error.trustworthy) return {0.0, 0.0, refusal_of(error)};
    return {std::sqrt(error.mse), 0.0};
}

}  // namespace

struct TuningViews::Implementation {
    struct SceneViews {
        const ExperimentScene* entry = nullptr;
        Scene scene;
        struct TruthOfView {
            TuningView name;
            ViewTruths truths;
        };
        std::vector<TruthOfView> views;
    };

    const Experiment& experiment;
    std::string plane;
    bool limited;
    std::unique_ptr<GlContext> context;
    std::vector<std::unique_ptr<SceneViews>> scenes;

    Truth choose(const ViewTruths& truths) const {
        const std::vector<Truth> all = truths.of(plane);
        return limited && all.size() > 1 ? all[1] : all.front();
    }
};

TuningViews::TuningViews(const Experiment& experiment, const std::string& plane, bool limited, int hold_out,
                         const SceneFinder& finder, const RunOptions& options)
    : implementation_(new Implementation{experiment, plane, limited, GlContext::create(options.backend), {}}) {
    if (hold_out < 2) throw ConfigError(fmt::format("every {}. view held out: must be 2 or more", hold_out));
    ProgressLine progress;
    const ReferenceCache cache(options.cache_dir);
    const ReferenceRenderer references(cache, progress, options.stop, options.threads);
    RunResults record;
    int trained = 0, judged = 0;
    for (std::size_t s = 0; s < experiment.scenes.size(); ++s) {
        auto views = std::make_unique<Implementation::SceneViews>(
            Implementation::SceneViews{&experiment.scenes[s], finder.load(experiment.scenes[s].scene), {}});
        const std::vector<std::string> names = views_of(*views->entry, views->scene);
        const PathTracer tracer(views->scene);
        const ReferenceSettings full = full_truth_settings(experiment, *views->entry);
        const auto within = limited ? limited_truth_settings(experiment, *views->entry) : std::nullopt;
        const double scenes = static_cast<double>(experiment.scenes.size());
        const ProgressPart part{static_cast<double>(s) / scenes, static_cast<double>(s + 1) / scenes};
        for (std::size_t i = 0; i < names.size(); ++i) {
            const TuningView name{views->entry->scene, names[i], static_cast<int>(i) % hold_out == hold_out - 1};
            const View view(views->scene.camera(names[i]), experiment.width, experiment.height);
            const ProgressPart of_view = part.part(static_cast<double>(i) / static_cast<double>(names.size()),
                                                   static_cast<double>(i + 1) / static_cast<double>(names.size()));
            ViewTruths truths;
            truths.full =
                references.render(tracer, views->scene, view, full, {name.scene, name.view, "full"}, of_view, record);
            if (within) {
                truths.limit = views->entry->indirect_radius;
                truths.limited = references.render(tracer, views->scene, view, *within,
                                                   {name.scene, name.view, "limited"}, of_view, record);
            }
            if (options.stop && options.stop->load()) throw ConfigError("interrupted; the same command goes on");
            (name.held_out ? judged : trained) += 1;
            views->views.push_back({name, std::move(truths)});
        }
        implementation_->scenes.push_back(std::move(views));
    }
    if (trained == 0 || judged == 0) {
        throw ConfigError(
            fmt::format("{} views to train on and {} held out: at least one of each is needed; name more "
                        "views or hold out others",
                        trained, judged));
    }
}

TuningViews::~TuningViews() = default;

std::vector<std::vector<ViewCost>> TuningViews::costs(const std::vector<Method>& methods, bool held_out) const {
    const Experiment& experiment = implementation_->experiment;
    const std::string& plane = implementation_->plane;
    std::vector<std::vector<ViewCost>> costs(methods.size());
    for (const std::unique_ptr<Implementation::SceneViews>& scene : implementation_->scenes) {
        if (std::ranges::none_of(scene->views, [&](const auto& view) { return view.name.held_out == held_out; }))
            continue;
        const Quantities quantities = quantities_of(experiment, *scene->entry, plane);
        std::vector<std::unique_ptr<Pipeline>> pipelines;
        std::vector<Pipeline*> in_turn;
        std::vector<int> frames;
        for (const Method& method : methods) {
            const Method in_scene = method_in_scene(method, *scene->entry, experiment.file.string());
            pipelines.push_back(std::make_unique<Pipeline>(*implementation_->context, scene->scene, in_scene,
                                                           quantities, experiment.width, experiment.height));
            in_turn.push_back(pipelines.back().get());
            frames.push_back(frames_to_settle(in_scene));
        }
        for (const Implementation::SceneViews::TruthOfView& view : scene->views) {
            if (view.name.held_out != held_out) continue;
            const View camera(scene->scene.camera(view.name.view), experiment.width, experiment.height);
            const Frame* truth = &view.truths.full.frame;
            for (std::size_t i = 0; i < methods.size(); ++i) {
                for (int frame = 1; frame < frames[i]; ++frame) pipelines[i]->time_passes(camera, truth);
                const Frame image = pipelines[i]->render(camera, nullptr, truth).frame;
                costs[i].push_back({view.name, error_of(image.plane(plane), implementation_->choose(view.truths), plane,
                                                        experiment.reference.most_noise)});
            }
            const std::vector<Timing> timings = time_interleaved(in_turn, camera, truth, experiment.timing);
            for (std::size_t i = 0; i < methods.size(); ++i) costs[i].back().cost.milliseconds = timings[i].median;
        }
    }
    return costs;
}

TuningCost TuningViews::training_cost(const Method& method) const { return mean_cost(costs({method}, false).front()); }

TuningCost mean_cost(const std::vector<ViewCost>& costs) {
    TuningCost mean;
    double error = 0.0, milliseconds = 0.0;
    for (const ViewCost& cost : costs) {
        if (!cost.cost.told() && mean.told())
            mean.refusal = fmt::format("{} / {}: {}", cost.view.scene, cost.view.view, cost.cost.refusal);
        error += std::log(cost.cost.error);
        milliseconds += std::log(cost.cost.milliseconds);
    }
    const double count = static_cast<double>(costs.size());
    mean.milliseconds = std::exp(milliseconds / count);
    if (mean.told()) mean.error = std::exp(error / count);
    return mean;
}

}  // namespace plumb
