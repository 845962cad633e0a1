#include "experiments/cost_round.h"

#include <algorithm>
#include <exception>
#include <memory>

#include <fmt/format.h>

#include "experiments/settling.h"
#include "experiments/statistics.h"
#include "rasterizer/calibrating_workload.h"
#include "rasterizer/pipeline.h"

namespace plumb {
namespace {

bool is_asked_for(const std::vector<Threshold>& thresholds, const CostRatio& cell) {
    return std::ranges::any_of(thresholds, [&](const Threshold& threshold) {
        const RowPattern& rows = threshold.rows;
        return threshold.kind == ThresholdKind::cost && threshold.relative_to.empty() &&
               matches_pattern(rows.scene, cell.scene) && matches_pattern(rows.plane, cell.plane) &&
               matches_pattern(rows.method, cell.method) &&
               (cell.view.empty() || matches_pattern(rows.view, cell.view));
    });
}

// One method for one plane, ready to be timed.
struct CostRunner {
    std::unique_ptr<Pipeline> pipeline;
    std::string method;
    int frames_to_settle = 1;
};

double frame_milliseconds(Pipeline& pipeline, const View& view) {
    double sum = 0.0;
    for (const PassTiming& pass : pipeline.time_passes(view)) sum += pass.milliseconds;
    return sum;
}

// The methods of `runners` on one view, in turn with the workload.
std::vector<CostRatio> time_in_turn(CalibratingWorkload& workload, const std::vector<CostRunner*>& runners,
                                    const View& view, const CostRatio& cell, const ExperimentTiming& timing) {
    for (const CostRunner* runner : runners) {
        const int frames = std::max(timing.warm_up, runner->frames_to_settle);
        for (int frame = 0; frame < frames; ++frame) frame_milliseconds(*runner->pipeline, view);
    }
    workload.milliseconds();  // finds how many rounds the clock needs
    std::vector<double> works = {workload.milliseconds()};
    std::vector<std::vector<double>> times(runners.size()), ratios(runners.size());
    for (int repetition = 0; repetition < timing.repetitions; ++repetition) {
        for (std::size_t i = 0; i < runners.size(); ++i) {
            times[i].push_back(frame_milliseconds(*runners[i]->pipeline, view));
        }
        const double before = works.back();
        works.push_back(workload.milliseconds());
        for (std::size_t i = 0; i < runners.size(); ++i)
            ratios[i].push_back(2.0 * times[i].back() / (before + works.back()));
    }
    std::vector<CostRatio> result;
    for (std::size_t i = 0; i < runners.size(); ++i) {
        CostRatio cost = cell;
        cost.method = runners[i]->method;
        cost.ratio = quantile(ratios[i], 0.5);
        cost.milliseconds = quantile(times[i], 0.5), cost.workload_ms = quantile(works, 0.5);
        result.push_back(std::move(cost));
    }
    return result;
}

class Round {
public:
    Round(const Experiment& experiment, const std::vector<Threshold>& thresholds, const SceneFinder& finder,
          GlContext& context, const std::atomic<bool>* stop)
        : experiment_(experiment),
          thresholds_(thresholds),
          finder_(finder),
          context_(context),
          workload_(context),
          stop_(stop) {}

    CostRound run() {
        for (const ExperimentScene& entry : experiment_.scenes) {
            std::vector<std::string> planes;
            std::ranges::copy_if(experiment_.planes, std::back_inserter(planes), [&](const std::string& plane) {
                return std::ranges::any_of(experiment_.methods, [&](const Method& method) {
                    return is_asked_for(thresholds_, {entry.scene, "", plane, method.name});
                });
            });
            if (planes.empty()) continue;
            const Scene scene = finder_.load(entry.scene);
            for (const std::string& plane : planes) time_plane(entry, scene, plane);
        }
        return std::move(result_);
    }

private:
    bool stopped() const { return stop_ && stop_->load(); }

    void time_plane(const ExperimentScene& entry, const Scene& scene, const std::string& plane) {
        std::vector<CostRunner> runners = runners_of(entry, scene, plane);
        for (const Camera& camera : scene.cameras) {
            const bool wanted = entry.views.empty() || std::ranges::find(entry.views, camera.name) != entry.views.end();
            if (!wanted || stopped()) continue;
            std::vector<CostRunner*> asked;
            for (CostRunner& runner : runners) {
                if (is_asked_for(thresholds_, {entry.scene, camera.name, plane, runner.method}))
                    asked.push_back(&runner);
            }
            if (asked.empty()) continue;
            const View view(camera, experiment_.width, experiment_.height);
            for (CostRatio& cost :
                 time_in_turn(workload_, asked, view, {entry.scene, camera.name, plane, ""}, experiment_.timing)) {
                result_.ratios.push_back(std::move(cost));
            }
        }
    }

    std::vector<CostRunner> runners_of(const ExperimentScene& entry, const Scene& scene, const std::string& plane) {
        const Quantities quantities = quantities_of(experiment_, entry, plane);
        std::vector<CostRunner> runners;
        for (const Method& method : experiment_.methods) {
            if (!is_asked_for(thresholds_, {entry.scene, "", plane, method.name})) continue;
            const auto fail = [&](std::string_view why) {
                result_.failures.push_back(fmt::format("{} / {} / {}: {}", entry.scene, plane, method.name, why));
            };
            const Method in_scene = method_in_scene(method, entry, experiment_.file.string());
            if (in_scene.gbuffer.source == SourceOfStage::truth || in_scene.direct.source == SourceOfStage::truth) {
                fail(
                    "takes stages from the truth, so that it has no time of its own; limit the cost of another method");
                continue;
            }
            try {
                runners.push_back({std::make_unique<Pipeline>(context_, scene, in_scene, quantities, experiment_.width,
                                                              experiment_.height),
                                   method.name, frames_to_settle(in_scene)});
            } catch (const std::exception& error) {
                fail(error.what());
            }
        }
        return runners;
    }

    const Experiment& experiment_;
    const std::vector<Threshold>& thresholds_;
    const SceneFinder& finder_;
    GlContext& context_;
    CalibratingWorkload workload_;
    const std::atomic<bool>* stop_;
    CostRound result_;
};

}  // namespace

CostRound measure_costs(const Experiment& experiment, const std::vector<Threshold>& thresholds,
                        const SceneFinder& finder, GlBackend backend, const std::atomic<bool>* stop) {
    const bool any = std::ranges::any_of(thresholds, [](const Threshold& threshold) {
        return threshold.kind == ThresholdKind::cost && threshold.relative_to.empty();
    });
    if (!any) return {};
    const std::unique_ptr<GlContext> context = GlContext::create(backend);
    return Round(experiment, thresholds, finder, *context, stop).run();
}

}  // namespace plumb
