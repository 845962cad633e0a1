#include "metrics/plane_series.h"

#include <algorithm>

namespace plumb {

PlaneSeries::PlaneSeries(std::string plane, SeriesOf kind, const ComparisonSettings& settings)
    : plane_(std::move(plane)), kind_(kind), settings_(settings) {
    settings_.keep_blocks = true;
}

std::vector<PlaneComparison> PlaneSeries::add(const Frame& test, const Frame& reference,
                                              const std::vector<Region>& regions) {
    std::vector<PlaneComparison> comparisons = compare_plane(test, reference, plane_, settings_, regions);
    for (PlaneComparison& comparison : comparisons) {
        auto part = std::ranges::find(parts_, comparison.region, &Part::region);
        if (part == parts_.end()) {
            parts_.push_back({comparison.region, 0, MeasureSeries(kind_), ErrorSeries(kind_, settings_.referenced)});
            part = parts_.end() - 1;
        }
        part->pixels += comparison.pixels;
        part->measures.add(comparison);
        if (comparison.error_sums) part->error.add(std::move(*comparison.error_sums), samples_of(reference));
    }
    return comparisons;
}

std::vector<PlaneSeriesResult> PlaneSeries::results() const {
    std::vector<PlaneSeriesResult> results;
    for (const Part& part : parts_) {
        PlaneSeriesResult result{part.region, part.pixels, part.measures.measures(settings_.referenced.bootstrap),
                                 {},          {},          part.measures.over_members()};
        if (part.error.members() > 0) {
            result.error = part.error.error();
            result.error_over_members = part.error.over_members();
            set_referenced(result.measures, *result.error, part.measures.peak());
        }
        results.push_back(std::move(result));
    }
    return results;
}

std::optional<ReferencedError> PlaneSeries::error() const {
    if (parts_.empty() || parts_.front().error.members() == 0) return std::nullopt;
    return parts_.front().error.error();
}

}  // namespace plumb
