// What a check leaves behind: a table for the terminal, JUnit XML for CI services, JSON for programs.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/check_file.h"
#include "experiments/check_run.h"
#include "experiments/junit.h"

namespace plumb {

// One line per threshold: value, limit, margin, value at calibration, change, verdict; below, what moved, what failed
// and why each limit that broke is there, and the methods that had to fail.
std::string print_check_table(const CheckResults& results);

// The limits that a calibration set, beside those that were there before.
std::string print_calibration_table(const ThresholdSet& before, const ThresholdSet& after);

// One case per threshold, one per method that must fail, and one for the cells of the run.
JunitSuite junit_of(const CheckFile& check, const CheckResults& results);

// Everything, for programs; numbers that are not finite are null.
std::string print_check_json(const CheckFile& check, const CheckResults& results);

// junit.xml and check.json, each whole or not at all. Throws ImageError.
void write_check_files(const CheckFile& check, const CheckResults& results, const std::filesystem::path& folder);

}  // namespace plumb
