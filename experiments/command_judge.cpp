// `plumbline judge`: frames of any other renderer, held against the path tracer's truth of the same cameras.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/cache_option.h"
#include "experiments/command.h"
#include "experiments/config_error.h"
#include "experiments/exit_code.h"
#include "experiments/foreign_frame.h"
#include "experiments/gate_options.h"
#include "experiments/image_pairs.h"
#include "experiments/interruption.h"
#include "experiments/judge.h"
#include "experiments/sequence_report.h"
#include "experiments/view_options.h"
#include "frames/atomic_file.h"
#include "frames/image_error.h"
#include "frames/image_file.h"

namespace plumb {
namespace {

constexpr const char* judge_examples = R"help(Examples:
  plumbline judge --scene clutter --path slide --frames 30 --size 480 270 --export-cameras cameras.json
  plumbline judge frames/ --scene clutter --path slide --planes total,ao --ao-radius 0.3
  plumbline judge image.exr --scene cornell --view front --regions --fail-above rmse=0.02,rmse@silhouettes=0.1
  plumbline judge frames/ --scene hall.toml --path walk --rename ViewLayer.DiffInd=indirect --fail-above flicker=0.004
Render the frames with the cameras that --export-cameras writes, one file per frame, named in their order (numbers count
as numbers), in linear Rec.709 radiance, nothing tone-mapped. Pixel centres are at (i + 0.5, j + 0.5), and primary rays go
through them unless you say --antialias.
Channels as tev and Nuke show them: R, G, B without a layer are the plane total; ao.Y (or ao.R, ao.G, ao.B, all equal) is
ao; direct.R.. is direct; likewise indirect, indirect.1.., irradiance, reflection, emission. Of the G-buffer, where
--planes names them: depth.Z (metres along the view axis), normal.X.. (world space), albedo.R.. Names count in any case;
--rename THEIRS=OURS takes others. Without --planes, all planes of light that the first file has are judged.
The truth's noise decides what can be told: "(?)" marks errors that it is too near to, and a line says how many samples
would do. Truths are kept, so that the next build is judged in seconds.)help";

struct JudgeCommandOptions {
    std::filesystem::path images, export_cameras, heat_maps, cache;
    JudgeSettings judge;
    ViewOptions quantities;  // its quantities alone
    std::vector<int> size;
    int frames = 0;
    std::vector<std::string> rename;
    GateOptions gate;
    double heat_map_scale = 0.0;
    bool json = false;
};

std::vector<std::filesystem::path> files_of(const std::filesystem::path& images) {
    if (images.empty()) return {};
    if (std::filesystem::is_directory(images)) return images_in(images);
    return {images};
}

// What the first file says: the size of all frames, and the planes, unless options do.
void read_first(const std::filesystem::path& file, const JudgeCommandOptions& options, JudgeSettings& settings) {
    const Frame first = with_our_names(read_frame(file), settings.renamings, file.string());
    settings.cameras.width = first.width(), settings.cameras.height = first.height();
    if (!options.size.empty() && (options.size[0] != first.width() || options.size[1] != first.height())) {
        throw ImageError(fmt::format("{}: is {}x{}, not {}x{} as --size says", file.string(), first.width(),
                                     first.height(), options.size[0], options.size[1]));
    }
    if (!settings.planes.empty()) return;
    std::ranges::copy_if(first.plane_names(), std::back_inserter(settings.planes), is_light_plane);
    if (settings.planes.empty()) {
        throw ImageError(fmt::format("{}: no plane of light among {}; name those to judge with --planes and --rename",
                                     file.string(), fmt::join(first.plane_names(), ", ")));
    }
}

JudgeSettings settings_of(const JudgeCommandOptions& options, const std::vector<std::filesystem::path>& files) {
    JudgeSettings settings = options.judge;
    settings.renamings = parse_renamings(options.rename);
    settings.reference.quantities = options.quantities.read_quantities();
    settings.stop = &interruption_flag();
    CameraSequence& cameras = settings.cameras;
    if (!files.empty()) {
        read_first(files.front(), options, settings);
        cameras.frames = static_cast<int>(files.size());
        if (options.frames > 0 && options.frames != cameras.frames) {
            throw ImageError(fmt::format("'{}' holds {} images, not {} as --frames says", options.images.string(),
                                         cameras.frames, options.frames));
        }
    } else {
        cameras.frames = std::max(options.frames, 1);
        if (!options.size.empty()) cameras.width = options.size[0], cameras.height = options.size[1];
    }
    return settings;
}

// To standard error, so that standard output is JSON alone where that was asked for.
void print_cameras(const Scene& scene, const JudgeSettings& settings) {
    const CameraSequence& cameras = settings.cameras;
    const bool several = cameras.frames > 1;
    fmt::print(stderr, "{}, {}: {} frame{} of {}x{}{}\n", settings.scene, cameras.place(scene), cameras.frames,
               several ? "s" : "", cameras.width, cameras.height,
               several ? fmt::format(", from {} s at {} per second", cameras.start, cameras.frames_per_second) : "");
    fmt::print(stderr, "{}: {}\n", several ? "first camera" : "camera",
               describe_camera(cameras.view_at(scene, 0).camera()));
    if (several && !cameras.path.empty()) {
        fmt::print(stderr, "last camera: {}\n", describe_camera(cameras.view_at(scene, cameras.frames - 1).camera()));
    }
}

nlohmann::ordered_json json_of(const JudgeSettings& settings, const Judge& judge,
                               const std::vector<MeasuredThing>& whole, const std::vector<std::string>& failed) {
    const CameraSequence& cameras = settings.cameras;
    nlohmann::ordered_json json = {{"scene", settings.scene}};
    if (!cameras.path.empty()) json["path"] = cameras.path;
    if (!cameras.view.empty()) json["view"] = cameras.view;
    json["start"] = cameras.start;
    json["frames_per_second"] = cameras.frames_per_second;
    json.update(json_of(whole));
    json["frames"] = json_of(judge.comparison().frames());
    json["noise_warnings"] = judge.noise_warnings();
    json["breaches"] = failed;
    return json;
}

int judge(const JudgeCommandOptions& options, const CommonOptions& common) {
    const std::vector<Limit> limits = options.gate.limits();
    const auto files = files_of(options.images);
    if (files.empty() && options.export_cameras.empty())
        throw ConfigError("name the frames to judge, or --export-cameras FILE for the cameras to render them with");
    const JudgeSettings settings = settings_of(options, files);
    const Scene scene = SceneFinder(common.scenes_dirs).load(settings.scene);
    print_cameras(scene, settings);
    if (!options.export_cameras.empty()) {
        write_text_atomically(options.export_cameras,
                              cameras_json(scene, settings.scene, settings.cameras).dump(2) + "\n");
        fmt::print(stderr, "{}\n", options.export_cameras.string());
    }
    if (files.empty()) return exit_fine;

    const ReferenceCache cache(options.cache);
    ProgressLine progress;
    Judge judge(scene, files, settings, cache, progress);
    const bool finished = judge.run();
    progress.clear();
    if (!finished) {
        fmt::print("Interrupted; truths that were finished are kept.\n");
        return exit_interrupted;
    }
    const std::vector<MeasuredThing> whole = judge.comparison().whole();
    const std::vector<std::string> failed = breaches(whole, limits);
    if (options.json) {
        fmt::print(
            "{}\n",
            json_of(settings, judge, whole, failed).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else {
        if (files.size() > 1)
            fmt::print("{}\nAll {} frames\n", print_frames(judge.comparison().frames(), whole), files.size());
        fmt::print("{}", print_measures(whole));
    }
    if (!options.heat_maps.empty()) {
        const std::string legend = judge.write_error_maps(options.heat_maps, options.heat_map_scale);
        progress.clear();
        fmt::print(stderr, "{}\n{}", options.heat_maps.string(), legend);
    }
    for (const std::string& line : judge.noise_warnings()) fmt::print(stderr, "{}\n", line);
    for (const std::string& line : failed) fmt::print(stderr, "plumbline: {}\n", line);
    return failed.empty() ? exit_fine : exit_failed;
}

void add_camera_options(CLI::App& command, JudgeCommandOptions& options) {
    const std::string group = "Cameras";
    CameraSequence& cameras = options.judge.cameras;
    command.add_option("--scene", options.judge.scene, "Built-in scene, scene of the scenes folder, or file")
        ->required()
        ->type_name("SCENE")
        ->group(group);
    CLI::Option* view =
        command.add_option("--view", cameras.view, "Camera that stands still; the scene's first by default")
            ->type_name("NAME")
            ->group(group);
    command.add_option("--path", cameras.path, "Camera path")->type_name("NAME")->excludes(view)->group(group);
    command.add_option("--start", cameras.start, "Seconds of scene time of the first frame")
        ->check(CLI::Number)
        ->capture_default_str()
        ->group(group);
    command.add_option("--frames-per-second", cameras.frames_per_second, "Frames per second of scene time")
        ->check(CLI::PositiveNumber)
        ->capture_default_str()
        ->group(group);
    command.add_option("--frames", options.frames, "Frames; as many as there are files by default")
        ->check(CLI::PositiveNumber)
        ->group(group);
    command.add_option("--size", options.size, "Width and height in pixels; those of the first file by default")
        ->expected(2)
        ->check(CLI::Range(1, 16384))
        ->group(group);
    command.add_option("--export-cameras", options.export_cameras, "Write the cameras of all frames as JSON")
        ->type_name("FILE")
        ->group(group);
}

void add_truth_options(CLI::App& command, JudgeCommandOptions& options) {
    const std::string group = "Truth";
    ReferenceSettings& settings = options.judge.reference;
    command.add_option("--samples", settings.samples, "Samples per pixel (even), the most with a target error")
        ->check(CLI::Range(2, 1 << 24))
        ->capture_default_str()
        ->group(group);
    command.add_option("--target-error", settings.target_error, "Stop below this relative standard error")
        ->check(CLI::Range(0.0, 1.0))
        ->group(group);
    command.add_option("--seed", settings.seed, "Seed of the samples")->capture_default_str()->group(group);
    command.add_flag("--antialias", settings.antialias, "Spread primary rays over the pixel")->group(group);
    command
        .add_option("--separation", settings.minimum_separation,
                    "Metres between layers, for the region second_layer and planes layer2.*")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->group(group);
    command.add_option("--threads", options.judge.threads, "Threads; 0: all")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->group(group);
}

}  // namespace

void add_judge_command(CLI::App& app, const CommonOptions& common, Action& action) {
    CLI::App* command =
        app.add_subcommand("judge", "Judge another renderer's frames by the path tracer's truth")->group("Measure");
    auto options = std::make_shared<JudgeCommandOptions>();
    command->add_option("images", options->images, "Image, or folder with one image per frame")
        ->type_name("FILE|FOLDER")
        ->check(CLI::ExistingPath);
    command->add_option("--planes", options->judge.planes, "Planes to judge, separated by commas")->delimiter(',');
    command->add_option("--rename", options->rename, "Take their plane for ours (repeatable)")
        ->type_name("THEIRS=OURS")
        ->allow_extra_args(false);
    command->add_flag("--regions", options->judge.comparison.regions,
                      "Also over silhouettes, newly_seen, second_layer, border and rest");
    command->add_flag("--json", options->json, "Print JSON instead of tables");
    command->add_option("--heat-map", options->heat_maps, "Folder for one error map per frame and plane")
        ->type_name("FOLDER");
    command
        ->add_option("--heat-map-scale", options->heat_map_scale,
                     "Error that is shown brightest; just above the 99th percentile by default")
        ->check(CLI::PositiveNumber);
    options->gate.add_to(*command);
    add_camera_options(*command, *options);
    add_truth_options(*command, *options);
    add_cache_option(*command, options->cache);
    options->quantities.add_quantities_to(*command);
    options->judge.comparison.comparison.flip = FlipRange::by_plane;
    command->footer(judge_examples);
    command->callback([options, &common, &action] { action = [options, &common] { return judge(*options, common); }; });
}

}  // namespace plumb
