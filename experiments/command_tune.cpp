// `plumbline tune`: the free parameters of a method at their best.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/backend_option.h"
#include "experiments/cache_option.h"
#include "experiments/command.h"
#include "experiments/disk_use.h"
#include "experiments/exit_code.h"
#include "experiments/interruption.h"
#include "experiments/statistics.h"
#include "experiments/terminal_table.h"
#include "experiments/tuning_views.h"
#include "frames/atomic_file.h"

namespace plumb {
namespace {

constexpr const char* tune_examples = R"(Examples:
  plumbline tune two_layers --on experiments/one_vs_two_layers.toml --plane ao --free ao.intensity=0.25..2 --free ao.blur.radius=0..6
  plumbline tune mine.toml --on experiments/one_vs_two_layers.toml --plane ao --free ao.samples=4..40 --free ao.blur.radius=0..6 --budget 30
The experiment gives scenes, views, radii, truths and resolution; its methods are not used. Every other view of each scene is
held out: it judges the result and has no part in it. A scene's own overrides win over the method, so what is tuned must not
be among them.)";

struct TuneCommandOptions {
    std::string method, plane = "ao", name;
    std::filesystem::path experiment, output;
    std::vector<std::string> free;
    TuningSettings settings;
    RunOptions run;
    int hold_out = 2;
    bool limited = false, quick = false;
};

// What a scene overrides cannot be tuned: every trial would be the same.
void refuse_overridden(const Experiment& experiment, const Method& method,
                       const std::vector<FreeParameter>& parameters) {
    for (const ExperimentScene& scene : experiment.scenes) {
        for (const FreeParameter& parameter : parameters) {
            const std::string low =
                parameter.choices.empty() ? fmt::format("{}", parameter.low) : parameter.choices.front();
            const std::string high =
                parameter.choices.empty() ? fmt::format("{}", parameter.high) : parameter.choices.back();
            Method first = method, second = method;
            set_method_parameter(first, fmt::format("{}={}", parameter.name, low));
            set_method_parameter(second, fmt::format("{}={}", parameter.name, high));
            const std::string source = experiment.file.string();
            if (method_hash(method_in_scene(first, scene, source)) !=
                method_hash(method_in_scene(second, scene, source)))
                continue;
            throw ConfigError(
                fmt::format("{}: scene '{}' sets {} for all methods, so that it cannot be tuned there; "
                            "remove it from the experiment",
                            source, scene.scene, parameter.name));
        }
    }
}

std::string error_text(const TuningCost& cost) { return cost.told() ? fmt::format("{:.4g}", cost.error) : "refused"; }

std::string print_views(const std::vector<ViewCost>& before, const std::vector<ViewCost>& after) {
    using Align = TerminalTable::Align;
    TerminalTable table({{"scene"},
                         {"view"},
                         {"used"},
                         {"RMSE before", Align::right},
                         {"after", Align::right},
                         {"ratio", Align::right},
                         {"ms before", Align::right},
                         {"after", Align::right}});
    for (std::size_t i = 0; i < before.size(); ++i) {
        const TuningCost &a = before[i].cost, &b = after[i].cost;
        table.add_row({before[i].view.scene, before[i].view.view, before[i].view.held_out ? "held out" : "training",
                       error_text(a), error_text(b),
                       a.told() && b.told() ? fmt::format("{:.3f}", b.error / a.error) : "-",
                       fmt::format("{:.3g}", a.milliseconds), fmt::format("{:.3g}", b.milliseconds)});
    }
    return table.print();
}

std::string print_ratio(const std::vector<ViewCost>& before, const std::vector<ViewCost>& after) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const TuningCost &a = before[i].cost, &b = after[i].cost;
        if (a.told() && b.told()) ratios.push_back(b.error / a.error);
    }
    const RatioSummary ratio = summarise_ratios(ratios);
    if (ratio.count == 0) return "the truth is too noisy for a statement";
    if (!ratio.has_interval())
        return fmt::format("{:.3f} times the RMSE over {} view{}, too few for an interval", ratio.mean, ratio.count,
                           ratio.count == 1 ? "" : "s");
    return fmt::format("{:.3f} times the RMSE (95 % interval {:.3f} to {:.3f} over {} views)", ratio.mean, ratio.lower,
                       ratio.upper, ratio.count);
}

std::string name_of_tuned(const TuneCommandOptions& options, const Method& start) {
    return options.name.empty() ? start.name + "_tuned" : options.name;
}

int run(TuneCommandOptions options, const CommonOptions& common) {
    Experiment experiment = load_experiment(options.experiment);
    if (options.quick) make_small(experiment);  // all views are needed
    const Method start = load_method(options.method);
    std::vector<FreeParameter> parameters;
    experiment.planes = {options.plane};
    for (const std::string& text : options.free)
        parameters.push_back(parse_free_parameter(text, start, &experiment.planes));
    experiment.methods = {start};
    experiment.baseline = start.name;
    refuse_overridden(experiment, start, parameters);
    options.run.stop = &interruption_flag();
    if (options.output.empty())
        options.output = std::filesystem::path("out") / (name_of_tuned(options, start) + ".toml");
    const SceneFinder finder(common.scenes_dirs);
    LoadedScenes scenes(finder);
    // Nothing but truths, and a file of a method.
    fmt::print("{}\n", describe_disk_use({disk_use(experiment, scenes, false).cache, 0}, options.run.cache_dir,
                                         std::filesystem::absolute(options.output).parent_path()));
    std::fflush(stdout);

    const TuningViews views(experiment, options.plane, options.limited, options.hold_out, finder, options.run);
    int trials = 0;
    const TuningResult result = tune(start, parameters, options.settings, [&](const Method& method) {
        if (options.run.stop->load()) throw ConfigError("interrupted: nothing was written; truths are kept");
        TuningCost cost = views.training_cost(method);
        std::string values;
        Method copy = method;
        for (const MethodParameter& parameter : method_parameters(copy)) {
            for (const FreeParameter& free : parameters) {
                if (free.name == parameter.name)
                    values += fmt::format("{} = {}  ", free.name, print_parameter(parameter));
            }
        }
        fmt::print("{:4}  {}{}, {:.3g} ms\n", ++trials, values,
                   cost.told() ? fmt::format("RMSE {:.5g}", cost.error) : "refused, " + cost.refusal,
                   cost.milliseconds);
        std::fflush(stdout);
        return cost;
    });

    Method best = result.best.method;
    best.name = name_of_tuned(options, start);
    for (const bool held_out : {false, true}) {
        const std::vector<std::vector<ViewCost>> costs = views.costs({start, best}, held_out);
        fmt::print("\n{}{}: {}\n", print_views(costs[0], costs[1]), held_out ? "held out" : "training",
                   print_ratio(costs[0], costs[1]));
    }
    if (!result.best.within_budget)
        fmt::print("no combination keeps the budget of {} ms; this is the fastest\n", options.settings.budget);
    fmt::print("\n");
    for (const MethodDifference& difference : diff_methods(start, best))
        fmt::print("{}: {} -> {}\n", difference.parameter, difference.first, difference.second);
    write_text_atomically(options.output, fmt::format("# {} tuned on {} for the plane {}: {} trials.\n{}", start.name,
                                                      options.experiment.string(), options.plane, result.trials.size(),
                                                      print_method(best)));
    fmt::print("{}\n", options.output.string());
    return result.best.within_budget ? exit_fine : exit_failed;
}

}  // namespace

void add_tune_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command =
        app.add_subcommand("tune", "Find the parameters of a method that make its error smallest")->group("Measure");
    auto options = std::make_shared<TuneCommandOptions>();
    command->add_option("method", options->method, "Method: a name or a TOML file")->required();
    command->add_option("--on", options->experiment, "Experiment whose scenes, views and truths are used")
        ->required()
        ->type_name("FILE");
    command->add_option("--plane", options->plane, "Plane whose error is made small")->capture_default_str();
    command->add_option("--free", options->free, "A free parameter: name=low..high or name=this|that; may be repeated")
        ->required();
    command->add_option("--budget", options->settings.budget, "Milliseconds that a frame may take; 0: no limit")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--steps", options->settings.steps, "Values tried per parameter and pass")
        ->check(CLI::Range(3, 1000))
        ->capture_default_str();
    command->add_option("--passes", options->settings.passes, "Times that all ranges are narrowed")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_option("--hold-out", options->hold_out, "Every so many views of a scene one is held out")
        ->check(CLI::Range(2, 1000))
        ->capture_default_str();
    command->add_flag("--limited", options->limited, "Indirect light: against the truth limited to the radius");
    command->add_flag("--quick", options->quick, "Try it: a quarter of the resolution, few samples");
    command->add_option("--name", options->name, "Name of the tuned method; METHOD_tuned by default");
    command->add_option("-o,--output", options->output, "File of the tuned method; out/NAME.toml by default");
    command->add_option("--threads", options->run.threads, "Threads of the path tracer; 0: all")
        ->check(CLI::NonNegativeNumber);
    add_cache_option(*command, options->run.cache_dir);
    add_backend_option(*command, options->run.backend);
    command->footer(tune_examples);
    command->callback([options, &common, &action] { action = [options, &common] { return run(*options, common); }; });
}

}  // namespace plumb
