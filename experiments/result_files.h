// A run's results as files for other programs.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/results.h"

namespace plumb {

// One line per row; all measures of the whole view or path as columns; quoted as RFC 4180 says.
std::string print_csv(const RunResults& results);
// One line per row and region (metrics/regions.h): the same measures and, of paths, the same stability over that region
// alone, under the same names, each with the ends of its interval.
std::string print_regions_csv(const RunResults& results);
// Everything: rows with parameters, measures and the time of each pass, the experiment, versions, machine, references,
// failures. Numbers that are not finite are null. A line for each row (run_json.h).
std::string print_json(const RunResults& results);

// Writes results.csv, regions.csv, results.json and index.html (page.h) into `folder`, each whole or not at all.
void write_result_files(const RunResults& results, const std::filesystem::path& folder);

// A cell of a CSV file, quoted where it has to be.
std::string csv_text(const std::string& text);
// Nine digits, which tell floats apart; nothing for what is not a number.
std::string csv_number(double value);

}  // namespace plumb
