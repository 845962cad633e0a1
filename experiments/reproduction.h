// The figures, tables and claims of the texts that Plumbline grew from, made again: each an experiment like any other
// (`plumbline run` takes the same files) that also says what is to be made of its results (presentation.h).
//
//     000  Nielsen 2015, "Using Deep G-buffers for Interactive Screenspace Global Illumination", thesis
//     001  Tohidi Far 2019, "Deep G-Buffers for Stable Global Illumination Approximation", paper
//     002  Meiri, "OGLdev", tutorial 36, deferred shading
//     003  the journal of a dissertation that implements deep G-buffers
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/claims.h"
#include "experiments/config.h"
#include "experiments/disk_use.h"
#include "experiments/drawings.h"
#include "experiments/loaded_scenes.h"
#include "experiments/measurements.h"
#include "experiments/presentation.h"
#include "experiments/runner.h"

namespace plumb {

struct Reproduction {
    std::string name, title, question;
    std::filesystem::path file;
    std::string text;   // the whole file
    ConfigValue table;  // the same, parsed
    Presentation presentation;
    std::vector<Drawing> drawings;  // of a file that has nothing else, and nothing to run

    // Where in the seeds its figures, numbers and claims stand, each place once: "000, table 4.2".
    std::vector<std::string> sources() const;
};

// Names of those that are part of the program, in the order of the seeds.
std::vector<std::string> reproduction_names();
// One of these by name, or a file. Throws ConfigError, also where a figure, number or claim names a method, curve,
// plane or scene that the experiment does not have.
Reproduction load_reproduction(const std::string& name_or_path);

// The most that it may take, scenes that are not there counted where their views are named.
DiskUse disk_use(const Reproduction& reproduction, LoadedScenes& scenes, bool write_frames, bool quick);

// Renders and measures, unless there are drawings only; the run's own files go to options.output. Optional scenes that
// are not there are left out. Throws what loading and rendering throw.
Measurements run_reproduction(const Reproduction& reproduction, LoadedScenes& scenes, const RunOptions& options,
                              bool quick);

struct PresentedReproduction {
    std::vector<ClaimResult> claims;
    std::vector<std::filesystem::path> files;
    std::string text;  // tables and claims for a terminal
};

// Writes measurements.json, numbers.csv, claims.json, the figures as SVG, PNG and CSV, the seeds' numbers beside ours
// as CSV, and README.md, which shows all of it, into `folder`. Pictures are looked for in `folder`/run. Throws
// ImageError.
PresentedReproduction present(const Reproduction& reproduction, const Measurements& measurements,
                              const std::filesystem::path& folder);

}  // namespace plumb
