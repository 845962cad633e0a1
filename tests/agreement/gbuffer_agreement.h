// How well the rasterizer's G-buffer agrees with the exact one, pixel by pixel.
#pragma once

#include <string>

#include "frames/frame.h"
#include "frames/image.h"
#include "scenes/camera.h"

namespace plumb::test {

// What may differ. The bounds are those that the project promises; 1e-4 of the depth is some hundred times the
// resolution of a 32-bit float, and leaves room for the rasterizer's interpolation over large triangles.
struct AgreementTolerance {
    float relative_depth = 1e-4f;
    float normal_degrees = 0.5f;
    float albedo = 1.0f / 255.0f;
};

struct AgreementCount {
    int pixels = 0;    // compared: all but those at edges
    int at_edges = 0;  // left out
    int wrong_hit = 0, wrong_depth = 0, wrong_normal = 0, wrong_albedo = 0;
    int agreeing = 0;
    Image wrong;  // 1 where a compared pixel disagrees, 0.25 at edges

    double fraction() const { return pixels == 0 ? 1.0 : static_cast<double>(agreeing) / pixels; }
    std::string summary() const;
};

// Compares layer `prefix` ("" or "layer2.") of both frames, which hold depth, normal and albedo. A pixel is at an edge
// where, in the exact G-buffer, one of its eight neighbours differs in hit or miss, lies off its tangent plane (or it
// off the neighbour's) by more than 0.2 % of the depth, or has a normal more than 15 degrees away: there a shift of the
// rasterizer's vertices by its sub-pixel grid (1/256 pixel) may show another surface. Edges of the first layer are
// edges of the second, since its separation test starts from the first.
AgreementCount compare_gbuffers(const View& view, const Frame& rasterized, const Frame& exact,
                                const std::string& prefix, const AgreementTolerance& tolerance = {});

}  // namespace plumb::test
