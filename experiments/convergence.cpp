#include "experiments/convergence.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>

#include <fmt/format.h>

#include "experiments/progress_line.h"
#include "experiments/reference_cache.h"
#include "metrics/referenced_error.h"
#include "pathtracer/reference.h"

namespace plumb {
namespace {

constexpr std::uint64_t reference_seed = 0x9E3779B97F4A7C15;  // none of the seeds 1, 2, 3...

std::string_view to_string(SamplePoints points) { return points == SamplePoints::sobol ? "sobol" : "random"; }

// What is left of the seeds' measurements at one number of samples.
std::vector<double> mse_at(const ConvergenceCurve& curve, int samples) {
    std::vector<double> found;
    for (const ConvergenceMeasurement& measurement : curve.measurements) {
        if (measurement.samples == samples && measurement.used) found.push_back(measurement.mse);
    }
    return found;
}

class ConvergenceRunner {
public:
    ConvergenceRunner(const ConvergenceExperiment& experiment, const RunOptions& options)
        : experiment_(experiment), options_(options) {
        double samples = 0.0;
        for (const int count : experiment.samples) samples += count;
        all_work_ = static_cast<double>(experiment.scenes.size()) *
                    (experiment.reference_samples + 2.0 * experiment.seeds * samples);
    }

    bool stopped() const { return options_.stop && options_.stop->load(); }

    void run(const ConvergenceScene& entry, const SceneFinder& finder, std::vector<ConvergenceCurve>& curves) {
        const Scene scene = finder.load(entry.scene);
        const View view(choose_camera(scene, entry.view), experiment_.width, experiment_.height);
        const PathTracer tracer(scene);
        settings_ = {};
        settings_.quantities = experiment_.quantities;
        settings_.quantities.planes = experiment_.planes;
        settings_.quantities.ao_radius = entry.ao_radius;
        const Frame reference = render_reference(tracer, scene, view, entry.scene);

        const auto first = static_cast<std::ptrdiff_t>(curves.size());
        for (const std::string& plane : experiment_.planes) {
            for (const SamplePoints points : {SamplePoints::random, SamplePoints::sobol})
                curves.push_back({entry.scene, view.camera().name, plane, points, {}, {}, 0.0});
        }
        for (const SamplePoints points : {SamplePoints::random, SamplePoints::sobol}) {
            for (int seed = 1; seed <= experiment_.seeds && !stopped(); ++seed) {
                for (const int samples : experiment_.samples) {
                    progress_.show(done_ / all_work_,
                                   fmt::format("{}: {} points, seed {} of {}, {} samples", entry.scene,
                                               to_string(points), seed, experiment_.seeds, samples));
                    settings_.points = points;
                    settings_.seed = static_cast<std::uint64_t>(seed);
                    settings_.samples = samples;
                    ReferenceControl control;
                    control.threads = options_.threads;
                    control.stop = options_.stop;
                    const ReferenceResult image = tracer.render(view, settings_, control);
                    if (!image.complete) return;
                    done_ += samples;
                    for (auto curve = curves.begin() + first; curve != curves.end(); ++curve) {
                        if (curve->points == points)
                            curve->measurements.push_back(measure(image.frame, reference, curve->plane, samples, seed));
                    }
                }
            }
        }
        for (auto curve = curves.begin() + first; curve != curves.end(); ++curve) fit(*curve, experiment_.most_noise);
    }

private:
    Frame render_reference(const PathTracer& tracer, const Scene& scene, const View& view, const std::string& name) {
        settings_.samples = experiment_.reference_samples;
        settings_.seed = reference_seed;
        ReferenceControl control;
        control.threads = options_.threads;
        control.stop = options_.stop;
        control.on_progress = [&](const ReferenceProgress& progress) {
            progress_.show((done_ + progress.samples_done) / all_work_,
                           fmt::format("{}: reference, {} of {} samples, {:.2f} M rays/s, relative error {:.2g}", name,
                                       progress.samples_done, progress.samples_wanted, progress.rays_per_second * 1e-6,
                                       progress.relative_error));
        };
        CachedReference cached =
            ReferenceCache(options_.cache_dir).get(reference_key(scene, view, settings_), [&](const auto& checkpoint) {
                control.checkpoint = checkpoint;
                return tracer.render(view, settings_, control);
            });
        if (!cached.warning.empty()) progress_.log("warning: " + cached.warning);
        done_ += experiment_.reference_samples;
        return std::move(cached.result.frame);
    }

    ConvergenceMeasurement measure(const Frame& image, const Frame& reference, const std::string& plane, int samples,
                                   int seed) const {
        ReferencedErrorSettings settings;
        settings.bootstrap.resamples = 40;  // the seeds tell how sure it is, not the interval
        // Without the image's own halves: its noise is what is measured.
        const ReferencedError error =
            referenced_error(image.plane(plane), reference.plane(half_a_of(plane)), reference.plane(half_b_of(plane)),
                             experiment_.reference_samples, settings);
        return {samples, seed, error.mse, error.reference_noise_mse, false};
    }

    const ConvergenceExperiment& experiment_;
    const RunOptions& options_;
    ProgressLine progress_;
    ReferenceSettings settings_;
    double all_work_ = 1.0, done_ = 0.0;  // samples per pixel
};

}  // namespace

double ConvergenceCurve::rmse(int samples) const {
    const std::vector<double> found = mse_at(*this, samples);
    double sum = 0.0;
    for (const double mse : found) sum += mse;
    return found.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(found.size()));
}

double ConvergenceCurve::least_rmse(int samples) const {
    const std::vector<double> found = mse_at(*this, samples);
    return found.empty() ? 0.0 : std::sqrt(*std::ranges::min_element(found));
}

double ConvergenceCurve::greatest_rmse(int samples) const {
    const std::vector<double> found = mse_at(*this, samples);
    return found.empty() ? 0.0 : std::sqrt(*std::ranges::max_element(found));
}

void fit(ConvergenceCurve& curve, double most_noise) {
    std::map<int, std::vector<double>> x, y;  // by seed
    for (ConvergenceMeasurement& measurement : curve.measurements) {
        measurement.used = measurement.mse > 0.0 && measurement.noise_mse <= most_noise * measurement.mse;
        if (!measurement.used) continue;
        x[measurement.seed].push_back(std::log(measurement.samples));
        y[measurement.seed].push_back(0.5 * std::log(measurement.mse));
    }
    std::vector<double> slopes;
    double intercepts = 0.0;
    for (const auto& [seed, logarithms] : x) {
        if (logarithms.size() < 3) continue;
        const LineFit line = fit_line(logarithms, y.at(seed));
        slopes.push_back(line.slope);
        intercepts += line.intercept;
    }
    curve.slope = summarise_mean(slopes);
    curve.rmse_at_one = slopes.empty() ? 0.0 : std::exp(intercepts / static_cast<double>(slopes.size()));
}

ConvergenceResults run_convergence(const ConvergenceExperiment& experiment, const SceneFinder& finder,
                                   const RunOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    ConvergenceResults results;
    results.experiment = experiment;
    results.system = read_system_facts();
    results.command = options.command;
    results.started = utc_now();
    ConvergenceRunner runner(experiment, options);
    for (const ConvergenceScene& entry : experiment.scenes) {
        if (runner.stopped()) break;
        const std::size_t before = results.curves.size();
        try {
            runner.run(entry, finder, results.curves);
        } catch (const std::exception& error) {
            results.curves.erase(results.curves.begin() + static_cast<std::ptrdiff_t>(before), results.curves.end());
            results.failures.push_back({entry.scene, error.what()});
        }
    }
    results.interrupted = runner.stopped();
    results.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return results;
}

}  // namespace plumb
