#include "experiments/sequence_report.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/terminal_table.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

bool is_gbuffer(const MeasuredThing& thing) { return !std::isnan(thing.measure("hit_agreement")); }

std::vector<MeasuredThing> selected(const std::vector<MeasuredThing>& things,
                                    const std::function<bool(const MeasuredThing&)>& wanted) {
    std::vector<MeasuredThing> list;
    std::ranges::copy_if(things, std::back_inserter(list), wanted);
    return list;
}

std::string number(double value, const char* format = "{:.6g}") {
    return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

bool is_end_of_interval(std::string_view name) { return name.ends_with("_lower") || name.ends_with("_upper"); }

// "0.0132 [0.012, 0.0143]"
std::string number_with_interval(const MeasuredThing& thing, const std::string& name) {
    const double lower = thing.measure(name + "_lower"), upper = thing.measure(name + "_upper");
    const std::string value = number(thing.measure(name));
    return std::isnan(lower) || std::isnan(upper) ? value : fmt::format("{} [{:.3g}, {:.3g}]", value, lower, upper);
}

// One row per measure that any of the things has, in their order.
std::string print_columns(const std::vector<MeasuredThing>& things) {
    if (things.empty()) return "";
    std::vector<TerminalTable::Column> columns = {{"measure"}};
    std::vector<std::string> names;
    for (const MeasuredThing& thing : things) {
        columns.push_back({thing.name, TerminalTable::Align::right});
        for (const auto& [name, value] : thing.measures) {
            if (!std::isnan(value) && std::ranges::find(names, name) == names.end()) names.push_back(name);
        }
    }
    TerminalTable table(columns);
    for (const std::string& name : names) {
        if (is_end_of_interval(name)) continue;
        std::vector<std::string> cells = {name};
        for (const MeasuredThing& thing : things) cells.push_back(number_with_interval(thing, name));
        table.add_row(std::move(cells));
    }
    return table.print();
}

bool is_referenced(const MeasuredThing& thing) { return !std::isnan(thing.measure("unbiased_mse")); }

// "0.0132 [0.012, 0.0143]", free of the reference's noise where that is possible.
std::string error_with_interval(const MeasuredThing& thing) {
    if (!is_referenced(thing)) return number(thing.measure("rmse"), "{:.3g}");
    const auto root = [&](const char* name) { return std::sqrt(std::max(thing.measure(name), 0.0)); };
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]{}", root("unbiased_mse"), root("unbiased_mse_lower"),
                       root("unbiased_mse_upper"), thing.measure("trustworthy") == 0.0 ? " (?)" : "");
}

std::string flicker_with_interval(const MeasuredThing& thing) {
    if (std::isnan(thing.measure("flicker"))) return "-";
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]{}", thing.measure("flicker"), thing.measure("flicker_lower"),
                       thing.measure("flicker_upper"), thing.measure("flicker_trustworthy") == 0.0 ? " (?)" : "");
}

// A column of a table with one row per thing.
struct Cell {
    const char* title;
    std::function<std::string(const MeasuredThing&)> text;
};

Cell measure_cell(const char* title, const char* measure) {
    return {title, [measure](const MeasuredThing& thing) { return number(thing.measure(measure), "{:.3g}"); }};
}

std::vector<Cell> error_cells() {
    return {{"RMSE [95 %]", error_with_interval},
            measure_cell("bias", "bias"),
            {"PSNR",
             [](const MeasuredThing& thing) {
                 return number(thing.measure(is_referenced(thing) ? "unbiased_psnr" : "psnr"), "{:.3g}");
             }},
            measure_cell("SSIM", "ssim"),
            measure_cell("FLIP", "flip"),
            measure_cell("p95", "p95"),
            {"flicker [95 %]", flicker_with_interval}};
}

struct Row {
    std::vector<std::string> head;
    const MeasuredThing* thing;
};

// Columns that are "-" in every row are left out.
std::string print_rows(const std::vector<std::string>& heads, const std::vector<Row>& rows) {
    std::vector<TerminalTable::Column> columns;
    columns.reserve(heads.size() + error_cells().size());
    for (const std::string& head : heads) columns.push_back({head});
    std::vector<Cell> cells = error_cells();
    std::erase_if(cells, [&](const Cell& cell) {
        return std::ranges::all_of(rows, [&](const Row& row) { return cell.text(*row.thing) == "-"; });
    });
    for (const Cell& cell : cells) columns.push_back({cell.title, TerminalTable::Align::right});
    TerminalTable table(columns);
    for (const Row& row : rows) {
        std::vector<std::string> line = row.head;
        for (const Cell& cell : cells) line.push_back(cell.text(*row.thing));
        table.add_row(std::move(line));
    }
    return table.print();
}

Json json_of_measures(const MeasuredThing& thing) {
    Json json = Json::object();
    for (const auto& [name, value] : thing.measures) {
        if (std::isfinite(value))
            json[name] = value;
        else if (std::isinf(value))
            json[name] = value > 0 ? "inf" : "-inf";
    }
    return json;
}

}  // namespace

std::string print_measures(const std::vector<MeasuredThing>& things) {
    std::string text =
        print_columns(selected(things, [](const auto& thing) { return thing.region.empty() && !is_gbuffer(thing); }));
    if (const auto layers = selected(things, is_gbuffer); !layers.empty()) {
        text += "\nG-buffer\n";
        text += print_columns(layers);
    }
    std::vector<Row> rows;
    for (const MeasuredThing& thing : things) {
        if (!thing.region.empty())
            rows.push_back({{thing.name, thing.region, number(thing.measure("values"))}, &thing});
    }
    if (!rows.empty()) {
        text += '\n';
        text += print_rows({"plane", "region", "values"}, rows);
    }
    return text;
}

std::string print_frames(const std::vector<MeasuredFrame>& frames, const std::vector<MeasuredThing>& whole) {
    std::vector<Row> rows;
    for (const MeasuredThing& of_all : whole) {
        if (!of_all.region.empty() || is_gbuffer(of_all)) continue;
        for (const MeasuredFrame& frame : frames) {
            for (const MeasuredThing& thing : frame.things) {
                if (thing.full_name() == of_all.full_name()) rows.push_back({{thing.name, frame.name}, &thing});
            }
        }
        rows.push_back({{of_all.name, "all"}, &of_all});
    }
    return rows.empty() ? "" : print_rows({"plane", "frame"}, rows);
}

Json json_of(const std::vector<MeasuredThing>& things) {
    Json json = {{"planes", Json::object()}};
    for (const MeasuredThing& thing : things) {
        if (!thing.region.empty())
            json["regions"][thing.name][thing.region] = json_of_measures(thing);
        else
            json[is_gbuffer(thing) ? "gbuffer" : "planes"][thing.name] = json_of_measures(thing);
    }
    return json;
}

Json json_of(const std::vector<MeasuredFrame>& frames) {
    Json json = Json::array();
    for (const MeasuredFrame& frame : frames) {
        Json entry = {{"frame", frame.name}};
        entry.update(json_of(frame.things));
        json.push_back(std::move(entry));
    }
    return json;
}

}  // namespace plumb
