#include "experiments/ladder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "experiments/no_value.h"
#include "experiments/statistics.h"
#include "experiments/svg_chart.h"
#include "experiments/terminal_table.h"

namespace plumb {
namespace {

Ladder read_ladder(ConfigReader& reader, const Experiment& experiment) {
    Ladder ladder;
    ladder.plane = reader.required_text("plane");
    ladder.title = reader.text("title", ladder.plane);
    ladder.rungs = reader.texts("rungs", {});
    ladder.paths = reader.boolean("paths", false);
    if (std::ranges::find(experiment.planes, ladder.plane) == experiment.planes.end()) {
        reader.fail("plane",
                    fmt::format("'{}' is not compared; {}", ladder.plane, name_hint(ladder.plane, experiment.planes)));
    }
    if (ladder.rungs.empty()) reader.fail("rungs", "must name at least one method or oracle");
    std::vector<std::string> names;
    if (!ladder.paths) {
        for (const int layers : experiment.oracle_layers) names.push_back(oracle_name(layers));
    }
    for (const Method& method : experiment.methods) names.push_back(method.name);
    for (const std::string& rung : ladder.rungs) {
        if (std::ranges::find(names, rung) != names.end()) continue;
        reader.fail("rungs", fmt::format("'{}' is neither a method nor an oracle of this experiment; {}", rung,
                                         name_hint(rung, names)));
    }
    reader.finish();
    return ladder;
}

// The rows of one rung in one scene, by view or path.
using Rung = std::map<std::string, const ResultRow*>;

Rung rung_of(const RunResults& results, const std::string& scene, const Ladder& ladder, const std::string& name) {
    Rung rung;
    for (const ResultRow& row : results.rows) {
        const bool full = row.truth.empty() || row.truth == "full";
        const bool belongs = row.scene == scene && row.plane == ladder.plane && row.method == name && full;
        if (belongs && row.path.empty() != ladder.paths && row.measured) rung[row.place()] = &row;
    }
    return rung;
}

// What `below` adds to `above`, view by view; without one above, to the truth, which has no error.
struct Step {
    double from = 0.0, to = 0.0;
    MeanSummary change;
    double milliseconds_saved = 0.0;
    bool both_take_time = false;
};

std::optional<Step> step_between(const Rung* above, const Rung& below) {
    std::vector<double> from, to, changes, saved;
    for (const auto& [view, row] : below) {
        if (above && !above->contains(view)) continue;
        const ResultRow* upper = above ? above->at(view) : nullptr;
        from.push_back(upper ? upper->rmse() : 0.0), to.push_back(row->rmse());
        changes.push_back(to.back() - from.back());
        if (upper && upper->is_method() && row->is_method()) saved.push_back(upper->timing.median - row->timing.median);
    }
    if (changes.empty()) return std::nullopt;
    Step step{summarise_mean(from).mean, summarise_mean(to).mean, summarise_mean(changes), 0.0, !saved.empty()};
    if (step.both_take_time) step.milliseconds_saved = summarise_mean(saved).mean;
    return step;
}

std::string note_of(const Step& step) {
    if (!step.both_take_time) return "";
    return step.milliseconds_saved >= 0.0 ? fmt::format("saves {:.3g} ms", step.milliseconds_saved)
                                          : fmt::format("costs {:.3g} ms", -step.milliseconds_saved);
}

}  // namespace

std::vector<Ladder> read_ladders(const Experiment& experiment) {
    ConfigReader reader(experiment.presentation, experiment.file.string());
    std::vector<Ladder> ladders;
    for (ConfigReader& table : reader.tables("ladders")) ladders.push_back(read_ladder(table, experiment));
    return ladders;
}

std::vector<Waterfall> climb(const std::vector<Ladder>& ladders, const RunResults& results) {
    std::vector<Waterfall> waterfalls;
    for (const Ladder& ladder : ladders) {
        for (const ExperimentScene& entry : results.experiment.scenes) {
            Waterfall waterfall{fmt::format("{}: {}", entry.scene, ladder.title), "RMSE", {}};
            std::vector<Rung> rungs;
            for (const std::string& name : ladder.rungs) {
                rungs.push_back(rung_of(results, entry.scene, ladder, name));
                const Rung* above = rungs.size() > 1 ? &rungs[rungs.size() - 2] : nullptr;
                const std::optional<Step> step = step_between(above, rungs.back());
                if (!step) break;
                WaterfallBar bar{name, step->from, step->to, no_value, no_value, note_of(*step)};
                if (step->change.count > 1)
                    bar.change_lower = step->change.lower, bar.change_upper = step->change.upper;
                waterfall.bars.push_back(std::move(bar));
            }
            if (waterfall.bars.size() == ladder.rungs.size()) waterfalls.push_back(std::move(waterfall));
        }
    }
    return waterfalls;
}

std::string print_waterfalls(const std::vector<Waterfall>& waterfalls) {
    if (waterfalls.empty()) return "";
    std::vector<Chart> charts;
    for (const Waterfall& waterfall : waterfalls) {
        Chart chart;
        chart.title = waterfall.title, chart.y_label = waterfall.axis;
        chart.y_scale = ChartScale::linear, chart.is_waterfall = true;
        ChartSeries adds{"adds error", "#d55e00", {}, ChartSeries::Style::bars};
        ChartSeries removes{"takes error away", "#009e73", {}, ChartSeries::Style::bars};
        for (std::size_t i = 0; i < waterfall.bars.size(); ++i) {
            const WaterfallBar& bar = waterfall.bars[i];
            chart.categories.push_back(bar.label);
            ChartSeries& series = bar.to >= bar.from ? adds : removes;
            series.points.push_back(
                {static_cast<double>(i), bar.to, bar.from + bar.change_lower, bar.from + bar.change_upper, bar.from});
            series.labels.push_back(bar.note);
        }
        chart.series = {adds, removes};
        charts.push_back(std::move(chart));
    }
    return print_svg(charts, 2, "What each approximation adds to the error",
                     "Means over a scene's views; whiskers: 95 % intervals of what a rung adds.");
}

std::string print_waterfall_table(const std::vector<Waterfall>& waterfalls) {
    using Align = TerminalTable::Align;
    TerminalTable table({{"ladder"}, {"rung"}, {"RMSE", Align::right}, {"adds [95 %]", Align::right}, {"time"}});
    for (const Waterfall& waterfall : waterfalls) {
        if (&waterfall != &waterfalls.front()) table.add_rule();
        for (const WaterfallBar& bar : waterfall.bars) {
            std::string adds = fmt::format("{:+.3g}", bar.to - bar.from);
            if (!std::isnan(bar.change_lower))
                adds += fmt::format(" [{:+.2g}, {:+.2g}]", bar.change_lower, bar.change_upper);
            table.add_row({waterfall.title, bar.label, fmt::format("{:.3g}", bar.to), adds, bar.note});
        }
    }
    return table.print();
}

}  // namespace plumb
