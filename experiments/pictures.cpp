#include "experiments/pictures.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "frames/exr.h"
#include "frames/picture.h"
#include "metrics/comparison.h"
#include "metrics/error_image.h"

namespace plumb {
namespace {

// Rounded up to one or two leading digits, so that legends read well.
double round_up_scale(double value) {
    if (!(value > 0.0) || !std::isfinite(value)) return 1e-6;
    const double magnitude = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
        if (value <= step * magnitude * (1.0 + 1e-9)) return step * magnitude;
    }
    return 10.0 * magnitude;
}

struct Subject {
    std::string plane, truth;
    bool operator==(const Subject&) const = default;
};

class PictureWriter {
public:
    PictureWriter(const SceneRun& run, const std::string& scene, const std::filesystem::path& folder,
                  RunResults& results)
        : run_(run), scene_(scene), folder_(folder), results_(results) {}

    void write(const Subject& subject) {
        const double scale = error_scale(subject);
        for (const std::string& view : run_.views()) {
            const Truth* truth = find_truth(view, subject);
            if (truth) write_view(subject, view, *truth, scale);
        }
    }

private:
    const Truth* find_truth(const std::string& view, const Subject& subject) {
        const auto found = run_.truths().find(view);
        if (found == run_.truths().end()) return nullptr;
        truths_ = found->second.of(subject.plane);
        const auto truth = std::ranges::find(truths_, subject.truth, &Truth::name);
        return truth == truths_.end() ? nullptr : &*truth;
    }

    template <class Function>
    void for_each_method(const Subject& subject, const std::string& view, Function&& function) const {
        for (const PlaneImage& image : run_.images()) {
            if (image.plane == subject.plane && image.view == view && image.path_tracer_samples == 0) function(image);
        }
    }

    // The 99th percentile of the worst image's error: fireflies and silhouettes do not set the scale.
    double error_scale(const Subject& subject) {
        double scale = 0.0;
        for (const std::string& view : run_.views()) {
            const Truth* truth = find_truth(view, subject);
            if (!truth) continue;
            for_each_method(subject, view, [&](const PlaneImage& image) {
                const Image error = mean_of_channels(absolute_error(image.image, truth->frame->plane(subject.plane)));
                const double level = value_percentile(error, 0.99);
                if (std::isfinite(level)) scale = std::max(scale, level);
            });
        }
        return round_up_scale(scale);
    }

    void write_view(const Subject& subject, const std::string& view, const Truth& truth, double scale) {
        const Image& reference = truth.frame->plane(subject.plane);
        PictureSettings look;
        // Just below white, and of the full truth, so that both truths and the methods look alike.
        const Image& exposed = run_.truths().at(view).full.frame.plane(subject.plane);
        look.exposure = static_cast<float>(std::log2(0.9 / default_data_range(subject.plane, exposed)));

        PictureSet set;
        set.scene = scene_, set.view = view, set.plane = subject.plane, set.truth = subject.truth;
        set.error_scale = scale;
        if (subject.plane != "ao" && subject.plane != "depth") {
            set.exposure_note = fmt::format("pictures: exposure {:+.1f} stops, then sRGB", look.exposure);
        }
        const std::string stem =
            fmt::format("pictures/{}.{}.{}", file_name_of(scene_), file_name_of(view), file_name_of(subject.plane));
        const std::string suffix = subject.truth.empty() ? "" : fmt::format(".{}", file_name_of(subject.truth));

        add(set,
            {"truth", "truth", stem + ".truth" + suffix + ".png", fmt::format("{} samples per pixel", truth.samples)},
            picture_of_plane(subject.plane, reference, look));
        for_each_method(subject, view, [&](const PlaneImage& image) {
            const std::string method = file_name_of(image.method);
            add(set, {image.method, "method", fmt::format("{}.{}.png", stem, method), note_of(subject, image)},
                picture_of_plane(subject.plane, image.image, look));
            const Image error = mean_of_channels(absolute_error(image.image, reference));
            add(set, {image.method, "error", fmt::format("{}.{}.error{}.png", stem, method, suffix), ""},
                apply_colour_map(error, error_colour_map, 0.0f, static_cast<float>(scale)));
        });
        results_.pictures.push_back(std::move(set));
    }

    void add(PictureSet& set, Picture picture, const Image& displayed) {
        write_png(folder_ / picture.file, displayed);
        set.images.push_back(std::move(picture));
    }

    std::string note_of(const Subject& subject, const PlaneImage& image) const {
        for (const ResultRow& row : results_.rows) {
            const bool same = row.scene == scene_ && row.view == image.view && row.plane == image.plane &&
                              row.method == image.method && row.truth == subject.truth;
            if (same && row.measured) return fmt::format("RMSE {:.3g}, {:.3g} ms", row.rmse(), row.timing.median);
        }
        return fmt::format("{:.3g} ms", image.timing.median);
    }

    const SceneRun& run_;
    const std::string& scene_;
    const std::filesystem::path& folder_;
    RunResults& results_;
    std::vector<Truth> truths_;
};

}  // namespace

void write_pictures(const SceneRun& run, const Experiment& experiment, const std::string& scene,
                    const std::filesystem::path& folder, RunResults& results) {
    PictureWriter writer(run, scene, folder, results);
    std::vector<Subject> written;
    for (const std::string& plane : experiment.planes) {
        for (const auto& [view, truths] : run.truths()) {
            for (const Truth& truth : truths.of(plane)) {
                const Subject subject{plane, truth.name};
                if (std::ranges::find(written, subject) != written.end()) continue;
                written.push_back(subject);
                writer.write(subject);
            }
        }
    }
}

void write_frames(const SceneRun& run, const Experiment& experiment, const std::string& scene,
                  const std::filesystem::path& folder) {
    for (const auto& entry : run.truths()) {
        const std::string& view = entry.first;
        const ViewTruths& truths = entry.second;
        const std::string stem = fmt::format("{}.{}", file_name_of(scene), file_name_of(view));
        const auto write = [&](Frame frame, const std::string& name) {
            frame.facts["scene"] = scene, frame.facts["view"] = view, frame.facts["experiment"] = experiment.name;
            write_exr(folder / "frames" / fmt::format("{}.{}.exr", stem, file_name_of(name)), frame);
        };
        const auto write_truth = [&](const ReferenceResult& truth, const std::string& name) {
            Frame frame = truth.frame;
            frame.facts["samples"] = fmt::format("{}", truth.samples);  // what `plumbline compare` looks for
            write(std::move(frame), name);
        };
        write_truth(truths.full, "truth");
        if (truths.limited) write_truth(*truths.limited, "limited_truth");
        for (const Method& method : experiment.methods) {
            Frame frame(experiment.width, experiment.height);
            for (const PlaneImage& image : run.images()) {
                if (image.view == view && image.method == method.name) frame.set(image.plane, image.image);
            }
            frame.facts["method"] = method.name;
            if (!frame.plane_names().empty()) write(std::move(frame), method.name);
        }
    }
}

std::string file_name_of(std::string_view name) {
    std::string result(name);
    for (char& letter : result) {
        const bool plain = std::isalnum(static_cast<unsigned char>(letter)) || letter == '-' || letter == '_';
        if (!plain) letter = '_';
    }
    return result;
}

}  // namespace plumb
