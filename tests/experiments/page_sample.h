// A run's results made by hand with all that a page can show: pictures, a camera path, a sweep, oracles, regions, a
// waterfall.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/packed_plane.h"
#include "experiments/path_pictures.h"
#include "frames/atomic_file.h"
#include "frames/picture.h"
#include "tests/experiments/sample_results.h"

namespace plumb {

inline constexpr int sample_width = 32, sample_height = 18, sample_frames = 5;

// Truth, and methods `one` and `two`, of radiance: no two pixels and no two channels are alike.
inline Image sample_truth() {
    Image image(sample_width, sample_height, 3);
    for (int y = 0; y < sample_height; ++y) {
        for (int x = 0; x < sample_width; ++x) {
            for (int c = 0; c < 3; ++c)
                image.at(x, y, c) =
                    0.02f * static_cast<float>(x + 1) + 0.007f * static_cast<float>(y) + 0.11f * static_cast<float>(c);
        }
    }
    return image;
}
inline Image sample_image(const std::string& method) {
    Image image = sample_truth();
    for (float& value : image.values()) value = method == "one" ? 1.5f * value : value + 0.01f;
    if (method == "one") image.at(0, 0, 1) = std::numeric_limits<float>::quiet_NaN();
    return image;
}

inline PictureSet sample_pictures(const std::filesystem::path& folder, const std::string& view = "front") {
    PictureSet set;
    set.scene = "cornell", set.view = view, set.plane = "total";
    set.error_scale = 0.4, set.exposure = 0.5f;
    const auto add = [&](const std::string& label, const std::string& kind, const Image& image) {
        const std::string stem = fmt::format("pictures/{}.{}", view, label);
        write_text_atomically(folder / (stem + ".plane"), pack_plane(image));
        set.images.push_back({label, kind, stem + ".png", "a note", stem + ".plane"});
    };
    add("truth", "truth", sample_truth());
    for (const std::string method : {"one", "two"}) {
        add(method, "method", sample_image(method));
        set.images.push_back({method, "error", fmt::format("pictures/{}.{}.error.png", view, method), "", ""});
    }
    return set;
}

// Frame i of the truth is 0.2 i everywhere; `one` is 0.1 more, `two` 0.02.
inline PathPictures sample_path(const std::filesystem::path& folder) {
    std::vector<Image> images;
    images.reserve(std::size_t{3} * sample_frames);  // pointers into it stay
    std::vector<const Image*> truth;
    std::vector<PathImages> methods(2);
    methods[0].label = "one", methods[1].label = "two";
    for (int i = 0; i < sample_frames; ++i) {
        const float level = 0.2f * static_cast<float>(i);
        for (const float more : {0.0f, 0.1f, 0.02f}) images.emplace_back(sample_width, sample_height, 1, level + more);
        truth.push_back(&images[images.size() - 3]);
        for (std::size_t m = 0; m < 2; ++m) {
            const double error = m == 0 ? 0.1 : 0.02;
            methods[m].frames.push_back(&images[images.size() - 2 + m]);
            methods[m].rmse.push_back(error);
            methods[m].flicker.push_back(i == 0 ? std::numeric_limits<double>::quiet_NaN() : error * i);
        }
    }
    PathPictures subject;
    subject.scene = "cornell", subject.path = "orbit", subject.plane = "ao", subject.frames_per_second = 10;
    return write_path_pictures(subject, truth, methods, folder);
}

inline RunResults full_sample(const std::filesystem::path& folder) {
    RunResults results = sample_results();
    results.experiment.title = "One layer against two";
    results.experiment.question = "What does the second layer buy?";
    for (ResultRow& row : results.rows) {
        row.regions = {{"silhouettes", 40, 4 * row.mse, 3 * row.mse, 5 * row.mse}};
        row.gbuffer_bytes_per_pixel = 12;
    }
    for (const int samples : {2, 4, 8}) {
        ResultRow row = sample_row("front", "path tracer, " + std::to_string(samples) + " spp",
                                   0.2 / std::sqrt(samples), 1.0 * samples);
        row.path_tracer_samples = samples;
        results.rows.push_back(row);
        ResultRow swept =
            sample_row("front", "sao, ao.samples = " + std::to_string(samples), 0.3 / samples, 0.8 * samples);
        swept.curve = "sao", swept.curve_parameter = "ao.samples", swept.curve_value = samples;
        results.rows.push_back(swept);
    }
    ResultRow oracle = sample_row("front", "oracle, 1 layer", 0.01, 0.0);
    oracle.oracle.layers = 1;
    results.rows.push_back(oracle);
    for (const std::string method : {"one", "two"}) {
        ResultRow row = sample_row("", method, 0.07, 3.0);
        row.path = "orbit";
        row.stability = sample_stability(method == "one" ? 0.04 : 0.01);
        results.rows.push_back(row);
    }
    ResultRow refused = sample_row("left", "noisy", 0.1, 9.0);
    refused.measured = false, refused.refusal = "4096 samples per pixel would do";
    results.rows.push_back(refused);
    results.pictures = {sample_pictures(folder), sample_pictures(folder, "left")};
    results.path_pictures = {sample_path(folder)};
    results.waterfalls = {{"front / ao: two",
                           "RMSE",
                           {{"layers", 0.0, 0.03, 0.02, 0.04, "saves 12 ms"},
                            {"estimator", 0.03, 0.06, 0.01, 0.05, ""},
                            {"blur", 0.06, 0.05, -0.02, -0.005, ""}}}};
    results.failures = {{"cornell / front / <b>", "went wrong"}};
    results.summary = {"two has 0.5 times the RMSE of one over 3 views."};
    return results;
}

}  // namespace plumb
