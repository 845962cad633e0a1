// Runs a check: the experiment, what its methods cost, and the methods that must fail; and repeats it for calibration.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/check_file.h"
#include "experiments/disk_use.h"
#include "experiments/exit_code.h"
#include "experiments/runner.h"
#include "experiments/verdicts.h"

namespace plumb {

// A method that is broken on purpose, and whether its threshold saw it.
struct MustFailVerdict {
    std::string name;
    Verdict verdict;  // of the threshold with the broken method in place of its own
    bool proven = false;
    std::string message;
};

struct CheckResults {
    RunResults run;
    CostRound costs;
    std::vector<Verdict> verdicts;
    std::vector<MustFailVerdict> must_fail;
    std::vector<std::string> failed_cells;  // of all runs, with their cause
    double seconds = 0.0;
    bool interrupted = false;

    // exit_failed where a limit is breached, a value untold, a cell failed or a broken method passed; else
    // exit_wrong_use where a threshold matches no row; exit_interrupted before all.
    ExitCode exit_code() const;
};

// The results of the experiment go to options.output, those of broken methods to its folder must_fail. Throws what
// run_experiment throws, and ConfigError where a threshold has no limit yet, or a cost was calibrated with another
// workload.
CheckResults run_check(const CheckFile& check, const SceneFinder& finder, const RunOptions& options);

// At most, of the experiment and of the methods that must fail.
DiskUse disk_use(const CheckFile& check, const SceneFinder& finder, bool write_frames);

struct CalibrationOptions {
    int repetitions = 10;
    bool add = false;     // to the runs that the limits come from so far; else they start anew
    bool loaded = false;  // with every core kept busy by something else, as on shared machines
};

struct CalibrationResults {
    ThresholdSet set;  // with new limits
    std::vector<MustFailVerdict> must_fail;
    bool interrupted = false;

    bool proven() const;  // whether every broken method breaks its new limit
};

// Repeats experiment and costs. The truths come from the cache; methods draw no random numbers that could be varied
// (their results are the same to the last bit), so that what varies is time. Throws what run_check throws, and
// ConfigError where a value cannot be told.
CalibrationResults run_calibration(const CheckFile& check, const SceneFinder& finder, const RunOptions& options,
                                   const CalibrationOptions& calibration);

// The experiment that renders `must_fail` where its threshold looks: only those scenes and views or paths, only the
// broken method and the one it is relative to. Truths are those of `experiment`, so that they are in the cache.
Experiment must_fail_experiment(const Experiment& experiment, const MustFail& must_fail, const Threshold& threshold);

// The threshold with the broken method in place of its own.
Threshold must_fail_threshold(const MustFail& must_fail, Threshold threshold);
MustFailVerdict judge_must_fail(const MustFail& must_fail, Verdict verdict);

}  // namespace plumb
