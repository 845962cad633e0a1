// What an experiment of kind "convergence" leaves behind: a table, a figure, CSV, JSON and a page.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/convergence.h"

namespace plumb {

std::string print_convergence_table(const ConvergenceResults& results);
// One row per image: scene, view, plane, points, seed, samples, mse, rmse, reference_noise_mse, used.
std::string print_convergence_csv(const ConvergenceResults& results);
// One entry per curve, with its slope, and everything that is needed to measure it again.
std::string print_convergence_json(const ConvergenceResults& results);
// A chart per scene (columns) and plane (rows).
std::string print_convergence_figure(const ConvergenceResults& results);
// The figure and the table as one page that needs neither network nor script.
std::string print_convergence_page(const ConvergenceResults& results);

// convergence.csv, .json, .svg and index.html, each whole or not at all. Throws ImageError.
void write_convergence_files(const ConvergenceResults& results, const std::filesystem::path& folder);

}  // namespace plumb
