#include "experiments/summary.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/ratio_text.h"
#include "experiments/result_table.h"
#include "experiments/row_groups.h"
#include "experiments/row_measurement.h"
#include "experiments/terminal_table.h"

namespace plumb {
namespace {

std::string with_interval(double value, double low, double high) {
    if (!std::isfinite(low) || !std::isfinite(high)) return short_number(value);
    return fmt::format("{} [{}, {}]", short_number(value), short_number(low), short_number(high));
}

std::string with_interval(const Estimate& of) { return with_interval(of.value, of.lower, of.upper); }

std::string optional_number(double value, const char* format) {
    return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

std::string ratio_text(const RatioSummary& ratio) {
    const RatioText text = print_ratio(ratio);
    if (ratio.has_interval())
        return fmt::format("{} times (95 % interval {} to {})", text.mean, text.lower, text.upper);
    return fmt::format("{} times (of {}: no interval)", text.mean, ratio.count == 1 ? "one case" : "two cases");
}

std::string verdict(const RatioSummary& error, const RatioSummary& time, const char* places) {
    if (!error.has_interval())
        return fmt::format("So few {} have no interval: they do not show that it changes the error.", places);
    if (error.upper < 1.0) {
        return time.mean > 1.0 ? fmt::format("It buys accuracy: {:.0f} % less error for {:.0f} % more time.",
                                             100.0 * (1.0 - error.mean), 100.0 * (time.mean - 1.0))
                               : "It is both more accurate and faster.";
    }
    if (error.lower > 1.0) {
        return time.mean < 1.0
                   ? fmt::format("It trades accuracy for speed: {:.0f} % more error for {:.0f} % less time.",
                                 100.0 * (error.mean - 1.0), 100.0 * (1.0 - time.mean))
                   : "It costs time and loses accuracy.";
    }
    return fmt::format("The interval includes 1: these {} do not show that it changes the error.", places);
}

// " (over 3 paths)" where fewer tell the flicker than the error.
std::string flicker_count(const RowGroup& group, const RatioSummary& flicker, const RatioSummary& error) {
    return flicker.count == error.count ? "" : fmt::format(" (over {})", group.count(flicker.count));
}

// One method against the baseline.
std::string compare(const RowGroup& group, const std::string& method, const std::string& baseline) {
    const RowRatio error = ratio_between(group, method, baseline, RowQuantity::error);
    const RatioSummary time = ratio_between(group, method, baseline, RowQuantity::time).ratio;
    const RatioSummary flicker = ratio_between(group, method, baseline, RowQuantity::flicker).ratio;
    if (error.ratio.count == 0 || time.count == 0) {
        return fmt::format("{}: no {} allows a statement about {} ({} refused).", group.name(),
                           group.paths ? "path" : "view", method, error.refused);
    }
    std::string text = fmt::format("{}: {} has {} the RMSE", group.name(), method, ratio_text(error.ratio));
    if (flicker.count > 0)
        text += fmt::format(" and {} the flicker{}", ratio_text(flicker), flicker_count(group, flicker, error.ratio));
    return text + fmt::format(" of {} over {}, lower in {} of them{}, and takes {} its time. {}", baseline,
                              group.count(error.ratio.count), error.ratio.below_one,
                              error.refused > 0 ? fmt::format(" ({} more refused)", error.refused) : "",
                              ratio_text(time), verdict(error.ratio, time, group.paths ? "paths" : "views"));
}

// What each layer could bring to any method: the oracle with more layers against the oracle with fewer.
std::vector<std::string> compare_oracles(const RowGroup& group) {
    const std::vector<std::string> names = group.oracles();
    std::vector<std::string> sentences;
    for (std::size_t i = 1; i < names.size(); ++i) {
        const std::string &name = names[i], &fewer = names[i - 1];
        const RatioSummary error = ratio_between(group, name, fewer, RowQuantity::error).ratio;
        const RatioSummary flicker = ratio_between(group, name, fewer, RowQuantity::flicker).ratio;
        if (error.count == 0) {
            sentences.push_back(fmt::format("In principle, {}: no {} allows a statement about '{}' against '{}'.",
                                            group.name(), group.paths ? "path" : "view", name, fewer));
            continue;
        }
        std::string text = fmt::format("In principle, {}: the best possible RMSE of '{}' is {} that of '{}'",
                                       group.name(), name, ratio_text(error), fewer);
        if (flicker.count > 0)
            text += fmt::format(", its flicker {}{}", ratio_text(flicker), flicker_count(group, flicker, error));
        sentences.push_back(fmt::format("{}, over {}.", text, group.count(error.count)));
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
        cells.push_back(row.oracle.any() ? "-"
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
    std::vector<std::string> sentences;
    const std::string& baseline = results.experiment.baseline;
    for (const RowGroup& group : group_rows(results)) {
        for (const Method& method : results.experiment.methods) {
            if (method.name != baseline) sentences.push_back(compare(group, method.name, baseline));
        }
        std::ranges::move(compare_oracles(group), std::back_inserter(sentences));
    }
    return sentences;
}

}  // namespace plumb
