// A check: a comparison experiment, the thresholds that its results are held against, and methods that are broken on
// purpose and must be caught. Written in TOML (experiments/ci.toml is an example): the keys of experiment_file.h, and
//
//   thresholds = "ci_thresholds.toml"   # a file beside this one, which --calibrate can rewrite; or [[thresholds]] here
//
//   [[must_fail]]                       # at least one: a gate that cannot fail holds nothing
//   name = "obscurance at a third of its strength"
//   threshold = "clutter: ambient visibility of two layers"     # which has to break
//   method = { base = "two_layers", ao.intensity = 0.3 }
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/thresholds.h"

namespace plumb {

struct MustFail {
    std::string name;
    std::string threshold;
    Method method;  // broken; called `name`
};

struct CheckFile {
    Experiment experiment;
    ThresholdSet set;
    std::filesystem::path thresholds_file;  // empty: they stand in the experiment's own file
    std::vector<MustFail> must_fail;

    // Null where no threshold is called that.
    const Threshold* find_threshold(std::string_view name) const;
};

// Throws ConfigError with file and line; also for thresholds that name a scene, plane or method that the experiment
// does not have (what a scene's views are called is known only once it is loaded), and for a method that must fail
// where the scene's own parameters would mend it.
CheckFile load_check_file(const std::filesystem::path& file);

// The names of the thresholds that have no limit yet.
std::vector<std::string> without_limit(const CheckFile& check);

}  // namespace plumb
