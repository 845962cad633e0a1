// How long methods take, measured side by side.
#pragma once

#include <atomic>
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

// What plays a camera path, frame by frame, with whatever it keeps from one frame to the next.
struct TimedPath {
    // Leaves it as the path's first frame finds it, and caches and compilers warm.
    std::function<void()> begin;
    // The frames from 0 on, in order.
    std::function<std::vector<PassTiming>(int frame)> frame;
};

// Times whatever plays a path of `frames` frames: all play the whole path side by side, over and over, so that every
// frame is timed with the history that it has in a sequence. They take turns at each frame, another one first each
// time, so that none is always the one that follows a certain other; and all begin anew, untimed, before each time
// that the path is played. It is played twice at least and until every subject was timed `repetitions` times. Gives the
// medians and quartiles over all frames and plays, one Timing for each; nothing once `stop` is set.
std::vector<Timing> time_along_path(const std::vector<TimedPath>& subjects, int frames,
                                    const ExperimentTiming& settings, const std::atomic<bool>* stop = nullptr);

// Medians and quartiles over frames that were timed one by one; all have the same passes. None: zeros.
Timing median_timing(const std::vector<Timing>& frames);

}  // namespace plumb
