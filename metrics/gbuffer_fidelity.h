// How right a G-buffer is, layer by layer, against one that is exact.
//
//   hit_agreement   share of pixels where both hold a surface or both hold none (depth finite and above zero)
//   agreement       share of pixels where that is so and, where both hold a surface, depth, normal and albedo are
//                   within their tolerances
//   depth_error     |z - r| / r
//   normal_angle    degrees between the normals
//   albedo_error    largest difference of a channel
//   motion_error    pixels: length of the difference of the vectors
//
// The last four are over pixels where both hold a surface: mean, median, 95th and 99th percentile, maximum (linear
// between order statistics). Shares and means have 95 % intervals (block_bootstrap.h). A value that is not finite on
// one side or on both is left out of them, counted, and no agreement. Good for: telling by how much encodings and ways
// of making a second layer err. Bad for: edges, where one pixel to the left or right are two surfaces; mask them out
// (regions.h), or read the median.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frames/frame.h"
#include "metrics/block_bootstrap.h"

namespace plumb {

struct GbufferFidelitySettings {
    // Where two renderers that see the same surface differ by float rounding alone.
    double depth_tolerance = 1e-4;          // share of the depth
    double normal_tolerance = 0.5;          // degrees
    double albedo_tolerance = 1.0 / 255.0;  // a step of an 8-bit image
    BootstrapSettings bootstrap;
    const Image* mask = nullptr;  // pixels that count
};

struct ErrorDistribution {
    Estimate mean;  // NaN, as all others, where there is no value
    double median = 0, percentile_95 = 0, percentile_99 = 0, maximum = 0;
    std::size_t values = 0, left_out = 0;
};

struct LayerFidelity {
    std::string layer;  // "layer1", "layer2"...
    Estimate hit_agreement, agreement;
    std::size_t pixels = 0, both_hit = 0, only_test = 0, only_reference = 0;
    // Of planes that both G-buffers have.
    std::optional<ErrorDistribution> depth, normal, albedo, motion;

    // hit_agreement, agreement, and for each of depth_error, normal_angle, albedo_error and motion_error its _mean,
    // _median, _p95, _p99 and _maximum, always in this order; NaN for planes that are not there. Intervals end in
    // _lower and _upper.
    std::vector<std::pair<std::string, double>> measures() const;
};

// The names that measures() uses, in its order.
const std::vector<std::string>& fidelity_names();

// Measures of several frames as one: of *_maximum the largest, of all others the mean of the frames that have it. Ends
// of intervals are NaN: no mean of intervals is one.
std::vector<std::pair<std::string, double>> fidelity_over_frames(
    const std::vector<std::vector<std::pair<std::string, double>>>& frames);

// True where both frames have a plane depth.
bool has_gbuffer(const Frame& test, const Frame& reference);

// All layers whose depth both frames have: depth, layer2.depth... Throws ImageError where there is none, for different
// shapes, and for planes of another number of channels than 1 (depth), 3 (normal, albedo) and 2 (motion).
std::vector<LayerFidelity> gbuffer_fidelity(const Frame& test, const Frame& reference,
                                            const GbufferFidelitySettings& settings = {});

}  // namespace plumb
