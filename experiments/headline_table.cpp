#include "experiments/headline_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/ratio_text.h"
#include "experiments/result_table.h"
#include "experiments/row_groups.h"
#include "experiments/summary.h"

namespace plumb {
namespace {

struct NamedQuantity {
    RowQuantity quantity;
    const char* name;
};

constexpr NamedQuantity error_quantity{RowQuantity::error, "RMSE"};
constexpr NamedQuantity flicker_quantity{RowQuantity::flicker, "flicker"};
constexpr NamedQuantity time_quantity{RowQuantity::time, "ms"};

std::string with_count(const std::string& value, const RowGroup& group, int count, int all) {
    return count == all ? value : fmt::format("{} ({} of {})", value, count, group.count(all));
}

// Places that have a row of each name.
int places_with(const RowGroup& group, const std::vector<std::string>& names) {
    return static_cast<int>(std::ranges::count_if(group.places, [&](const auto& place) {
        return std::ranges::all_of(names, [&](const std::string& name) { return place.second.contains(name); });
    }));
}

// The geometric mean of `name` over the places that all of `names` tell, those left aside that have no row at all.
std::string mean_of(const RowGroup& group, const std::string& name, std::vector<std::string> names,
                    RowQuantity quantity) {
    std::erase_if(names, [&](const std::string& other) {
        return std::ranges::none_of(group.places, [&](const auto& place) { return place.second.contains(other); });
    });
    if (std::ranges::find(names, name) == names.end()) return "-";
    std::vector<double> values;
    for (const auto& entry : group.places) {
        const auto& rows = entry.second;
        const bool told = std::ranges::all_of(names, [&](const std::string& other) {
            return rows.contains(other) && !std::isnan(value_of(*rows.at(other), quantity));
        });
        if (told) values.push_back(value_of(*rows.at(name), quantity));
    }
    if (values.empty()) return "-";
    return with_count(short_number(summarise_ratios(values).mean), group, static_cast<int>(values.size()),
                      places_with(group, names));
}

std::string ratio_of(const RowGroup& group, const std::string& name, const std::string& base, RowQuantity quantity) {
    const RowRatio found = ratio_between(group, name, base, quantity);
    const RatioSummary& ratio = found.ratio;
    if (ratio.count == 0) return "-";
    const int all = ratio.count + found.refused;
    const RatioText text = print_ratio(ratio);
    if (ratio.has_interval())
        return with_count(fmt::format("{} [{}, {}]", text.mean, text.lower, text.upper), group, ratio.count, all);
    return fmt::format("{} ({}{}: no interval)", text.mean,
                       ratio.count == all ? "" : fmt::format("{} of ", ratio.count), group.count(all));
}

class Headline {
public:
    explicit Headline(const RunResults& results) : results_(results), groups_(group_rows(results)) {}

    std::string print() {
        if (groups_.empty()) return "";
        table_.columns = {""};
        for (const RowGroup& group : groups_) table_.columns.push_back(title_of(group));
        std::vector<std::string> methods, oracles;
        for (const Method& method : results_.experiment.methods) methods.push_back(method.name);
        for (const RowGroup& group : groups_) {
            for (const std::string& oracle : group.oracles()) {
                if (std::ranges::find(oracles, oracle) == oracles.end()) oracles.push_back(oracle);
            }
        }
        for (const std::string& method : methods) {
            for (const NamedQuantity& of : {error_quantity, flicker_quantity, time_quantity})
                add_row(fmt::format("{}: {}", method, of.name),
                        [&](const RowGroup& group) { return mean_of(group, method, methods, of.quantity); });
        }
        for (const std::string& oracle : oracles) {
            for (const NamedQuantity& of : {error_quantity, flicker_quantity})
                add_row(fmt::format("{}: {}", oracle, of.name),
                        [&](const RowGroup& group) { return mean_of(group, oracle, group.oracles(), of.quantity); });
        }
        const std::string& baseline = results_.experiment.baseline;
        for (const std::string& method : methods) {
            if (method == baseline) continue;
            add_ratios(fmt::format("in practice, {} over {}", method, baseline), method, baseline,
                       {error_quantity, flicker_quantity, {RowQuantity::time, "time"}});
        }
        for (std::size_t i = 1; i < oracles.size(); ++i)
            add_ratios(fmt::format("in principle, {} over {}", oracles[i], oracles[i - 1]), oracles[i], oracles[i - 1],
                       {error_quantity, flicker_quantity});
        return text();
    }

private:
    static std::string title_of(const RowGroup& group) {
        // The full truth is what is meant where nothing else is said.
        const std::string truth = group.truth.empty() || group.truth == "full" ? "" : ", truth " + group.truth;
        return fmt::format("{}{}: {}", group.plane, truth, group.count(static_cast<int>(group.places.size())));
    }

    // A row in which nothing is told (a time of oracles, flicker without paths) is left out.
    template <class CellOf>
    void add_row(const std::string& name, const CellOf& cell_of) {
        std::vector<std::string> row = {name};
        for (const RowGroup& group : groups_) row.push_back(cell_of(group));
        if (std::any_of(row.begin() + 1, row.end(), [](const std::string& cell) { return cell != "-"; }))
            table_.rows.push_back(std::move(row));
    }

    void add_ratios(const std::string& name, const std::string& method, const std::string& base,
                    const std::vector<NamedQuantity>& quantities) {
        for (const NamedQuantity& of : quantities)
            add_row(fmt::format("{}: {}", name, of.name),
                    [&](const RowGroup& group) { return ratio_of(group, method, base, of.quantity); });
    }

    std::string text() const {
        const Experiment& experiment = results_.experiment;
        std::string text =
            fmt::format("# {}\n\n{}\n\n{}\n", experiment.title, experiment.question, table_.print_markdown());
        for (const std::string& sentence : summarise(results_)) text += fmt::format("- {}\n", sentence);
        return text +
               fmt::format(
                   "\nGeometric means and, in brackets, 95 % intervals over views or paths, where there are three at "
                   "least; of an oracle, the best that any method could make of what so many layers hold. Counts in "
                   "brackets leave out where an error is nought or within the truth's noise, which forms no ratio. "
                   "{}x{}, {} on {}; `{}`, {}{}.\n",
                   experiment.width, experiment.height, results_.gl_renderer, results_.system.cpu, results_.command,
                   results_.started, experiment.quick ? ", a trial run that proves nothing" : "");
    }

    const RunResults& results_;
    std::vector<RowGroup> groups_;
    ResultTable table_;
};

}  // namespace

std::string print_headline(const RunResults& results) { return Headline(results).print(); }

}  // namespace plumb
