#include "experiments/pictures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/packed_plane.h"
#include "frames/atomic_file.h"
#include "frames/exr.h"
#include "frames/picture.h"
#include "metrics/comparison.h"
#include "metrics/error_image.h"

namespace plumb {
namespace {

struct PictureSubject {
    std::string plane, truth;
    bool operator==(const PictureSubject&) const = default;
};

class PictureWriter {
public:
    PictureWriter(const SceneRun& run, const Experiment& experiment, const std::string& scene,
                  const std::filesystem::path& folder, RunResults& results)
        : run_(run), experiment_(experiment), scene_(scene), folder_(folder), results_(results) {}

    void write(const PictureSubject& subject) {
        const double scale = error_scale(subject);
        for (const std::string& view : run_.views()) {
            const Truth* truth = find_truth(view, subject);
            if (truth) write_view(subject, view, *truth, scale);
        }
    }

private:
    const Truth* find_truth(const std::string& view, const PictureSubject& subject) {
        const auto found = run_.truths().find(view);
        if (found == run_.truths().end()) return nullptr;
        truths_ = found->second.of(subject.plane);
        const auto truth = std::ranges::find(truths_, subject.truth, &Truth::name);
        return truth == truths_.end() ? nullptr : &*truth;
    }

    template <class Function>
    void for_each_method(const PictureSubject& subject, const std::string& view, Function&& function) const {
        for (const PlaneImage& image : run_.images()) {
            const bool wanted = image.plane == subject.plane && image.view == view;
            if (wanted && find_method(experiment_.methods, image.method)) function(image);
        }
    }

    // The 99th percentile of the worst image's error: fireflies and silhouettes do not set the scale.
    double error_scale(const PictureSubject& subject) {
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

    void write_view(const PictureSubject& subject, const std::string& view, const Truth& truth, double scale) {
        const Image& reference = truth.frame->plane(subject.plane);
        PictureSettings look;
        // Just below white, and of the full truth, so that both truths and the methods look alike.
        const Image& exposed = run_.truths().at(view).full.frame.plane(subject.plane);
        look.exposure = exposure_for(default_data_range(subject.plane, exposed));

        PictureSet set;
        set.scene = scene_, set.view = view, set.plane = subject.plane, set.truth = subject.truth;
        set.error_scale = scale;
        set.exposure = look.exposure;
        set.exposure_note = exposure_note(subject.plane, look.exposure);
        const std::string stem =
            fmt::format("pictures/{}.{}.{}", file_name_of(scene_), file_name_of(view), file_name_of(subject.plane));
        const std::string suffix = subject.truth.empty() ? "" : fmt::format(".{}", file_name_of(subject.truth));

        add_values(set, {"truth", "truth", fmt::format("{}.truth{}", stem, suffix), note_of(truth)}, reference, look);
        for_each_method(subject, view, [&](const PlaneImage& image) {
            const std::string name = fmt::format("{}.{}", stem, file_name_of(image.method));
            add_values(set, {image.method, "method", name, note_of(subject, image)}, image.image, look);
            const Image error = mean_of_channels(absolute_error(image.image, reference));
            const std::string file = fmt::format("{}.error{}.png", name, suffix);
            write_png(folder_ / file, apply_colour_map(error, error_colour_map, 0.0f, static_cast<float>(scale)));
            set.images.push_back({image.method, "error", file, "", ""});
        });
        results_.pictures.push_back(std::move(set));
    }

    struct Named {
        std::string label, kind, stem, note;
    };

    void add_values(PictureSet& set, const Named& named, const Image& image, const PictureSettings& look) const {
        const Picture picture{named.label, named.kind, named.stem + ".png", named.note, named.stem + ".plane"};
        write_png(folder_ / picture.file, picture_of_plane(set.plane, image, look));
        write_text_atomically(folder_ / picture.values, pack_plane(image));
        set.images.push_back(picture);
    }

    static std::string note_of(const Truth& truth) { return fmt::format("{} samples per pixel", truth.samples); }

    std::string note_of(const PictureSubject& subject, const PlaneImage& image) const {
        for (const ResultRow& row : results_.rows) {
            const bool same = row.scene == scene_ && row.view == image.view && row.plane == image.plane &&
                              row.method == image.method && row.truth == subject.truth;
            if (same && row.measured) return fmt::format("RMSE {:.3g}, {:.3g} ms", row.rmse(), row.timing.median);
        }
        return fmt::format("{:.3g} ms", image.timing.median);
    }

    const SceneRun& run_;
    const Experiment& experiment_;
    const std::string& scene_;
    const std::filesystem::path& folder_;
    RunResults& results_;
    std::vector<Truth> truths_;
};

}  // namespace

void write_pictures(const SceneRun& run, const Experiment& experiment, const std::string& scene,
                    const std::filesystem::path& folder, RunResults& results) {
    PictureWriter writer(run, experiment, scene, folder, results);
    std::vector<PictureSubject> written;
    for (const std::string& plane : experiment.planes) {
        for (const auto& [view, truths] : run.truths()) {
            for (const Truth& truth : truths.of(plane)) {
                const PictureSubject subject{plane, truth.name};
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

}  // namespace plumb
