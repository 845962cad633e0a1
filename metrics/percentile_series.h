// A percentile of the errors over a series of images: the mean of the images' percentiles.
//
// Its 95 % interval covers two things that have nothing to do with each other: how the errors are spread over the image
// (drawn are blocks and images, of the shares of errors up to each image's percentile, measure_blocks.h), and how the
// percentile changes from image to image (drawn are images alone). Their distances to the mean add up as squares.
#pragma once

#include <cstddef>
#include <vector>

#include "metrics/block_bootstrap.h"
#include "metrics/quantile_curve.h"

namespace plumb {

class PercentileSeries {
public:
    // Of the percentile at `level` (0..1); `longest_run` as BlockSeries has it.
    PercentileSeries(double level, std::size_t longest_run)
        : level_(level), shares_(longest_run), percentiles_(longest_run) {}

    // The next image's percentile, and its errors that are not above it, block by block. NaN: the image has no errors,
    // and only its blocks must be as many.
    void add(double percentile, std::vector<BlockSum> not_above);

    // `magnitudes`: the mean of the images' curves. NaN where no image had errors.
    Estimate mean(const QuantileCurve& magnitudes, const BootstrapSettings& settings = {}) const;

private:
    double level_;
    BlockSeries shares_;
    BlockSeries percentiles_;  // a block for each image
};

}  // namespace plumb
