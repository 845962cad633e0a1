// `plumbline check`: an experiment held against thresholds.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/backend_option.h"
#include "experiments/cache_option.h"
#include "experiments/check_report.h"
#include "experiments/check_run.h"
#include "experiments/command.h"
#include "experiments/disk_use.h"
#include "experiments/exit_code.h"
#include "experiments/interruption.h"
#include "experiments/view_options.h"
#include "frames/atomic_file.h"

namespace plumb {
namespace {

constexpr const char* check_examples = R"(Examples:
  plumbline check experiments/ci.toml                        a build's gate: table, junit.xml, check.json
  plumbline check mine.toml --output out/gate --scenes-dir ~/scenes
  plumbline check mine.toml --calibrate                      limits from ten runs, never tighter than noise
  plumbline check mine.toml --calibrate --add --loaded       and from ten more on busy cores
Exits with 1 where a limit is broken, a cell failed, or a method that must fail passes; with 2 where a threshold matches
no row. docs/continuous_integration.md shows how to put it into your own CI, and what to do when it fails.)";

struct CheckCommandOptions {
    std::filesystem::path file;
    RunOptions run;
    CalibrationOptions calibration;
    bool calibrate = false;
};

void print_disk_use(const CheckFile& file, const CommonOptions& common, const RunOptions& run) {
    const DiskUse use = disk_use(file, SceneFinder(common.scenes_dirs), run.write_frames);
    fmt::print("{}\n", describe_disk_use(use, run.cache_dir, run.output));
    std::fflush(stdout);
}

int check(const CheckCommandOptions& options, const CommonOptions& common) {
    const CheckFile file = load_check_file(options.file);
    RunOptions run = options.run;
    if (run.output.empty()) run.output = std::filesystem::path("out") / file.experiment.name;
    run.stop = &interruption_flag();
    run.command = fmt::format("plumbline check {}", options.file.string());
    require_writable_folder(run.output);
    // A check that ends early must not leave the verdict of the one before.
    for (const char* name : {"junit.xml", "check.json"}) std::filesystem::remove(run.output / name);

    run.experiment_text = read_config_text(options.file);
    print_disk_use(file, common, run);
    const CheckResults results = run_check(file, SceneFinder(common.scenes_dirs), run);
    if (results.interrupted) {
        fmt::print("\nInterrupted: nothing is decided; the truths that were finished are kept.\n");
        return exit_interrupted;
    }
    write_check_files(file, results, run.output);
    const ExitCode code = results.exit_code();
    fmt::print("{}\n\n{}\n{}, {:.0f} s on {}, {}\n", file.experiment.title, print_check_table(results),
               code == exit_fine ? "PASSED" : "FAILED", results.seconds, results.run.system.cpu,
               results.run.gl_renderer);
    for (const char* name : {"junit.xml", "check.json", "index.html"}) fmt::print("{}\n", (run.output / name).string());
    return code;
}

int calibrate(const CheckCommandOptions& options, const CommonOptions& common) {
    const CheckFile file = load_check_file(options.file);
    if (file.thresholds_file.empty()) {
        throw ConfigError(
            fmt::format("'{}': --calibrate rewrites a whole file of thresholds; move the [[thresholds]] into "
                        "one of their own and name it: thresholds = \"FILE.toml\"",
                        options.file.string()));
    }
    RunOptions run = options.run;
    if (run.output.empty()) run.output = std::filesystem::path("out") / file.experiment.name;
    run.stop = &interruption_flag();
    run.command = fmt::format("plumbline check {} --calibrate", options.file.string());
    run.write_frames = false;
    require_writable_folder(run.output);
    print_disk_use(file, common, run);
    const CalibrationResults results = run_calibration(file, SceneFinder(common.scenes_dirs), run, options.calibration);
    if (results.interrupted) {
        fmt::print("\nInterrupted: '{}' is as it was.\n", file.thresholds_file.string());
        return exit_interrupted;
    }
    fmt::print("\n{}\n", print_calibration_table(file.set, results.set));
    for (const MustFailVerdict& verdict : results.must_fail) fmt::print("'{}' {}\n", verdict.name, verdict.message);
    if (!results.proven()) {
        fmt::print(stderr,
                   "plumbline: '{}' is as it was: with the new limits the gate could not fail; break the method of "
                   "[[must_fail]] more, or take a value that is less noisy\n",
                   file.thresholds_file.string());
        return exit_failed;
    }
    write_text_atomically(file.thresholds_file, print_thresholds(results.set));
    fmt::print("{}\n", file.thresholds_file.string());
    return exit_fine;
}

}  // namespace

void add_check_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command =
        app.add_subcommand("check", "Hold an experiment against thresholds: a gate for CI")->group("Measure");
    auto options = std::make_shared<CheckCommandOptions>();
    command->add_option("file", options->file, "Experiment with thresholds (TOML)")->required()->type_name("FILE");
    command->add_option("-o,--output", options->run.output, "Results folder; out/NAME by default");
    add_cache_option(*command, options->run.cache_dir);
    CLI::Option* calibrate_option = command->add_flag(
        "--calibrate", options->calibrate, "Set the limits from repeated runs and write the file of thresholds anew");
    command->add_option("--repetitions", options->calibration.repetitions, "Runs of a calibration")
        ->check(CLI::Range(2, 1000))
        ->capture_default_str()
        ->needs(calibrate_option);
    command->add_flag("--add", options->calibration.add, "Count the runs of earlier calibrations too")
        ->needs(calibrate_option);
    command->add_flag("--loaded", options->calibration.loaded, "Calibrate with every core kept busy by something else")
        ->needs(calibrate_option);
    command->add_option("--threads", options->run.threads, "Threads of the path tracer; 0: all")
        ->check(CLI::NonNegativeNumber);
    add_backend_option(*command, options->run.backend);
    command->footer(check_examples);
    command->callback([options, &common, &action] {
        action = [options, &common] {
            return options->calibrate ? calibrate(*options, common) : check(*options, common);
        };
    });
}

}  // namespace plumb
