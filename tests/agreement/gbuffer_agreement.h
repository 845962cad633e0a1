// How well the rasterizer's G-buffer agrees with the exact one, pixel by pixel.
#pragma once

#include <string>

#include "frames/frame.h"
#include "frames/image.h"

namespace plumb::test {

// What may differ. The bounds are those that the project promises; 1e-4 of the depth is some thousand times the
// resolution of a 32-bit float, and leaves room for the rasterizer's interpolation over large triangles.
struct AgreementTolerance {
    float relative_depth = 1e-4f;
    float normal_degrees = 0.5f;
    float albedo = 1.0f / 255.0f;
};

struct AgreementCount {
    int pixels = 0;  // compared: all but those at silhouettes
    int agreeing = 0;
    int silhouettes = 0;  // left out
    int wrong_hit = 0, wrong_depth = 0, wrong_normal = 0, wrong_albedo = 0;
    int wrong_at_coincident = 0;  // disagreeing where two surfaces lie in the same place and either answer is right
    Image wrong;                  // 1 where a compared pixel disagrees, 0.25 at silhouettes

    double fraction() const { return static_cast<double>(agreeing) / pixels; }
    double explained_fraction() const { return static_cast<double>(agreeing + wrong_at_coincident) / pixels; }
    std::string summary() const;
    void add(const AgreementCount& other);  // counts only
};

// Compares layer `prefix` ("" or "layer2.") of both frames, which hold depth, normal and albedo. `silhouettes` is 1
// where a shift of vertices by the rasterizer's sub-pixel grid (1/256 pixel) may show another surface, `coincident`
// where two surfaces are closer together than rounding.
AgreementCount compare_gbuffers(const Frame& rasterized, const Frame& exact, const std::string& prefix,
                                const Image& silhouettes, const Image& coincident,
                                const AgreementTolerance& tolerance = {});

}  // namespace plumb::test
