#include "experiments/summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "experiments/statistics.h"
#include "experiments/terminal_table.h"

namespace plumb {
namespace {

using Subject = std::pair<std::string, std::string>;  // plane, truth's kind

// "full" and "within 0.3 m", "within 1 m"...: the limit differs from scene to scene, the question does not.
std::string truth_kind(const std::string& truth) {
    return truth.starts_with("within") ? "limited to the method's radius" : truth;
}

// Three digits that count, without an exponent where the number is large.
std::string short_number(double value) {
    return std::abs(value) >= 1000.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string with_interval(double value, double low, double high) {
    if (!std::isfinite(low) || !std::isfinite(high)) return short_number(value);
    return fmt::format("{} [{}, {}]", short_number(value), short_number(low), short_number(high));
}

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

}  // namespace

std::string print_results_table(const std::vector<ResultRow>& rows) {
    using Align = TerminalTable::Align;
    TerminalTable table({{"scene"},
                         {"view"},
                         {"plane"},
                         {"truth"},
                         {"method"},
                         {"RMSE [95 %]", Align::right},
                         {"PSNR", Align::right},
                         {"SSIM", Align::right},
                         {"ms [quartiles]", Align::right},
                         {"G-buffer B/px", Align::right}});
    const ResultRow* before = nullptr;
    for (const ResultRow& row : rows) {
        const auto subject = [](const ResultRow& r) { return std::tie(r.scene, r.plane, r.truth); };
        if (before && subject(*before) != subject(row)) table.add_rule();
        before = &row;
        std::vector<std::string> cells = {row.scene, row.view, row.plane, row.truth, row.method};
        if (row.measured) {
            cells.insert(cells.end(), {with_interval(row.rmse(), row.rmse_lower(), row.rmse_upper()),
                                       optional_number(row.psnr, "{:.1f}"), optional_number(row.ssim, "{:.3f}")});
        } else {
            cells.insert(cells.end(), {"refused (1)", "-", "-"});
        }
        cells.push_back(row.timing.repetitions > 1
                            ? with_interval(row.timing.median, row.timing.lower_quartile, row.timing.upper_quartile)
                            : short_number(row.timing.median));
        cells.push_back(row.gbuffer_bytes_per_pixel > 0 ? fmt::format("{}", row.gbuffer_bytes_per_pixel) : "-");
        table.add_row(std::move(cells));
    }
    std::string text = table.print();
    bool first = true;
    for (const ResultRow& row : rows) {
        if (row.measured) continue;
        if (first) text += "\n(1) the truth is too noisy for these; nothing is claimed about them:\n";
        first = false;
        text += fmt::format("    {} / {} / {}{} / {}: {}\n", row.scene, row.view, row.plane,
                            row.truth.empty() ? "" : fmt::format(" ({})", row.truth), row.method, row.refusal);
    }
    return text;
}

std::vector<std::string> summarise(const RunResults& results) {
    // Rows of methods by subject, then by place, then by method.
    std::map<Subject, std::map<std::pair<std::string, std::string>, std::map<std::string, const ResultRow*>>> cells;
    std::vector<Subject> order;
    for (const ResultRow& row : results.rows) {
        if (row.path_tracer_samples > 0) continue;
        const Subject subject{row.plane, truth_kind(row.truth)};
        if (std::ranges::find(order, subject) == order.end()) order.push_back(subject);
        cells[subject][{row.scene, row.view}][row.method] = &row;
    }
    std::ranges::stable_sort(order, {}, [&](const Subject& subject) {
        return std::ranges::find(results.experiment.planes, subject.first) - results.experiment.planes.begin();
    });

    std::vector<std::string> sentences;
    const std::string& baseline = results.experiment.baseline;
    for (const Subject& subject : order) {
        for (const Method& method : results.experiment.methods) {
            if (method.name == baseline) continue;
            std::vector<double> errors, times;
            int refused = 0;
            for (const auto& [place, rows] : cells[subject]) {
                if (!rows.contains(method.name) || !rows.contains(baseline)) continue;
                const ResultRow &row = *rows.at(method.name), &base = *rows.at(baseline);
                if (base.timing.median > 0.0 && row.timing.median > 0.0)
                    times.push_back(row.timing.median / base.timing.median);
                if (!row.measured || !base.measured || !(row.rmse() > 0.0) || !(base.rmse() > 0.0)) {
                    ++refused;
                } else {
                    errors.push_back(row.rmse() / base.rmse());
                }
            }
            const std::string name = subject.second.empty() ? subject.first
                                     : subject.second == "full"
                                         ? fmt::format("{} against the full truth", subject.first)
                                         : fmt::format("{} against the truth {}", subject.first, subject.second);
            if (errors.empty()) {
                sentences.push_back(
                    fmt::format("{}: no view allows a statement about {} ({} refused).", name, method.name, refused));
                continue;
            }
            const RatioSummary error = summarise_ratios(errors), time = summarise_ratios(times);
            sentences.push_back(fmt::format(
                "{}: {} has {} the RMSE of {} over {} view{}, lower in {} of them{}, and takes {} its time. {}", name,
                method.name, ratio_text(error), baseline, error.count, error.count == 1 ? "" : "s", error.below_one,
                refused > 0 ? fmt::format(" ({} more refused)", refused) : "", ratio_text(time),
                verdict(error, time, error.upper<1.0, error.lower> 1.0)));
        }
    }
    return sentences;
}

}  // namespace plumb
