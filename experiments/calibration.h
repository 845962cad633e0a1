// Limits from the measured spread of repeated runs, never tighter than noise.
//
// The rule, for a value of mean m and spread s (standard deviation of a single run) over n runs:
//
//   limit = m + max(4 * max(s, p * |m|), f * |m|, g - m)     for fail_above; mirrored for fail_below
//
// rounded outwards to three digits, where p is the relative spread pooled over all thresholds of the same kind, g the
// worst value that was seen, and f a floor.
//
// - Four spreads: a check has some twenty thresholds and runs with every change; at four spreads noise alone breaks one
//   build in some 1600 (one-sided normal tail 3.2e-5), at three one in 37.
// - Pooled: the spread of ten runs is itself wrong by a quarter (1 / sqrt(2 (n - 1))), so that one value in some thirty
//   seems half as noisy as it is; values of a kind are noisy for the same reason, and together they tell how much.
// - The floors stand for what repeated runs on one machine cannot show. Methods and truths are the same to the last bit
// in
//   every run, so errors, benefits and flicker have no spread at all; with another truth (a changed integrator draws
//   other samples) or another driver they have. Another seed of the truth moves errors of experiments/ci.toml by up to
//   0.5 % and benefits by 0.05 %, against a floor of 2 %; along camera paths, whose truths have fewer samples, flicker
//   by up to 4.5 %, against a floor of 10 %. Times have a spread; their floor, 10 %, is there because another processor
//   weighs the work differently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/thresholds.h"

namespace plumb {

// f of the rule, as a share of the mean.
double calibration_floor(const Threshold& threshold);

// Statistics of `values`, together with those of `before` (Chan, Golub, LeVeque 1979: pairwise update of sums of
// squares). `values` must not be empty.
CalibratedValue pool(const std::vector<double>& values, const std::optional<CalibratedValue>& before = {});

// p of the rule: root mean square of the relative spreads, weighted by runs - 1; 0 where no value has two runs.
double pooled_relative_spread(const std::vector<Threshold>& thresholds, ThresholdKind kind);

// The limit of a calibrated threshold. Throws ConfigError where the mean is zero: nothing follows from it.
double calibrated_limit(const Threshold& threshold, double pooled_spread);

// Away from the value that is limited: up for fails_above. Zero stays.
double round_outwards(double limit, bool upwards, int digits = 3);

// The same thresholds with new limits; values[i] holds those of thresholds[i], one per run. With `add` the runs that
// the thresholds were calibrated with before count too.
std::vector<Threshold> calibrate(std::vector<Threshold> thresholds, const std::vector<std::vector<double>>& values,
                                 bool add);

}  // namespace plumb
