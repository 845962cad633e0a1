#include "experiments/row_measurement.h"

#include <cmath>

#include <fmt/format.h>

#include "experiments/mean_measures.h"
#include "experiments/no_value.h"
#include "metrics/comparison.h"
#include "metrics/error_series.h"

namespace plumb {
namespace {

// Of the truth's frame, what belongs to one plane.
Frame reference_of(const Truth& truth) {
    Frame reference(truth.frame->width(), truth.frame->height());
    for (const char* prefix : {"", "half_a.", "half_b."}) {
        const std::string name = prefix + truth.plane;
        if (truth.frame->has(name)) reference.set(name, truth.frame->plane(name));
    }
    reference.facts["samples"] = fmt::format("{}", truth.samples);
    return reference;
}

// What a method shows, seed after seed.
void add_seeds(const PlaneImage& image, const Frame& reference, int reference_samples,
               const std::vector<Region>& regions, const ComparisonSettings& settings, ResultRow& row) {
    MeanMeasures measures;
    ErrorSeries error(SeriesOf::seeds, settings.referenced);
    std::vector<ErrorSeries> errors_in_regions(regions.size(), error);
    const bool has_halves = reference.has("half_a." + image.plane);
    const auto add = [&](const Image& picture) {
        Frame test(picture.width(), picture.height());
        test.set(image.plane, picture);
        measures.add(compare_frames(test, reference, settings).planes.front().measures());
        if (!has_halves) return;
        error.add(test, reference, image.plane, reference_samples);
        for (std::size_t i = 0; i < regions.size(); ++i)
            errors_in_regions[i].add(test, reference, image.plane, reference_samples, &regions[i].mask);
    };
    add(image.image);
    for (const Image& picture : image.other_seeds) add(picture);

    row.seeds = 1 + static_cast<int>(image.other_seeds.size());
    set_measures(measures.means(), row);
    if (error.members() == 0) return;
    add_error(error.error(), row);
    const Estimate over_seeds = error.over_members();
    row.seeds_mse_lower = over_seeds.lower, row.seeds_mse_upper = over_seeds.upper;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        if (errors_in_regions[i].members() == 0) continue;
        const ReferencedError inside = errors_in_regions[i].error();
        row.regions.push_back({regions[i].name, regions[i].pixels, inside.mse, inside.lower, inside.upper});
    }
}

}  // namespace

void set_measures(std::vector<std::pair<std::string, double>> measures, ResultRow& row) {
    row.measures = std::move(measures);
    row.mse = measure_named(row.measures, "mse"), row.psnr = measure_named(row.measures, "psnr");
    row.ssim = measure_named(row.measures, "ssim"), row.data_range = measure_named(row.measures, "data_range");
    row.mse_lower = row.mse_upper = row.seeds_mse_lower = row.seeds_mse_upper = no_value;
    row.measured = true;
}

Frame frame_of(const PlaneImage& image) {
    Frame frame(image.image.width(), image.image.height());
    frame.set(image.plane, image.image);
    if (image.halves) {
        frame.set("half_a." + image.plane, image.halves->a);
        frame.set("half_b." + image.plane, image.halves->b);
    }
    return frame;
}

std::string refusal_of(const ReferencedError& error) {
    const std::string noise = fmt::format("not measured: the truth's noise (RMSE {:.2g}) is too near to the difference",
                                          std::sqrt(error.reference_noise_mse));
    if (const auto samples = error.samples_needed())
        return fmt::format("{}; {} samples per pixel would do", noise, *samples);
    return noise + "; no number of samples can be told, because the difference is lost in it";
}

void add_error(const ReferencedError& error, ResultRow& row) {
    row.mse = error.mse, row.mse_lower = error.lower, row.mse_upper = error.upper;
    row.noise_mse = error.reference_noise_mse;
    row.measured = error.trustworthy;
    if (!row.measured) row.refusal = refusal_of(error);
}

ResultRow measure_row(const PlaneImage& image, const Truth& truth, const std::vector<Region>& regions,
                      double most_noise) {
    ResultRow row;
    row.view = image.view, row.plane = image.plane, row.method = image.method, row.truth = truth.name;
    row.path_tracer_samples = image.path_tracer_samples, row.oracle_layers = image.oracle_layers;
    row.timing = image.timing;
    row.gbuffer_bytes_per_pixel = image.gbuffer_bytes_per_pixel;
    row.reference_samples = truth.samples;

    const Frame reference = reference_of(truth);
    ComparisonSettings settings;
    settings.referenced.noise_limit = most_noise;
    if (!image.other_seeds.empty()) {
        add_seeds(image, reference, truth.samples, regions, settings, row);
        return row;
    }
    const Frame test = frame_of(image);
    const PlaneComparison comparison = compare_frames(test, reference, settings).planes.front();
    set_measures(comparison.measures(), row);
    row.mse = comparison.best_mse();
    if (comparison.referenced) add_error(*comparison.referenced, row);
    if (reference.has("half_a." + image.plane)) {
        for (const ErrorInRegion& error :
             errors_in_regions(test, reference, image.plane, truth.samples, regions, settings.referenced))
            row.regions.push_back({error.region, error.pixels, error.error.mse, error.error.lower, error.error.upper});
    }
    return row;
}

}  // namespace plumb
