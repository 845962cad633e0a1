#include "experiments/scene_run.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "experiments/method_timing.h"
#include "experiments/settling.h"
#include "metrics/comparison.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

// Any other seed makes paths independent of the reference's; this one flips half of the bits.
constexpr std::uint64_t independent_seed_mask = 0x9E3779B97F4A7C15;

constexpr double share_of_references = 0.7;  // of a scene's time, for the progress line only

std::ptrdiff_t place_of(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) - names.begin();
}

std::string refusal_of(const ReferencedError& error) {
    const std::string noise = fmt::format("not measured: the truth's noise (RMSE {:.2g}) is too near to the difference",
                                          std::sqrt(error.reference_noise_mse));
    if (const auto samples = error.samples_needed())
        return fmt::format("{}; {} samples per pixel would do", noise, *samples);
    return noise + "; no number of samples can be told, because the difference is lost in it";
}

}  // namespace

SceneRun::SceneRun(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene,
                   const SceneRunControl& control)
    : experiment_(experiment), entry_(entry), scene_(scene), control_(control), tracer_(scene), views_(entry.views) {
    if (views_.empty()) {
        for (const Camera& camera : scene.cameras) views_.push_back(camera.name);
    }
    if (views_.empty()) throw SceneError(fmt::format("scene '{}' has no view; add one to its scene file", scene.name));
    if (experiment.quick) views_.resize(1);
    for (const std::string& view : views_) scene.camera(view);  // throws for a name that is not there
}

void SceneRun::show(double fraction, const std::string& text) {
    control_.progress.show(std::lerp(control_.progress_from, control_.progress_to, fraction),
                           fmt::format("{}: {}", entry_.scene, text));
}

double SceneRun::measuring_progress(const std::string& plane, double done) const {
    const double planes = static_cast<double>(experiment_.planes.size());
    return std::lerp(share_of_references, 1.0,
                     (static_cast<double>(place_of(experiment_.planes, plane)) + done) / planes);
}

View SceneRun::view_of(const std::string& name) const {
    return View(scene_.camera(name), experiment_.width, experiment_.height);
}

void SceneRun::run(RunResults& results) {
    for (const std::string& view : views_) {
        if (stopped()) return;
        try {
            render_truths(view, results);
        } catch (const std::exception& error) {
            results.failures.push_back({fmt::format("{} / {} / reference", entry_.scene, view), error.what()});
        }
    }
    for (const std::string& plane : experiment_.planes) {
        if (stopped()) return;
        render_methods(plane, results);
        render_path_tracer_curve(plane, results);
    }
    const auto first = static_cast<std::ptrdiff_t>(results.rows.size());
    for (const PlaneImage& image : images_) measure(image, results);
    std::ranges::stable_sort(results.rows.begin() + first, results.rows.end(), {}, [&](const ResultRow& row) {
        return std::tuple(place_of(experiment_.planes, row.plane), row.truth != "full", place_of(views_, row.view),
                          row.path_tracer_samples);
    });
}

void SceneRun::render_truths(const std::string& view, RunResults& results) {
    const auto place = static_cast<double>(place_of(views_, view)) / static_cast<double>(views_.size());
    ViewTruths truths;
    truths.full = render_reference(view, full_truth_settings(experiment_, entry_), "full", place, results);
    const auto limited = limited_truth_settings(experiment_, entry_);
    if (limited && !stopped()) {
        truths.limit = entry_.indirect_radius;
        truths.limited = render_reference(view, *limited, fmt::format("within {} m", truths.limit),
                                          place + 0.5 / static_cast<double>(views_.size()), results);
    }
    if (!stopped()) truths_.emplace(view, std::move(truths));
}

ReferenceResult SceneRun::render_reference(const std::string& view, const ReferenceSettings& settings,
                                           const std::string& truth, double fraction, RunResults& results) {
    const View camera_view = view_of(view);
    const std::string what = fmt::format("{}, truth ({})", view, truth);
    ReferenceControl control;
    control.threads = control_.threads;
    control.stop = control_.stop;
    const double share = share_of_references / static_cast<double>(views_.size());
    control.on_progress = [&](const ReferenceProgress& progress) {
        const double done = static_cast<double>(progress.samples_done) / std::max(1, progress.samples_wanted);
        show(share_of_references * fraction + share * 0.5 * done,
             fmt::format("{}: {} of {} samples, {:.1f} M rays/s, error {:.2g}", what, progress.samples_done,
                         progress.samples_wanted, progress.rays_per_second * 1e-6, progress.relative_error));
    };
    CachedReference cached = control_.cache.get(
        reference_key(scene_, camera_view, settings),
        [&](const std::filesystem::path& checkpoint) {
            control.checkpoint = checkpoint;
            return tracer_.render(camera_view, settings, control);
        },
        [&] { control_.progress.log(fmt::format("{} / {}: another run renders it; waiting", entry_.scene, what)); });
    if (!cached.warning.empty()) control_.progress.log("warning: " + cached.warning);
    results.references.push_back(
        {entry_.scene, view, truth, cached.result.samples, cached.result.seconds, cached.from_cache});
    return std::move(cached.result);
}

void SceneRun::render_methods(const std::string& plane, RunResults& results) {
    Quantities quantities = experiment_.quantities;
    quantities.planes = {plane};
    quantities.ao_radius = entry_.ao_radius;

    // One pipeline per method for this plane alone, so that its time is the time of what the plane needs.
    std::vector<std::unique_ptr<Pipeline>> pipelines;
    std::vector<Pipeline*> working;
    std::vector<const Method*> methods;
    std::vector<int> frames;  // that are rendered, of which the last is measured
    for (const Method& method : experiment_.methods) {
        const Method in_scene = method_in_scene(method, entry_, experiment_.file.string());
        try {
            pipelines.push_back(std::make_unique<Pipeline>(control_.context, scene_, in_scene, quantities,
                                                           experiment_.width, experiment_.height));
            working.push_back(pipelines.back().get());
            methods.push_back(&method);
            frames.push_back(frames_to_settle(in_scene));
        } catch (const std::exception& error) {
            results.failures.push_back({fmt::format("{} / {} / {}", entry_.scene, plane, method.name), error.what()});
        }
    }
    if (working.empty()) return;

    for (const std::string& view : views_) {
        const auto truths = truths_.find(view);
        if (stopped() || truths == truths_.end()) continue;
        show(measuring_progress(plane, 0.0), fmt::format("{}, {}: methods", view, plane));
        const View camera_view = view_of(view);
        std::vector<PlaneImage> images;
        std::vector<Pipeline*> rendered;
        const auto fail = [&](const std::string& method, const std::exception& error) {
            results.failures.push_back(
                {fmt::format("{} / {} / {} / {}", entry_.scene, view, plane, method), error.what()});
        };
        for (std::size_t i = 0; i < working.size(); ++i) {
            try {
                const Frame* truth = &truths->second.full.frame;
                for (int frame = 1; frame < frames[i]; ++frame) working[i]->time_passes(camera_view, truth);
                RasterResult raster = working[i]->render(camera_view, nullptr, truth);
                images.push_back({view,
                                  plane,
                                  methods[i]->name,
                                  std::move(raster.frame.plane(plane)),
                                  0,
                                  {},
                                  static_cast<int>(working[i]->gbuffer_bytes_per_pixel())});
                rendered.push_back(working[i]);
            } catch (const std::exception& error) {
                fail(methods[i]->name, error);
            }
        }
        try {
            std::vector<Timing> timings =
                time_interleaved(rendered, camera_view, &truths->second.full.frame, experiment_.timing);
            for (std::size_t i = 0; i < images.size(); ++i) {
                images[i].timing = std::move(timings[i]);
                images_.push_back(std::move(images[i]));
            }
        } catch (const std::exception& error) {
            fail("timing", error);
        }
    }
}

void SceneRun::render_path_tracer_curve(const std::string& plane, RunResults& results) {
    ReferenceSettings settings = full_truth_settings(experiment_, entry_);
    settings.quantities.planes = {plane};
    settings.target_error = 0.0;
    settings.seed ^= independent_seed_mask;
    for (const std::string& view : views_) {
        if (!truths_.contains(view)) continue;
        if (!truths_.at(view).full.frame.has(fmt::format("half_a.{}", plane)))
            continue;  // a plane without noise has no curve
        for (const int samples : experiment_.path_tracer_samples) {
            if (stopped()) return;
            show(measuring_progress(plane, 0.5),
                 fmt::format("{}, {}: path tracer at {} samples", view, plane, samples));
            settings.samples = samples;
            try {
                ReferenceControl control;
                control.threads = control_.threads;
                ReferenceResult result = tracer_.render(view_of(view), settings, control);
                PlaneImage image{
                    view,    plane, fmt::format("path tracer, {} spp", samples), std::move(result.frame.plane(plane)),
                    samples, {}};
                const double milliseconds = 1000.0 * result.seconds;
                image.timing = {milliseconds, milliseconds, milliseconds, 1, {{"path tracer", milliseconds}}};
                images_.push_back(std::move(image));
            } catch (const std::exception& error) {
                results.failures.push_back(
                    {fmt::format("{} / {} / {} / path tracer, {} spp", entry_.scene, view, plane, samples),
                     error.what()});
            }
        }
    }
}

void SceneRun::measure(const PlaneImage& image, RunResults& results) {
    for (const Truth& truth : truths_.at(image.view).of(image.plane)) {
        // The path tracer's curve is light without a limit.
        if (image.path_tracer_samples > 0 && truth.frame != &truths_.at(image.view).full.frame) continue;
        try {
            ResultRow row;
            row.scene = entry_.scene, row.view = image.view, row.plane = image.plane;
            row.method = image.method, row.truth = truth.name, row.path_tracer_samples = image.path_tracer_samples;
            if (const Method* method = find_method(experiment_.methods, image.method)) {
                row.parameters = method_in_scene(*method, entry_, experiment_.file.string());
            }
            row.timing = image.timing;
            row.gbuffer_bytes_per_pixel = image.gbuffer_bytes_per_pixel;
            row.reference_samples = truth.samples;

            Frame test(image.image.width(), image.image.height());
            test.set(image.plane, image.image);
            Frame reference(test.width(), test.height());
            for (const char* prefix : {"", "half_a.", "half_b."}) {
                const std::string name = prefix + image.plane;
                if (truth.frame->has(name)) reference.set(name, truth.frame->plane(name));
            }
            reference.facts["samples"] = fmt::format("{}", truth.samples);
            ComparisonSettings settings;
            settings.referenced.noise_limit = experiment_.reference.most_noise;
            const PlaneComparison comparison = compare_frames(test, reference, settings).planes.front();

            row.measures = comparison.measures();
            row.mse = comparison.best_mse();
            row.mse_lower = row.mse_upper = std::numeric_limits<double>::quiet_NaN();
            row.psnr = comparison.errors.psnr;
            row.ssim = comparison.ssim ? comparison.ssim->mean : std::numeric_limits<double>::quiet_NaN();
            row.data_range = comparison.errors.peak;
            row.measured = true;
            if (comparison.referenced) {
                row.mse_lower = comparison.referenced->lower, row.mse_upper = comparison.referenced->upper;
                row.noise_mse = comparison.referenced->reference_noise_mse;
                row.measured = comparison.referenced->trustworthy;
                if (!row.measured) row.refusal = refusal_of(*comparison.referenced);
            }
            results.rows.push_back(std::move(row));
        } catch (const std::exception& error) {
            results.failures.push_back(
                {fmt::format("{} / {} / {} / {}", entry_.scene, image.view, image.plane, image.method), error.what()});
        }
    }
}

}  // namespace plumb
