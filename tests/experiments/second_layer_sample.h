// Results made by hand of a run with views, camera paths and oracles: what the headline is made of.
#pragma once

#include <string>

#include "tests/experiments/sample_results.h"

namespace plumb {

inline ResultRow sample_oracle(const std::string& view, int layers, double rmse) {
    ResultRow row = sample_row(view, oracle_name(layers), rmse, 0.0);
    row.oracle.layers = layers, row.timing = {};
    return row;
}

// As if the row were of a camera path that is called like its view.
inline ResultRow along_path(ResultRow row, double flicker) {
    row.path = row.view, row.view.clear();
    row.stability = sample_stability(flicker);
    return row;
}

// Three views as sample_results() has them (the second method has half the error in twice the time), and three paths,
// in which it has 0.8, 0.4 and 0.2 times the error and 0.5 times the flicker. Oracles with one, two and all layers:
// each has half the error and flicker of the one before, and that with all layers could not be told in one view.
inline RunResults second_layer_results() {
    RunResults results = sample_results();
    for (const char* view : {"front", "left", "right"}) {
        results.rows.push_back(sample_oracle(view, 0, 0.01));
        results.rows.push_back(sample_oracle(view, 2, 0.02));
        results.rows.push_back(sample_oracle(view, 1, 0.04));
    }
    results.rows[6].measured = false;  // all in view, front
    for (const std::string path : {"strafe", "orbit", "walk"}) {
        const double factor = path == "strafe" ? 0.8 : path == "orbit" ? 0.4 : 0.2;
        results.rows.push_back(along_path(sample_row(path, "one", 0.2, 2.0), 0.04));
        results.rows.push_back(along_path(sample_row(path, "two", 0.2 * factor, 3.0), 0.02));
        results.rows.push_back(along_path(sample_oracle(path, 1, 0.04), 0.008));
        results.rows.push_back(along_path(sample_oracle(path, 2, 0.02), 0.004));
    }
    ResultRow tracer = sample_row("front", "path tracer, 2 spp", 0.3, 1.0);
    tracer.path_tracer_samples = 2;
    results.rows.push_back(tracer);
    return results;
}

}  // namespace plumb
