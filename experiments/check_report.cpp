#include "experiments/check_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/run_json.h"
#include "experiments/terminal_table.h"
#include "frames/atomic_file.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;
using Align = TerminalTable::Align;

Json number(const std::optional<double>& value) { return value ? number_json(*value) : Json(nullptr); }

std::string four_digits(const std::optional<double>& value) { return value ? fmt::format("{:.4g}", *value) : "-"; }

std::string percent(double share) {
    if (std::isnan(share)) return "-";
    // A change that rounds to nothing is told as none, not as "-0.0 %".
    return std::abs(share) < 5e-4 ? "0 %" : fmt::format("{:+.1f} %", 100.0 * share);
}

std::optional<double> calibrated_mean(const Threshold& threshold) {
    return threshold.calibrated ? std::optional(threshold.calibrated->mean) : std::nullopt;
}

std::string limit_text(const Threshold& threshold) {
    return fmt::format("{} {}", threshold.fails_above ? "<=" : ">=", four_digits(threshold.limit));
}

// What a reader of a failure needs, one fact a line.
std::string facts_of(const Verdict& verdict) {
    const Threshold& threshold = verdict.threshold;
    std::string text = verdict.message;
    text.append(fmt::format("\nvalue {}, limit {}, margin {}", four_digits(verdict.value.value), limit_text(threshold),
                            percent(verdict.margin())));
    if (threshold.calibrated) {
        text.append(fmt::format("\nat calibration {:.6g} (spread {:.2g} over {} runs), change {}",
                                threshold.calibrated->mean, threshold.calibrated->spread, threshold.calibrated->runs,
                                percent(verdict.change())));
    }
    for (const std::string& untold : verdict.value.untold) text.append("\nnot told: ").append(untold);
    return text.append("\nreason of the limit: ").append(threshold.reason);
}

Json verdict_json(const Verdict& verdict) {
    const Threshold& threshold = verdict.threshold;
    constexpr std::array statuses = {"kept", "breached", "untold", "unmatched"};
    Json json = {{"name", threshold.name},
                 {"kind", to_string(threshold.kind)},
                 {"verdict", statuses.at(static_cast<std::size_t>(verdict.status))},
                 {"value", number(verdict.value.value)},
                 {"of", verdict.value.place},
                 {"rows", verdict.value.rows},
                 {threshold.limit_key(), number(threshold.limit)},
                 {"margin", number(verdict.margin())}};
    if (threshold.calibrated) {
        const CalibratedValue& before = *threshold.calibrated;
        json["calibrated"] = {{"runs", before.runs},
                              {"mean", before.mean},
                              {"spread", before.spread},
                              {"least", before.least},
                              {"greatest", before.greatest}};
        json["change"] = number(verdict.change());
        json["moved"] = verdict.moved();
    }
    json["message"] = verdict.message;
    json["untold"] = verdict.value.untold;
    json["reason"] = threshold.reason;
    return json;
}

JunitCase case_of(const Verdict& verdict) {
    JunitCase test;
    test.name = verdict.threshold.name;
    test.class_name = fmt::format("plumbline.{}", to_string(verdict.threshold.kind));
    test.message = verdict.message, test.text = facts_of(verdict);
    if (verdict.status == VerdictStatus::unmatched) {
        test.outcome = JunitCase::Outcome::error;
    } else if (verdict.status != VerdictStatus::kept) {
        test.outcome = JunitCase::Outcome::failed;
    }
    const auto add = [&](const char* name, const std::optional<double>& value) {
        if (value && std::isfinite(*value)) test.properties.emplace_back(name, fmt::format("{:.9g}", *value));
    };
    add("value", verdict.value.value);
    add("limit", verdict.threshold.limit);
    add("margin", verdict.margin());
    add("calibrated", calibrated_mean(verdict.threshold));
    add("change", verdict.change());
    return test;
}

}  // namespace

std::string print_check_table(const CheckResults& results) {
    TerminalTable table({{"threshold"},
                         {"of"},
                         {"value", Align::right},
                         {"limit", Align::right},
                         {"margin", Align::right},
                         {"calibrated", Align::right},
                         {"change", Align::right},
                         {"verdict"}});
    for (const Verdict& verdict : results.verdicts) {
        std::string status(to_string(verdict.status));
        if (verdict.moved() && verdict.status == VerdictStatus::kept) status.append(", moved");
        table.add_row({verdict.threshold.name, verdict.value.place, four_digits(verdict.value.value),
                       limit_text(verdict.threshold), percent(verdict.margin()),
                       four_digits(calibrated_mean(verdict.threshold)), percent(verdict.change()), std::move(status)});
    }
    std::string text = table.print();
    if (const std::string moved = describe_movement(results.verdicts); !moved.empty()) text.append("\n" + moved + "\n");
    for (const MustFailVerdict& verdict : results.must_fail)
        text.append(
            fmt::format("\n{} '{}' {}\n", verdict.proven ? "Proof:" : "NO PROOF:", verdict.name, verdict.message));
    for (const Verdict& verdict : results.verdicts) {
        if (verdict.status == VerdictStatus::kept) continue;
        text.append(fmt::format("\n{}: {}\n  {}\n  reason of the limit: {}\n", to_string(verdict.status),
                                verdict.threshold.name, verdict.message, verdict.threshold.reason));
    }
    if (!results.failed_cells.empty()) {
        text.append(fmt::format("\n{} cell{} failed:\n  {}\n", results.failed_cells.size(),
                                results.failed_cells.size() == 1 ? "" : "s", fmt::join(results.failed_cells, "\n  ")));
    }
    return text;
}

std::string print_calibration_table(const ThresholdSet& before, const ThresholdSet& after) {
    TerminalTable table({{"threshold"},
                         {"runs", Align::right},
                         {"mean", Align::right},
                         {"spread", Align::right},
                         {"limit before", Align::right},
                         {"limit", Align::right}});
    for (const Threshold& threshold : after.thresholds) {
        const auto old = std::ranges::find(before.thresholds, threshold.name, &Threshold::name);
        const CalibratedValue& value = threshold.calibrated.value();
        table.add_row({threshold.name, fmt::format("{}", value.runs), fmt::format("{:.6g}", value.mean),
                       fmt::format("{:.2f} %", 100.0 * value.spread / std::abs(value.mean)),
                       old == before.thresholds.end() ? "-" : four_digits(old->limit), limit_text(threshold)});
    }
    return table.print();
}

JunitSuite junit_of(const CheckFile& check, const CheckResults& results) {
    JunitSuite suite;
    suite.name = fmt::format("plumbline check {}", check.experiment.name);
    suite.timestamp = results.run.started;
    if (suite.timestamp.ends_with('Z')) suite.timestamp.pop_back();  // as JUnit's schema wants it; it is UTC
    suite.seconds = results.seconds;
    suite.properties = {{"cpu", results.run.system.cpu},
                        {"cores", fmt::format("{}", results.run.system.worker_threads)},
                        {"gl_renderer", results.run.gl_renderer},
                        {"gl_version", results.run.gl_version}};
    JunitCase cells{"every cell was rendered", "plumbline.run", JunitCase::Outcome::passed, "", "", {}};
    if (!results.failed_cells.empty()) {
        cells.outcome = JunitCase::Outcome::failed;
        cells.message =
            fmt::format("{} failed, the first: {}", results.failed_cells.size(), results.failed_cells.front());
        cells.text = fmt::format("{}", fmt::join(results.failed_cells, "\n"));
    }
    suite.cases.push_back(cells);
    for (const Verdict& verdict : results.verdicts) suite.cases.push_back(case_of(verdict));
    for (const MustFailVerdict& verdict : results.must_fail) {
        JunitCase test{verdict.name, "plumbline.must_fail", JunitCase::Outcome::passed, verdict.message, "", {}};
        test.text = fmt::format("{}\n{}", verdict.message, facts_of(verdict.verdict));
        if (!verdict.proven) test.outcome = JunitCase::Outcome::failed;
        suite.cases.push_back(std::move(test));
    }
    return suite;
}

std::string print_check_json(const CheckFile& check, const CheckResults& results) {
    Json json = run_json(results.run.command, results.run.started, results.seconds, results.run.system);
    json["gl_renderer"] = results.run.gl_renderer;
    json["file"] = check.experiment.file.filename().string();
    json["exit_code"] = static_cast<int>(results.exit_code());
    json["thresholds"] = Json::array();
    for (const Verdict& verdict : results.verdicts) json["thresholds"].push_back(verdict_json(verdict));
    json["must_fail"] = Json::array();
    for (const MustFailVerdict& verdict : results.must_fail) {
        json["must_fail"].push_back({{"name", verdict.name},
                                     {"proven", verdict.proven},
                                     {"message", verdict.message},
                                     {"threshold", verdict_json(verdict.verdict)}});
    }
    json["costs"] = Json::array();
    for (const CostRatio& cost : results.costs.ratios) {
        json["costs"].push_back({{"scene", cost.scene},
                                 {"view", cost.view},
                                 {"plane", cost.plane},
                                 {"method", cost.method},
                                 {"ratio", number(cost.ratio)},
                                 {"milliseconds", number(cost.milliseconds)},
                                 {"workload_milliseconds", number(cost.workload_ms)}});
    }
    json["movement"] = describe_movement(results.verdicts);
    json["failed_cells"] = results.failed_cells;
    if (check.set.calibration) {
        json["calibration"] = {{"date", check.set.calibration->date},
                               {"machines", check.set.calibration->machines},
                               {"workload", check.set.calibration->workload}};
    }
    // Bytes that are no UTF-8 (a file name) are replaced rather than losing all results.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_check_files(const CheckFile& check, const CheckResults& results, const std::filesystem::path& folder) {
    write_text_atomically(folder / "junit.xml", print_junit(junit_of(check, results)));
    write_text_atomically(folder / "check.json", print_check_json(check, results));
}

}  // namespace plumb
