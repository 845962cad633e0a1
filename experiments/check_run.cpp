#include "experiments/check_run.h"

#include <algorithm>
#include <chrono>
#include <stop_token>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/calibration.h"
#include "experiments/pictures.h"
#include "rasterizer/calibrating_workload.h"

namespace plumb {
namespace {

bool stopped(const RunOptions& options) { return options.stop && options.stop->load(); }

void require_workload(const CheckFile& check) {
    const bool any_cost = std::ranges::any_of(check.set.thresholds, [](const Threshold& threshold) {
        return threshold.kind == ThresholdKind::cost && threshold.relative_to.empty();
    });
    if (!any_cost || !check.set.calibration || check.set.calibration->workload == calibrating_workload_version) return;
    throw ConfigError(
        fmt::format("'{}': its costs were calibrated with version {} of the calibrating workload, this is "
                    "version {}; calibrate them anew: plumbline check {} --calibrate",
                    check.thresholds_file.string(), check.set.calibration->workload, calibrating_workload_version,
                    check.experiment.file.string()));
}

void require_limits(const CheckFile& check) {
    const std::vector<std::string> missing = without_limit(check);
    if (missing.empty()) return;
    throw ConfigError(
        fmt::format("{} of {} thresholds have no limit yet, such as '{}'; set them: plumbline check {} "
                    "--calibrate",
                    missing.size(), check.set.thresholds.size(), missing.front(), check.experiment.file.string()));
}

// The folder of one must_fail run.
RunOptions options_of_must_fail(const RunOptions& options, const MustFail& must_fail) {
    RunOptions result = options;
    result.output = options.output / "must_fail" / file_name_of(must_fail.name);
    result.write_frames = false;
    result.experiment_text.clear();  // another experiment than the file's
    return result;
}

void add_failures(const RunResults& run, const CostRound& costs, const std::string& prefix,
                  std::vector<std::string>& cells) {
    for (const CellFailure& failure : run.failures)
        cells.push_back(fmt::format("{}{}: {}", prefix, failure.cell, failure.message));
    for (const std::string& failure : costs.failures) cells.push_back(fmt::format("{}cost of {}", prefix, failure));
}

// Runs all broken methods against `thresholds`; returns early when stopped.
std::vector<MustFailVerdict> run_must_fail(const CheckFile& check, const std::vector<Threshold>& thresholds,
                                           const SceneFinder& finder, const RunOptions& options,
                                           std::vector<std::string>& failed_cells) {
    std::vector<MustFailVerdict> verdicts;
    for (const MustFail& must_fail : check.must_fail) {
        if (stopped(options)) break;
        const Threshold& named = *std::ranges::find(thresholds, must_fail.threshold, &Threshold::name);
        const Experiment experiment = must_fail_experiment(check.experiment, must_fail, named);
        const Threshold threshold = must_fail_threshold(must_fail, named);
        LoadedScenes scenes(finder);
        const RunResults run = run_experiment(experiment, scenes, options_of_must_fail(options, must_fail));
        const CostRound costs = measure_costs(experiment, {threshold}, finder, options.backend, options.stop);
        add_failures(run, costs, fmt::format("must fail, {}: ", must_fail.name), failed_cells);
        if (stopped(options)) break;
        verdicts.push_back(judge_must_fail(must_fail, judge(threshold, value_of(threshold, run.rows, costs.ratios))));
    }
    return verdicts;
}

// Threads that keep cores busy with arithmetic for as long as the object lives.
class BusyCores {
public:
    explicit BusyCores(unsigned count) {
        for (unsigned i = 0; i < count; ++i) {
            threads_.emplace_back([](const std::stop_token& stop) {
                volatile double value = 1.0;
                while (!stop.stop_requested()) value = value * 1.0000001 + 1e-9;
            });
        }
    }

private:
    std::vector<std::jthread> threads_;
};

}  // namespace

ExitCode CheckResults::exit_code() const {
    if (interrupted) return exit_interrupted;
    bool failed = !failed_cells.empty(), unmatched = false;
    for (const Verdict& verdict : verdicts) {
        failed |= verdict.status == VerdictStatus::breached || verdict.status == VerdictStatus::untold;
        unmatched |= verdict.status == VerdictStatus::unmatched;
    }
    for (const MustFailVerdict& verdict : must_fail) failed |= !verdict.proven;
    return failed ? exit_failed : unmatched ? exit_wrong_use : exit_fine;
}

Experiment must_fail_experiment(const Experiment& experiment, const MustFail& must_fail, const Threshold& threshold) {
    Experiment result = experiment;
    result.title = fmt::format("Must fail: {}", must_fail.name);
    result.question = fmt::format("Does the threshold '{}' see it?", threshold.name);
    result.path_tracer_samples.clear();
    result.sweep_points.clear();
    result.presentation = {ConfigMembers{}, 0};
    result.methods = {must_fail.method};
    if (const Method* base = find_method(experiment.methods, threshold.relative_to)) result.methods.push_back(*base);
    result.baseline = must_fail.method.name;
    if (threshold.kind != ThresholdKind::cost) result.timing = {0, 1};  // nobody reads the times

    std::erase_if(result.scenes,
                  [&](const ExperimentScene& scene) { return !matches_pattern(threshold.rows.scene, scene.scene); });
    const bool of_paths = !threshold.rows.path.empty();
    for (ExperimentScene& scene : result.scenes) {
        std::erase_if(scene.paths, [&](const ExperimentPath& path) {
            return !of_paths || !matches_pattern(threshold.rows.path, path.path);
        });
        // A scene without views would be rendered from all of them.
        const auto other_view = [&](const std::string& view) { return !matches_pattern(threshold.rows.view, view); };
        if (of_paths && scene.views.size() > 1) scene.views.resize(1);
        if (!std::ranges::all_of(scene.views, other_view)) std::erase_if(scene.views, other_view);
    }
    return result;
}

DiskUse disk_use(const CheckFile& check, const SceneFinder& finder, bool write_frames) {
    LoadedScenes scenes(finder);
    DiskUse use = disk_use(check.experiment, scenes, write_frames);
    for (const MustFail& must_fail : check.must_fail) {
        const Threshold& threshold = *check.find_threshold(must_fail.threshold);
        // Its truths are the experiment's.
        use.output += disk_use(must_fail_experiment(check.experiment, must_fail, threshold), scenes, false).output;
    }
    return use;
}

Threshold must_fail_threshold(const MustFail& must_fail, Threshold threshold) {
    threshold.rows.method = must_fail.name;
    threshold.calibrated.reset();  // of the sound method
    return threshold;
}

MustFailVerdict judge_must_fail(const MustFail& must_fail, Verdict verdict) {
    MustFailVerdict result{must_fail.name, std::move(verdict), false, ""};
    result.proven = result.verdict.status == VerdictStatus::breached;
    result.message =
        result.proven
            ? fmt::format("breaks '{}', as it must: {}", must_fail.threshold, result.verdict.message)
            : fmt::format("the gate cannot fail: '{}' lets it pass: {}", must_fail.threshold, result.verdict.message);
    return result;
}

CheckResults run_check(const CheckFile& check, const SceneFinder& finder, const RunOptions& options) {
    LoadedScenes scenes(finder);
    require_effects_in_scenes(check.experiment, scenes);
    require_limits(check);
    require_workload(check);
    const auto start = std::chrono::steady_clock::now();
    CheckResults results;
    results.run = run_experiment(check.experiment, scenes, options);
    results.costs = measure_costs(check.experiment, check.set.thresholds, finder, options.backend, options.stop);
    add_failures(results.run, results.costs, "", results.failed_cells);
    if (!stopped(options)) {
        results.verdicts = judge_all(check.set.thresholds, results.run.rows, results.costs.ratios);
        results.must_fail = run_must_fail(check, check.set.thresholds, finder, options, results.failed_cells);
    }
    results.interrupted = stopped(options);
    results.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return results;
}

bool CalibrationResults::proven() const {
    return std::ranges::all_of(must_fail, [](const MustFailVerdict& verdict) { return verdict.proven; });
}

CalibrationResults run_calibration(const CheckFile& check, const SceneFinder& finder, const RunOptions& options,
                                   const CalibrationOptions& calibration) {
    LoadedScenes scenes(finder);
    require_effects_in_scenes(check.experiment, scenes);
    const std::vector<Threshold>& thresholds = check.set.thresholds;
    if (calibration.add) require_workload(check);
    CalibrationResults results;
    std::vector<std::vector<double>> values(thresholds.size());
    std::vector<std::string> failed_cells;
    std::string machine;
    {
        const BusyCores load(calibration.loaded ? std::max(1u, std::thread::hardware_concurrency()) : 0);
        for (int run = 0; run < calibration.repetitions; ++run) {
            const RunResults rows = run_experiment(check.experiment, scenes, options);
            const CostRound costs = measure_costs(check.experiment, thresholds, finder, options.backend, options.stop);
            results.interrupted = stopped(options);
            if (results.interrupted) return results;
            add_failures(rows, costs, "", failed_cells);
            for (std::size_t i = 0; i < thresholds.size(); ++i) {
                const ThresholdValue value = value_of(thresholds[i], rows.rows, costs.ratios);
                if (!value.value || !value.untold.empty()) {
                    failed_cells.push_back(fmt::format("threshold '{}': {}{}", thresholds[i].name, value.unmatched,
                                                       fmt::join(value.untold, "; ")));
                } else {
                    values[i].push_back(*value.value);
                }
            }
            if (!failed_cells.empty())
                throw ConfigError(fmt::format("nothing can be calibrated:\n  {}", fmt::join(failed_cells, "\n  ")));
            machine = fmt::format("{}, {} cores, {}, {}", rows.system.cpu, rows.system.worker_threads, rows.gl_renderer,
                                  calibration.loaded ? "load added" : "no load added");
        }
    }
    results.set.thresholds = calibrate(thresholds, values, calibration.add);
    CalibrationNote note = calibration.add ? check.set.calibration.value_or(CalibrationNote{}) : CalibrationNote{};
    note.machines.push_back(fmt::format("{} runs: {}", calibration.repetitions, machine));
    note.date = utc_now(), note.workload = calibrating_workload_version;
    results.set.calibration = note;
    results.must_fail = run_must_fail(check, results.set.thresholds, finder, options, failed_cells);
    results.interrupted = stopped(options);
    if (!failed_cells.empty() && !results.interrupted)
        throw ConfigError(fmt::format("nothing can be calibrated:\n  {}", fmt::join(failed_cells, "\n  ")));
    return results;
}

}  // namespace plumb
