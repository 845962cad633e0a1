// `plumbline compare`: how far two images, or two folders of frames, are apart.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/command.h"
#include "experiments/config_error.h"
#include "experiments/error_maps.h"
#include "experiments/exit_code.h"
#include "experiments/gate_options.h"
#include "experiments/image_pairs.h"
#include "experiments/sequence_comparison.h"
#include "experiments/sequence_report.h"
#include "frames/image_file.h"

namespace plumb {
namespace {

constexpr const char* compare_examples = R"help(Examples:
  plumbline compare ours.exr truth.exr
  plumbline compare ours.png theirs.png --data-range 1 --json
  plumbline compare ours.exr truth.exr --heat-map out/errors --map flip
  plumbline compare ours.exr truth.exr --regions --fail-above rmse@silhouettes=0.05
  plumbline compare ours.exr truth.exr --fail-above rmse=0.01,p95=0.05 --fail-below psnr=35    a gate: exits with 1
  plumbline compare ours/ truth/ --fail-above rmse=0.01,flicker=0.004
The second image is the reference. Where it has half-buffers (as 'plumbline reference' writes them) the unbiased_* measures
are free of its noise, and of that of the first where that has half-buffers too. "(?)" marks errors that the noise is too
near to. Brackets hold 95 % intervals, drawn over blocks of the image and over frames; limits hold for their ends too, such as
rmse_upper=0.01.
Of two folders the frames that share a name are compared. A gate then looks at all of them together: rmse is the root of
the mean squared error of all frames, maximum the largest, others are means. Where the references have planes motion (to
the frame before), position and depth there is also flicker, warping and temporal_variance.
Where both have a plane depth their G-buffers are compared, layer by layer: hit_agreement, agreement, depth_error_*,
normal_angle_* (degrees), albedo_error_* and motion_error_* (pixels), with * mean, median, p95, p99 or maximum.)help";

struct CompareCommandOptions {
    std::filesystem::path test, reference, heat_maps;
    GateOptions gate;
    double data_range = 0.0, heat_map_scale = 0.0;
    std::optional<FlipRange> flip;
    double pixels_per_degree = flip_pixels_per_degree;
    std::string exposures;
    ErrorMapKind map = ErrorMapKind::difference;
    bool regions = false, json = false;
};

// "-4..3": one exposure a stop, two at least.
ExposureRange parse_exposures(const std::string& text) {
    const auto dots = text.find("..");
    const auto number = [&](std::string_view part) {
        double value = 0.0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        const bool whole = error == std::errc() && end == part.data() + part.size() && std::isfinite(value);
        return whole ? std::optional(value) : std::nullopt;
    };
    const std::string_view whole = text;
    const auto first = number(whole.substr(0, dots));
    const auto last = dots == std::string::npos ? std::nullopt : number(whole.substr(dots + 2));
    if (!first || !last || *last < *first || *last - *first > 100.0)
        throw ConfigError(fmt::format("--exposures '{}': write the first and the last in stops, such as -4..3", text));
    return {*first, *last, std::max(2, static_cast<int>(std::ceil(*last - *first)))};
}

SequenceSettings settings_of(const CompareCommandOptions& options, const ImagePair& first) {
    SequenceSettings settings;
    settings.regions = options.regions;
    if (options.data_range > 0.0) settings.comparison.data_range = options.data_range;
    const bool both_displayed = is_displayed_name(first.test) && is_displayed_name(first.reference);
    settings.comparison.pixels_per_degree = options.pixels_per_degree;
    if (!options.exposures.empty()) settings.comparison.exposures = parse_exposures(options.exposures);
    settings.comparison.flip = options.flip.value_or(both_displayed ? FlipRange::displayed : FlipRange::by_plane);
    return settings;
}

void write_heat_maps(const CompareCommandOptions& options, const ImagePairs& images,
                     const SequenceComparison& comparison) {
    auto scales = error_map_scales(comparison.frames(), options.heat_map_scale, options.map);
    const ComparisonSettings settings = settings_of(options, images.pairs.front()).comparison;
    std::set<std::string> shown;
    for (const ImagePair& pair : images.pairs) {
        const Frame test = read_frame(pair.test), reference = read_frame(pair.reference);
        for (const auto& [plane, scale] : scales) {
            if (!test.has(plane) || !reference.has(plane)) continue;
            const std::string name =
                images.pairs.size() == 1 ? plane : fmt::format("{}.{}", pair.test.stem().string(), plane);
            const auto map = error_map(options.map, test.plane(plane), reference.plane(plane), plane, settings);
            if (!map) continue;
            write_error_map(options.heat_maps / fmt::format("{}.{}.png", name, name_of(options.map)), *map, scale);
            shown.insert(plane);
        }
    }
    std::erase_if(scales, [&](const auto& entry) { return !shown.contains(entry.first); });
    fmt::print(stderr, "{}\n{}", options.heat_maps.string(), error_map_legend(scales, options.map));
}

void print_only_in(const std::filesystem::path& where, const std::vector<std::string>& names) {
    if (!names.empty()) fmt::print("only in '{}': {}\n", where.string(), fmt::join(names, ", "));
}

int compare(const CompareCommandOptions& options) {
    const std::vector<Limit> limits = options.gate.limits();
    const ImagePairs images = find_pairs(options.test, options.reference);
    SequenceComparison comparison(settings_of(options, images.pairs.front()));
    for (const ImagePair& pair : images.pairs) {
        const Frame test = read_frame(pair.test);
        comparison.add(pair.name, test, read_frame(pair.reference));
    }
    const std::vector<MeasuredThing> whole = comparison.whole();
    const std::vector<std::string> failed = breaches(whole, limits);
    const bool sequence = images.pairs.size() > 1;

    if (options.json) {
        nlohmann::ordered_json json = {{"test", options.test.string()}, {"reference", options.reference.string()}};
        json.update(json_of(whole));
        if (sequence) json["frames"] = json_of(comparison.frames());
        json["only_in_test"] = comparison.only_in_test();
        json["only_in_reference"] = comparison.only_in_reference();
        json["frames_only_in_test"] = images.only_in_test;
        json["frames_only_in_reference"] = images.only_in_reference;
        json["breaches"] = failed;
        fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else {
        if (sequence) fmt::print("{}\nAll {} frames\n", print_frames(comparison.frames(), whole), images.pairs.size());
        fmt::print("{}", print_measures(whole));
        print_only_in(options.test, comparison.only_in_test());
        print_only_in(options.reference, comparison.only_in_reference());
        print_only_in(options.test, images.only_in_test);
        print_only_in(options.reference, images.only_in_reference);
    }
    if (!options.heat_maps.empty()) write_heat_maps(options, images, comparison);
    for (const std::string& line : failed) fmt::print(stderr, "plumbline: {}\n", line);
    return failed.empty() ? exit_fine : exit_failed;
}

}  // namespace

void add_compare_command(CLI::App& app, const CommonOptions&, Action& action) {
    CLI::App* command =
        app.add_subcommand("compare", "Measure how far two images, or folders of frames, are apart")->group("Measure");
    auto options = std::make_shared<CompareCommandOptions>();
    command->add_option("test", options->test, "Image to judge (EXR, PNG, HDR...), or a folder of them")
        ->required()
        ->type_name("FILE|FOLDER");
    command->add_option("reference", options->reference, "What to judge it by")->required()->type_name("FILE|FOLDER");
    command->add_flag("--json", options->json, "Print JSON instead of tables");
    command->add_flag("--regions", options->regions,
                      "Also over silhouettes, newly_seen, second_layer, border and rest; the reference needs planes "
                      "depth and normal");
    command
        ->add_option("--heat-map", options->heat_maps, "Folder for one error map per plane, and per frame of a folder")
        ->type_name("FOLDER");
    command->add_option("--map", options->map, "What the maps show: difference, flip or ssim (1 - SSIM)")
        ->transform(CLI::CheckedTransformer(std::map<std::string, ErrorMapKind>{
            {"difference", ErrorMapKind::difference}, {"flip", ErrorMapKind::flip}, {"ssim", ErrorMapKind::ssim}}))
        ->type_name("KIND");
    command
        ->add_option("--heat-map-scale", options->heat_map_scale,
                     "Error that is shown brightest; by default just above the 99th percentile of differences, 1 of "
                     "FLIP and SSIM")
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
    command
        ->add_option("--pixels-per-degree", options->pixels_per_degree,
                     "Of the screen and its viewer, for FLIP; 67.02 by default: 3840 pixels over 0.7 m seen from 0.7 m")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--exposures", options->exposures,
                     "Stops between which FLIP of radiance is taken, one exposure each, such as -4..3; by default what "
                     "shows the reference from its brightest to its median pixel")
        ->type_name("A..B");
    options->gate.add_to(*command);
    command->footer(compare_examples);
    command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace plumb
