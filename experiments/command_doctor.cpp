// `plumbline doctor`: what this machine has, what is missing, and which Debian package brings it.
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/build_facts.h"
#include "experiments/command.h"
#include "experiments/exit_code.h"
#include "experiments/system_facts.h"
#include "rasterizer/gl_context.h"

namespace plumb {
namespace {

std::string cache_or_unknown(long bytes) {
    return bytes > 0 ? print_bytes(static_cast<std::uint64_t>(bytes)) : "unknown";
}

// Prints each context; true where one starts at all.
bool print_contexts() {
    bool any = false;
    fmt::print("\nOpenGL contexts (4.5 core is needed; the first that starts is used by default)\n");
    for (const GlBackendReport& report : GlContext::probe()) {
        fmt::print("  {} {}: {}\n", to_string(report.backend), report.platform,
                   report.starts ? "starts" : "does not start");
        if (report.starts) {
            fmt::print("      vendor    {}\n      renderer  {}\n      version   {}\n      runs on   {}\n",
                       report.info.vendor, report.info.renderer, report.info.version,
                       report.info.software ? "the CPU (software)" : "a GPU");
            any = true;
        } else {
            fmt::print("      {}\n", report.problem);
        }
    }
    return any;
}

int run_doctor(const CommonOptions& common) {
    const BuildFacts& build = build_facts();
    const SystemFacts facts = read_system_facts();
    fmt::print("plumbline {} ({}), {} build by {}\n\n", build.version, build.git_describe, build.build_type,
               build.compiler);
    fmt::print("System     {}\nCPU        {}, {} logical cores, {} worker threads (TBB)\n", facts.operating_system,
               facts.cpu, facts.logical_cores, facts.worker_threads);
    fmt::print("Memory     {}, {} available\n", print_bytes(facts.memory_bytes), print_bytes(facts.available_bytes));
    fmt::print("Caches     L1 {}, L2 {}, L3 {}\n", cache_or_unknown(facts.level1_bytes),
               cache_or_unknown(facts.level2_bytes), cache_or_unknown(facts.level3_bytes));
    fmt::print("Embree     {}\n", facts.embree);
    const bool draws = print_contexts();

    std::vector<std::string> missing;
    if (!draws)
        missing.push_back(
            "no OpenGL 4.5 context starts: apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6");
    if (facts.embree == "does not start") missing.push_back("Embree does not start: apt-get install libembree3-3");
    if (common.scenes_dirs.empty()) {
        fmt::print(
            "\nExternal scenes: none; --scenes-dir or PLUMBLINE_SCENES names their folder (the built-in ones need "
            "none)\n");
    }
    for (const auto& folder : common.scenes_dirs) {
        if (std::filesystem::is_directory(folder)) {
            fmt::print("\nExternal scenes: '{}'\n", folder.string());
        } else {
            missing.push_back(fmt::format("scenes folder '{}' does not exist", folder.string()));
        }
    }

    if (missing.empty()) {
        fmt::print("\nNothing is missing.\n");
        return exit_fine;
    }
    fmt::print("\nMissing:\n");
    for (const std::string& item : missing) fmt::print("  {}\n", item);
    return exit_environment;
}

}  // namespace

void add_doctor_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command =
        app.add_subcommand("doctor", "Print what this machine has and what is missing")->group("Look around");
    command->footer("Example:\n  plumbline doctor\nExits with 3 where something is missing.");
    command->callback([&] { action = [&] { return run_doctor(common); }; });
}

}  // namespace plumb
