// How right one layer of a G-buffer is over the frames of a path or of any sequence (gbuffer_fidelity.h of each).
//
// Shares and means run over the values of all frames, percentiles are the means of the frames', maxima the largest, and
// counts are sums. 95 % intervals draw blocks of the image and runs of frames at once (block_bootstrap.h); those of
// percentiles are percentile_series.h's.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "metrics/block_bootstrap.h"
#include "metrics/gbuffer_fidelity.h"
#include "metrics/percentile_series.h"

namespace plumb {

class FidelitySeries {
public:
    FidelitySeries();

    // The next frame, compared with GbufferFidelitySettings::keep_blocks. Throws ImageError for one without blocks and
    // for another size.
    void add(const LayerFidelity& frame);

    std::size_t frames() const { return frames_; }
    // Over all frames.
    LayerFidelity result(const BootstrapSettings& settings = {}) const;

private:
    struct PlaneErrors {
        BlockSeries means;
        std::vector<PercentileSeries> percentiles;  // in order of error_percentiles
        QuantileCurve magnitudes;                   // mean over the frames that have values
        std::size_t frames_with_values = 0;
        ErrorDistribution counts;  // its maximum, values and left_out only
        bool is_there = false;     // in any frame
    };
    static void add(const ErrorDistribution& frame, const ErrorBlocks& blocks, PlaneErrors& errors);
    static ErrorDistribution distribution(const PlaneErrors& errors, const BootstrapSettings& settings);

    std::size_t frames_ = 0;
    LayerFidelity counts_;  // the layer's name and its counts of pixels only
    BlockSeries hits_, agreeing_;
    std::array<PlaneErrors, fidelity_planes.size()> errors_;
};

}  // namespace plumb
