// One image, or a sequence of them, held against its reference frame by frame: errors, regions, G-buffers and, where
// the reference knows how surfaces move, stability.
//
// Over a sequence, measures are those of metrics/plane_series.h and, of a G-buffer, of metrics/fidelity_series.h, with
// intervals over frames and blocks.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/measured_thing.h"
#include "frames/frame.h"
#include "metrics/comparison.h"
#include "metrics/fidelity_series.h"
#include "metrics/path_stability.h"
#include "metrics/plane_series.h"
#include "metrics/regions.h"

namespace plumb {

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
    void add_plane(const Frame& test, const Frame& reference, const std::string& plane,
                   const std::vector<Region>& regions, MeasuredFrame& frame);
    void add_stability(const Frame& test, const Frame& reference, const std::vector<Region>& regions,
                       MeasuredThing& thing);

    SequenceSettings settings_;
    std::vector<MeasuredFrame> frames_;
    std::vector<std::string> only_in_test_, only_in_reference_;
    std::map<std::string, PlaneSeries> errors_;       // by plane
    std::map<std::string, PathStability> stability_;  // by plane
    std::map<std::string, FidelitySeries> layers_;    // of the G-buffer, by name
    std::optional<Frame> before_;                     // the reference's position
};

}  // namespace plumb
