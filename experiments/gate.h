// Limits on measures: what `--fail-above rmse=0.01,p95=0.05` means.
#pragma once

#include <string>
#include <vector>

#include "metrics/comparison.h"

namespace plumb {

struct Limit {
    std::string measure;
    double value = 0.0;
    bool fails_above = true;  // false: fails below
};

// "rmse=0.01,p95=0.05". Throws ConfigError for what is no limit and for unknown measures.
std::vector<Limit> parse_limits(const std::string& text, bool fails_above);

// One line per limit that a plane does not keep; a measure that does not exist keeps no limit.
std::vector<std::string> breaches(const FrameComparison& comparison, const std::vector<Limit>& limits);

}  // namespace plumb
