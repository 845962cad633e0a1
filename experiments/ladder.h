// From the truth down to a method, one approximation switched on at a time: what each adds to the error, and what time
// it saves.
//
// A [[ladders]] table of a comparison names a plane and its rungs, in order: oracles ("oracle, all in view", "oracle, 2
// layers": what lies outside the view, and behind its layers, is lost) and methods, each of which differs from the one
// above by one more approximation; `paths = true` takes the scene's camera paths instead of its views. The truth stands
// above the first. Errors are RMSE against the full truth, means over those of the scene's views in which every rung
// could be measured; what a rung adds is the mean difference to the rung above, with Student's interval over the views.
// A rung may take error away: one approximation can make up for another. A rung of which nothing could be measured is
// left out, and what it would add is then part of the next one's; that is told in words.
#pragma once

#include <string>
#include <vector>

#include "experiments/results.h"

namespace plumb {

struct Ladder {
    std::string title, plane;
    std::vector<std::string> rungs;  // names of oracles and methods
    bool paths = false;              // over the scene's camera paths instead of its views
};

// The tables `ladders` of the experiment. Throws ConfigError for rungs that are neither its methods nor its oracles and
// for planes that it does not compare.
std::vector<Ladder> read_ladders(const Experiment& experiment);

struct Climb {
    std::vector<Waterfall> waterfalls;  // one per ladder and scene
    std::vector<std::string> gaps;      // rungs, views and whole ladders that are left out, with the reason
};

Climb climb(const std::vector<Ladder>& ladders, const RunResults& results);

// Waterfalls as SVG, two in a row; empty where there is none.
std::string print_waterfalls(const std::vector<Waterfall>& waterfalls);
// The same as text: one line per rung.
std::string print_waterfall_table(const std::vector<Waterfall>& waterfalls);
std::string print_waterfall_csv(const std::vector<Waterfall>& waterfalls);

}  // namespace plumb
