// What methods cost, told by the calibrating workload (rasterizer/calibrating_workload.h).
//
// Workload and methods take turns on one OpenGL context: workload, method, method, workload, method... Each frame's
// time is divided by the mean of the workload's times before and after its turn, so that a machine that slows down or
// speeds up during the round, as shared ones do, cancels; of these ratios the median counts.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "experiments/experiment_file.h"
#include "experiments/scene_finder.h"
#include "experiments/thresholds.h"
#include "rasterizer/gl_context.h"

namespace plumb {

struct CostRatio {
    std::string scene, view, plane, method;
    double ratio = 0.0;                            // of the method's time to the workload's
    double milliseconds = 0.0, workload_ms = 0.0;  // medians, to read; nothing is decided by them
};

struct CostRound {
    std::vector<CostRatio> ratios;
    std::vector<std::string> failures;  // "cornell / front / ao / two_layers: why"
};

// Times every scene, view, plane and method that a threshold of kind `cost` without `relative_to` asks for, each once.
// A method that takes stages from the truth has no time of its own and is a failure.
CostRound measure_costs(const Experiment& experiment, const std::vector<Threshold>& thresholds,
                        const SceneFinder& finder, GlBackend backend, const std::atomic<bool>* stop = nullptr);

}  // namespace plumb
