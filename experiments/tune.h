// The search for a method's free parameters: those values that make the error smallest within a time budget.
//
// Coordinate search with narrowing: in each pass every parameter in turn is tried at evenly spaced values of its range
// (geometrically where the range spans a factor of ten or more), the others kept; the best is taken, and the range
// contracts around it to 0.6 of its width (as XeGTAO's auto-tuner narrows its ranges). Good for: a handful of
// parameters that act nearly independently, with an error that costs a second to evaluate. Bad for: narrow diagonal
// valleys, which it descends in small steps, and for ranges with several minima, of which it finds the best that its
// first pass touches.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rasterizer/method.h"

namespace plumb {

// One free parameter: a range of numbers, or a list of values to choose from.
struct FreeParameter {
    std::string name;
    double low = 0.0, high = 0.0;
    bool whole = false;                // whole numbers only
    std::vector<std::string> choices;  // not empty: these instead of the range
};

// "ao.intensity=0.5..2", "ao.samples=8..40" (whole numbers, as the parameter is) or "ao.normals=interpolated|face".
// Throws ConfigError for what is neither, for unknown parameters, for values that the parameter refuses, and for what
// has no effect on `planes` (null: on any).
FreeParameter parse_free_parameter(const std::string& text, const Method& method,
                                   const std::vector<std::string>* planes = nullptr);

struct TuningCost {
    double error = 0.0;
    double milliseconds = 0.0;
    std::string refusal = {};  // why the error cannot be told: the truth is too noisy; empty where it can

    bool told() const { return refusal.empty(); }
};

struct TuningSettings {
    int steps = 7;  // values tried per parameter and pass; at least 3
    int passes = 3;
    double budget = 0.0;  // milliseconds; 0: none
};

struct TuningTrial {
    Method method;
    TuningCost cost;
    bool within_budget = true;
};

struct TuningResult {
    TuningTrial start, best;
    std::vector<TuningTrial> trials;  // in order; each combination once
};

// `evaluate` is called once per combination of values. The start counts among the candidates, so that the best is never
// worse on the same views; where nothing keeps the budget the fastest trial is the best. A trial whose error cannot be
// told is never the best: an error that is lost in the truth's noise would look smaller than any. Throws ConfigError
// for settings that make no sense, and where the start's own error cannot be told; and what `evaluate` throws.
TuningResult tune(const Method& start, const std::vector<FreeParameter>& parameters, const TuningSettings& settings,
                  const std::function<TuningCost(const Method&)>& evaluate);

}  // namespace plumb
