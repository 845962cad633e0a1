// `plumbline compare`: how far two images are apart.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/command.h"
#include "experiments/exit_code.h"
#include "experiments/gate.h"
#include "experiments/terminal_table.h"
#include "frames/image_file.h"
#include "frames/picture.h"
#include "metrics/comparison.h"
#include "metrics/error_image.h"

namespace plumb {
namespace {

constexpr const char* examples = R"(Examples:
  plumbline compare ours.exr truth.exr
  plumbline compare ours.png theirs.png --data-range 1 --json
  plumbline compare ours.exr truth.exr --heat-map out/errors
  plumbline compare ours.exr truth.exr --fail-above rmse=0.01,p95=0.05 --fail-below psnr=35    a gate: exits with 1
The second image is the reference. Where it has half-buffers (as 'plumbline reference' writes them) the unbiased_* measures
are free of its noise.)";

struct Options {
    std::filesystem::path test, reference, heat_maps;
    std::string fail_above, fail_below;
    double data_range = 0.0, heat_map_scale = 0.0;
    std::optional<FlipRange> flip;
    bool json = false;
};

std::string print_comparison(const FrameComparison& comparison) {
    std::vector<TerminalTable::Column> columns = {{"measure"}};
    for (const PlaneComparison& plane : comparison.planes)
        columns.push_back({plane.plane, TerminalTable::Align::right});
    TerminalTable table(columns);
    for (const std::string& name : measure_names()) {
        std::vector<std::string> cells = {name};
        bool exists = false;
        for (const PlaneComparison& plane : comparison.planes) {
            const double value = plane.measure(name);
            exists |= !std::isnan(value);
            cells.push_back(std::isnan(value) ? "-" : fmt::format("{:.6g}", value));
        }
        if (exists) table.add_row(std::move(cells));
    }
    return table.print();
}

nlohmann::ordered_json json_of(const Options& options, const FrameComparison& comparison,
                               const std::vector<std::string>& failed) {
    nlohmann::ordered_json json = {{"test", options.test.string()}, {"reference", options.reference.string()}};
    json["planes"] = nlohmann::ordered_json::object();
    for (const PlaneComparison& plane : comparison.planes) {
        for (const auto& [name, value] : plane.measures()) {
            auto& entry = json["planes"][plane.plane][name];
            // JSON has no infinity; PSNR of equal images is one.
            if (std::isfinite(value))
                entry = value;
            else if (std::isinf(value))
                entry = value > 0 ? "inf" : "-inf";
        }
    }
    json["only_in_test"] = comparison.only_in_test;
    json["only_in_reference"] = comparison.only_in_reference;
    json["breaches"] = failed;
    return json;
}

void write_heat_maps(const Options& options, const FrameComparison& comparison, const Frame& test,
                     const Frame& reference) {
    for (const PlaneComparison& plane : comparison.planes) {
        const Image error = mean_of_channels(absolute_error(test.plane(plane.plane), reference.plane(plane.plane)));
        double scale = options.heat_map_scale;
        if (scale <= 0.0) scale = value_percentile(error, 0.99);
        if (!(scale > 0.0)) scale = 1.0;  // equal images: a black map
        const auto file = options.heat_maps / fmt::format("{}.error.png", plane.plane);
        write_png(file, apply_colour_map(error, ColourMap::inferno, 0.0f, static_cast<float>(scale)));
        fmt::print(stderr, "{}: |difference| from 0 (black) to {:.4g} (yellow)\n", file.string(), scale);
    }
}

// Whether a file holds what a screen shows, not radiance.
bool is_displayed(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".bmp" ||
           extension == ".tga";
}

int compare(const Options& options) {
    std::vector<Limit> limits = parse_limits(options.fail_above, true);
    for (const Limit& limit : parse_limits(options.fail_below, false)) limits.push_back(limit);
    const Frame test = read_frame(options.test), reference = read_frame(options.reference);
    ComparisonSettings settings;
    if (options.data_range > 0.0) settings.data_range = options.data_range;
    const bool both_displayed = is_displayed(options.test) && is_displayed(options.reference);
    settings.flip = options.flip.value_or(both_displayed ? FlipRange::displayed : FlipRange::by_plane);
    const FrameComparison comparison = compare_frames(test, reference, settings);
    const std::vector<std::string> failed = breaches(comparison, limits);

    if (options.json) {
        fmt::print("{}\n",
                   json_of(options, comparison, failed).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else {
        fmt::print("{}", print_comparison(comparison));
        if (!comparison.only_in_test.empty())
            fmt::print("only in '{}': {}\n", options.test.string(), fmt::join(comparison.only_in_test, ", "));
        if (!comparison.only_in_reference.empty()) {
            fmt::print("only in '{}': {}\n", options.reference.string(), fmt::join(comparison.only_in_reference, ", "));
        }
    }
    if (!options.heat_maps.empty()) write_heat_maps(options, comparison, test, reference);
    for (const std::string& line : failed) fmt::print(stderr, "plumbline: {}\n", line);
    return failed.empty() ? exit_fine : exit_failed;
}

}  // namespace

void add_compare_command(CLI::App& app, const CommonOptions&, Action& action) {
    CLI::App* command = app.add_subcommand("compare", "Measure how far two images are apart")->group("Measure");
    auto options = std::make_shared<Options>();
    command->add_option("test", options->test, "Image to judge: EXR, PNG, HDR...")->required()->type_name("FILE");
    command->add_option("reference", options->reference, "Image to judge it by")->required()->type_name("FILE");
    command->add_flag("--json", options->json, "Print JSON instead of a table");
    command->add_option("--heat-map", options->heat_maps, "Folder for one error map per plane")->type_name("FOLDER");
    command
        ->add_option("--heat-map-scale", options->heat_map_scale,
                     "Error that is shown brightest; the 99th percentile by default")
        ->check(CLI::PositiveNumber);
    command->add_option("--data-range", options->data_range, "Peak of PSNR and range of SSIM; per plane by default")
        ->check(CLI::PositiveNumber);
    command
        ->add_option(
            "--flip", options->flip,
            "FLIP of values that a screen shows (displayed), of radiance over the exposures that the reference "
            "needs (radiance), by the kind of plane (by-plane), or none. Default: displayed for two PNG or "
            "JPEG files, by-plane for all others")
        ->transform(CLI::CheckedTransformer(std::map<std::string, FlipRange>{{"displayed", FlipRange::displayed},
                                                                             {"radiance", FlipRange::radiance},
                                                                             {"by-plane", FlipRange::by_plane},
                                                                             {"none", FlipRange::none}}))
        ->type_name("RANGE");
    command->add_option("--fail-above", options->fail_above, "Exit with 1 where a measure is above: rmse=0.01,p95=0.05")
        ->type_name("LIMITS");
    command->add_option("--fail-below", options->fail_below, "Exit with 1 where a measure is below: psnr=35,ssim=0.95")
        ->type_name("LIMITS");
    command->footer(examples);
    command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace plumb
