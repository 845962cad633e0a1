// Thresholds: what a check holds a run's values against, each with its reason; read from TOML and written back.
//
//   [[thresholds]]
//   name = "clutter: ambient visibility of two layers"
//   kind = "error"               # error, benefit, flicker or cost; what each is, check_values.h tells
//   plane = "ao"
//   method = "two_layers"
//   scene = "clutter"            # patterns: "*" stands for any letters; "*" by default
//   fail_above = 0.161           # or fail_below; "calibrate" until `plumbline check --calibrate` has set it
//   reason = "what it means when this breaks"
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/config.h"

namespace plumb {

enum class ThresholdKind { error, benefit, flicker, cost };
std::string_view to_string(ThresholdKind kind);

// What becomes of the values of several rows.
enum class OverRows { worst, mean };
std::string_view to_string(OverRows over);

// Which rows: each a text in which "*" stands for any letters. Rows are of views (`path` is empty) or of camera paths
// (`view` is empty). A row with one truth only matches every `truth`.
struct RowPattern {
    std::string scene = "*", view = "*", path, plane, truth = "full", method;
};

// Whether `text` is what `pattern` says.
bool matches_pattern(std::string_view pattern, std::string_view text);

// The values of repeated runs of the same build.
struct CalibratedValue {
    int runs = 0;
    double mean = 0.0, spread = 0.0;  // standard deviation of one run's value
    double least = 0.0, greatest = 0.0;
};

struct Threshold {
    std::string name;
    ThresholdKind kind = ThresholdKind::error;
    RowPattern rows;
    std::string measure;      // of errors, benefits and flicker
    std::string region;       // of errors and benefits: only over these pixels (metrics/regions.h); empty: all
    std::string relative_to;  // method: of benefits, and of costs that are not told as ratio to the workload
    OverRows over = OverRows::worst;
    bool fails_above = true;      // false: fails below
    std::optional<double> limit;  // none: to be calibrated
    std::string reason;
    std::optional<CalibratedValue> calibrated;
    int line = 0;  // in its file

    // "fail_above", "fail_below"
    std::string_view limit_key() const { return fails_above ? "fail_above" : "fail_below"; }
};

// Where and when the limits were calibrated.
struct CalibrationNote {
    std::vector<std::string> machines;  // "10 runs: CPU, 2 cores, llvmpipe (LLVM 15...), no load added"
    std::string date;                   // of the last one
    int workload = 0;                   // version of the calibrating workload that costs are told by
};

struct ThresholdSet {
    std::vector<Threshold> thresholds;
    std::optional<CalibrationNote> calibration;
};

// The keys `thresholds` and `calibration` of a table. Throws ConfigError with file and line: for a missing or empty
// reason, for keys that do not belong to the kind, for names that are there twice.
ThresholdSet read_thresholds(ConfigReader& reader);

// The set as a TOML file that read_thresholds takes back. Comments of the file before are not kept; reasons are.
std::string print_thresholds(const ThresholdSet& set);

}  // namespace plumb
