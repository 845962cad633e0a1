#include "experiments/summary.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <compare>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/result_table.h"
#include "experiments/row_measurement.h"
#include "experiments/statistics.h"
#include "experiments/terminal_table.h"

namespace plumb {
namespace {

// What sentences are about.
struct Subject {
    std::string plane, truth;  // the truth's kind
    bool paths = false;        // camera paths, or still views
    bool operator<(const Subject& other) const {
        return std::tie(plane, truth, paths) < std::tie(other.plane, other.truth, other.paths);
    }
    bool operator==(const Subject&) const = default;
};

// Rows by place (scene and view or path), then by method.
using Cells = std::map<std::pair<std::string, std::string>, std::map<std::string, const ResultRow*>>;

// "full" and "within 0.3 m", "within 1 m"...: the limit differs from scene to scene, the question does not.
std::string truth_kind(const std::string& truth) {
    return truth.starts_with("within") ? "limited to the method's radius" : truth;
}

std::string with_interval(double value, double low, double high) {
    if (!std::isfinite(low) || !std::isfinite(high)) return short_number(value);
    return fmt::format("{} [{}, {}]", short_number(value), short_number(low), short_number(high));
}

std::string with_interval(const Estimate& of) { return with_interval(of.value, of.lower, of.upper); }

std::string optional_number(double value, const char* format) {
    return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

std::string ratio_text(const RatioSummary& ratio) {
    if (ratio.count < 2) return fmt::format("{:.2f} times", ratio.mean);
    return fmt::format("{:.2f} times (95 % interval {:.2f} to {:.2f})", ratio.mean, ratio.lower, ratio.upper);
}

std::string verdict(const RatioSummary& error, const RatioSummary& time, bool better_known, bool worse_known) {
    if (better_known) {
        return time.mean > 1.0 ? fmt::format("It buys accuracy: {:.0f} % less error for {:.0f} % more time.",
                                             100.0 * (1.0 - error.mean), 100.0 * (time.mean - 1.0))
                               : "It is both more accurate and faster.";
    }
    if (worse_known) {
        return time.mean < 1.0
                   ? fmt::format("It trades accuracy for speed: {:.0f} % more error for {:.0f} % less time.",
                                 100.0 * (error.mean - 1.0), 100.0 * (1.0 - time.mean))
                   : "It costs time and loses accuracy.";
    }
    return "The interval includes 1: these views do not show that it changes the error.";
}

std::string name_of(const Subject& subject) {
    std::string name = subject.plane;
    if (subject.truth == "full")
        name += " against the full truth";
    else if (!subject.truth.empty())
        name += fmt::format(" against the truth {}", subject.truth);
    if (subject.paths) name += ", along camera paths";
    return name;
}

std::string count_text(int count, const Subject& subject) {
    return fmt::format("{} {}{}", count, subject.paths ? "path" : "view", count == 1 ? "" : "s");
}

bool comparable(const ResultRow& row, const ResultRow& base) {
    return row.measured && base.measured && row.rmse() > 0.0 && base.rmse() > 0.0;
}

bool flicker_known(const ResultRow& row) {
    return row.stability && row.stability->tells("flicker") && row.stability->flicker.lower > 0.0;
}
bool flickers_known(const ResultRow& row, const ResultRow& base) { return flicker_known(row) && flicker_known(base); }

// One method against the baseline.
std::string compare(const Subject& subject, const Cells& cells, const std::string& method,
                    const std::string& baseline) {
    std::vector<double> errors, times, flickers;
    int refused = 0;
    for (const auto& [place, rows] : cells) {
        if (!rows.contains(method) || !rows.contains(baseline)) continue;
        const ResultRow &row = *rows.at(method), &base = *rows.at(baseline);
        if (base.timing.median > 0.0 && row.timing.median > 0.0)
            times.push_back(row.timing.median / base.timing.median);
        if (flickers_known(row, base)) flickers.push_back(row.stability->flicker.value / base.stability->flicker.value);
        if (comparable(row, base))
            errors.push_back(row.rmse() / base.rmse());
        else
            ++refused;
    }
    const std::string name = name_of(subject);
    if (errors.empty() || times.empty()) {
        return fmt::format("{}: no {} allows a statement about {} ({} refused).", name, subject.paths ? "path" : "view",
                           method, refused);
    }
    const RatioSummary error = summarise_ratios(errors), time = summarise_ratios(times);
    std::string text = fmt::format("{}: {} has {} the RMSE", name, method, ratio_text(error));
    if (!flickers.empty()) text += fmt::format(" and {} the flicker", ratio_text(summarise_ratios(flickers)));
    return text + fmt::format(" of {} over {}, lower in {} of them{}, and takes {} its time. {}", baseline,
                              count_text(error.count, subject), error.below_one,
                              refused > 0 ? fmt::format(" ({} more refused)", refused) : "", ratio_text(time),
                              verdict(error, time, error.upper<1.0, error.lower> 1.0));
}

// What each layer could bring to any method: the oracle with more layers against the oracle with fewer.
std::vector<std::string> compare_oracles(const Subject& subject, const Cells& cells) {
    std::map<int, std::string> names;  // all in view comes last
    for (const auto& [place, rows] : cells) {
        for (const auto& [name, row] : rows) {
            if (row->oracle_layers >= 0) names[row->oracle_layers == 0 ? INT_MAX : row->oracle_layers] = name;
        }
    }
    std::vector<std::string> sentences;
    const std::string* before = nullptr;
    for (const auto& [layers, name] : names) {
        const std::string* fewer = std::exchange(before, &name);
        if (!fewer) continue;
        std::vector<double> ratios, flickers;
        for (const auto& [place, rows] : cells) {
            if (!rows.contains(name) || !rows.contains(*fewer)) continue;
            const ResultRow &row = *rows.at(name), &base = *rows.at(*fewer);
            if (comparable(row, base)) ratios.push_back(row.rmse() / base.rmse());
            if (flickers_known(row, base)) flickers.push_back(row.stability->flicker.value / base.stability->flicker.value);
        }
        if (ratios.empty()) {
            sentences.push_back(fmt::format("In principle, {}: no {} allows a statement about '{}' against '{}'.",
                                            name_of(subject), subject.paths ? "path" : "view", name, *fewer));
            continue;
        }
        const RatioSummary ratio = summarise_ratios(ratios);
        std::string text = fmt::format("In principle, {}: the best possible RMSE of '{}' is {} that of '{}'",
                                       name_of(subject), name, ratio_text(ratio), *fewer);
        if (!flickers.empty()) text += fmt::format(", its flicker {}", ratio_text(summarise_ratios(flickers)));
        sentences.push_back(fmt::format("{}, over {}.", text, count_text(ratio.count, subject)));
    }
    return sentences;
}

// The peak of PSNR and data range of SSIM, without which neither says anything.
std::string data_ranges_text(const std::vector<ResultRow>& rows) {
    std::vector<std::pair<std::string, Estimate>> ranges;  // by plane and truth: from the least to the most
    for (const ResultRow& row : rows) {
        if (!row.measured) continue;
        const std::string name = row.truth.empty() ? row.plane : fmt::format("{} ({})", row.plane, row.truth);
        const auto found = std::ranges::find(ranges, name, &std::pair<std::string, Estimate>::first);
        if (found == ranges.end()) {
            ranges.push_back({name, {row.data_range, row.data_range, row.data_range}});
        } else {
            found->second.lower = std::min(found->second.lower, row.data_range);
            found->second.upper = std::max(found->second.upper, row.data_range);
        }
    }
    if (ranges.empty()) return "";
    std::vector<std::string> texts;
    for (const auto& [name, of] : ranges) {
        const std::string least = short_number(of.lower), most = short_number(of.upper);
        texts.push_back(least == most ? fmt::format("{} {}", name, most)
                                      : fmt::format("{} {} to {}", name, least, most));
    }
    return fmt::format("Peak of PSNR and data range of SSIM (of linear values): {}.\n", fmt::join(texts, ", "));
}

std::string refusals_text(const std::vector<ResultRow>& rows) {
    std::string text;
    const auto add = [&](const ResultRow& row, const std::string& what, const std::string& refusal) {
        if (refusal.empty()) return;
        if (text.empty()) text = "\n(1) the truth is too noisy for these; nothing is claimed about them:\n";
        text += fmt::format("    {} / {} / {}{} / {}{}: {}\n", row.scene, row.place(), row.plane,
                            row.truth.empty() ? "" : fmt::format(" ({})", row.truth), row.method, what, refusal);
    };
    for (const ResultRow& row : rows) {
        if (!row.measured) add(row, "", row.refusal);
        if (row.stability) add(row, ", flicker", refusal_of(*row.stability, "flicker", row.reference_samples));
    }
    return text;
}

}  // namespace

std::string print_results_table(const std::vector<ResultRow>& rows) {
    using Align = TerminalTable::Align;
    const bool has_paths = std::ranges::any_of(rows, [](const ResultRow& row) { return row.stability.has_value(); });
    std::vector<TerminalTable::Column> columns{{"scene"},
                                               {has_paths ? "view or path" : "view"},
                                               {"plane"},
                                               {"truth"},
                                               {"method"},
                                               {"RMSE [95 %]", Align::right},
                                               {"PSNR", Align::right},
                                               {"SSIM", Align::right},
                                               {"ms [quartiles]", Align::right},
                                               {"G-buffer B/px", Align::right}};
    if (has_paths) columns.push_back({"flicker [95 %]", Align::right});
    TerminalTable table(columns);
    const ResultRow* before = nullptr;
    for (const ResultRow& row : rows) {
        const auto subject = [](const ResultRow& r) { return std::tie(r.scene, r.path, r.plane, r.truth); };
        if (before && subject(*before) != subject(row)) table.add_rule();
        before = &row;
        std::vector<std::string> cells = {row.scene, row.place(), row.plane, row.truth, row.method};
        if (row.measured) {
            cells.insert(cells.end(), {with_interval(row.rmse(), row.rmse_lower(), row.rmse_upper()),
                                       optional_number(row.psnr, "{:.1f}"), optional_number(row.ssim, "{:.3f}")});
        } else {
            cells.insert(cells.end(), {"refused (1)", "-", "-"});
        }
        cells.push_back(row.oracle_layers >= 0 ? "-"
                        : row.timing.repetitions > 1
                            ? with_interval(row.timing.median, row.timing.lower_quartile, row.timing.upper_quartile)
                            : short_number(row.timing.median));
        cells.push_back(row.gbuffer_bytes_per_pixel > 0 ? fmt::format("{}", row.gbuffer_bytes_per_pixel) : "-");
        if (has_paths) {
            cells.push_back(!row.stability                     ? ""
                            : !row.stability->tells("flicker") ? "refused (1)"
                                                               : with_interval(row.stability->flicker));
        }
        table.add_row(std::move(cells));
    }
    return fmt::format("{}{}{}", table.print(), data_ranges_text(rows), refusals_text(rows));
}

std::vector<std::string> summarise(const RunResults& results) {
    std::map<Subject, Cells> cells;
    std::vector<Subject> order;
    for (const ResultRow& row : results.rows) {
        if (row.path_tracer_samples > 0) continue;
        const Subject subject{row.plane, truth_kind(row.truth), !row.path.empty()};
        if (std::ranges::find(order, subject) == order.end()) order.push_back(subject);
        cells[subject][{row.scene, row.place()}][row.method] = &row;
    }
    std::ranges::stable_sort(order, {}, [&](const Subject& subject) {
        return std::ranges::find(results.experiment.planes, subject.plane) - results.experiment.planes.begin();
    });

    std::vector<std::string> sentences;
    const std::string& baseline = results.experiment.baseline;
    for (const Subject& subject : order) {
        for (const Method& method : results.experiment.methods) {
            if (method.name != baseline) sentences.push_back(compare(subject, cells[subject], method.name, baseline));
        }
        std::ranges::move(compare_oracles(subject, cells[subject]), std::back_inserter(sentences));
    }
    return sentences;
}

}  // namespace plumb
