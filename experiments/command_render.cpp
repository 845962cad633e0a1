// `plumbline render`: one view through the OpenGL pipeline, with the time of each pass.
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/backend_option.h"
#include "experiments/command.h"
#include "experiments/exit_code.h"
#include "experiments/method_file.h"
#include "experiments/method_timing.h"
#include "experiments/scene_finder.h"
#include "experiments/terminal_table.h"
#include "experiments/view_options.h"
#include "frames/exr.h"
#include "rasterizer/pipeline.h"
#include "scenes/effects.h"

namespace plumb {
namespace {

constexpr const char* examples = R"(Examples:
  plumbline render cornell --method two_layers
  plumbline render clutter --method one_layer --set ao.samples=50 --set ao.blur.radius=0 --explain
  plumbline render cornell --path strafe --time 0.5
  plumbline render colonnade --method mine.toml --backend osmesa --planes total,layer2.depth
  plumbline render cornell --print-method          the method with all its parameters, as TOML)";

struct Options {
    ViewOptions view;
    std::string method = "two_layers";
    std::vector<std::string> assignments;
    GlBackend backend = GlBackend::automatic;
    std::filesystem::path truth;
    int repetitions = 5;
    bool explain = false, print_method = false;
};

void print_effects(const EffectPlan& plan) {
    TerminalTable table({{"effect"}, {"scene"}, {"why"}});
    for (const Effect& effect : plan.effects) {
        table.add_row({to_string(effect.kind), effect.on ? "on" : "off", effect.reason});
    }
    fmt::print("{}\n", table.print());
}

void print_decisions(const Pipeline& pipeline) {
    TerminalTable table({{"pass"}, {"runs"}, {"why"}});
    for (const PassDecision& decision : pipeline.decisions()) {
        table.add_row({decision.pass, decision.runs ? "on" : "off", decision.reason});
    }
    fmt::print("{}\n", table.print());
}

void print_timing(const Timing& timing, const GlInfo& info) {
    using Align = TerminalTable::Align;
    TerminalTable table({{"pass"}, {"ms", Align::right}});
    for (const PassTiming& pass : timing.passes) table.add_row({pass.pass, fmt::format("{:.3f}", pass.milliseconds)});
    table.add_rule();
    table.add_row({"all", fmt::format("{:.3f}", timing.median)});
    fmt::print("{}median of {} frames, quartiles {:.3f} and {:.3f} ms; {}; timed by {}\n", table.print(),
               timing.repetitions, timing.lower_quartile, timing.upper_quartile, info.renderer,
               info.software ? "the steady clock after glFinish (software)" : "GPU timer queries");
}

int render(const Options& options, const CommonOptions& common) {
    Method method = load_method(options.method);
    for (const std::string& assignment : options.assignments) set_method_parameter(method, assignment);
    if (options.print_method) {
        fmt::print("{}", print_method(method));
        return exit_fine;
    }
    const Scene scene = options.view.load(SceneFinder(common.scenes_dirs));
    const View view = options.view.make_view(scene);
    Frame truth;
    if (!options.truth.empty()) truth = read_exr(options.truth);

    const std::unique_ptr<GlContext> context = GlContext::create(options.backend);
    Pipeline pipeline(*context, scene, method, options.view.read_quantities(), view.width(), view.height());
    if (options.explain) {
        print_effects(plan_effects(scene));
        print_decisions(pipeline);
    }
    const Frame* given_truth = options.truth.empty() ? nullptr : &truth;
    RasterResult result = pipeline.render(view, nullptr, given_truth);
    if (options.repetitions > 0) {
        const ExperimentTiming timing{1, options.repetitions};
        print_timing(time_interleaved({&pipeline}, view, given_truth, timing).front(), context->info());
    }
    result.frame.facts["scene"] = options.view.scene;
    result.frame.facts["view"] = view.camera().name;
    result.frame.facts["method"] = method.name;
    result.frame.facts["method_parameters"] = print_method(method);
    result.frame.facts["renderer"] = context->info().renderer;
    write_frame_files(result.frame, options.view, view.camera().name, method.name);
    return exit_fine;
}

}  // namespace

void add_render_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command = app.add_subcommand("render", "Render one view in OpenGL with a method")->group("Render");
    auto options = std::make_shared<Options>();
    options->view.add_to(*command, {"ao", "direct", "indirect", "total"});
    const std::string group = "Method";
    command->add_option("--method", options->method, "Built-in method or TOML file")
        ->capture_default_str()
        ->group(group);
    command->add_option("--set", options->assignments, "Set a parameter: name=value (repeatable)")
        ->group(group)
        ->type_name("NAME=VALUE");
    command->add_option("--truth", options->truth, "EXR frame for stages that the method takes from the truth")
        ->group(group)
        ->type_name("FILE");
    command->add_flag("--print-method", options->print_method, "Print the method as TOML and stop")->group(group);
    command->add_flag("--explain", options->explain, "Print each effect and pass, on or off, and why");
    command->add_option("--repetitions", options->repetitions, "Frames to time; 0: none")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    add_backend_option(*command, options->backend);
    command->footer(examples);
    command->callback(
        [options, &common, &action] { action = [options, &common] { return render(*options, common); }; });
}

}  // namespace plumb
