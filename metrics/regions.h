// Parts of a view where methods err for known reasons, as masks made from the truth's G-buffer.
//
//   silhouettes   within 2 pixels of an edge. A pixel is at an edge where one of its eight neighbours shows a surface
//                 and it does not, or the other way round; where the normals of the two are more than 15 degrees
//                 apart; or where the depth bends: with z the depth, 1/z is linear over the pixels of a plane, so
//                 |1/z(left) - 2/z + 1/z(right)| z is 0 on it (up to rounding), whatever its slope, and about s on
//                 both sides of a step to s times as much depth. Above 0.01 it is an edge, in rows and in columns.
//   newly_seen    surfaces that were not visible in the frame before. Plane seen_before says so exactly where there is
//                 one; else motion, depth and position of both frames do (surface_motion.h), which counts surfaces
//                 that moved by themselves as newly seen.
//   second_layer  where the second layer holds something: layer2.depth is finite and above zero
//   border        within a tenth of the shorter side of the image's edge: where screen-space methods miss what lies
//                 outside
//   rest          in none of the others
//
// Regions overlap, all but the last. Good for: telling the error that a second layer can mend from that which it
// cannot. Bad for: views with fine foliage, which are silhouettes all over.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "frames/frame.h"
#include "metrics/referenced_error.h"
#include "metrics/surface_motion.h"

namespace plumb {

struct RegionSettings {
    int silhouette_width = 2;                   // pixels on either side of an edge
    double silhouette_normal_angle = 15;        // degrees
    double silhouette_depth_bend = 0.01;        // share of the depth
    double border = 0.1;                        // share of the shorter side, 0 to 0.5
    double tolerance = same_surface_tolerance;  // of newly_seen
};

struct Region {
    std::string name;
    Image mask;              // one channel: 1 where a pixel belongs to it
    std::size_t pixels = 0;  // that do
};

// The names that regions_of() may use, in its order.
const std::vector<std::string>& region_names();

// Needs planes depth and normal. newly_seen is there where the frame has seen_before, or `before` is given (its plane
// position is read) and the frame has motion and position; second_layer where it has layer2.depth. Regions without
// pixels are there, with 0 pixels. Throws ImageError for missing planes, different sizes and settings out of range.
std::vector<Region> regions_of(const Frame& truth_gbuffer, const Frame* before = nullptr,
                               const RegionSettings& settings = {});

// The error over one region alone.
struct ErrorInRegion {
    std::string region;
    std::size_t pixels = 0;
    ReferencedError error;
};

// referenced_error() of each region in turn; regions without pixels are left out.
std::vector<ErrorInRegion> errors_in_regions(const Frame& method, const Frame& reference, std::string_view plane,
                                             int reference_samples, const std::vector<Region>& regions,
                                             const ReferencedErrorSettings& settings = {});

}  // namespace plumb
