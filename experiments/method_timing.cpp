#include "experiments/method_timing.h"

#include <algorithm>

#include "experiments/statistics.h"

namespace plumb {
namespace {

Timing timing_of_frame(std::vector<PassTiming> passes) {
    Timing frame;
    frame.passes = std::move(passes);
    for (const PassTiming& pass : frame.passes) frame.median += pass.milliseconds;
    return frame;
}

std::vector<Timing> median_timings(const std::vector<std::vector<Timing>>& frames) {
    std::vector<Timing> timings;
    timings.reserve(frames.size());
    for (const std::vector<Timing>& of_subject : frames) timings.push_back(median_timing(of_subject));
    return timings;
}

}  // namespace

Timing median_timing(const std::vector<Timing>& frames) {
    Timing timing;
    if (frames.empty()) return timing;
    timing.repetitions = static_cast<int>(frames.size());
    std::vector<double> sums;
    sums.reserve(frames.size());
    for (const Timing& frame : frames) sums.push_back(frame.median);
    timing.median = quantile(sums, 0.5);
    timing.lower_quartile = quantile(sums, 0.25), timing.upper_quartile = quantile(sums, 0.75);
    for (std::size_t pass = 0; pass < frames.front().passes.size(); ++pass) {
        std::vector<double> times;
        times.reserve(frames.size());
        for (const Timing& frame : frames) times.push_back(frame.passes.at(pass).milliseconds);
        timing.passes.push_back({frames.front().passes[pass].pass, quantile(times, 0.5)});
    }
    return timing;
}

std::vector<Timing> time_interleaved(const std::vector<TimedFrame>& subjects, const ExperimentTiming& settings) {
    for (int i = 0; i < settings.warm_up; ++i) {
        for (const TimedFrame& render : subjects) render();
    }
    std::vector<std::vector<Timing>> frames(subjects.size());
    for (int i = 0; i < settings.repetitions; ++i) {
        for (std::size_t j = 0; j < subjects.size(); ++j) frames[j].push_back(timing_of_frame(subjects[j]()));
    }
    return median_timings(frames);
}

std::vector<Timing> time_along_path(const std::vector<TimedPath>& subjects, int frames,
                                    const ExperimentTiming& settings, const std::atomic<bool>* stop) {
    const int plays = std::max(2, (settings.repetitions + frames - 1) / frames);
    std::vector<std::vector<Timing>> times(subjects.size());
    std::size_t turn = 0;
    for (int play = 0; play < plays; ++play) {
        for (int i = 0; i < std::max(1, settings.warm_up); ++i) {
            for (const TimedPath& subject : subjects) subject.begin();
        }
        for (int frame = 0; frame < frames; ++frame, ++turn) {
            for (std::size_t i = 0; i < subjects.size(); ++i) {
                if (stop && stop->load()) return {};
                const std::size_t place = (turn + i) % subjects.size();
                times[place].push_back(timing_of_frame(subjects[place].frame(frame)));
            }
        }
    }
    return median_timings(times);
}

std::vector<Timing> time_interleaved(const std::vector<Pipeline*>& pipelines, const View& view, const Frame* truth,
                                     const ExperimentTiming& settings) {
    std::vector<TimedFrame> subjects;
    subjects.reserve(pipelines.size());
    for (Pipeline* pipeline : pipelines)
        subjects.emplace_back([=, &view] { return pipeline->time_passes(view, truth); });
    return time_interleaved(subjects, settings);
}

}  // namespace plumb
