// `plumbline reproduce`: the figures, tables and claims of the seeds, made again.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/backend_option.h"
#include "experiments/cache_option.h"
#include "experiments/claims_report.h"
#include "experiments/command.h"
#include "experiments/exit_code.h"
#include "experiments/interruption.h"
#include "experiments/reproduction.h"
#include "experiments/reproduction_key.h"
#include "experiments/terminal_table.h"
#include "experiments/view_options.h"
#include "frames/atomic_file.h"
#include "rasterizer/gl_error.h"

namespace plumb {
namespace {

constexpr const char* reproduce_examples = R"(Examples:
  plumbline reproduce --list                          what there is, and where in the seeds it stands
  plumbline reproduce thesis-gbuffer-time             one of them: figures, the original's numbers, claims
  plumbline reproduce --all --scenes-dir ~/scenes     all of them, and the table of claims; once more after a kill, it goes on
  plumbline reproduce thesis-ssao-samples --present   its files again, from the numbers of the last run
  plumbline reproduce --claims out/reproduce          the table of claims again, from finished runs
Each writes OUTPUT/NAME/: README.md, figures as SVG, PNG and CSV, numbers.csv, claims.json, and the run's own page in
run/. What this program has measured of the same file and scenes before, without a failure, is not measured again, unless with
--again. Exits with 1 where cells or whole experiments failed, which are listed at the end; claims that fail are a finding, not
a failure.)";

struct ReproduceCommandOptions {
    std::vector<std::string> names;
    RunOptions run;
    std::filesystem::path output = "out/reproduce", claims_folder, report;
    bool all = false, list = false, quick = false, present = false, again = false, frames = false;
};

int print_list() {
    TerminalTable table({{"name"}, {"what"}, {"stands in"}});
    for (const std::string& name : reproduction_names()) {
        const Reproduction reproduction = load_reproduction(name);
        std::vector<std::string> row = {name, reproduction.title};
        for (const std::string& source : reproduction.sources()) {
            row.resize(2);
            row.push_back(source);
            table.add_row(std::exchange(row, {}));
        }
    }
    fmt::print("{}", table.print());
    return exit_fine;
}

// All records that lie in `folder`/*/claims.json, in the order of the experiments; those of the user's own files last.
std::vector<ClaimRecord> gather_claims(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (std::filesystem::is_regular_file(entry.path() / "claims.json")) files.push_back(entry.path());
    }
    if (files.empty()) {
        throw ConfigError(
            fmt::format("'{}' holds no finished reproduction (no NAME/claims.json); run 'plumbline "
                        "reproduce --all' first",
                        folder.string()));
    }
    const std::vector<std::string> order = reproduction_names();
    const auto place_of = [&](const std::filesystem::path& file) {
        return std::pair(std::ranges::find(order, file.filename().string()) - order.begin(), file);
    };
    std::ranges::sort(files, {}, place_of);
    std::vector<ClaimRecord> records;
    for (const std::filesystem::path& file : files) {
        const std::vector<ClaimRecord> more = read_claims_json(file / "claims.json");
        records.insert(records.end(), more.begin(), more.end());
    }
    return records;
}

void write_claims(const std::filesystem::path& folder, const std::filesystem::path& report) {
    const std::filesystem::path file = report.empty() ? folder / "CLAIMS.md" : report;
    const std::vector<ClaimRecord> records = gather_claims(folder);
    write_text_atomically(file, print_claims_markdown(records, "plumbline reproduce --all"));
    fmt::print("\n{} claims: {}\n", records.size(), file.string());
}

// Reproduces one after the other.
class Reproducer {
public:
    Reproducer(const ReproduceCommandOptions& options, const CommonOptions& common)
        : options_(options), finder_(common.scenes_dirs) {}

    // Exit code of this one. Throws what loading and rendering throw.
    int reproduce(const std::string& name) {
        const Reproduction reproduction = load_reproduction(name);
        const std::filesystem::path folder = options_.output / reproduction.name;
        require_writable_folder(folder);
        fmt::print("\n{}: {}\n{}\n", reproduction.name, reproduction.title, reproduction.question);
        LoadedScenes scenes(finder_);
        std::optional<Measurements> measurements = kept(reproduction, scenes, folder);
        if (!measurements) measurements = measure(reproduction, name, scenes, folder);
        if (measurements->interrupted) {
            fmt::print(
                "\nInterrupted: no figures were made of it; the same command goes on with the references and cells "
                "that "
                "were finished.\n");
            return exit_interrupted;
        }
        const PresentedReproduction presented = present(reproduction, *measurements, folder);
        fmt::print("{}\n", presented.text);
        if (!measurements->cells.empty())
            fmt::print("{:.0f} s, {} on {}\n", measurements->seconds, measurements->renderer, measurements->cpu);
        fmt::print("{}\n", (folder / "README.md").string());
        for (const CellFailure& failure : measurements->failures)
            failures_.push_back({fmt::format("{}: {}", name, failure.cell), failure.message});
        return measurements->failures.empty() ? exit_fine : exit_failed;
    }

    // Of all of them, those included that were measured before; truths that some share are counted for each.
    DiskUse all_disk_use(const std::vector<std::string>& names) const {
        DiskUse all;
        LoadedScenes scenes(finder_);
        for (const std::string& name : names) {
            const DiskUse use = disk_use(load_reproduction(name), scenes, options_.frames, options_.quick);
            all.cache += use.cache, all.output += use.output;
        }
        return all;
    }

    void add_failure(const std::string& name, const std::exception& error) {
        fmt::print("failed: {}\n", error.what());
        failures_.push_back({name, error.what()});
    }

    void print_failures() const {
        if (failures_.empty()) return;
        fmt::print("\n{} failed:\n", failures_.size());
        for (const CellFailure& failure : failures_) fmt::print("  {}: {}\n", failure.cell, failure.message);
    }

private:
    // What a run before this one found, where it still stands.
    std::optional<Measurements> kept(const Reproduction& reproduction, LoadedScenes& scenes,
                                     const std::filesystem::path& folder) {
        const std::filesystem::path file = folder / "measurements.json";
        if (options_.present) return read_measurements_json(file);
        if (options_.again || !std::filesystem::exists(file)) return std::nullopt;
        try {
            Measurements measurements = read_measurements_json(file);
            const bool stands =
                measurements.failures.empty() &&
                measurements.key == measuring_key(reproduction, hashes_, scenes, options_.run.backend, options_.quick);
            if (!stands) return std::nullopt;
            fmt::print("measured before ({}); --again measures it anew\n", measurements.started);
            return measurements;
        } catch (const ConfigError&) {
            return std::nullopt;  // a file that cannot be read is written again, which costs time only
        }
    }

    Measurements measure(const Reproduction& reproduction, const std::string& name, LoadedScenes& scenes,
                         const std::filesystem::path& folder) {
        RunOptions run = options_.run;
        run.output = folder / "run";
        run.write_frames = options_.frames;
        run.stop = &interruption_flag();
        // What is kept of it is read elsewhere, where the folders of this machine say nothing.
        run.command = fmt::format("plumbline reproduce {}{}", std::filesystem::path(name).filename().string(),
                                  options_.quick ? " --quick" : "");
        const DiskUse use = disk_use(reproduction, scenes, run.write_frames, options_.quick);
        if (use.output > 0) fmt::print("{}\n", describe_disk_use(use, run.cache_dir, run.output));
        std::fflush(stdout);
        // Before the run, which releases the scenes.
        const std::string key = measuring_key(reproduction, hashes_, scenes, run.backend, options_.quick);
        Measurements measurements = run_reproduction(reproduction, scenes, run, options_.quick);
        measurements.key = key;
        return measurements;
    }

    const ReproduceCommandOptions& options_;
    SceneFinder finder_;
    SceneHashes hashes_;
    std::vector<CellFailure> failures_;
};

int run(const ReproduceCommandOptions& options, const CommonOptions& common) {
    if (options.list) return print_list();
    if (!options.claims_folder.empty()) {
        write_claims(options.claims_folder, options.report);
        return exit_fine;
    }
    const std::vector<std::string> names = options.all ? reproduction_names() : options.names;
    if (names.empty()) throw ConfigError("name what to reproduce, or ask for --all or --list");
    for (const std::string& name : names) load_reproduction(name);  // a misspelt last one is told before the first runs
    Reproducer reproducer(options, common);
    if (names.size() > 1 && !options.present)
        fmt::print("Disk, all together: {}\n", print_disk_use(reproducer.all_disk_use(names)));
    int code = exit_fine;
    const auto attempt = [&](const std::string& name, const auto& action) {
        try {
            return action();
        } catch (const GlUnavailable&) {
            throw;  // whatever comes next would lack it too
        } catch (const std::exception& error) {
            reproducer.add_failure(name, error);
            return static_cast<int>(exit_failed);
        }
    };
    for (const std::string& name : names) {
        const int one = names.size() == 1 ? reproducer.reproduce(name)  // its error tells the exit code
                                          : attempt(name, [&] { return reproducer.reproduce(name); });
        if (one == exit_interrupted) {
            reproducer.print_failures();  // of those before it
            return one;
        }
        code = std::max(code, one);
    }
    if (options.all || !options.report.empty()) {
        code = std::max(code, attempt("table of claims", [&] {
                            write_claims(options.output, options.report);
                            return static_cast<int>(exit_fine);
                        }));
    }
    reproducer.print_failures();
    return code;
}

}  // namespace

void add_reproduce_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command =
        app.add_subcommand("reproduce", "Make the seeds' figures and tables again, and test what they claim")
            ->group("Measure");
    auto options = std::make_shared<ReproduceCommandOptions>();
    command->add_option("names", options->names, "What to reproduce: names (--list), or experiment files with claims")
        ->type_name("NAME");
    command->add_flag("--all", options->all, "Everything there is, then the table of claims");
    command->add_flag("--list", options->list, "What there is, and where in the seeds it stands");
    command->add_option("-o,--output", options->output, "Folder of all results")->capture_default_str();
    command->add_flag("--quick", options->quick,
                      "Try it: a quarter of the resolution, one view per scene, few samples; proves nothing");
    command->add_flag("--present", options->present, "Render nothing: figures and claims from the last run's numbers");
    command->add_flag("--again", options->again, "Measure anew what was measured before");
    command->add_option("--claims", options->claims_folder, "Only gather FOLDER/*/claims.json into a table of claims")
        ->type_name("FOLDER");
    command->add_option("--report", options->report, "Where that table goes; CLAIMS.md in the folder by default")
        ->type_name("FILE");
    command->add_flag("--frames", options->frames, "Also write the frames as EXR files");
    add_cache_option(*command, options->run.cache_dir);
    command->add_option("--threads", options->run.threads, "Threads of the path tracer; 0: all")
        ->check(CLI::NonNegativeNumber);
    add_backend_option(*command, options->run.backend);
    command->footer(reproduce_examples);
    command->callback([options, &common, &action] { action = [options, &common] { return run(*options, common); }; });
}

}  // namespace plumb
