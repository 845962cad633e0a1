// How long methods take, measured side by side.
#pragma once

#include <functional>
#include <vector>

#include "experiments/results.h"

namespace plumb {

// Renders one frame and tells the time of each of its passes.
using TimedFrame = std::function<std::vector<PassTiming>()>;

// Times whatever renders frames: all warm up, then take turns (A B A B ...), so that a machine that slows down slows
// all of them. One Timing for each.
std::vector<Timing> time_interleaved(const std::vector<TimedFrame>& subjects, const ExperimentTiming& settings);

// The same of each pipeline's passes over `view`. `truth` feeds the stages that a method takes from it; it may be null.
std::vector<Timing> time_interleaved(const std::vector<Pipeline*>& pipelines, const View& view, const Frame* truth,
                                     const ExperimentTiming& settings);

// Medians and quartiles over frames that were timed one by one; all have the same passes. None: zeros.
Timing median_timing(const std::vector<Timing>& frames);

}  // namespace plumb
