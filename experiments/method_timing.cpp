#include "experiments/method_timing.h"

#include "experiments/statistics.h"

namespace plumb {

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
        for (std::size_t j = 0; j < subjects.size(); ++j) {
            Timing frame;
            frame.passes = subjects[j]();
            for (const PassTiming& pass : frame.passes) frame.median += pass.milliseconds;
            frames[j].push_back(std::move(frame));
        }
    }
    std::vector<Timing> timings;
    timings.reserve(frames.size());
    for (const std::vector<Timing>& of_subject : frames) timings.push_back(median_timing(of_subject));
    return timings;
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
