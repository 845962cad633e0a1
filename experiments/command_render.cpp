// `plumbline render`: one view through the OpenGL pipeline, with the time of each pass.
#include <algorithm>
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
#include "experiments/settling.h"
#include "experiments/terminal_table.h"
#include "experiments/view_options.h"
#include "frames/exr.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/pass_timer.h"
#include "rasterizer/pipeline.h"
#include "scenes/effects.h"

namespace plumb {
namespace {

constexpr const char* render_examples = R"(Examples:
  plumbline render cornell --method two_layers
  plumbline render clutter --method one_layer --set ao.samples=50 --set ao.blur.radius=0 --explain
  plumbline render cornell --path strafe --time 0.5
  plumbline render clutter-moving --path strafe --time 2 --frames 30 --set ao.temporal.alpha=0.9
  plumbline render colonnade --method mine.toml --backend osmesa --planes total,layer2.depth
  plumbline render cornell --print-method          the method with all its parameters, as TOML)";

struct RenderCommandOptions {
    ViewOptions view;
    std::string method = "two_layers";
    std::vector<std::string> assignments;
    GlBackend backend = GlBackend::automatic;
    std::filesystem::path truth;
    int frames = 0;  // 0: as many as the method needs to settle
    double frames_per_second = 30.0;
    std::uint32_t seed = 0;
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
               timer_description(info.software));
}

// What a method that suits many scenes sets and this one has nothing for.
void print_idle_parameters(const Method& method, const Scene& scene) {
    for (const MethodDifference& difference : diff_methods(Method(), method)) {
        if (!reason_without_effect(method, difference.parameter).empty()) continue;
        const std::string reason = reason_without_effect(method, difference.parameter, nullptr, &scene);
        if (!reason.empty())
            fmt::print("note: {} = {} has no effect, because {}\n", difference.parameter, difference.second, reason);
    }
}

// The frame at --time after those before it, so that what the method keeps from frame to frame has come about.
RasterResult render_last_frame(Pipeline& pipeline, const RenderCommandOptions& options, const Scene& scene,
                               const Method& method, const Frame* truth) {
    const int frames = options.frames > 0 ? options.frames : frames_to_settle(method);
    if (frames == 1)
        return pipeline.render({.now = {options.view.make_view(scene)}, .truth = truth, .seed = options.seed});
    const auto at = [&](int frame) {
        const double time = options.view.time - (frames - 1 - frame) / options.frames_per_second;
        return Moment{options.view.make_view(scene, time), time};
    };
    if (truth && (!options.view.path.empty() || std::ranges::any_of(scene.instances, &Instance::moves))) {
        throw MethodError(fmt::format(
            "--truth is that of one moment, and {} frames are rendered in which something moves; set --frames to 1",
            frames));
    }
    const auto request = [&](int frame) {
        return FrameRequest{
            .now = at(frame), .previous = at(frame - 1), .next = at(frame + 1), .truth = truth, .seed = options.seed};
    };
    for (int frame = 0; frame + 1 < frames; ++frame) pipeline.time_passes(request(frame));
    fmt::print("frame {} of {}, at {:.3f} s\n", frames, frames, options.view.time);
    return pipeline.render(request(frames - 1));
}

int render(const RenderCommandOptions& options, const CommonOptions& common) {
    Method method = load_method(options.method);
    const std::vector<std::string> planes = options.view.read_quantities().planes;
    set_method_parameters(method, options.assignments, &planes);
    if (options.print_method) {
        fmt::print("{}", print_method(method));
        return exit_fine;
    }
    const Scene scene = options.view.load(SceneFinder(common.scenes_dirs));
    set_method_parameters(method, options.assignments, &planes, &scene);
    print_idle_parameters(method, scene);
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
    RasterResult result = render_last_frame(pipeline, options, scene, method, given_truth);
    if (options.repetitions > 0) {
        const ExperimentTiming timing{1, options.repetitions};
        print_timing(time_interleaved({&pipeline}, view, given_truth, timing).front(), context->info());
    }
    result.frame.facts["scene"] = options.view.scene;
    result.frame.facts["view"] = view.camera().name;
    result.frame.facts["method"] = method.name;
    result.frame.facts["seed"] = fmt::format("{}", options.seed);
    result.frame.facts["method_parameters"] = print_method(method);
    result.frame.facts["renderer"] = context->info().renderer;
    write_frame_files(result.frame, options.view, view.camera().name, method.name);
    return exit_fine;
}

}  // namespace

void add_render_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command = app.add_subcommand("render", "Render one view in OpenGL with a method")->group("Render");
    auto options = std::make_shared<RenderCommandOptions>();
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
    command
        ->add_option("--frames", options->frames,
                     "Frames to render, the last of them the one shown; by default as many as what the method keeps "
                     "from frame to frame needs to settle")
        ->check(CLI::Range(1, 100000))
        ->group(group);
    command
        ->add_option("--frames-per-second", options->frames_per_second,
                     "Of those frames, along --path and as objects move")
        ->check(CLI::PositiveNumber)
        ->capture_default_str()
        ->group(group);
    command
        ->add_option("--seed", options->seed,
                     "Of the patterns of taps: other seeds give independent noise; 0: patterns as published")
        ->capture_default_str()
        ->group(group);
    command->add_option("--repetitions", options->repetitions, "Frames to time; 0: none")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    add_backend_option(*command, options->backend);
    command->footer(render_examples);
    command->callback(
        [options, &common, &action] { action = [options, &common] { return render(*options, common); }; });
}

}  // namespace plumb
