// The headline of a run in one table, as Markdown: what each method brings against the baseline in practice, and what
// more layers could bring to any method in principle.
//
// One column for each plane, truth and kind of place (views, camera paths). First the values themselves: error, flicker
// and time of each method, error and flicker of each oracle, geometric means over the places that all methods, or all
// oracles, tell. Then ratios with Student's 95 % intervals, place by place: each method to the baseline, each oracle to
// the one with fewer layers. Where some places tell nothing, because an error is nought or within the truth's noise,
// the number of those that do stands behind the value. Below the table stand the sentences of summary.h.
#pragma once

#include <string>

#include "experiments/results.h"

namespace plumb {

// Empty where nothing was measured.
std::string print_headline(const RunResults& results);

}  // namespace plumb
