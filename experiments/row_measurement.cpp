#include "experiments/row_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "experiments/no_value.h"

namespace plumb {
namespace {

// Of the truth's frame, what belongs to one plane.
Frame reference_of(const Truth& truth) {
    Frame reference(truth.frame->width(), truth.frame->height());
    for (const std::string& name : {truth.plane, half_a_of(truth.plane), half_b_of(truth.plane)}) {
        if (truth.frame->has(name)) reference.set(name, truth.frame->plane(name));
    }
    reference.facts["samples"] = fmt::format("{}", truth.samples);
    return reference;
}

RegionError region_error(std::string region, std::size_t pixels, std::vector<std::pair<std::string, double>> measures,
                         const std::optional<ReferencedError>& error) {
    RegionError result{std::move(region), pixels};
    result.mse = measure_named(measures, "mse");
    result.mse_lower = measure_named(measures, "mse_lower"), result.mse_upper = measure_named(measures, "mse_upper");
    if (error) {
        result.mse = error->mse, result.mse_lower = error->lower, result.mse_upper = error->upper;
        result.measured = error->trustworthy;
    }
    result.measures = std::move(measures);
    return result;
}

// "layer2." and "normal" of "layer2.normal".
std::pair<std::string, std::string> layer_and_plane(const std::string& plane) {
    const auto dot = plane.rfind('.');
    const std::size_t start = dot == std::string::npos ? 0 : dot + 1;
    return {plane.substr(0, start), plane.substr(start)};
}

// What a method shows, seed after seed.
void add_seeds(const PlaneImage& image, const Frame& reference, const std::vector<Region>& regions,
               ComparisonSettings settings, ResultRow& row) {
    settings.intervals = false;  // of single seeds
    PlaneSeries series(image.plane, SeriesOf::seeds, settings);
    const auto add = [&](const Image& picture) {
        Frame test(picture.width(), picture.height());
        test.set(image.plane, picture);
        series.add(test, reference, regions);
    };
    add(image.image);
    for (const Image& picture : image.other_seeds) add(picture);
    row.seeds = 1 + static_cast<int>(image.other_seeds.size());
    add_series(series.results(), row);
    // All seeds show the same pixels.
    for (RegionError& region : row.regions) region.pixels /= static_cast<std::size_t>(row.seeds);
}

}  // namespace

void set_measures(std::vector<std::pair<std::string, double>> measures, ResultRow& row) {
    row.measures = std::move(measures);
    row.mse = measure_named(row.measures, "mse");
    const double unbiased_psnr = measure_named(row.measures, "unbiased_psnr");
    row.psnr = std::isnan(unbiased_psnr) ? measure_named(row.measures, "psnr") : unbiased_psnr;
    row.ssim = measure_named(row.measures, "ssim"), row.data_range = measure_named(row.measures, "data_range");
    row.mse_lower = measure_named(row.measures, "mse_lower"), row.mse_upper = measure_named(row.measures, "mse_upper");
    row.seeds_mse_lower = row.seeds_mse_upper = no_value;
    row.measured = true;
}

void add_series(std::vector<PlaneSeriesResult> results, ResultRow& row) {
    for (PlaneSeriesResult& part : results) {
        if (!part.region.empty()) {
            row.regions.push_back(region_error(part.region, part.pixels, std::move(part.measures), part.error));
            continue;
        }
        set_measures(std::move(part.measures), row);
        if (part.error) add_error(*part.error, row);
        if (row.seeds < 2) continue;
        row.over_seeds = std::move(part.over_members);
        if (part.error_over_members) {
            row.seeds_mse_lower = part.error_over_members->lower;
            row.seeds_mse_upper = part.error_over_members->upper;
        }
    }
}

ComparisonSettings comparison_settings(const Experiment& experiment) {
    ComparisonSettings settings;
    settings.flip = experiment.measures.flip;
    settings.pixels_per_degree = experiment.measures.pixels_per_degree;
    settings.referenced.noise_limit = experiment.reference.most_noise;
    return settings;
}

Frame frame_of(const PlaneImage& image) {
    Frame frame(image.image.width(), image.image.height());
    frame.set(image.plane, image.image);
    if (image.halves) {
        frame.set(half_a_of(image.plane), image.halves->a);
        frame.set(half_b_of(image.plane), image.halves->b);
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

std::string refusal_of(const PathStabilityResult& stability, std::string_view measure, int reference_samples) {
    if (stability.tells(measure)) return "";
    const std::string noise = fmt::format(
        "not measured: the truth's noise (RMS {:.2g} from frame to frame) is too near to the flicker", stability.noise);
    const auto samples = stability.samples_needed(reference_samples);
    return samples && measure.starts_with("flicker") ? fmt::format("{}; {} samples per pixel would do", noise, *samples)
                                                     : noise;
}

void add_error(const ReferencedError& error, ResultRow& row) {
    row.mse = error.mse, row.mse_lower = error.lower, row.mse_upper = error.upper;
    row.noise_mse = error.reference_noise_mse;
    row.measured = error.trustworthy;
    if (!row.measured) row.refusal = refusal_of(error);
}

std::optional<LayerFidelity> fidelity_of(const PlaneImage& image, const Frame& truth,
                                         const GbufferFidelitySettings& settings) {
    const auto [layer, name] = layer_and_plane(image.plane);
    const std::string depth = layer + "depth";
    constexpr std::array<std::string_view, 4> names = {"depth", "normal", "albedo", "motion"};
    if (std::ranges::find(names, name) == names.end() || !truth.has(depth)) return std::nullopt;
    Frame test(truth.width(), truth.height()), reference(truth.width(), truth.height());
    test.set("depth", truth.plane(depth)), reference.set("depth", truth.plane(depth));
    test.set(name, image.image), reference.set(name, truth.plane(image.plane));
    return std::move(gbuffer_fidelity(test, reference, settings).front());
}

std::vector<std::pair<std::string, double>> fidelity_measures(const LayerFidelity& fidelity, const std::string& plane) {
    auto measures = fidelity.measures();
    const bool is_depth = layer_and_plane(plane).second == "depth";
    std::erase_if(measures, [&](const auto& measure) {
        if (std::isnan(measure.second)) return true;
        // Whether the test holds a surface its depth alone could tell.
        return !is_depth && (measure.first.starts_with("hit_agreement") || measure.first.starts_with("depth_error"));
    });
    return measures;
}

ResultRow measure_row(const PlaneImage& image, const Truth& truth, const std::vector<Region>& regions,
                      const ComparisonSettings& settings) {
    ResultRow row;
    row.view = image.view, row.plane = image.plane, row.method = image.method, row.truth = truth.name;
    row.path_tracer_samples = image.path_tracer_samples, row.oracle = image.oracle;
    row.timing = image.timing;
    row.gbuffer_bytes_per_pixel = image.gbuffer_bytes_per_pixel;
    row.reference_samples = truth.samples;

    if (const auto fidelity = fidelity_of(image, *truth.frame))
        row.fidelity = fidelity_measures(*fidelity, image.plane);

    const Frame reference = reference_of(truth);
    if (!image.other_seeds.empty()) {
        add_seeds(image, reference, regions, settings, row);
        return row;
    }
    for (const PlaneComparison& part : compare_plane(frame_of(image), reference, image.plane, settings, regions)) {
        if (!part.region.empty()) {
            row.regions.push_back(region_error(part.region, part.pixels, part.measures(), part.referenced));
            continue;
        }
        set_measures(part.measures(), row);
        if (part.referenced) add_error(*part.referenced, row);
    }
    return row;
}

}  // namespace plumb
