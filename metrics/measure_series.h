// All measures over a series of images: the frames of a path, or one view rendered with many seeds.
//
// Over a series, rmse and psnr follow from the mean squared error of all images (the peak of psnr from its mean
// square); other means run over the values of all images; percentiles are means of the images'; maximum is the largest,
// values and left_out are sums, and what has no interval is the mean of the images that have it. 95 % intervals draw
// blocks of the image and members of the series at once (block_bootstrap.h); those of percentiles are
// percentile_series.h's. The unbiased measures are an ErrorSeries' to tell.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "metrics/comparison.h"
#include "metrics/error_series.h"
#include "metrics/percentile_series.h"

namespace plumb {

class MeasureSeries {
public:
    explicit MeasureSeries(SeriesOf kind);

    // The next image's comparison; ComparisonSettings::keep_blocks made it. Throws ImageError for another size.
    void add(const PlaneComparison& comparison);

    std::size_t members() const { return members_; }
    // Of psnr: the root of the images' mean square.
    double peak() const;
    // As PlaneComparison::measures() has them.
    std::vector<std::pair<std::string, double>> measures(const BootstrapSettings& settings = {}) const;
    // Over the members alone, Student's t: of those measures that have intervals and that a mean makes sense of.
    std::vector<std::pair<std::string, Estimate>> over_members() const;

private:
    // Of the members that have the measure, in their order.
    std::vector<double> values_of(std::string_view name) const;

    std::size_t members_ = 0;
    std::vector<std::string> names_;           // of all measures
    std::vector<std::vector<double>> values_;  // of each measure, in order of the members
    std::array<BlockSeries, mean_measures.size()> means_;
    std::vector<PercentileSeries> percentiles_;  // in order of percentile_measures
    QuantileCurve magnitudes_;                   // mean over the members
};

}  // namespace plumb
