// Results made by hand, for what turns results into text.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "experiments/results.h"
#include "metrics/comparison.h"

namespace plumb {

inline ResultRow sample_row(const std::string& view, const std::string& method, double rmse, double milliseconds) {
    ResultRow row;
    row.scene = "cornell", row.view = view, row.plane = "ao", row.method = method;
    row.measured = true;
    row.mse = rmse * rmse, row.mse_lower = 0.81 * row.mse, row.mse_upper = 1.21 * row.mse;
    row.psnr = -20 * std::log10(rmse), row.ssim = 0.9, row.reference_samples = 64;
    for (const std::string& name : measure_names()) row.measures.emplace_back(name, name == "rmse" ? rmse : 0.0);
    row.timing = {milliseconds,
                  0.9 * milliseconds,
                  1.1 * milliseconds,
                  5,
                  {{"gbuffer", 0.4 * milliseconds}, {"ao", 0.6 * milliseconds}}};
    return row;
}

// Told beyond doubt, each interval a tenth to either side.
inline PathStabilityResult sample_stability(double flicker) {
    const auto about = [](double value) { return Estimate{value, 0.9 * value, 1.1 * value}; };
    PathStabilityResult stability;
    stability.flicker = about(flicker), stability.trustworthy = true;
    stability.method_warping = about(0.5), stability.truth_warping = about(0.4);
    stability.temporal_variance = about(0.01);
    return stability;
}

// Two methods on three views: the second has half the error and takes twice the time.
inline RunResults sample_results() {
    RunResults results;
    results.experiment.name = "sample", results.experiment.title = "A <sample> & more";
    results.experiment.question = "What about \"quotes\"?";
    results.experiment.planes = {"ao"};
    Method one, two;
    one.name = "one", two.name = "two";
    results.experiment.methods = {one, two};
    results.experiment.baseline = "one";
    for (const std::string view : {"front", "left", "right"}) {
        results.rows.push_back(sample_row(view, "one", 0.10, 2.0));
        results.rows.push_back(sample_row(view, "two", 0.05, 4.0));
    }
    results.gl_renderer = "a renderer";
    return results;
}

}  // namespace plumb
