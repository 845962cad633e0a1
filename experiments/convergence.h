// Measures how the path tracer's error falls with its samples.
//
// For each scene, kind of points, seed and number of samples one image; its mean squared error against a long run of
// Sobol points with another seed, by the reference's two halves A and B: mean((I - A)(I - B)), which the reference's
// own noise does not bias (metrics/referenced_error.h). To log RMSE over log samples a line is fitted by least squares,
// seed by seed, since the images of one seed share their first samples; over the seeds the slopes have a mean and a
// standard error. Independent points fall with slope -1/2; scrambled Sobol points do better where the integrand is
// smooth (-3/2 at best: Owen 1997, "Scrambled Net Variance for Integrals of Smooth Functions").
#pragma once

#include <string>
#include <vector>

#include "experiments/convergence_file.h"
#include "experiments/runner.h"
#include "experiments/statistics.h"
#include "experiments/system_facts.h"
#include "pathtracer/sample_points.h"

namespace plumb {

struct ConvergenceMeasurement {
    int samples = 0, seed = 0;
    double mse = 0.0;        // free of the reference's noise
    double noise_mse = 0.0;  // the reference's
    bool used = false;       // in the fit: the reference is good enough to tell
};

// One curve of the figure.
struct ConvergenceCurve {
    std::string scene, view, plane;
    SamplePoints points = SamplePoints::random;
    std::vector<ConvergenceMeasurement> measurements;
    MeanSummary slope;         // of log RMSE over log samples, over the seeds; count 0: nothing could be fitted
    double rmse_at_one = 0.0;  // where the fitted line meets one sample

    // Over the seeds; 0 where no seed's error could be told.
    double rmse(int samples) const;
    double least_rmse(int samples) const;
    double greatest_rmse(int samples) const;
};

struct ConvergenceResults {
    ConvergenceExperiment experiment;
    SystemFacts system;
    std::string command, started;
    double seconds = 0.0;
    std::vector<ConvergenceCurve> curves;  // random and Sobol points of the same plane follow each other
    std::vector<CellFailure> failures;     // scenes that could not be finished
    bool interrupted = false;              // then what was measured is worth nothing but for the cached references
};

// A scene that fails is listed in the results and does not end the run.
ConvergenceResults run_convergence(const ConvergenceExperiment& experiment, const SceneFinder& finder,
                                   const RunOptions& options);

// Fills slope, rmse_at_one and `used`.
void fit(ConvergenceCurve& curve, double most_noise);

}  // namespace plumb
