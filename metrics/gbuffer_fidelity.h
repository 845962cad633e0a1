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
// between order statistics). All but the maximum have 95 % intervals: shares and means by drawing blocks
// (block_bootstrap.h), percentiles by drawing the shares of errors below them (measure_blocks.h). A value that is not
// finite on one side or on both is left out of them, counted, and no agreement. Good for: telling by how much encodings
// and ways of making a second layer err. Bad for: edges, where one pixel to the left or right are two surfaces; mask
// them out (regions.h), or read the median.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frames/frame.h"
#include "metrics/block_bootstrap.h"
#include "metrics/quantile_curve.h"

namespace plumb {

struct GbufferFidelitySettings {
    // Where two renderers that see the same surface differ by float rounding alone.
    double depth_tolerance = 1e-4;          // share of the depth
    double normal_tolerance = 0.5;          // degrees
    double albedo_tolerance = 1.0 / 255.0;  // a step of an 8-bit image
    BootstrapSettings bootstrap;
    const Image* mask = nullptr;  // pixels that count
    bool intervals = true;
    bool keep_blocks = false;  // for a FidelitySeries, whose members share size and mask
};

struct ErrorDistribution {
    Estimate mean, median, percentile_95, percentile_99;  // NaN where there is no value
    double maximum = 0;
    std::size_t values = 0, left_out = 0;
};

struct ErrorPercentile {
    std::string_view name;
    double level;
    Estimate ErrorDistribution::*estimate;
};
inline constexpr std::array<ErrorPercentile, 3> error_percentiles = {
    {{"median", 0.5, &ErrorDistribution::median},
     {"p95", 0.95, &ErrorDistribution::percentile_95},
     {"p99", 0.99, &ErrorDistribution::percentile_99}}};

// What a distribution is made of, block by block.
struct ErrorBlocks {
    std::vector<BlockSum> errors;
    std::array<std::vector<BlockSum>, error_percentiles.size()> not_above;  // each percentile
    QuantileCurve magnitudes;
};

struct LayerFidelity;

// How one plane of a layer is compared.
struct FidelityPlane {
    std::string_view plane, measure;
    int channels;
    std::optional<ErrorDistribution> LayerFidelity::*result;
};

struct LayerBlocks {
    std::vector<BlockSum> hits, agreeing;
    std::array<std::optional<ErrorBlocks>, 4> errors;  // in order of fidelity_planes
};

struct LayerFidelity {
    std::string layer;  // "layer1", "layer2"...
    Estimate hit_agreement, agreement;
    std::size_t pixels = 0, both_hit = 0, only_test = 0, only_reference = 0;
    // Of planes that both G-buffers have.
    std::optional<ErrorDistribution> depth, normal, albedo, motion;
    std::optional<LayerBlocks> blocks;  // where the settings ask for them

    // hit_agreement, agreement, and for each of depth_error, normal_angle, albedo_error and motion_error its _mean,
    // _median, _p95, _p99 and _maximum, always in this order; NaN for planes that are not there. Each but the maxima is
    // followed by the ends of its interval, with _lower and _upper behind its name.
    std::vector<std::pair<std::string, double>> measures() const;
};

inline constexpr std::array<FidelityPlane, 4> fidelity_planes = {
    {{"depth", "depth_error", 1, &LayerFidelity::depth},
     {"normal", "normal_angle", 3, &LayerFidelity::normal},
     {"albedo", "albedo_error", 3, &LayerFidelity::albedo},
     {"motion", "motion_error", 2, &LayerFidelity::motion}}};

// The names that measures() uses, in its order.
const std::vector<std::string>& fidelity_names();

// True where both frames have a plane depth.
bool has_gbuffer(const Frame& test, const Frame& reference);

// All layers whose depth both frames have: depth, layer2.depth... Throws ImageError where there is none, for different
// shapes, and for planes of another number of channels than 1 (depth), 3 (normal, albedo) and 2 (motion).
std::vector<LayerFidelity> gbuffer_fidelity(const Frame& test, const Frame& reference,
                                            const GbufferFidelitySettings& settings = {});

}  // namespace plumb
