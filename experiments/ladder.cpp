#include "experiments/ladder.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

#include "experiments/no_value.h"
#include "experiments/result_files.h"
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
    for (const int layers : experiment.oracle_layers) names.push_back(oracle_name(layers));
    for (const int bounces : experiment.oracle_bounces) names.push_back(oracle_name_of_bounces(bounces));
    for (const Method& method : experiment.methods) names.push_back(method.name);
    for (const std::string& rung : ladder.rungs) {
        if (std::ranges::find(names, rung) != names.end()) continue;
        reader.fail("rungs", fmt::format("'{}' is neither a method nor an oracle of this experiment; {}", rung,
                                         name_hint(rung, names)));
    }
    reader.finish();
    return ladder;
}

// One rung in one scene.
struct Rung {
    std::string name;
    std::map<std::string, const ResultRow*> rows;  // measured, by view or path
    std::map<std::string, std::string> refusals;   // of the other views or paths

    // What happened to those views that it lacks.
    std::string reason() const {
        if (refusals.empty()) return "it was not rendered (see the failures)";
        return fmt::format("{}: {}", refusals.begin()->first, refusals.begin()->second);
    }
};

Rung rung_of(const RunResults& results, const std::string& scene, const Ladder& ladder, const std::string& name) {
    Rung rung{name, {}, {}};
    for (const ResultRow& row : results.rows) {
        const bool full = row.truth.empty() || row.truth == "full";
        const bool belongs = row.scene == scene && row.plane == ladder.plane && row.method == name && full;
        if (!belongs || row.path.empty() == ladder.paths) continue;
        if (row.measured)
            rung.rows[row.place()] = &row;
        else
            rung.refusals[row.place()] = row.refusal;
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

Step step_between(const Rung* above, const Rung& below, const std::vector<std::string>& places) {
    std::vector<double> from, to, changes, saved;
    for (const std::string& place : places) {
        const ResultRow& row = *below.rows.at(place);
        const ResultRow* upper = above ? above->rows.at(place) : nullptr;
        from.push_back(upper ? upper->rmse() : 0.0), to.push_back(row.rmse());
        changes.push_back(to.back() - from.back());
        if (upper && upper->is_method() && row.is_method()) saved.push_back(upper->timing.median - row.timing.median);
    }
    Step step{summarise_mean(from).mean, summarise_mean(to).mean, summarise_mean(changes), 0.0, !saved.empty()};
    if (step.both_take_time) step.milliseconds_saved = summarise_mean(saved).mean;
    return step;
}

std::string note_of(const Step& step) {
    if (!step.both_take_time) return "";
    return step.milliseconds_saved >= 0.0 ? fmt::format("saves {:.3g} ms", step.milliseconds_saved)
                                          : fmt::format("costs {:.3g} ms", -step.milliseconds_saved);
}

// Views or paths in which every rung was measured, of `all`.
std::vector<std::string> common_places(const std::vector<Rung>& rungs, const std::set<std::string>& all) {
    std::vector<std::string> places;
    std::ranges::copy_if(all, std::back_inserter(places), [&](const std::string& place) {
        return std::ranges::all_of(rungs, [&](const Rung& rung) { return rung.rows.contains(place); });
    });
    return places;
}

void climb_in_scene(const Ladder& ladder, const std::string& scene, const RunResults& results, Climb& climb) {
    Waterfall waterfall{fmt::format("{}: {}", scene, ladder.title), "RMSE", {}};
    const auto tell = [&](const std::string& gap) {
        climb.gaps.push_back(fmt::format("Ladder '{}': {}.", waterfall.title, gap));
    };
    std::vector<Rung> rungs;
    std::set<std::string> all;
    for (const std::string& name : ladder.rungs) {
        rungs.push_back(rung_of(results, scene, ladder, name));
        for (const auto& entry : rungs.back().rows) all.insert(entry.first);
    }
    std::erase_if(rungs, [&](const Rung& rung) {
        if (rung.rows.empty())
            tell(fmt::format("nothing is measured of the rung '{}', which is left out ({})", rung.name, rung.reason()));
        return rung.rows.empty();
    });
    const std::vector<std::string> places = common_places(rungs, all);
    const char* kind = ladder.paths ? "path" : "view";
    for (const Rung& rung : rungs) {
        if (rung.rows.size() < all.size())
            tell(fmt::format("the rung '{}' is measured in {} of {} {}s ({})", rung.name, rung.rows.size(), all.size(),
                             kind, rung.reason()));
    }
    if (places.empty()) return tell(fmt::format("left out, because its rungs share no measured {}", kind));
    for (const Rung& rung : rungs) {
        const Step step = step_between(&rung == &rungs.front() ? nullptr : &rung - 1, rung, places);
        WaterfallBar bar{rung.name, step.from, step.to, no_value, no_value, note_of(step)};
        if (step.change.has_interval()) bar.change_lower = step.change.lower, bar.change_upper = step.change.upper;
        waterfall.bars.push_back(std::move(bar));
    }
    climb.waterfalls.push_back(std::move(waterfall));
}

}  // namespace

std::vector<Ladder> read_ladders(const Experiment& experiment) {
    ConfigReader reader(experiment.presentation, experiment.file.string());
    std::vector<Ladder> ladders;
    for (ConfigReader& table : reader.tables("ladders")) ladders.push_back(read_ladder(table, experiment));
    return ladders;
}

Climb climb(const std::vector<Ladder>& ladders, const RunResults& results) {
    Climb climb;
    for (const Ladder& ladder : ladders) {
        for (const ExperimentScene& entry : results.experiment.scenes) {
            if (!ladder.paths || !entry.paths.empty()) climb_in_scene(ladder, entry.scene, results, climb);
        }
    }
    return climb;
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
    return print_svg(
        charts, 2, "What each approximation adds to the error",
        "Means over a scene's views; whiskers: 95 % intervals of what a rung adds; beside bars: its time.");
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

std::string print_waterfall_csv(const std::vector<Waterfall>& waterfalls) {
    const auto number = [](double value) { return std::isnan(value) ? "" : fmt::format("{:.9g}", value); };
    std::string text = "ladder,rung,rmse_above,rmse,adds,adds_lower,adds_upper,time\n";
    for (const Waterfall& waterfall : waterfalls) {
        for (const WaterfallBar& bar : waterfall.bars) {
            text += fmt::format("{},{},{},{},{},{},{},{}\n", csv_text(waterfall.title), csv_text(bar.label),
                                number(bar.from), number(bar.to), number(bar.to - bar.from), number(bar.change_lower),
                                number(bar.change_upper), csv_text(bar.note));
        }
    }
    return text;
}

}  // namespace plumb
