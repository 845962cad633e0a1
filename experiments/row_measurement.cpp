#include "experiments/row_measurement.h"

#include <cmath>

#include <fmt/format.h>

#include "experiments/no_value.h"
#include "metrics/comparison.h"

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

}  // namespace

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

    const Frame test = frame_of(image), reference = reference_of(truth);
    ComparisonSettings settings;
    settings.referenced.noise_limit = most_noise;
    const PlaneComparison comparison = compare_frames(test, reference, settings).planes.front();
    row.measures = comparison.measures();
    row.psnr = comparison.errors.psnr;
    row.ssim = comparison.ssim ? comparison.ssim->mean : no_value;
    row.data_range = comparison.errors.peak;
    row.mse = comparison.best_mse();
    row.mse_lower = row.mse_upper = no_value;
    row.measured = true;
    if (comparison.referenced) add_error(*comparison.referenced, row);
    if (reference.has("half_a." + image.plane)) {
        for (const ErrorInRegion& error :
             errors_in_regions(test, reference, image.plane, truth.samples, regions, settings.referenced))
            row.regions.push_back({error.region, error.pixels, error.error.mse, error.error.lower, error.error.upper});
    }
    return row;
}

}  // namespace plumb
