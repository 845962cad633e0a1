// Everything that is measured of one plane over a series of images, over the whole image and over each region: the
// measures (measure_series.h) and the error that the reference's noise does not bias (error_series.h).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "metrics/comparison.h"
#include "metrics/error_series.h"
#include "metrics/measure_series.h"

namespace plumb {

struct PlaneSeriesResult {
    std::string region;                                    // empty: the whole image
    std::size_t pixels = 0;                                // of all members
    std::vector<std::pair<std::string, double>> measures;  // as PlaneComparison::measures() has them
    std::optional<ReferencedError> error;                  // where the references have half-buffers
    std::optional<Estimate> error_over_members;            // its mse, over members alone
    std::vector<std::pair<std::string, Estimate>> over_members;
};

class PlaneSeries {
public:
    // Blocks are kept whatever the settings say.
    PlaneSeries(std::string plane, SeriesOf kind, const ComparisonSettings& settings);

    // The next image, its reference and the regions of its view; gives what compare_plane() says of it.
    std::vector<PlaneComparison> add(const Frame& test, const Frame& reference,
                                     const std::vector<Region>& regions = {});

    // The whole image first, then regions in the order in which they first held values.
    std::vector<PlaneSeriesResult> results() const;
    // Over the whole image; nothing where no reference had half-buffers.
    std::optional<ReferencedError> error() const;

private:
    struct Part {
        std::string region;
        std::size_t pixels;
        MeasureSeries measures;
        ErrorSeries error;
    };

    std::string plane_;
    SeriesOf kind_;
    ComparisonSettings settings_;
    std::vector<Part> parts_;
};

}  // namespace plumb
