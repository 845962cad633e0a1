#include "metrics/fidelity_series.h"

#include <cmath>
#include <limits>

#include "frames/image_error.h"
#include "metrics/error_series.h"

namespace plumb {

FidelitySeries::FidelitySeries() {
    for (PlaneErrors& errors : errors_) {
        errors.counts.maximum = std::numeric_limits<double>::quiet_NaN();
        for (const ErrorPercentile& percentile : error_percentiles)
            errors.percentiles.emplace_back(percentile.level, longest_run(SeriesOf::frames));
    }
}

void FidelitySeries::add(const LayerFidelity& frame) {
    if (!frame.blocks) throw ImageError("a series needs comparisons of G-buffers that keep their blocks");
    hits_.add(frame.blocks->hits);
    agreeing_.add(frame.blocks->agreeing);
    counts_.layer = frame.layer;
    counts_.pixels += frame.pixels, counts_.both_hit += frame.both_hit;
    counts_.only_test += frame.only_test, counts_.only_reference += frame.only_reference;
    for (std::size_t i = 0; i < fidelity_planes.size(); ++i) {
        if (const auto& errors = frame.*fidelity_planes[i].result) add(*errors, *frame.blocks->errors[i], errors_[i]);
    }
    ++frames_;
}

void FidelitySeries::add(const ErrorDistribution& frame, const ErrorBlocks& blocks, PlaneErrors& errors) {
    errors.is_there = true;
    errors.means.add(blocks.errors);
    for (std::size_t i = 0; i < error_percentiles.size(); ++i)
        errors.percentiles[i].add((frame.*error_percentiles[i].estimate).value, blocks.not_above[i]);
    errors.counts.values += frame.values, errors.counts.left_out += frame.left_out;
    if (frame.values == 0) return;
    errors.counts.maximum = std::fmax(errors.counts.maximum, frame.maximum);  // of a NaN and a number: the number
    errors.magnitudes.average_in(blocks.magnitudes, errors.frames_with_values++);
}

ErrorDistribution FidelitySeries::distribution(const PlaneErrors& errors, const BootstrapSettings& settings) {
    ErrorDistribution result = errors.counts;
    result.mean = errors.means.mean(settings);
    for (std::size_t i = 0; i < error_percentiles.size(); ++i)
        result.*error_percentiles[i].estimate = errors.percentiles[i].mean(errors.magnitudes, settings);
    return result;
}

LayerFidelity FidelitySeries::result(const BootstrapSettings& settings) const {
    LayerFidelity result = counts_;
    result.hit_agreement = hits_.mean(settings);
    result.agreement = agreeing_.mean(settings);
    for (std::size_t i = 0; i < fidelity_planes.size(); ++i) {
        if (errors_[i].is_there) result.*fidelity_planes[i].result = distribution(errors_[i], settings);
    }
    return result;
}

}  // namespace plumb
