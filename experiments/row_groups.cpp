#include "experiments/row_groups.h"

#include <algorithm>
#include <climits>
#include <cmath>

#include <fmt/format.h>

#include "experiments/no_value.h"

namespace plumb {
namespace {

// "full" and "within 0.3 m", "within 1 m"...: the limit differs from scene to scene, the question does not.
std::string truth_kind(const std::string& truth) {
    return truth.starts_with("within") ? "limited to the method's radius" : truth;
}

}  // namespace

std::string RowGroup::name() const {
    std::string name = plane;
    if (truth == "full")
        name += " against the full truth";
    else if (!truth.empty())
        name += fmt::format(" against the truth {}", truth);
    if (paths) name += ", along camera paths";
    return name;
}

std::string RowGroup::count(int number) const {
    return fmt::format("{} {}{}", number, paths ? "path" : "view", number == 1 ? "" : "s");
}

std::vector<std::string> RowGroup::oracles() const {
    std::map<int, std::string> names;
    for (const auto& [place, rows] : places) {
        for (const auto& [name, row] : rows) {
            if (row->oracle.layers >= 0) names[row->oracle.layers == 0 ? INT_MAX : row->oracle.layers] = name;
        }
    }
    std::vector<std::string> list;
    list.reserve(names.size());
    for (const auto& entry : names) list.push_back(entry.second);
    return list;
}

std::vector<RowGroup> group_rows(const RunResults& results) {
    std::vector<RowGroup> groups;
    for (const ResultRow& row : results.rows) {
        if (row.path_tracer_samples > 0) continue;
        const std::string truth = truth_kind(row.truth);
        auto group = std::ranges::find_if(groups, [&](const RowGroup& other) {
            return other.plane == row.plane && other.truth == truth && other.paths == !row.path.empty();
        });
        if (group == groups.end()) group = groups.insert(group, RowGroup{row.plane, truth, !row.path.empty(), {}});
        group->places[{row.scene, row.place()}][row.method] = &row;
    }
    std::ranges::stable_sort(groups, {}, [&](const RowGroup& group) {
        return std::ranges::find(results.experiment.planes, group.plane) - results.experiment.planes.begin();
    });
    return groups;
}

double value_of(const ResultRow& row, RowQuantity quantity) {
    switch (quantity) {
        case RowQuantity::error:
            return row.measured && row.rmse() > 0.0 ? row.rmse() : no_value;
        case RowQuantity::flicker:
            // Where the interval begins at zero the truth's noise leaves it open.
            return row.stability && row.stability->tells("flicker") && row.stability->flicker.lower > 0.0
                       ? row.stability->flicker.value
                       : no_value;
        case RowQuantity::time:
            break;
    }
    return row.timing.median > 0.0 ? row.timing.median : no_value;
}

RowRatio ratio_between(const RowGroup& group, const std::string& method, const std::string& base,
                       RowQuantity quantity) {
    RowRatio result;
    std::vector<double> ratios;
    for (const auto& [place, rows] : group.places) {
        if (!rows.contains(method) || !rows.contains(base)) continue;
        const double ratio = value_of(*rows.at(method), quantity) / value_of(*rows.at(base), quantity);
        if (std::isfinite(ratio))
            ratios.push_back(ratio);
        else
            ++result.refused;
    }
    result.ratio = summarise_ratios(ratios);
    return result;
}

}  // namespace plumb
