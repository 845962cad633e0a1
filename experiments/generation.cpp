#include "experiments/generation.h"

#include <chrono>
#include <cmath>
#include <exception>
#include <optional>

#include <fmt/format.h>

#include "experiments/progress_line.h"
#include "experiments/statistics.h"
#include "pathtracer/reference.h"

namespace plumb {
namespace {

// Counts of one method over the frames of a walk.
struct Counts {
    double pixels = 0, wrong = 0, inside_pixels = 0, wrong_inside = 0, missing = 0, second_layers = 0, violations = 0;

    void add(const Frame& rendered, const Frame& exact, const Image& at_silhouettes, float separation) {
        const auto first = rendered.plane("depth").values(), second = rendered.plane("layer2.depth").values();
        const auto expected = exact.plane("layer2.depth").values(), mask = at_silhouettes.values();
        for (std::size_t i = 0; i < second.size(); ++i) {
            const bool found = std::isfinite(second[i]), there = std::isfinite(expected[i]);
            const bool is_wrong =
                found != there || (there && !(std::abs(second[i] - expected[i]) <= 1e-3f * expected[i]));
            ++pixels;
            wrong += is_wrong;
            inside_pixels += mask[i] == 0.0f;
            wrong_inside += is_wrong && mask[i] == 0.0f;
            missing += there && !found;
            second_layers += found;
            violations += found && !(second[i] > first[i] + separation);
        }
    }
};

class WalkRun {
public:
    WalkRun(const GenerationExperiment& experiment, const GenerationWalk& walk, const Scene& scene, GlContext& context)
        : experiment_(experiment),
          walk_(walk),
          scene_(scene),
          counts_(experiment.methods.size()),
          times_(counts_.size()) {
        Quantities quantities;
        quantities.planes = {"depth", "normal", "albedo", "layer2.depth", "layer2.normal", "layer2.albedo"};
        for (Method method : experiment.methods) {
            method.gbuffer.minimum_separation = walk.minimum_separation;
            pipelines_.push_back(
                std::make_unique<Pipeline>(context, scene, method, quantities, experiment.width, experiment.height));
        }
    }

    void render(int index, int threads) {
        const Moment before = at(index - 1), now = at(index);
        const FrameRequest request{.now = now, .previous = before, .next = at(index + 1)};
        // A scene that stands still needs one tree for all frames.
        if (now.time || !tracer_) tracer_.emplace(scene_, now.time ? TimeSpan{*before.time, *now.time} : TimeSpan{});
        const Frame exact = tracer_->gbuffer(
            now.view, {.minimum_separation = walk_.minimum_separation, .previous_view = &before.view}, threads);
        Image at_silhouettes = silhouettes(exact, now.view, 1);
        const Image of_second = silhouettes(exact, now.view, 2);
        for (std::size_t i = 0; i < of_second.values().size(); ++i)
            at_silhouettes.values()[i] = std::max(at_silhouettes.values()[i], of_second.values()[i]);
        for (std::size_t i = 0; i < pipelines_.size(); ++i) {
            const RasterResult result = pipelines_[i]->render(request);
            if (index == 0) continue;
            counts_[i].add(result.frame, exact, at_silhouettes, walk_.minimum_separation);
            double milliseconds = 0.0;
            for (const PassTiming& timing : result.timings)
                milliseconds += timing.pass.starts_with("gbuffer") ? timing.milliseconds : 0.0;
            times_[i].push_back(milliseconds);
        }
        if (index > 0) add_motion(exact);
    }

    void finish(std::vector<GenerationRow>& rows) const {
        for (std::size_t i = 0; i < pipelines_.size(); ++i) {
            const Counts& counts = counts_[i];
            rows.push_back({walk_.name, experiment_.methods[i].name,
                            moving_pixels_ > 0 ? motion_ / moving_pixels_ : 0.0, counts.wrong / counts.pixels,
                            counts.wrong_inside / std::max(1.0, counts.inside_pixels), counts.missing / counts.pixels,
                            counts.violations / std::max(1.0, counts.second_layers), quantile(times_[i], 0.5),
                            static_cast<int>(pipelines_[i]->gbuffer_bytes_per_pixel())});
        }
    }

private:
    Moment at(int index) const {
        const double seconds = index / experiment_.frames_per_second;
        const auto on_path = static_cast<float>(walk_.start + walk_.camera_speed * seconds);
        Moment moment{View(scene_.path(walk_.path).at(on_path), experiment_.width, experiment_.height)};
        if (walk_.object_speed > 0.0) moment.time = walk_.start + walk_.object_speed * seconds;
        return moment;
    }

    void add_motion(const Frame& exact) {
        const Image& motion = exact.plane("motion");
        for (int y = 0; y < motion.height(); ++y) {
            for (int x = 0; x < motion.width(); ++x) {
                const double length = std::hypot(motion.at(x, y, 0), motion.at(x, y, 1));
                if (std::isfinite(length)) motion_ += length, ++moving_pixels_;
            }
        }
    }

    const GenerationExperiment& experiment_;
    const GenerationWalk& walk_;
    const Scene& scene_;
    std::vector<std::unique_ptr<Pipeline>> pipelines_;
    std::vector<Counts> counts_;
    std::vector<std::vector<double>> times_;
    std::optional<PathTracer> tracer_;
    double motion_ = 0.0, moving_pixels_ = 0.0;
};

}  // namespace

GenerationResults run_generation(const GenerationExperiment& experiment, const SceneFinder& finder,
                                 const RunOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    GenerationResults results;
    results.experiment = experiment;
    results.system = read_system_facts();
    results.command = options.command;
    results.started = utc_now();
    const std::unique_ptr<GlContext> context = GlContext::create(options.backend);
    results.gl_renderer = context->info().renderer;
    ProgressLine progress;
    const double all = static_cast<double>(experiment.walks.size()) * experiment.frames;
    for (std::size_t w = 0; w < experiment.walks.size() && !results.interrupted; ++w) {
        const GenerationWalk& walk = experiment.walks[w];
        try {
            const Scene scene = finder.load(walk.scene);
            WalkRun run(experiment, walk, scene, *context);
            for (int i = 0; i < experiment.frames && !results.interrupted; ++i) {
                progress.show((static_cast<double>(w) * experiment.frames + i) / all,
                              fmt::format("{}: frame {} of {}", walk.name, i + 1, experiment.frames));
                run.render(i, options.threads);
                results.interrupted = options.stop && options.stop->load();
            }
            if (!results.interrupted) run.finish(results.rows);
        } catch (const std::exception& error) {
            results.failures.push_back({walk.name, error.what()});
        }
    }
    progress.clear();
    results.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return results;
}

}  // namespace plumb
