#include "experiments/path_run.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "experiments/method_timing.h"
#include "experiments/no_value.h"
#include "experiments/oracle_images.h"
#include "experiments/path_pictures.h"
#include "experiments/row_measurement.h"
#include "experiments/settling.h"
#include "metrics/comparison.h"
#include "metrics/fidelity_series.h"
#include "metrics/path_lag.h"
#include "metrics/path_stability.h"
#include "metrics/plane_series.h"
#include "rasterizer/pipeline.h"

namespace plumb {
namespace {

ComparisonSettings series_settings(const Experiment& experiment) {
    ComparisonSettings settings = comparison_settings(experiment);
    settings.intervals = false;  // of single frames
    return settings;
}

GbufferFidelitySettings fidelity_settings() {
    GbufferFidelitySettings settings;
    settings.intervals = false;  // of single frames
    settings.keep_blocks = true;
    return settings;
}

PathStabilitySettings stability_settings(const Experiment& experiment) {
    PathStabilitySettings settings;
    settings.noise_limit = experiment.reference.most_noise;
    return settings;
}

Frame without_derived_planes(const Frame& truth) {
    Frame frame(truth.width(), truth.height());
    for (const std::string& plane : truth.plane_names()) {
        if (!is_derived_plane(plane)) frame.set(plane, truth.plane(plane));
    }
    return frame;
}

// Thrice as long as it takes to settle: in the last third less than a ten-thousandth is still to come.
int held_frames(const Method& method) { return 3 * frames_to_settle(method); }

void add_to(Image& sum, const Image& image, float weight) {
    if (sum.empty()) sum = Image(image.width(), image.height(), image.channels());
    for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += weight * image.values()[i];
}

}  // namespace

// What one method makes of one plane, frame after frame.
struct PathRun::Series {
    Series(const Experiment& experiment, std::string of_plane, std::string of_method)
        : plane(std::move(of_plane)),
          method(std::move(of_method)),
          errors(plane, SeriesOf::frames, series_settings(experiment)),
          stability(plane, stability_settings(experiment)),
          lag(plane) {}

    std::string plane, method;
    OracleLimits oracle;  // as ResultRow has it
    std::unique_ptr<Pipeline> pipeline;
    int gbuffer_bytes_per_pixel = 0;
    PlaneSeries errors;
    FidelitySeries fidelity;
    PathStability stability;
    PathLag lag;
    std::vector<FrameMeasure> frames;
    std::vector<Image> images;
    Timing timing;
};

PathRun::PathRun(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene,
                 const ExperimentPath& path, const SceneRunControl& control, std::filesystem::path folder)
    : experiment_(experiment),
      entry_(entry),
      scene_(scene),
      path_(path),
      control_(control),
      folder_(std::move(folder)),
      references_(control.cache, control.progress, control.stop, control.threads),
      scene_moves_(std::ranges::any_of(scene.instances, &Instance::moves)),
      truths_(experiment.planes.size()) {
    scene.path(path.path);  // throws for a name that is not there
    tells_lag_ = scene_moves_;
    for (int frame = 1; frame < path.frames; ++frame)
        tells_lag_ = tells_lag_ && Moment{at(frame).view} == Moment{at(0).view};
}

PathRun::~PathRun() = default;

Moment PathRun::at(int frame) const {
    const double time = path_.start + frame / path_.frames_per_second;
    Moment moment{View(scene_.path(path_.path).at(static_cast<float>(time)), experiment_.width, experiment_.height)};
    if (scene_moves_) moment.time = time;
    return moment;
}

std::string PathRun::cell_key(int frame) const {
    return fmt::format("path {} from {:a} at {:a}, frame {} of {}; {}", path_.path, path_.start,
                       path_.frames_per_second, frame, path_.frames,
                       methods_key(experiment_, entry_, scene_, at(frame).view, control_.context.info()));
}

std::vector<std::vector<PlaneImage>> PathRun::load_cells() const {
    std::vector<std::vector<PlaneImage>> cells;
    const int count = path_.frames + (tells_lag_ ? 1 : 0);  // what was held after the last frame included
    for (int frame = 0; frame < count; ++frame) {
        // Histories cannot be taken up in the middle: one frame that is missing, and all are rendered again.
        std::optional<std::vector<PlaneImage>> cell = control_.cells.load(cell_key(frame));
        if (!cell) return {};
        cells.push_back(std::move(*cell));
    }
    return cells;
}

void PathRun::make_pipelines(RunResults& results) {
    for (const std::unique_ptr<Series>& series : series_) {
        if (series->oracle.any()) continue;
        const Quantities quantities = quantities_of(experiment_, entry_, series->plane);
        try {
            series->pipeline = std::make_unique<Pipeline>(control_.context, scene_, method_of(*series), quantities,
                                                          experiment_.width, experiment_.height);
            series->gbuffer_bytes_per_pixel = static_cast<int>(series->pipeline->gbuffer_bytes_per_pixel());
        } catch (const std::exception& error) {
            results.failures.push_back(
                {fmt::format("{} / {} / {} / {}", entry_.scene, path_.path, series->plane, series->method),
                 error.what()});
        }
    }
    std::erase_if(series_,
                  [](const std::unique_ptr<Series>& series) { return !series->oracle.any() && !series->pipeline; });
}

Method PathRun::method_of(const Series& series) const {
    return method_in_scene(*find_method(experiment_.methods, series.method), entry_, experiment_.file.string());
}

TimeSpan PathRun::span_to(int frame) const {
    return scene_moves_ ? TimeSpan{*at(frame - 1).time, *at(frame).time} : TimeSpan{};
}

ReferenceSettings PathRun::truth_settings() const {
    ReferenceSettings settings = full_truth_settings(experiment_, entry_);
    settings.samples = experiment_.reference.path_samples;
    return settings;
}

ReferenceResult PathRun::render_reference(int frame, const ReferenceSettings& settings, const std::string& truth,
                                          const ProgressPart& part, RunResults& results) const {
    const ProgressPart of_frame =
        control_.part.part(static_cast<double>(frame) / path_.frames, (frame + 1.0) / path_.frames);
    return references_.render(
        *tracer_, scene_, at(frame).view, settings,
        {entry_.scene, fmt::format("{}, frame {} of {}", path_.path, frame + 1, path_.frames), truth},
        of_frame.part(part.from, part.to), results, span_to(frame));
}

// The planes that are compared, with their halves, and the exact G-buffer.
Frame PathRun::render_truth(int frame, RunResults& results) {
    // A scene that stands still needs one tree for all frames.
    if (scene_moves_ || !tracer_) tracer_ = std::make_unique<PathTracer>(scene_, span_to(frame));
    ReferenceResult reference = render_reference(frame, truth_settings(), "full", {0.0, 1.0}, results);
    if (!reference.complete) return {};
    reference_samples_ = frame == 0 ? reference.samples : std::min(reference_samples_, reference.samples);
    Frame truth = std::move(reference.frame);
    truth.facts["samples"] = fmt::format("{}", reference.samples);
    const View before = at(frame - 1).view;
    Frame gbuffer = tracer_->gbuffer(
        at(frame).view, {.minimum_separation = entry_.minimum_separation, .previous_view = &before}, control_.threads);
    for (const std::string& plane : gbuffer.plane_names()) truth.set(plane, std::move(gbuffer.plane(plane)));
    return truth;
}

FrameRequest PathRun::request_for(int frame, const Frame& truth) const {
    FrameRequest request{.now = at(frame), .next = at(frame + 1), .truth = &truth};
    if (frame > 0) request.previous = at(frame - 1);
    return request;
}

std::vector<PlaneImage> PathRun::render_methods(int frame, const Frame& truth, RunResults& results) {
    std::vector<PlaneImage> images;
    for (const std::unique_ptr<Series>& series : series_) {
        if (!series->pipeline) continue;
        try {
            if (frame == 0) {
                // The path begins with a history that has settled, as in the middle of a sequence.
                const FrameRequest still{.now = at(0), .truth = &truth};
                const int settling = frames_to_settle(method_of(*series));
                for (int i = 1; i < settling; ++i) series->pipeline->time_passes(still);
            }
            RasterResult raster = series->pipeline->render(request_for(frame, truth));
            PlaneImage& image = images.emplace_back(
                PlaneImage{path_.path, series->plane, series->method, std::move(raster.frame.plane(series->plane))});
            image.gbuffer_bytes_per_pixel = series->gbuffer_bytes_per_pixel;
        } catch (const std::exception& error) {
            results.failures.push_back({fmt::format("{} / {} / {} / {}, frame {}", entry_.scene, path_.path,
                                                    series->plane, series->method, frame + 1),
                                        error.what()});
            series->pipeline.reset();
        }
    }
    return images;
}

bool PathRun::time_methods(RunResults& results) {
    control_.progress.show(control_.part.to, fmt::format("{}: {}, times of the methods", entry_.scene, path_.path));
    bool timed = true;
    for (const std::string& plane : experiment_.planes) timed = time_methods(plane, results) && timed;
    return timed;
}

// As for views, plane by plane.
bool PathRun::time_methods(const std::string& plane, RunResults& results) {
    std::vector<Series*> in_turn;
    std::vector<TimedPath> subjects;
    for (const std::unique_ptr<Series>& series : series_) {
        if (series->plane != plane || !series->pipeline) continue;
        in_turn.push_back(series.get());
        // One still frame is a history: what passes cost does not depend on what it holds.
        subjects.push_back({[this, pipeline = series->pipeline.get()] {
                                pipeline->forget();
                                pipeline->time_passes({.now = at(0), .truth = &stage_truths_.front()});
                            },
                            [this, pipeline = series->pipeline.get()](int frame) {
                                return pipeline->time_passes(
                                    request_for(frame, stage_truths_[static_cast<std::size_t>(frame)]));
                            }});
    }
    try {
        const std::vector<Timing> timings = time_along_path(subjects, path_.frames, experiment_.timing, control_.stop);
        if (stopped()) return false;
        for (std::size_t i = 0; i < in_turn.size(); ++i) in_turn[i]->timing = timings[i];
        return true;
    } catch (const std::exception& error) {
        results.failures.push_back(
            {fmt::format("{} / {} / {} / timing", entry_.scene, path_.path, plane), error.what()});
        // No error is told without its time.
        std::erase_if(series_, [&](const std::unique_ptr<Series>& series) {
            return series->plane == plane && !series->oracle.any();
        });
        return false;
    }
}

void PathRun::keep_first_cell(std::vector<PlaneImage> images) const {
    for (PlaneImage& image : images) {
        const auto found = std::ranges::find_if(series_, [&](const std::unique_ptr<Series>& series) {
            return series->plane == image.plane && series->method == image.method;
        });
        image.timing = (*found)->timing;
    }
    control_.cells.save(cell_key(0), images);
}

std::vector<PlaneImage> PathRun::render_held(const Frame& truth, RunResults& results) {
    std::vector<PlaneImage> images;
    const Moment last = at(path_.frames - 1);
    const FrameRequest request{.now = last, .previous = last, .next = last, .truth = &truth};
    for (const std::unique_ptr<Series>& series : series_) {
        if (!series->pipeline) continue;
        try {
            const int settling = frames_to_settle(method_of(*series)), frames = held_frames(method_of(*series));
            Image sum, settled;
            for (int i = 0; i < frames; ++i) {
                if (stopped()) return {};
                const RasterResult raster = series->pipeline->render(request);
                const Image& image = raster.frame.plane(series->plane);
                add_to(sum, image, 1.0f);
                if (i >= frames - settling) add_to(settled, image, 1.0f / static_cast<float>(settling));
            }
            images.push_back({path_.path, series->plane, series->method, std::move(sum)});
            images.push_back({path_.path, series->plane, series->method, std::move(settled)});
        } catch (const std::exception& error) {
            results.failures.push_back({fmt::format("{} / {} / {} / {}, held after the last frame", entry_.scene,
                                                    path_.path, series->plane, series->method),
                                        error.what()});
            series->pipeline.reset();
        }
    }
    return images;
}

void PathRun::add_held(const Frame& truth, RunResults& results) {
    const std::string key = cell_key(path_.frames);  // one behind the last
    std::optional<std::vector<PlaneImage>> held = control_.cells.load(key);
    if (!held) {
        held = render_held(truth, results);
        if (held->size() == 2 * experiment_.planes.size() * experiment_.methods.size()) control_.cells.save(key, *held);
    }
    for (std::size_t i = 0; i + 1 < held->size(); i += 2) {
        Series& series = series_of((*held)[i]);
        series.lag.hold((*held)[i].image, (*held)[i + 1].image, held_frames(method_of(series)));
    }
}

std::vector<PlaneImage> PathRun::render_oracle(int frame, const Frame& truth, RunResults& results) {
    const auto render = [&](const ReferenceSettings& settings, const std::string& name) {
        return render_reference(frame, settings, name, {1.0, 1.0}, results);
    };
    return oracle_images(experiment_, entry_, path_.path, at(frame).view, truth_settings(), truth, render);
}

PathRun::Series& PathRun::series_of(const PlaneImage& image) {
    return **std::ranges::find_if(series_, [&](const std::unique_ptr<Series>& series) {
        return series->plane == image.plane && series->method == image.method;
    });
}

void PathRun::add(const PlaneImage& image, int frame, const Frame& truth, const std::vector<Region>& regions) {
    Series& series = series_of(image);
    const Frame test = frame_of(image);
    FrameMeasure measure{path_.start + frame / path_.frames_per_second, no_value, no_value};
    const PlaneComparison whole = std::move(series.errors.add(test, truth, regions).front());
    if (const auto fidelity = fidelity_of(image, truth, fidelity_settings())) series.fidelity.add(*fidelity);
    if (whole.referenced) measure.rmse = std::sqrt(std::max(0.0, whole.referenced->mse));
    if (const std::optional<Flicker> flicker = series.stability.add(test, truth, nullptr, regions))
        measure.flicker = flicker->rms;
    if (tells_lag_ && !series.oracle.any()) series.lag.add(test, truth);
    series.frames.push_back(measure);
    if (!series.oracle.any()) series.images.push_back(image.image);  // pictures show methods
    if (frame == 0) series.timing = image.timing;                    // of all frames, where a cell has it
    series.gbuffer_bytes_per_pixel = image.gbuffer_bytes_per_pixel;
}

void PathRun::run(RunResults& results) {
    for (const std::string& plane : experiment_.planes) {
        const auto add_series = [&](const std::string& name) -> Series& {
            return *series_.emplace_back(std::make_unique<Series>(experiment_, plane, name));
        };
        for (const Method& method : experiment_.methods) add_series(method.name);
        for (const int layers : experiment_.oracle_layers) add_series(oracle_name(layers)).oracle.layers = layers;
        for (const int bounces : experiment_.oracle_bounces)
            add_series(oracle_name_of_bounces(bounces)).oracle.bounces = bounces;
    }
    const std::vector<std::vector<PlaneImage>> kept = load_cells();
    if (kept.empty()) make_pipelines(results);
    const bool feeds_stages = std::ranges::any_of(experiment_.methods, [&](const Method& method) {
        return uses_truth(method_in_scene(method, entry_, experiment_.file.string()));
    });
    std::vector<PlaneImage> first;
    for (int frame = 0; frame < path_.frames; ++frame) {
        const Frame truth = render_truth(frame, results);
        if (stopped()) return;
        const std::vector<Region> regions = regions_of(truth);
        const auto place = static_cast<std::size_t>(frame);
        std::vector<PlaneImage> images = kept.empty() ? render_methods(frame, truth, results) : kept[place];
        for (const PlaneImage& image : images) add(image, frame, truth, regions);
        stage_truths_.push_back(feeds_stages ? without_derived_planes(truth) : Frame());
        // A path with a failure is tried again by the next run.
        if (kept.empty() && images.size() == experiment_.planes.size() * experiment_.methods.size()) {
            if (frame == 0)
                first = std::move(images);
            else
                control_.cells.save(cell_key(frame), images);
        }
        const std::vector<PlaneImage> oracle = render_oracle(frame, truth, results);
        if (stopped()) return;
        for (const PlaneImage& image : oracle) add(image, frame, truth, regions);
        for (std::size_t plane = 0; plane < truths_.size(); ++plane)
            truths_[plane].push_back(truth.plane(experiment_.planes[plane]));
        if (tells_lag_ && frame + 1 == path_.frames) add_held(truth, results);
        if (stopped()) return;
    }
    // What failed on the way is on record, and has no row.
    std::erase_if(series_, [&](const std::unique_ptr<Series>& series) {
        return series->frames.size() != static_cast<std::size_t>(path_.frames);
    });
    if (kept.empty()) {
        const bool timed = time_methods(results);
        if (stopped()) return;
        if (timed && !first.empty()) keep_first_cell(std::move(first));
    }
    write_rows(results);
    write_pictures(results);
}

void PathRun::write_rows(RunResults& results) {
    for (const std::unique_ptr<Series>& series : series_) {
        ResultRow row;
        row.scene = entry_.scene, row.path = path_.path, row.plane = series->plane, row.method = series->method;
        row.truth = full_truth_name(series->plane);
        row.oracle = series->oracle;
        if (row.is_method()) describe_method(experiment_, entry_, series->method, row);
        row.reference_samples = reference_samples_;
        row.gbuffer_bytes_per_pixel = series->gbuffer_bytes_per_pixel;
        add_series(series->errors.results(), row);
        const std::map<std::string, PathStabilityResult> of_regions = series->stability.of_regions();
        for (RegionError& region : row.regions) {
            if (const auto found = of_regions.find(region.region); found != of_regions.end())
                region.stability = found->second;
        }
        if (series->fidelity.frames() > 0) row.fidelity = fidelity_measures(series->fidelity.result(), series->plane);
        row.frames = series->frames;
        row.stability = series->stability.result();
        row.timing = series->timing;
        if (const Estimate lag = series->lag.result(); std::isfinite(lag.value)) row.lag = lag;
        results.rows.push_back(std::move(row));
    }
}

void PathRun::write_pictures(RunResults& results) {
    for (std::size_t plane = 0; plane < experiment_.planes.size(); ++plane) {
        const std::string& name = experiment_.planes[plane];
        std::vector<PathImages> methods;
        for (const std::unique_ptr<Series>& series : series_) {
            if (series->plane != name || series->oracle.any()) continue;
            PathImages& images = methods.emplace_back(PathImages{series->method, {}, {}, {}});
            for (const Image& image : series->images) images.frames.push_back(&image);
            for (const FrameMeasure& frame : series->frames)
                images.rmse.push_back(frame.rmse), images.flicker.push_back(frame.flicker);
        }
        if (methods.empty()) continue;
        PathPictures subject;
        subject.scene = entry_.scene, subject.path = path_.path, subject.plane = name;
        subject.frames_per_second = path_.frames_per_second;
        subject.truth = full_truth_name(name);
        std::vector<const Image*> truths;
        for (const Image& image : truths_[plane]) truths.push_back(&image);
        results.path_pictures.push_back(write_path_pictures(std::move(subject), truths, methods, folder_));
    }
}

}  // namespace plumb
