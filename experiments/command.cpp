#include "experiments/command.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/build_facts.h"
#include "experiments/config.h"
#include "experiments/exit_code.h"
#include "frames/image_error.h"
#include "pathtracer/reference_error.h"
#include "rasterizer/gl_error.h"
#include "scenes/scene_error.h"
#include "scenes/scene_file.h"

namespace plumb {
namespace {

constexpr const char* all_examples = R"(Examples:
  plumbline doctor                                        what works on this machine
  plumbline scenes                                        what there is to see
  plumbline render cornell --method two_layers            one view in OpenGL, with the time of each pass
  plumbline reference cornell --samples 256               the same view, path traced
  plumbline compare a.exr b.exr --fail-above rmse=0.01    two images, and a gate for scripts
  plumbline judge frames/ --scene clutter --path slide    your own engine's frames against the truth
  plumbline run experiments/one_vs_two_layers.toml        a whole experiment: table, files, page
  plumbline reproduce --list                              figures and claims of the literature, made again
  plumbline check experiments/ci.toml                     the same held against limits: a gate for CI
  plumbline COMMAND --help                                the options of one command

Exit codes: 0 fine, 1 a threshold or comparison failed, 2 wrong use or bad input, 3 the environment lacks something,
130 interrupted (what was done is kept).
)";

// CLI11 only says that a subcommand is required; a misspelt one deserves better.
std::string unknown_command_hint(const CLI::App& app, int argc, const char* const* argv) {
    if (argc < 2 || argv[1][0] == '-') return "";
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    const std::string name = argv[1];
    if (std::find(names.begin(), names.end(), name) != names.end()) return "";
    return fmt::format("no command is called '{}'; {}", name, name_hint(name, names));
}

int report(ExitCode code, const std::exception& error) {
    fmt::print(stderr, "plumbline: {}\n", error.what());
    return code;
}

int run_action(const Action& action) {
    try {
        return action();
    } catch (const GlUnavailable& error) {
        fmt::print(stderr, "plumbline: {}\n('plumbline doctor' tells what works on this machine)\n", error.what());
        return exit_environment;
    } catch (const ConfigError& error) {
        return report(exit_wrong_use, error);
    } catch (const SceneError& error) {
        return report(exit_wrong_use, error);
    } catch (const ImageError& error) {
        return report(exit_wrong_use, error);
    } catch (const ReferenceError& error) {
        return report(exit_wrong_use, error);
    } catch (const MethodError& error) {
        return report(exit_wrong_use, error);
    } catch (const std::exception& error) {
        return report(exit_environment, error);  // a driver that fails, memory that runs out
    }
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
    // A file that may not grow further (ulimit -f) is an error to report, not an end without a word.
    std::signal(SIGXFSZ, SIG_IGN);
    CLI::App app("Plumbline measures real-time global illumination against a path-traced truth.", "plumbline");
    app.set_version_flag("--version",
                         fmt::format("plumbline {} ({})", build_facts().version, build_facts().git_describe));
    app.footer(all_examples);
    app.require_subcommand(1);
    app.fallthrough();

    CommonOptions common;
    common.arguments.assign(argv + std::min(argc, 1), argv + argc);
    common.scenes_dirs = scenes_dirs_of_environment();
    app.add_option("--scenes-dir", common.scenes_dirs, "Folder of external scenes (repeatable; else PLUMBLINE_SCENES)")
        ->type_name("FOLDER")
        ->allow_extra_args(false);

    Action action;
    add_doctor_command(app, common, action);
    add_scenes_command(app, common, action);
    add_render_command(app, common, action);
    add_reference_command(app, common, action);
    add_compare_command(app, common, action);
    add_judge_command(app, common, action);
    add_run_command(app, common, action);
    add_tune_command(app, common, action);
    add_reproduce_command(app, common, action);
    add_check_command(app, common, action);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const std::string hint = unknown_command_hint(app, argc, argv);
        if (!hint.empty()) {
            fmt::print(stderr, "plumbline: {}\n", hint);
            return exit_wrong_use;
        }
        return app.exit(error) == 0 ? exit_fine : exit_wrong_use;
    }
    return run_action(action);
}

}  // namespace plumb
