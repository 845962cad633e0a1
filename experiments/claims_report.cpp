#include "experiments/claims_report.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/result_table.h"
#include "experiments/run_json.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

std::ptrdiff_t count_of(const std::vector<ClaimRecord>& records, ClaimVerdict verdict) {
    return std::ranges::count(records, to_string(verdict), &ClaimRecord::verdict);
}

std::string verdict_text(const ClaimRecord& record) {
    return record.reason.empty() ? record.verdict : fmt::format("{}: {}", record.verdict, record.reason);
}

}  // namespace

ClaimRecord record_of(const ClaimResult& result, bool quick, const std::string& key) {
    ClaimRecord record{result.experiment,
                       result.claim.claim,
                       result.claim.source,
                       result.claim.test,
                       measured_text(result.claim, result.measured.summary),
                       range_text(result.claim),
                       to_string(result.verdict),
                       result.reason,
                       {},
                       result.measured.summary.count,
                       result.measured.missing,
                       quick,
                       key};
    for (const std::string& scene : result.measured.scenes())
        record.scenes.emplace_back(scene, scene_text(result.claim, result.measured, scene));
    return record;
}

std::string print_claims_json(const std::vector<ClaimResult>& results, bool quick, const std::string& key) {
    Json json = Json::array();
    for (const ClaimResult& result : results) {
        const ClaimRecord record = record_of(result, quick, key);
        const MeanSummary& summary = result.measured.summary;
        Json entry = {{"experiment", record.experiment},
                      {"claim", record.claim},
                      {"source", record.source},
                      {"test", record.test},
                      {"measured", record.measured},
                      {"range", record.range},
                      {"verdict", record.verdict},
                      {"reason", record.reason},
                      {"mean", number_json(summary.mean)},
                      {"lower", number_json(summary.lower)},
                      {"upper", number_json(summary.upper)},
                      {"cases", record.cases},
                      {"missing", record.missing},
                      {"quick", record.quick},
                      {"key", record.key},
                      {"scenes", Json::array()},
                      {"values", Json::array()}};
        for (const auto& [scene, text] : record.scenes)
            entry["scenes"].push_back({{"scene", scene}, {"measured", text}});
        for (const MeasuredCase& value : result.measured.cases) {
            entry["values"].push_back({{"scene", value.scene},
                                       {"place", value.place},
                                       {"plane", value.plane},
                                       {"truth", value.truth},
                                       {"method", value.method},
                                       {"value", number_json(value.value)}});
        }
        json.push_back(std::move(entry));
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<ClaimRecord> read_claims_json(const std::filesystem::path& file) {
    std::ifstream stream(file);
    try {
        const Json json = Json::parse(stream);
        std::vector<ClaimRecord> records;
        for (const Json& entry : json) {
            ClaimRecord record{entry.at("experiment"), entry.at("claim"),    entry.at("source"),
                               entry.at("test"),       entry.at("measured"), entry.at("range"),
                               entry.at("verdict"),    entry.at("reason"),   {},
                               entry.at("cases"),      entry.at("missing"),  entry.at("quick"),
                               entry.value("key", "")};  // none in files of programs that told none
            for (const Json& scene : entry.at("scenes"))
                record.scenes.emplace_back(scene.at("scene"), scene.at("measured"));
            records.push_back(std::move(record));
        }
        return records;
    } catch (const Json::exception& error) {
        throw ConfigError(fmt::format("'{}' is not a claims file ({}); 'plumbline reproduce' writes them",
                                      file.string(), error.what()));
    }
}

std::string print_claims_text(const std::vector<ClaimRecord>& records) {
    std::string text;
    for (const ClaimRecord& record : records) {
        text += fmt::format("{:<8} {}\n         {}; tested by: {}\n         {}, which has to be {}\n", record.verdict,
                            record.claim, record.source, record.test, record.measured, record.range);
        if (!record.reason.empty()) text += fmt::format("         {}\n", record.reason);
        if (record.missing > 0) text += fmt::format("         {} more could not be measured\n", record.missing);
    }
    return text;
}

std::string print_claims_markdown(const std::vector<ClaimRecord>& records, const std::string& command) {
    std::string text = fmt::format(
        "# Claims, put to the test\n\n"
        "What the texts that this program grew from say and what can be checked: where it stands, how it was tested, "
        "what "
        "was measured and whether it holds. Made by `{}`.\n\n"
        "{} claims: {} hold, {} fail, {} depend on what is seen, {} were not decided, {} could "
        "not be tested.\n\n"
        "000 is Nielsen's thesis (2015), 001 Tohidi Far's paper (2019), 002 OGLdev's tutorial 36, 003 the journal of a "
        "dissertation. A figure is the mean over views, paths or walks (ratios: geometric) with the 95 % interval of "
        "that "
        "mean; a claim holds where the whole interval lies in the range that stands below it, fails where it lies "
        "wholly "
        "outside, depends where it does both or where scenes contradict each other, and is not decided where it does "
        "both though all cases agree: these are too few, or differ too widely. Of scenes with two cases both stand in "
        "place of an interval. Times are those of a software rasteriser; only their ratios are compared.\n\n"
        "| # | claim | where | how it was tested | measured | verdict | experiment |\n|---|---|---|---|---|---|---|\n",
        command, records.size(), count_of(records, ClaimVerdict::holds), count_of(records, ClaimVerdict::fails),
        count_of(records, ClaimVerdict::depends), count_of(records, ClaimVerdict::undecided),
        count_of(records, ClaimVerdict::untested));
    int index = 0;
    bool any_quick = false;
    for (const ClaimRecord& record : records) {
        any_quick |= record.quick;
        text += fmt::format("| {} | {} | {} | {} | {}{}, has to be {}; {} cases{} | **{}**{} | {} |\n", ++index,
                            escape_markdown_cell(record.claim), escape_markdown_cell(record.source),
                            escape_markdown_cell(record.test), escape_markdown_cell(record.measured),
                            record.quick ? " (trial run)" : "", record.range, record.cases,
                            record.missing > 0 ? fmt::format(", {} not measured", record.missing) : "", record.verdict,
                            record.reason.empty() ? "" : ": " + escape_markdown_cell(record.reason), record.experiment);
    }
    text += "\n## Scene by scene\n\n";
    index = 0;
    for (const ClaimRecord& record : records) {
        std::vector<std::string> scenes;
        for (const auto& [scene, measured] : record.scenes) scenes.push_back(fmt::format("{} {}", scene, measured));
        text += fmt::format("{}. {} *{}*: {}\n", ++index, record.claim, verdict_text(record), fmt::join(scenes, "; "));
    }
    if (any_quick) text += "\nSome figures come from trial runs (`--quick`), which prove nothing.\n";
    return text;
}

}  // namespace plumb
