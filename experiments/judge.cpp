#include "experiments/judge.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/error_maps.h"
#include "experiments/foreign_frame.h"
#include "experiments/reference_renderer.h"
#include "experiments/row_measurement.h"
#include "frames/image_error.h"
#include "frames/image_file.h"

namespace plumb {

Judge::Judge(const Scene& scene, std::vector<std::filesystem::path> files, JudgeSettings settings,
             const ReferenceCache& cache, ProgressLine& progress)
    : scene_(scene),
      files_(std::move(files)),
      settings_(std::move(settings)),
      cache_(cache),
      progress_(progress),
      scene_moves_(std::ranges::any_of(scene.instances, &Instance::moves)),
      comparison_(settings_.comparison) {
    settings_.reference.quantities.planes.clear();
    std::ranges::copy_if(settings_.planes, std::back_inserter(settings_.reference.quantities.planes), is_light_plane);
}

Judge::~Judge() = default;

Frame Judge::read(int frame) const {
    const std::filesystem::path& file = files_[static_cast<std::size_t>(frame)];
    Frame foreign = with_our_names(read_frame(file), settings_.renamings, file.string());
    const CameraSequence& cameras = settings_.cameras;
    if (foreign.width() != cameras.width || foreign.height() != cameras.height) {
        throw ImageError(fmt::format("{}: is {}x{}; the first frame is {}x{}, and all must be of one size",
                                     file.string(), foreign.width(), foreign.height(), cameras.width, cameras.height));
    }
    Frame judged(foreign.width(), foreign.height());
    for (const std::string& plane : settings_.planes) {
        if (!foreign.has(plane)) {
            throw ImageError(fmt::format("{}: there is no plane '{}' (there are {}); see --planes and --rename",
                                         file.string(), plane, fmt::join(foreign.plane_names(), ", ")));
        }
        judged.set(plane, std::move(foreign.plane(plane)));
    }
    return judged;
}

Frame Judge::truth(int frame) {
    const CameraSequence& cameras = settings_.cameras;
    const View before = cameras.view_at(scene_, frame - 1), now = cameras.view_at(scene_, frame);
    const TimeSpan span = scene_moves_ ? TimeSpan{cameras.time(frame - 1), cameras.time(frame)} : TimeSpan{};
    // A scene that stands still needs one tree for all frames.
    if (scene_moves_ || !tracer_) tracer_ = std::make_unique<PathTracer>(scene_, span);
    Frame result(cameras.width, cameras.height);
    if (!settings_.reference.quantities.planes.empty()) {
        RunResults record;
        const double frames = cameras.frames;
        ReferenceResult reference =
            ReferenceRenderer(cache_, progress_, settings_.stop, settings_.threads)
                .render(*tracer_, scene_, now, settings_.reference,
                        {settings_.scene,
                         fmt::format("{}, frame {} of {}", cameras.place(scene_), frame + 1, cameras.frames), "full"},
                        ProgressPart{frame / frames, (frame + 1) / frames}, record, span);
        if (!reference.complete) return {};
        result = std::move(reference.frame);
        result.facts["samples"] = fmt::format("{}", reference.samples);
    }
    Frame gbuffer =
        tracer_->gbuffer(now, {.minimum_separation = settings_.reference.minimum_separation, .previous_view = &before},
                         settings_.threads);
    for (const std::string& plane : gbuffer.plane_names()) result.set(plane, std::move(gbuffer.plane(plane)));
    return result;
}

bool Judge::run() {
    for (int frame = 0; frame < settings_.cameras.frames; ++frame) {
        const Frame test = read(frame);  // what is wrong with a file is said before its truth is rendered
        const Frame reference = truth(frame);
        if (settings_.stop && settings_.stop->load()) return false;
        comparison_.add(files_[static_cast<std::size_t>(frame)].filename().string(), test, reference);
    }
    return true;
}

std::vector<std::string> Judge::noise_warnings() const {
    std::vector<std::string> warnings;
    for (const std::string& plane : settings_.planes) {
        const auto error = comparison_.error_of(plane);
        if (error && !error->trustworthy) warnings.push_back(fmt::format("{}: {}", plane, refusal_of(*error)));
    }
    return warnings;
}

std::string Judge::write_error_maps(const std::filesystem::path& folder, double scale) {
    const auto scales = error_map_scales(comparison_.frames(), scale);
    for (int frame = 0; frame < settings_.cameras.frames; ++frame) {
        const Frame test = read(frame), reference = truth(frame);
        const std::string stem = files_[static_cast<std::size_t>(frame)].stem().string();
        for (const auto& [plane, of_plane] : scales) {
            write_error_map(folder / fmt::format("{}.{}.error.png", stem, plane),
                            *error_map(ErrorMapKind::difference, test.plane(plane), reference.plane(plane), plane),
                            of_plane);
        }
    }
    return error_map_legend(scales);
}

}  // namespace plumb
