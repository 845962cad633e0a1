#include "experiments/path_pictures.h"

#include <algorithm>
#include <cmath>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include "experiments/picture_look.h"
#include "frames/atomic_file.h"
#include "frames/image_error.h"
#include "frames/picture.h"
#include "metrics/comparison.h"
#include "metrics/error_image.h"

namespace plumb {
namespace {

constexpr int jpeg_quality = 88;     // no blocks to be seen at one to one; a third of the bytes of a PNG
constexpr int greatest_width = 480;  // a page holds hundreds of frames

// Display values, averaged over the pixels that become one.
Image made_smaller(const Image& displayed) {
    if (displayed.width() <= greatest_width) return displayed;
    const int height = std::max(1, greatest_width * displayed.height() / displayed.width());
    Image small(greatest_width, height, displayed.channels());
    const OIIO::ImageSpec from(displayed.width(), displayed.height(), displayed.channels(), OIIO::TypeDesc::FLOAT);
    const OIIO::ImageSpec to(small.width(), small.height(), small.channels(), OIIO::TypeDesc::FLOAT);
    // OpenImageIO takes memory that it only reads as writable, too.
    const OIIO::ImageBuf source(from, const_cast<float*>(displayed.values().data()));
    OIIO::ImageBuf target(to, small.values().data());
    if (!OIIO::ImageBufAlgo::resize(target, source, "box")) {
        throw ImageError(fmt::format("cannot make a picture of {}x{} pixels smaller: {}", displayed.width(),
                                     displayed.height(), target.geterror()));
    }
    return small;
}

Image error_of(const Image& image, const Image& truth) { return mean_of_channels(absolute_error(image, truth)); }

void check(const PathPictures& subject, const std::vector<const Image*>& truth, const PathImages& method) {
    if (method.frames.size() == truth.size()) return;
    throw ImageError(fmt::format("{} / {} / {}: {} has {} frames, the truth {}; render both over the same frames",
                                 subject.scene, subject.path, subject.plane, method.label, method.frames.size(),
                                 truth.size()));
}

// The 99th percentile of the worst frame's error: fireflies and silhouettes do not set the scale.
double error_scale(const std::vector<const Image*>& truth, const std::vector<PathImages>& methods) {
    double scale = 0.0;
    for (const PathImages& method : methods) {
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const double level = value_percentile(error_of(*method.frames[i], *truth[i]), 0.99);
            if (std::isfinite(level)) scale = std::max(scale, level);
        }
    }
    return round_up_scale(scale);
}

}  // namespace

PathPictures write_path_pictures(PathPictures subject, const std::vector<const Image*>& truth,
                                 const std::vector<PathImages>& methods, const std::filesystem::path& folder) {
    if (truth.empty()) throw ImageError(fmt::format("{} / {}: a path of no frames", subject.scene, subject.path));
    for (const PathImages& method : methods) check(subject, truth, method);

    double range = 0.0;
    for (const Image* frame : truth) range = std::max(range, default_data_range(subject.plane, *frame));
    PictureSettings look;
    look.exposure = exposure_for(range);
    subject.exposure_note = exposure_note(subject.plane, look.exposure);
    subject.error_scale = error_scale(truth, methods);

    const std::string suffix = subject.truth.empty() ? "" : fmt::format(".{}", file_name_of(subject.truth));
    const std::string stem = fmt::format("pictures/{}.{}.{}", file_name_of(subject.scene), file_name_of(subject.path),
                                         file_name_of(subject.plane));
    const auto write = [&](PathPictureStrip& strip, const std::string& name, const Image& displayed) {
        const std::string file = fmt::format("{}.{}.{:04}.jpg", stem, name, strip.files.size());
        write_text_atomically(folder / file, encode_jpeg(made_smaller(displayed), jpeg_quality));
        strip.files.push_back(file);
    };
    PathPictureStrip truth_strip{"truth", "truth", {}, {}, {}};
    for (const Image* frame : truth) {
        write(truth_strip, fmt::format("truth{}", suffix), picture_of_plane(subject.plane, *frame, look));
    }
    subject.strips = {std::move(truth_strip)};
    for (const PathImages& method : methods) {
        PathPictureStrip seen{method.label, "method", {}, method.rmse, method.flicker};
        PathPictureStrip error{method.label, "error", {}, {}, {}};
        const std::string name = file_name_of(method.label);
        for (std::size_t i = 0; i < truth.size(); ++i) {
            write(seen, name, picture_of_plane(subject.plane, *method.frames[i], look));
            write(error, fmt::format("{}.error{}", name, suffix),
                  apply_colour_map(error_of(*method.frames[i], *truth[i]), error_colour_map, 0.0f,
                                   static_cast<float>(subject.error_scale)));
        }
        subject.strips.push_back(std::move(seen));
        subject.strips.push_back(std::move(error));
    }
    return subject;
}

}  // namespace plumb
