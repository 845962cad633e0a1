// The subcommands of `plumbline`. Each file command_NAME.cpp adds one: its options, its help, and what it does.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace plumb {

// Options that every subcommand understands.
struct CommonOptions {
    std::vector<std::filesystem::path> scenes_dirs;  // folders of external scenes
    std::vector<std::string> arguments;              // as typed, behind the program's name
};

// Set by a subcommand whose options were given: what to run; the result is the exit code.
using Action = std::function<int()>;

void add_doctor_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_scenes_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_render_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_reference_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_compare_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_judge_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_check_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_run_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_tune_command(CLI::App& app, const CommonOptions& common, Action& action);
void add_reproduce_command(CLI::App& app, const CommonOptions& common, Action& action);

// Parses the command line, runs the subcommand, and turns errors into a message and an exit code.
int run_command_line(int argc, const char* const* argv);

}  // namespace plumb
