#include "experiments/measured_cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/no_value.h"
#include "experiments/result_files.h"

namespace plumb {
namespace {

// The limit differs from scene to scene, the question does not.
std::string truth_class(const std::string& truth) { return truth.starts_with("within") ? "limited" : truth; }

double plain_measure(const Cell& cell, std::string_view measure) {
    if (!measure.ends_with('*')) return measure_named(cell.values, measure);
    measure.remove_suffix(1);
    double sum = no_value;
    for (const auto& [name, value] : cell.values) {
        if (name.starts_with(measure)) sum = std::isnan(sum) ? value : sum + value;
    }
    return sum;
}

void add_errors(const ResultRow& row, Cell& cell) {
    // Under its own names, the noise taken off.
    const std::set<std::string, std::less<>> replaced = {"mse", "rmse", "psnr", "ssim"};
    cell.set("rmse", row.rmse());
    cell.set("mse", row.mse);
    cell.set("psnr", row.psnr);
    cell.set("ssim", row.ssim);
    for (const auto& [name, value] : row.measures) {
        if (!replaced.contains(name)) cell.set(name, value);
    }
    for (const RegionError& region : row.regions) {
        if (region.measured) cell.set(fmt::format("rmse in {}", region.region), std::sqrt(std::max(region.mse, 0.0)));
        if (region.stability && region.stability->tells("flicker"))
            cell.set(fmt::format("flicker in {}", region.region), region.stability->flicker.value);
    }
    for (const auto& [name, value] : row.fidelity) cell.set(name, value);
    if (!row.stability) return;
    // What the truth's noise drowns is left out, as a whole row is.
    for (const auto& [measure, name] : {std::pair{"flicker", "flicker"},
                                        {"method_warping", "warping"},
                                        {"truth_warping", "truth warping"},
                                        {"temporal_variance", "temporal variance"}}) {
        if (row.stability->tells(measure)) cell.set(name, row.stability->measure(measure));
    }
}

}  // namespace

void Cell::set(std::string name, double value) {
    if (std::isfinite(value)) values.emplace_back(std::move(name), value);
}

const std::vector<std::string>& cell_attributes() {
    static const std::vector<std::string> names = {"scene", "place", "plane", "truth", "method", "curve", "parameter"};
    return names;
}

std::string attribute_of(const Cell& cell, std::string_view attribute) {
    if (attribute == "scene") return cell.scene;
    if (attribute == "place") return cell.place;
    if (attribute == "plane") return cell.plane;
    if (attribute == "truth") return cell.truth;
    if (attribute == "method") return cell.method;
    if (attribute == "curve") return cell.curve;
    if (attribute == "parameter") return std::isnan(cell.parameter) ? "" : fmt::format("{:g}", cell.parameter);
    throw std::out_of_range(fmt::format("cells have no attribute '{}'", attribute));
}

double measure_of(const Cell& cell, std::string_view measure) {
    // The last operator, so that those before it are applied first.
    std::size_t place = std::string_view::npos;
    for (const std::string_view symbol : {" + ", " - ", " * ", " / "}) {
        const std::size_t found = measure.rfind(symbol);
        if (found != std::string_view::npos && (place == std::string_view::npos || found > place)) place = found;
    }
    if (place == std::string_view::npos) return plain_measure(cell, measure);
    const double left = measure_of(cell, measure.substr(0, place));
    const double right = plain_measure(cell, measure.substr(place + 3));
    switch (measure[place + 1]) {
        case '+':
            return left + right;
        case '-':
            return left - right;
        case '*':
            return left * right;
        default:
            return left / right;
    }
}

std::vector<Cell> cells_of(const RunResults& results) {
    std::vector<Cell> cells;
    for (const ResultRow& row : results.rows) {
        Cell cell{row.scene, row.place(), row.plane, truth_class(row.truth), row.method, row.curve};
        if (!row.curve.empty()) cell.parameter = row.curve_value;
        if (row.path_tracer_samples > 0) cell.curve = "path tracer", cell.parameter = row.path_tracer_samples;
        if (row.oracle.bounces > 0) cell.curve = "oracle, bounces", cell.parameter = row.oracle.bounces;
        if (row.measured) add_errors(row, cell);
        if (row.lag) cell.set("lag", row.lag->value);
        if (!row.oracle.any() && row.timing.repetitions > 0) {
            cell.set("ms", row.timing.median);
            for (const PassTiming& pass : row.timing.passes)
                cell.set(fmt::format("ms of {}", pass.pass), pass.milliseconds);
        }
        if (row.is_method()) cell.set("bytes per pixel", row.gbuffer_bytes_per_pixel);
        cells.push_back(std::move(cell));
    }
    return cells;
}

std::vector<Cell> cells_of(const GenerationResults& results) {
    std::map<std::string, std::string> scenes;
    for (const GenerationWalk& walk : results.experiment.walks) scenes[walk.name] = walk.scene;
    std::vector<Cell> cells;
    for (const GenerationRow& row : results.rows) {
        Cell cell{scenes.at(row.walk), row.walk, "layer2", "", row.method, ""};
        cell.set("wrong", row.wrong);
        cell.set("wrong inside", row.inside);
        cell.set("missing", row.missing);
        cell.set("violations", row.violations);
        cell.set("pixels per frame", row.pixels_per_frame);
        cell.set("ms of gbuffer", row.milliseconds);
        cell.set("bytes per pixel", row.bytes_per_pixel);
        cells.push_back(std::move(cell));
    }
    return cells;
}

std::string print_cells_csv(const std::vector<Cell>& cells) {
    std::vector<std::string> columns;
    for (const Cell& cell : cells) {
        for (const auto& entry : cell.values) {
            if (std::ranges::find(columns, entry.first) == columns.end()) columns.push_back(entry.first);
        }
    }
    std::string text = fmt::format("{}", fmt::join(cell_attributes(), ","));
    for (const std::string& column : columns) text += fmt::format(",{}", csv_text(column));
    text += "\n";
    for (const Cell& cell : cells) {
        std::vector<std::string> line;
        for (const std::string& attribute : cell_attributes()) line.push_back(csv_text(attribute_of(cell, attribute)));
        for (const std::string& column : columns) {
            const double value = plain_measure(cell, column);
            line.push_back(std::isnan(value) ? "" : fmt::format("{:.9g}", value));
        }
        text += fmt::format("{}\n", fmt::join(line, ","));
    }
    return text;
}

}  // namespace plumb
