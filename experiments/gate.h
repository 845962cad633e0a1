// Limits on measures: what `--fail-above rmse=0.01,rmse@silhouettes=0.05,flicker=0.004` means.
//
// A limit without a region holds for everything that was measured over whole images and has such a measure: every
// plane, or every layer of a G-buffer. A limit on `measure@region` holds for every plane over that region.
#pragma once

#include <string>
#include <vector>

#include "experiments/measured_thing.h"

namespace plumb {

struct Limit {
    std::string measure;
    std::string region;  // empty: the whole image
    double value = 0.0;
    bool fails_above = true;  // false: fails below

    std::string name() const;  // "rmse", "rmse@silhouettes"
};

// "rmse=0.01,p95@border=0.05". Throws ConfigError for what is no limit and for unknown measures and regions.
std::vector<Limit> parse_limits(const std::string& text, bool fails_above);

// One line per limit and thing that does not keep it; a measure that does not exist keeps no limit.
std::vector<std::string> breaches(const std::vector<MeasuredThing>& things, const std::vector<Limit>& limits);

}  // namespace plumb
