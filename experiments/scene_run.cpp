#include "experiments/scene_run.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/method_timing.h"
#include "experiments/oracle_images.h"
#include "experiments/row_measurement.h"
#include "experiments/settling.h"
#include "metrics/referenced_error.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

// Any other seed makes paths independent of the reference's; this one flips half of the bits.
constexpr std::uint64_t independent_seed_mask = 0x9E3779B97F4A7C15;

constexpr double share_of_references = 0.7;  // of a scene's time, for the progress line only

// What a method shows of a view that stands still, in the last of so many frames; nothing is left of what was rendered
// before.
Image settled_plane(Pipeline& pipeline, const std::string& plane, int frames, const FrameRequest& request) {
    pipeline.forget();
    for (int frame = 1; frame < frames; ++frame) pipeline.time_passes(request);
    return pipeline.render(request).frame.plane(plane);
}

std::ptrdiff_t place_of(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) - names.begin();
}

}  // namespace

SceneRun::SceneRun(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene,
                   const SceneRunControl& control)
    : experiment_(experiment),
      entry_(entry),
      scene_(scene),
      control_(control),
      tracer_(scene),
      references_(control.cache, control.progress, control.stop, control.threads),
      views_(views_of(entry, scene)) {
    if (views_.empty()) throw SceneError(fmt::format("scene '{}' has no view; add one to its scene file", scene.name));
    if (experiment.quick) views_.resize(1);
}

void SceneRun::show(double fraction, const std::string& text) {
    control_.progress.show(control_.part.at(fraction), fmt::format("{}: {}", entry_.scene, text));
}

double SceneRun::measuring_progress(const std::string& plane, double done) const {
    const double planes = static_cast<double>(experiment_.planes.size());
    return std::lerp(share_of_references, 1.0,
                     (static_cast<double>(place_of(experiment_.planes, plane)) + done) / planes);
}

View SceneRun::view_of(const std::string& name) const {
    return View(scene_.camera(name), experiment_.width, experiment_.height);
}

std::string SceneRun::cell_key(const std::string& view, const std::string& plane) const {
    return fmt::format("plane {}; {}", plane,
                       methods_key(experiment_, entry_, scene_, view_of(view), control_.context.info()));
}

bool SceneRun::load_cell(const std::string& key) {
    std::optional<std::vector<PlaneImage>> kept = control_.cells.load(key);
    if (kept) std::ranges::move(*kept, std::back_inserter(images_));
    return kept.has_value();
}

void SceneRun::keep_cell(const std::string& key, std::vector<PlaneImage> images) {
    if (!key.empty()) control_.cells.save(key, images);
    std::ranges::move(images, std::back_inserter(images_));
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
    for (const std::string& view : views_) {
        if (stopped()) return;
        try {
            render_oracle(view, results);
        } catch (const std::exception& error) {
            results.failures.push_back({fmt::format("{} / {} / oracle", entry_.scene, view), error.what()});
        }
    }
    const auto first = static_cast<std::ptrdiff_t>(results.rows.size());
    for (const PlaneImage& image : images_) measure(image, results);
    std::ranges::stable_sort(results.rows.begin() + first, results.rows.end(), {}, [&](const ResultRow& row) {
        return std::tuple(place_of(experiment_.planes, row.plane), row.truth != "full", place_of(views_, row.view),
                          row.path_tracer_samples);
    });
}

void SceneRun::render_truths(const std::string& view, RunResults& results) {
    const double views = static_cast<double>(views_.size()), place = static_cast<double>(place_of(views_, view));
    const ProgressPart part =
        control_.part.part(share_of_references * place / views, share_of_references * (place + 1.0) / views);
    ViewTruths truths;
    truths.full = references_.render(tracer_, scene_, view_of(view), full_truth_settings(experiment_, entry_),
                                     {entry_.scene, view, "full"}, part.part(0.0, 0.5), results);
    const auto limited = limited_truth_settings(experiment_, entry_);
    if (limited && !stopped()) {
        truths.limit = entry_.indirect_radius;
        truths.limited = references_.render(tracer_, scene_, view_of(view), *limited,
                                            {entry_.scene, view, fmt::format("within {} m", truths.limit)},
                                            part.part(0.5, 1.0), results);
    }
    if (stopped()) return;
    const Frame gbuffer =
        tracer_.gbuffer(view_of(view), {.minimum_separation = entry_.minimum_separation}, control_.threads);
    regions_[view] = regions_of(gbuffer);
    // By which normals and albedo are judged where a surface is.
    for (const char* depth : {"depth", "layer2.depth"}) {
        if (gbuffer.has(depth) && !truths.full.frame.has(depth)) truths.full.frame.set(depth, gbuffer.plane(depth));
    }
    truths_.emplace(view, std::move(truths));
}

void SceneRun::render_methods(const std::string& plane, RunResults& results) {
    std::map<std::string, std::string> missing;  // views that no run before this one finished, with their cells' keys
    for (const auto& [view, truths] : truths_) {
        if (std::string key = cell_key(view, plane); !load_cell(key)) missing.emplace(view, std::move(key));
    }
    if (missing.empty()) return;
    const std::vector<MethodOfPlane> methods = make_pipelines(plane, results);
    if (methods.empty()) return;
    for (const auto& [view, key] : missing) {
        if (stopped()) return;
        show(measuring_progress(plane, 0.0), fmt::format("{}, {}: methods", view, plane));
        render_view(view, plane, methods, key, results);
    }
}

// One pipeline per method for this plane alone, so that its time is the time of what the plane needs.
std::vector<SceneRun::MethodOfPlane> SceneRun::make_pipelines(const std::string& plane, RunResults& results) {
    const Quantities quantities = quantities_of(experiment_, entry_, plane);
    std::vector<MethodOfPlane> methods;
    for (const Method& method : experiment_.methods) {
        const Method in_scene = method_in_scene(method, entry_, experiment_.file.string());
        try {
            methods.push_back({method.name,
                               std::make_unique<Pipeline>(control_.context, scene_, in_scene, quantities,
                                                          experiment_.width, experiment_.height),
                               frames_to_settle(in_scene)});
        } catch (const std::exception& error) {
            results.failures.push_back({fmt::format("{} / {} / {}", entry_.scene, plane, method.name), error.what()});
        }
    }
    return methods;
}

void SceneRun::render_view(const std::string& view, const std::string& plane, const std::vector<MethodOfPlane>& methods,
                           const std::string& key, RunResults& results) {
    const View camera = view_of(view);
    const Frame* truth = &truths_.at(view).full.frame;
    std::vector<PlaneImage> images;
    std::vector<Pipeline*> rendered;
    const auto fail = [&](const std::string& method, const std::exception& error) {
        results.failures.push_back({fmt::format("{} / {} / {} / {}", entry_.scene, view, plane, method), error.what()});
    };
    for (const MethodOfPlane& method : methods) {
        try {
            PlaneImage image{view, plane, method.name, {}};
            for (int seed = 0; seed < experiment_.seeds; ++seed) {
                Image picture =
                    settled_plane(*method.pipeline, plane, method.frames_to_settle,
                                  {.now = {camera}, .truth = truth, .seed = static_cast<std::uint32_t>(seed)});
                (seed == 0 ? image.image : image.other_seeds.emplace_back()) = std::move(picture);
            }
            image.gbuffer_bytes_per_pixel = static_cast<int>(method.pipeline->gbuffer_bytes_per_pixel());
            images.push_back(std::move(image));
            rendered.push_back(method.pipeline.get());
        } catch (const std::exception& error) {
            fail(method.name, error);
        }
    }
    try {
        std::vector<Timing> timings = time_interleaved(rendered, camera, truth, experiment_.timing);
        for (std::size_t i = 0; i < images.size(); ++i) images[i].timing = std::move(timings[i]);
        // A cell with a failure is tried again by the next run.
        const bool whole = images.size() == experiment_.methods.size();
        keep_cell(whole ? key : "", std::move(images));
    } catch (const std::exception& error) {
        fail("timing", error);
    }
}

void SceneRun::render_path_tracer_curve(const std::string& plane, RunResults& results) {
    if (experiment_.path_tracer_samples.empty()) return;
    ReferenceSettings settings = full_truth_settings(experiment_, entry_);
    settings.quantities.planes = {plane};
    settings.target_error = 0.0;
    settings.seed ^= independent_seed_mask;
    for (const std::string& view : views_) {
        if (!truths_.contains(view)) continue;
        if (!has_halves(truths_.at(view).full.frame, plane)) continue;  // a plane without noise has no curve
        if (stopped()) return;
        show(measuring_progress(plane, 0.5), fmt::format("{}, {}: path tracer", view, plane));
        const std::string key =
            fmt::format("path tracer at {}; timed {} times; {}", fmt::join(experiment_.path_tracer_samples, ", "),
                        experiment_.timing.repetitions, reference_key(scene_, view_of(view), settings));
        if (load_cell(key)) continue;
        try {
            std::vector<PlaneImage> images = time_path_tracer(view, plane, settings);
            if (stopped()) return;
            keep_cell(key, std::move(images));
        } catch (const std::exception& error) {
            results.failures.push_back(
                {fmt::format("{} / {} / {} / path tracer", entry_.scene, view, plane), error.what()});
        }
    }
}

std::vector<PlaneImage> SceneRun::time_path_tracer(const std::string& view, const std::string& plane,
                                                   ReferenceSettings settings) {
    std::vector<PlaneImage> images;
    std::vector<TimedFrame> subjects;
    for (const int samples : experiment_.path_tracer_samples) {
        settings.samples = samples;
        images.push_back({view, plane, fmt::format("path tracer, {} spp", samples), {}, samples});
        subjects.emplace_back([this, settings, view = view_of(view), &plane, &images, place = images.size() - 1] {
            ReferenceControl control;
            control.threads = control_.threads;
            ReferenceResult result;
            if (!stopped()) result = tracer_.render(view, settings, control);
            if (result.frame.has(plane)) images[place].image = std::move(result.frame.plane(plane));
            return std::vector<PassTiming>{{"path tracer", 1000.0 * result.seconds}};
        });
    }
    // The truths have warmed it up.
    std::vector<Timing> timings = time_interleaved(subjects, {0, experiment_.timing.repetitions});
    for (std::size_t i = 0; i < images.size(); ++i) images[i].timing = std::move(timings[i]);
    return images;
}

void SceneRun::render_oracle(const std::string& view, RunResults& results) {
    const auto truths = truths_.find(view);
    if (truths == truths_.end()) return;
    const View camera = view_of(view);
    const auto render = [&](const ReferenceSettings& settings, const std::string& name) {
        return references_.render(tracer_, scene_, camera, settings, {entry_.scene, view, name},
                                  control_.part.part(1.0, 1.0), results);
    };
    std::ranges::move(oracle_images(experiment_, entry_, view, camera, full_truth_settings(experiment_, entry_),
                                    truths->second.full.frame, render),
                      std::back_inserter(images_));
}

void SceneRun::measure(const PlaneImage& image, RunResults& results) {
    for (const Truth& truth : truths_.at(image.view).of(image.plane)) {
        // The path tracer's curve and the oracle are light without a limit.
        const bool is_full = truth.frame == &truths_.at(image.view).full.frame;
        if ((image.path_tracer_samples > 0 || image.oracle.any()) && !is_full) continue;
        try {
            ResultRow row = measure_row(image, truth, regions_.at(image.view), comparison_settings(experiment_));
            row.scene = entry_.scene;
            if (row.is_method()) describe_method(experiment_, entry_, image.method, row);
            results.rows.push_back(std::move(row));
        } catch (const std::exception& error) {
            results.failures.push_back(
                {fmt::format("{} / {} / {} / {}", entry_.scene, image.view, image.plane, image.method), error.what()});
        }
    }
}

std::string methods_key(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene,
                        const View& view, const GlInfo& gl) {
    // The truth's key names scene, view and quantities; some methods take stages from it.
    std::string key = fmt::format("OpenGL {} {}; seeds {}; timing {} {}; truth {}", gl.renderer, gl.version,
                                  experiment.seeds, experiment.timing.warm_up, experiment.timing.repetitions,
                                  reference_key(scene, view, full_truth_settings(experiment, entry)));
    for (const Method& method : experiment.methods) {
        const Method in_scene = method_in_scene(method, entry, experiment.file.string());
        key += fmt::format("; {} {:016x}", method.name, method_hash(in_scene));
    }
    return key;
}

void describe_method(const Experiment& experiment, const ExperimentScene& entry, const std::string& method,
                     ResultRow& row) {
    if (const Method* found = find_method(experiment.methods, method))
        row.parameters = method_in_scene(*found, entry, experiment.file.string());
    if (const auto point = experiment.sweep_points.find(method); point != experiment.sweep_points.end()) {
        row.curve = point->second.curve, row.curve_parameter = point->second.parameter;
        row.curve_value = point->second.value;
    }
}

}  // namespace plumb
