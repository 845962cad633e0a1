// The views that a method is tuned on and judged by, with their truths.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/reference_cache.h"
#include "experiments/runner.h"
#include "experiments/tune.h"

namespace plumb {

struct TuningView {
    std::string scene, view;
    bool held_out = false;  // judges the result only
};

struct ViewCost {
    TuningView view;
    TuningCost cost;  // RMSE, free of the truth's noise where it can be; refused where that noise is too near to it
};

class TuningViews {
public:
    // All views of the experiment's scenes; of each scene every `hold_out`-th is held out (2: every other one; at least
    // 2). Renders truths or takes them from the cache. The plane's limited truth is taken where it has one and
    // `limited` asks for it. Throws ConfigError where nothing is left to train on or to judge by, and what rendering
    // throws.
    TuningViews(const Experiment& experiment, const std::string& plane, bool limited, int hold_out,
                const SceneFinder& finder, const RunOptions& options);
    ~TuningViews();

    // Of each method as it runs in each scene, timed in turn; every view, held out or not, as asked for.
    std::vector<std::vector<ViewCost>> costs(const std::vector<Method>& methods, bool held_out) const;
    // Geometric means over the training views.
    TuningCost training_cost(const Method& method) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

// Geometric means; refused where one is.
TuningCost mean_cost(const std::vector<ViewCost>& costs);

}  // namespace plumb
