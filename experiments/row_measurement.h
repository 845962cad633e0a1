// One row of results: an image held against a truth.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/plane_image.h"
#include "experiments/results.h"
#include "experiments/view_truths.h"
#include "metrics/comparison.h"
#include "metrics/gbuffer_fidelity.h"
#include "metrics/plane_series.h"
#include "metrics/regions.h"

namespace plumb {

// The image alone, with its halves where it has them.
Frame frame_of(const PlaneImage& image);

// What the experiment wants to be measured.
ComparisonSettings comparison_settings(const Experiment& experiment);

// Fills what the image and its error say: names, time, measures, interval, regions, and whether the truth is good
// enough to tell. Scene, truth's name and parameters are the caller's. Throws ImageError where shapes differ or no
// value is finite.
ResultRow measure_row(const PlaneImage& image, const Truth& truth, const std::vector<Region>& regions,
                      const ComparisonSettings& settings);

// How right a plane of the G-buffer is (metrics/gbuffer_fidelity.h). Where the plane is not the depth itself, both
// sides are compared where the truth holds a surface, as far as the truth has its depth; nothing for planes of light.
std::optional<LayerFidelity> fidelity_of(const PlaneImage& image, const Frame& truth,
                                         const GbufferFidelitySettings& settings = {});
// The measures of that which say something of `plane`, as ResultRow has them.
std::vector<std::pair<std::string, double>> fidelity_measures(const LayerFidelity& fidelity, const std::string& plane);

// What a series of images says of a row, and of its regions.
void add_series(std::vector<PlaneSeriesResult> results, ResultRow& row);

// Measures as metrics/comparison.h names them, and what else a row takes from them.
void set_measures(std::vector<std::pair<std::string, double>> measures, ResultRow& row);

// What an error against a truth in halves says of a row.
void add_error(const ReferencedError& error, ResultRow& row);

// Why a row is not measured, and what would do.
std::string refusal_of(const ReferencedError& error);
// Why its flicker or temporal variance is not told, and what would do; empty where the measure is.
std::string refusal_of(const PathStabilityResult& stability, std::string_view measure, int reference_samples);

}  // namespace plumb
