// A run's rows as statements about them need them: those of one plane, truth and kind of place together, and ratios
// of one method to another over the places where both could be told.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "experiments/results.h"
#include "experiments/statistics.h"

namespace plumb {

struct RowGroup {
    std::string plane;
    std::string truth;   // its kind: "full", "limited to the method's radius", or empty where a plane has one
    bool paths = false;  // camera paths, or still views
    // By place (scene and view or path), then by method or oracle.
    std::map<std::pair<std::string, std::string>, std::map<std::string, const ResultRow*>> places;

    // "indirect against the full truth, along camera paths"
    std::string name() const;
    // "1 view", "6 paths"
    std::string count(int places) const;
    // Names of the oracles of layers, by their number; all in view comes last.
    std::vector<std::string> oracles() const;
};

// Of methods and oracles, in the order of the experiment's planes. Points into the results.
std::vector<RowGroup> group_rows(const RunResults& results);

enum class RowQuantity { error, flicker, time };

// NaN where the row does not tell it: refused, no path, or without a time; and where the truth's noise leaves open
// whether an image flickers at all.
double value_of(const ResultRow& row, RowQuantity quantity);

struct RowRatio {
    RatioSummary ratio;  // over the places where both tell the quantity
    int refused = 0;     // places that have both rows, of which one does not
};

RowRatio ratio_between(const RowGroup& group, const std::string& method, const std::string& base, RowQuantity quantity);

}  // namespace plumb
