// One row of results: an image held against a truth.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/plane_image.h"
#include "experiments/results.h"
#include "experiments/view_truths.h"
#include "metrics/regions.h"

namespace plumb {

// The image alone, with its halves where it has them.
Frame frame_of(const PlaneImage& image);

// Fills what the image and its error say: names, time, measures, interval, regions, and whether the truth is good
// enough to tell (its noise at most `most_noise` of the squared error). Scene, truth's name and parameters are the
// caller's. Throws ImageError where shapes differ or no value is finite.
ResultRow measure_row(const PlaneImage& image, const Truth& truth, const std::vector<Region>& regions,
                      double most_noise);

// Measures as metrics/comparison.h names them, and what else a row takes from them; the intervals are then still
// missing.
void set_measures(std::vector<std::pair<std::string, double>> measures, ResultRow& row);

// What an error against a truth in halves says of a row.
void add_error(const ReferencedError& error, ResultRow& row);

// Why a row is not measured, and what would do.
std::string refusal_of(const ReferencedError& error);

}  // namespace plumb
