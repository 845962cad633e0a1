#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/generation.h"
#include "experiments/result_files.h"
#include "experiments/run_json.h"
#include "experiments/terminal_table.h"
#include "frames/atomic_file.h"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(double fraction) { return fmt::format("{:.3f}", 100.0 * fraction); }

std::string print_csv(const GenerationResults& results) {
    std::string text =
        "walk,method,pixels_per_frame,wrong,wrong_inside,missing,violations,milliseconds,gbuffer_bytes_per_pixel\n";
    for (const GenerationRow& row : results.rows) {
        text += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", csv_text(row.walk),
                            csv_text(row.method), row.pixels_per_frame, row.wrong, row.inside, row.missing,
                            row.violations, row.milliseconds, row.bytes_per_pixel);
    }
    return text;
}

std::string print_json(const GenerationResults& results) {
    const GenerationExperiment& experiment = results.experiment;
    Json json = run_json(results.command, results.started, results.seconds, results.system);
    json["gl"] = {{"renderer", results.gl_renderer}};
    json["experiment"] = {{"title", experiment.title},
                          {"question", experiment.question},
                          {"resolution", {experiment.width, experiment.height}},
                          {"frames", experiment.frames},
                          {"frames_per_second", experiment.frames_per_second}};
    for (const GenerationWalk& walk : experiment.walks) {
        json["experiment"]["walks"].push_back({{"name", walk.name},
                                               {"scene", walk.scene},
                                               {"path", walk.path},
                                               {"start", walk.start},
                                               {"camera_speed", walk.camera_speed},
                                               {"object_speed", walk.object_speed},
                                               {"minimum_separation", walk.minimum_separation}});
    }
    for (const Method& method : experiment.methods) json["experiment"]["methods"][method.name] = print_method(method);
    json["failures"] = failures_json(results.failures);
    json["rows"] = Json::array();
    for (const GenerationRow& row : results.rows) {
        json["rows"].push_back({{"walk", row.walk},
                                {"method", row.method},
                                {"pixels_per_frame", row.pixels_per_frame},
                                {"wrong", row.wrong},
                                {"wrong_inside", row.inside},
                                {"missing", row.missing},
                                {"violations", row.violations},
                                {"milliseconds", row.milliseconds},
                                {"gbuffer_bytes_per_pixel", row.bytes_per_pixel}});
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string print_generation_table(const GenerationResults& results) {
    using Align = TerminalTable::Align;
    TerminalTable table({{"walk"},
                         {"px/frame", Align::right},
                         {"method"},
                         {"wrong %", Align::right},
                         {"inside %", Align::right},
                         {"missing %", Align::right},
                         {"violations %", Align::right},
                         {"ms", Align::right},
                         {"B/px", Align::right}});
    std::string walk;
    for (const GenerationRow& row : results.rows) {
        if (!walk.empty() && walk != row.walk) table.add_rule();
        walk = row.walk;
        table.add_row({row.walk, fmt::format("{:.2f}", row.pixels_per_frame), row.method, percent(row.wrong),
                       percent(row.inside), percent(row.missing), percent(row.violations),
                       fmt::format("{:.2f}", row.milliseconds), fmt::format("{}", row.bytes_per_pixel)});
    }
    return table.print();
}

void write_generation_files(const GenerationResults& results, const std::filesystem::path& folder) {
    write_text_atomically(folder / "generation.csv", print_csv(results));
    write_text_atomically(folder / "generation.json", print_json(results));
}

}  // namespace plumb
