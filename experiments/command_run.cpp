// `plumbline run`: a whole experiment.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/accuracy_figure.h"
#include "experiments/backend_option.h"
#include "experiments/cache_option.h"
#include "experiments/command.h"
#include "experiments/convergence_report.h"
#include "experiments/disk_use.h"
#include "experiments/exit_code.h"
#include "experiments/experiment_file.h"
#include "experiments/generation.h"
#include "experiments/headline_table.h"
#include "experiments/interruption.h"
#include "experiments/ladder.h"
#include "experiments/recorded_run.h"
#include "experiments/runner.h"
#include "experiments/summary.h"
#include "experiments/view_options.h"
#include "frames/atomic_file.h"

namespace plumb {
namespace {

constexpr const char* run_examples = R"(Examples:
  plumbline run experiments/one_vs_two_layers.toml
  plumbline run experiments/one_vs_two_layers.toml --quick          a look at it within a minute
  plumbline run experiments/convergence.toml                     how fast the truth comes: a figure
  plumbline run experiments/generation.toml                      second layers held against the exact ones
  plumbline run out/one_vs_two_layers/results.json --output out/again     a run once more, held against what it found
  plumbline run mine.toml --output out/mine --scenes-dir ~/scenes
Exits with 1 where cells failed (they are listed) or a repeated run came out otherwise, with 130 where it was interrupted.)";

struct RunCommandOptions {
    std::filesystem::path experiment;
    RunOptions run;
    bool quick = false, no_frames = false;
};

void print_question(const std::string& title, const std::string& question) {
    fmt::print("{}\n", title);
    if (!question.empty()) fmt::print("{}\n", question);
}

// What all kinds of experiment share.
RunOptions run_options_of(const RunCommandOptions& options, const std::string& name) {
    RunOptions run = options.run;
    if (run.output.empty()) run.output = std::filesystem::path("out") / name;
    run.write_frames = !options.no_frames;
    run.stop = &interruption_flag();
    run.command = fmt::format("plumbline run {}{}", options.experiment.string(), options.quick ? " --quick" : "");
    require_writable_folder(run.output);
    return run;
}

// `what` failed: "cell".
void print_failures(const std::vector<CellFailure>& failures, const std::string& what) {
    if (failures.empty()) return;
    fmt::print("\n{} {}{} failed:\n", failures.size(), what, failures.size() == 1 ? "" : "s");
    for (const CellFailure& failure : failures) fmt::print("  {}: {}\n", failure.cell, failure.message);
}

ExitCode exit_code_of(const std::vector<CellFailure>& failures) { return failures.empty() ? exit_fine : exit_failed; }

int run_convergence(const RunCommandOptions& options, const CommonOptions& common, ConvergenceExperiment experiment) {
    if (options.quick) make_quick(experiment);
    const RunOptions run_options = run_options_of(options, experiment.name);
    print_question(experiment.title, experiment.question);
    const ConvergenceResults results = run_convergence(experiment, SceneFinder(common.scenes_dirs), run_options);
    if (results.interrupted) {
        fmt::print("\nInterrupted: nothing was written; the same command finds the references that were finished.\n");
        return exit_interrupted;
    }
    write_convergence_files(results, run_options.output);
    fmt::print("\n{}\n{:.0f} s on {}\n", print_convergence_table(results), results.seconds, results.system.cpu);
    for (const char* file : {"convergence.csv", "convergence.json", "convergence.svg", "index.html"})
        fmt::print("{}\n", (run_options.output / file).string());
    print_failures(results.failures, "scene");
    return exit_code_of(results.failures);
}

int run_generation(const RunCommandOptions& options, const CommonOptions& common, GenerationExperiment experiment) {
    if (options.quick) make_quick(experiment);
    const RunOptions run_options = run_options_of(options, experiment.name);
    print_question(experiment.title, experiment.question);
    const GenerationResults results = run_generation(experiment, SceneFinder(common.scenes_dirs), run_options);
    if (results.interrupted) {
        fmt::print("\nInterrupted: nothing was written.\n");
        return exit_interrupted;
    }
    write_generation_files(results, run_options.output);
    fmt::print("\n{}\n{:.0f} s, {} on {}\n", print_generation_table(results), results.seconds, results.gl_renderer,
               results.system.cpu);
    for (const char* file : {"generation.csv", "generation.json"})
        fmt::print("{}\n", (run_options.output / file).string());
    print_failures(results.failures, "walk");
    return exit_code_of(results.failures);
}

void write_figures(const RunResults& results, const std::filesystem::path& folder) {
    if (!results.waterfalls.empty()) {
        write_text_atomically(folder / "ladder.svg", print_waterfalls(results.waterfalls));
        write_text_atomically(folder / "ladder.csv", print_waterfall_csv(results.waterfalls));
        fmt::print("Ladder  {}\n", (folder / "ladder.svg").string());
    }
    if (const std::string headline = print_headline(results); !headline.empty()) {
        write_text_atomically(folder / "headline.md", headline);
        fmt::print("Summary {}\n", (folder / "headline.md").string());
    }
    const std::string figure = print_accuracy_figure(results);
    if (figure.empty()) return;
    write_text_atomically(folder / "accuracy.svg", figure);
    write_text_atomically(folder / "equal_rows.csv", print_equal_rows_csv(results));
    fmt::print("Figure  {}\n", (folder / "accuracy.svg").string());
}

RunResults run_comparison(const RunOptions& run_options, const CommonOptions& common, Experiment experiment) {
    const SceneFinder finder(common.scenes_dirs);
    LoadedScenes scenes(finder);
    print_question(experiment.title, experiment.question);
    for (const LeftOutScene& scene : leave_out_absent_scenes(experiment, scenes))
        fmt::print("left out: {}\n", scene.message);
    require_effects_in_scenes(experiment, scenes);
    fmt::print("{}\n", describe_disk_use(disk_use(experiment, scenes, run_options.write_frames), run_options.cache_dir,
                                         run_options.output));
    std::fflush(stdout);
    RunResults results = run_experiment(experiment, scenes, run_options);

    fmt::print("\n{}\n{}\n", print_results_table(results.rows), print_equal_rows(results));
    for (const std::string& sentence : results.summary) fmt::print("* {}\n", sentence);
    if (!results.waterfalls.empty()) fmt::print("\n{}", print_waterfall_table(results.waterfalls));
    int cached = 0;
    for (const ReferenceUse& use : results.references) cached += use.from_cache ? 1 : 0;
    fmt::print("\n{} truths ({} of them from the cache), {} on {}, {:.0f} s\n", results.references.size(), cached,
               results.gl_renderer, results.system.cpu, results.seconds);
    print_failures(results.failures, "cell");
    fmt::print("\nTable   {}\nRegions {}\nNumbers {}\nPage    {}\n", (run_options.output / "results.csv").string(),
               (run_options.output / "regions.csv").string(), (run_options.output / "results.json").string(),
               (run_options.output / "index.html").string());
    write_figures(results, run_options.output);
    if (results.interrupted) fmt::print("\nInterrupted: the same command goes on where this one stopped.\n");
    return results;
}

int exit_code_of(const RunResults& results) {
    return results.interrupted ? exit_interrupted : exit_code_of(results.failures);
}

// A run as its results.json tells it.
int repeat(const RunCommandOptions& options, const CommonOptions& common) {
    const RecordedRun recorded = read_recorded_run(options.experiment);
    RunOptions run_options = run_options_of(options, recorded.experiment.name);
    run_options.experiment_text = recorded.experiment_text;
    if (std::filesystem::equivalent(run_options.output, options.experiment.parent_path())) {
        throw ConfigError(
            fmt::format("'{}' would be overwritten by its own repetition; name another folder with "
                        "--output",
                        options.experiment.string()));
    }
    const RunResults results = run_comparison(run_options, common, recorded.experiment);
    if (results.interrupted) return exit_interrupted;
    const RunDifference apart = difference(recorded, results);
    fmt::print("\n{} of {} rows are as recorded, bit for bit but for their times\n", apart.same, apart.rows);
    for (const std::string& row : apart.rows_apart) fmt::print("  {}\n", row);
    for (const std::string& cause : apart.causes) fmt::print("not as it was: {}\n", cause);
    return apart.rows_apart.empty() ? exit_code_of(results) : exit_failed;
}

int run(const RunCommandOptions& options, const CommonOptions& common) {
    if (options.experiment.extension() == ".json") return repeat(options, common);
    const std::string text = read_config_text(options.experiment);
    const ConfigValue table = parse_config(text, options.experiment.string());
    switch (kind_of(table, options.experiment)) {
        case ExperimentKind::convergence:
            return run_convergence(options, common, parse_convergence(table, options.experiment));
        case ExperimentKind::generation:
            return run_generation(options, common, parse_generation(table, options.experiment));
        case ExperimentKind::comparison:
            break;
    }
    Experiment experiment = parse_experiment(table, options.experiment);
    if (options.quick) make_quick(experiment);
    RunOptions run_options = run_options_of(options, experiment.name);
    run_options.experiment_text = text;
    return exit_code_of(run_comparison(run_options, common, std::move(experiment)));
}

}  // namespace

void add_run_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command = app.add_subcommand("run", "Run an experiment: table, files and page")->group("Measure");
    auto options = std::make_shared<RunCommandOptions>();
    command->add_option("experiment", options->experiment, "Experiment file (TOML), or the results.json of a run")
        ->required()
        ->type_name("FILE");
    command->add_option("-o,--output", options->run.output, "Results folder; out/NAME by default");
    add_cache_option(*command, options->run.cache_dir);
    command->add_flag("--quick", options->quick,
                      "Try it: a quarter of the resolution, one view per scene, few samples");
    command->add_flag("--no-frames", options->no_frames, "Do not write EXR files");
    command->add_option("--threads", options->run.threads, "Threads of the path tracer; 0: all")
        ->check(CLI::NonNegativeNumber);
    add_backend_option(*command, options->run.backend);
    command->footer(run_examples);
    command->callback([options, &common, &action] { action = [options, &common] { return run(*options, common); }; });
}

}  // namespace plumb
