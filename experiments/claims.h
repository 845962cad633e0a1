// Claims put to the test: what was measured, with its interval, and whether the claim holds.
//
// A quantity (presentation.h) is measured once for each view, path or walk; the cases are averaged (ratios
// geometrically) and Student's 95 % interval of the mean says how far views like these determine it. Then
//
//   holds     the interval lies where the claim says
//   fails     the interval lies elsewhere
//   depends   it does both, or scenes contradict each other: one holds and another fails by intervals of their own
//   not decided  the interval does both, though all cases agree: they are too few, or differ too widely
//   untested  fewer than two cases could be measured
#pragma once

#include <string>
#include <vector>

#include "experiments/presentation.h"
#include "experiments/statistics.h"

namespace plumb {

struct MeasuredCase {
    std::string scene, place, plane, truth, method;
    double value = 0.0;
};

struct Measured {
    QuantityKind kind = QuantityKind::value;
    std::vector<MeasuredCase> cases;
    int missing = 0;      // cases that were selected but have no such measure, or a ratio that is not positive
    MeanSummary summary;  // of all cases; the mean and interval of ratios are geometric

    // The same of one scene's cases alone.
    MeanSummary of_scene(const std::string& scene) const;
    std::vector<std::string> scenes() const;  // in the order of the cases
    std::vector<double> values_of(const std::string& scene) const;
};

// Throws ConfigError where two cells fit the same half of a ratio or difference, because the selectors name too little.
Measured measure_quantity(const std::vector<Cell>& cells, const MeasuredQuantity& quantity);

enum class ClaimVerdict { holds, fails, depends, undecided, untested };
std::string to_string(ClaimVerdict verdict);

struct ClaimResult {
    std::string experiment;
    Claim claim;
    Measured measured;
    ClaimVerdict verdict = ClaimVerdict::untested;
    std::string reason;  // on what it depends, or why it was not decided or not tested; else empty
};

ClaimResult judge_claim(const Claim& claim, const Measured& measured);
ClaimResult judge_claim(const Claim& claim, const std::vector<Cell>& cells);

// "above 1.6 and below 2.2"
std::string range_text(const Claim& claim);
// "1.87 times [1.6, 2.1]", "0.3 ms [0.1, 0.5]"; without the interval where there is none.
std::string measured_text(const Claim& claim, const MeanSummary& summary);
// The same of one scene. Of two cases both stand there instead of an interval, which one degree of freedom makes
// meaninglessly wide: "1.9 times (2 cases: 1.6, 2.1)".
std::string scene_text(const Claim& claim, const Measured& measured, const std::string& scene);

}  // namespace plumb
