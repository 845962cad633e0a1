#include "experiments/method_timing.h"

#include "experiments/statistics.h"

namespace plumb {

std::vector<Timing> time_interleaved(const std::vector<Pipeline*>& pipelines, const View& view, const Frame* truth,
                                     const ExperimentTiming& settings) {
    for (int i = 0; i < settings.warm_up; ++i) {
        for (Pipeline* pipeline : pipelines) pipeline->time_passes(view, truth);
    }
    std::vector<std::vector<std::vector<PassTiming>>> frames(pipelines.size());  // [pipeline][repetition][pass]
    for (int i = 0; i < settings.repetitions; ++i) {
        for (std::size_t j = 0; j < pipelines.size(); ++j) frames[j].push_back(pipelines[j]->time_passes(view, truth));
    }

    std::vector<Timing> timings;
    for (const auto& repetitions : frames) {
        Timing timing;
        timing.repetitions = static_cast<int>(repetitions.size());
        std::vector<double> sums;
        for (const auto& passes : repetitions) {
            double sum = 0.0;
            for (const PassTiming& pass : passes) sum += pass.milliseconds;
            sums.push_back(sum);
        }
        timing.median = quantile(sums, 0.5);
        timing.lower_quartile = quantile(sums, 0.25), timing.upper_quartile = quantile(sums, 0.75);
        for (std::size_t pass = 0; pass < repetitions.front().size(); ++pass) {
            std::vector<double> times;
            times.reserve(repetitions.size());
            for (const auto& passes : repetitions) times.push_back(passes[pass].milliseconds);
            timing.passes.push_back({repetitions.front()[pass].pass, quantile(times, 0.5)});
        }
        timings.push_back(std::move(timing));
    }
    return timings;
}

}  // namespace plumb
