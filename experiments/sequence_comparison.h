// One image, or a sequence of them, held against its reference frame by frame: errors, regions, G-buffers and, where
// the reference knows how surfaces move, stability.
//
// Over a sequence, `rmse` is the root of the mean squared error of all frames and `psnr` follows from it; unbiased_*
// come with intervals over frames and blocks (metrics/error_series.h); `maximum` and *_maximum are the largest of all
// frames, `values` and `left_out` their sums, all other measures the means of the frames'.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/measured_thing.h"
#include "frames/frame.h"
#include "metrics/comparison.h"
#include "metrics/error_series.h"
#include "metrics/path_stability.h"
#include "metrics/regions.h"

namespace plumb {

// flicker, flicker_lower, flicker_upper, method_warping, truth_warping, temporal_variance, temporal_variance_lower,
// temporal_variance_upper, flicker_noise, flicker_trustworthy (1 or 0): of planes of a sequence.
const std::vector<std::string>& stability_names();

struct SequenceSettings {
    ComparisonSettings comparison;
    bool regions = false;  // also over each region; the reference then needs planes depth and normal
    RegionSettings region_settings;
    PathStabilitySettings stability;
};

class SequenceComparison {
public:
    explicit SequenceComparison(const SequenceSettings& settings) : settings_(settings) {}

    // The next frame. Planes as compare_frames() takes them; G-buffers where both have depth; stability of planes that
    // show light, where the reference has motion, position and depth. Throws ImageError.
    void add(const std::string& name, const Frame& test, const Frame& reference);

    const std::vector<MeasuredFrame>& frames() const { return frames_; }
    // Over all frames: whole images first, in order of the planes, then G-buffers, then regions.
    std::vector<MeasuredThing> whole() const;
    // Of a plane over all frames; nothing where the reference has no half-buffers of it.
    std::optional<ReferencedError> error_of(const std::string& plane) const;
    // Planes that only one side of the first frame has.
    const std::vector<std::string>& only_in_test() const { return only_in_test_; }
    const std::vector<std::string>& only_in_reference() const { return only_in_reference_; }

private:
    void add_regions(const Frame& test, const Frame& reference, const std::vector<std::string>& planes,
                     const std::vector<Region>& regions, MeasuredFrame& frame);
    void add_to_series(const Frame& test, const Frame& reference, const std::string& plane, const std::string& region,
                       const Image* mask);
    void add_stability(const Frame& test, const Frame& reference, const std::vector<Region>& regions,
                       MeasuredThing& thing);

    SequenceSettings settings_;
    std::vector<MeasuredFrame> frames_;
    std::vector<std::string> only_in_test_, only_in_reference_;
    std::map<std::string, ErrorSeries> errors_;       // by MeasuredThing::full_name()
    std::map<std::string, PathStability> stability_;  // by plane
    std::optional<Frame> before_;                     // the reference's position
};

}  // namespace plumb
