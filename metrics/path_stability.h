// How steady a method is along a camera path, fed frame by frame.
//
//   flicker            root of the mean, over all pixels visible in two consecutive frames and over all pairs of
//                      frames, of the squared change of the error (flicker.h)
//   warping            the same of the images themselves, of the method and of the truth
//   temporal variance  mean, over all pixels whose surface point was visible throughout the last `window` frames and
//                      over all such frames, of the variance of the error at that point over these frames,
//                      1/(W-1) sum_k (e_k - mean e)^2, averaged over channels. Each point is followed back along the
//                      exact motion vectors; every earlier error is interpolated once, bilinearly, where the point then
//                      was. With a truth in halves it is the covariance of the errors against either half, which their
//                      noise does not bias.
//
// An error that is noise in time has temporal variance s^2 and flicker s * sqrt(2). An error that swims slowly hardly
// flickers but varies: one that grows by d a frame has flicker d and, over 8 frames, temporal variance 6 d^2.
//   Good for: telling shimmer (flicker) from drift (variance). Bad for: errors that stay where they are, in which both
//   are blind by design, and for surfaces that move by themselves, which are not followed.
//
// 95 % intervals: bootstrap over blocks x runs of frames (block_bootstrap.h). Memory: the last `window` frames of one
// method's plane, and a few numbers per block and frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frames/frame.h"
#include "metrics/flicker.h"
#include "metrics/regions.h"

namespace plumb {

struct PathStabilitySettings {
    FlickerSettings flicker;
    int window = 8;            // frames that temporal variance looks back over, 2 or more; a path of fewer has none
    double noise_limit = 0.1;  // largest share of the squared flicker that the truth's noise may have
};

struct PathStabilityResult {
    std::size_t frames = 0;
    // RMS values; NaN where no pixel was visible in two frames.
    Estimate flicker, method_warping, truth_warping;
    Estimate temporal_variance;  // a square; NaN where no point was visible throughout a window
    double noise = 0;            // RMS change that the truth's noise would add
    double noise_limit = 0.1;    // as the settings have it
    // The noise's share of the squared flicker is within the limit and the interval excludes zero, or there is no
    // noise.
    bool trustworthy = false;
    std::size_t pixels = 0, not_visible = 0, non_finite = 0;  // over all pairs of frames

    // All measures under fixed names in a fixed order, intervals as NAME_lower and NAME_upper: flicker, method_warping,
    // truth_warping, temporal_variance, flicker_noise, flicker_trustworthy (1 or 0).
    std::vector<std::pair<std::string, double>> measures() const;
    // NaN where no measure has the name.
    double measure(std::string_view name) const;
    // Whether the truth's noise leaves a measure to be told: of flicker, that it is trustworthy; of temporal variance,
    // that the interval excludes zero; warping errors, in which noise cancels, always.
    bool tells(std::string_view name) const;
    // Samples per pixel (even) of the truth with which the noise would be within the limit, where it has
    // `reference_samples` now; none where that cannot be said.
    std::optional<std::int64_t> samples_needed(int reference_samples) const;
};

// The names that measures() uses, in its order.
const std::vector<std::string>& stability_names();

class PathStability {
public:
    // Throws ImageError for a window below 2 and a noise limit that is not positive.
    explicit PathStability(std::string plane, const PathStabilitySettings& settings = {});

    // The next frame of the path; planes as flicker() needs them. Gives its flicker, nothing for the first frame. Where
    // a mask is given, only pixels that are not zero in it count (they may have been anywhere in the frame before). The
    // same is summed over each of `regions` by itself. Throws ImageError for missing planes and sizes that change.
    std::optional<Flicker> add(const Frame& method, const Frame& truth, const Image* mask = nullptr,
                               const std::vector<Region>& regions = {});

    PathStabilityResult result() const { return result_of(whole_); }
    // Over the regions that any frame had, by their names.
    std::map<std::string, PathStabilityResult> of_regions() const;

private:
    struct Sums {
        BlockSeries error, method, truth, noise, variance;
        std::size_t pixels = 0, not_visible = 0, non_finite = 0;
    };
    void add_change(ChangeSums change, const BlockGrid& grid, const Image* mask, Sums& sums) const;
    std::vector<BlockSum> sum_variances(const BlockGrid& grid, const Image* mask) const;
    PathStabilityResult result_of(const Sums& sums) const;

    std::string plane_;
    PathStabilitySettings settings_;
    std::deque<FrameErrors> past_;  // the newest last
    std::size_t frames_ = 0;
    Sums whole_;
    std::map<std::string, Sums> regions_;
};

}  // namespace plumb
