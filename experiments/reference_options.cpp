#include "experiments/reference_options.h"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/pictures.h"

namespace plumb {
namespace {

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

template <class Number>
struct SampleRange {
    Number from{}, to{};
};

// "FROM..TO"
template <class Number>
std::optional<SampleRange<Number>> parse_range(std::string_view text) {
    const auto dots = text.find("..");
    if (dots == std::string_view::npos) return std::nullopt;
    const auto from = parse_number<Number>(text.substr(0, dots)), to = parse_number<Number>(text.substr(dots + 2));
    if (!from || !to) return std::nullopt;
    return SampleRange<Number>{*from, *to};
}

void read_samples(const std::string& text, ReferenceOptions& options) {
    constexpr int most = 1 << 24;
    const auto fail = [&text](const std::string& message) {
        throw CLI::ValidationError("--samples", fmt::format("{}: {}", text, message));
    };
    SampleRange<int> range;
    options.is_shard = text.find("..") != std::string::npos;
    if (options.is_shard) {
        const auto parsed = parse_range<int>(text);
        if (!parsed) fail("a shard is written FIRST..END, as in 64..128");
        range = *parsed;
    } else {
        const auto parsed = parse_number<int>(text);
        if (!parsed) fail("must be a number, or FIRST..END for a shard");
        range.to = *parsed;
    }
    if (range.from % 2 != 0 || range.to % 2 != 0) fail("must be even, because the reference keeps two halves");
    if (range.from < 0 || range.to <= range.from || range.to > most)
        fail(fmt::format("must lie between {} and {}{}", options.is_shard ? 0 : 2, most,
                         options.is_shard ? ", the end beyond the first" : ""));
    options.settings.first_sample = range.from;
    options.settings.samples = range.to;
}

void read_shutter(const std::string& text, ReferenceOptions& options) {
    const auto range = parse_range<double>(text);
    if (!range || !std::isfinite(range->from) || !std::isfinite(range->to) || !(range->to > range->from)) {
        throw CLI::ValidationError("--shutter", fmt::format("{}: must be OPEN..CLOSE in seconds of scene time, as in "
                                                            "0.5..0.52",
                                                            text));
    }
    options.span = {range->from, range->to};
    options.view.time = range->to;
    options.has_shutter = true;
}

template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        const std::map<std::string, Value>& choices, const std::string& standard,
                        const std::string& description) {
    std::vector<std::string> names;
    names.reserve(choices.size());
    for (const auto& [choice, ignored] : choices) names.push_back(choice);
    return command
        .add_option_function<std::string>(
            name, [&value, choices](const std::string& choice) { value = choices.at(choice); }, description)
        ->check(CLI::IsMember(names))
        ->default_str(standard);
}

void add_samples(CLI::App& command, ReferenceOptions& options) {
    const std::string group = "Samples";
    CLI::Option* samples = command
                               .add_option_function<std::string>(
                                   "--samples", [&options](const std::string& text) { read_samples(text, options); },
                                   "Samples per pixel (even), the most with a target error; or a shard, samples "
                                   "FIRST to END - 1 of every pixel")
                               ->type_name("N|FIRST..END")
                               ->default_str(fmt::format("{}", options.settings.samples))
                               ->group(group);
    CLI::Option* target =
        command.add_option("--target-error", options.settings.target_error, "Stop below this relative standard error")
            ->check(CLI::Range(0.0, 1.0))
            ->group(group);
    command.add_option("--seed", options.settings.seed, "Seed of the samples")->capture_default_str()->group(group);
    add_choice<SamplePoints>(command, "--points", options.settings.points,
                             {{"sobol", SamplePoints::sobol}, {"random", SamplePoints::random}}, "sobol",
                             "Owen-scrambled Sobol points, or independent random ones to compare with")
        ->group(group);
    command
        .add_option("--merge", options.merge,
                    "Join shards that follow each other from sample 0 on: the bits of one run")
        ->type_name("SHARD...")
        ->check(CLI::ExistingFile)
        ->excludes(samples)
        ->excludes(target)
        ->group(group);
    command.add_option("--threads", options.threads, "Threads; 0: all")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->group(group);
}

// Returns the option of how emitters are sampled.
CLI::Option* add_light_paths(CLI::App& command, ReferenceOptions& options) {
    const std::string group = "Light paths";
    command
        .add_option("--roulette", options.settings.roulette_after,
                    "Bounces before paths may end at random (unbiased); 0: all paths go on to the last bounce")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->group(group);
    return add_choice<EmitterSampling>(command, "--emitters", options.settings.emitter_sampling,
                                       {{"lights", EmitterSampling::lights},
                                        {"directions", EmitterSampling::directions},
                                        {"both", EmitterSampling::both}},
                                       "both",
                                       "How emissive surfaces and the environment are found; the "
                                       "expectation is the same")
        ->group(group);
}

void add_camera(CLI::App& command, ReferenceOptions& options) {
    const std::string group = "Camera";
    command.add_flag("--antialias", options.settings.antialias, "Spread primary rays over the pixel")->group(group);
    command
        .add_option_function<std::string>(
            "--shutter", [&options](const std::string& text) { read_shutter(text, options); },
            "Seconds of scene time that the shutter is open; moving objects and a --path's camera blur")
        ->type_name("OPEN..CLOSE")
        ->excludes(command.get_option("--time"))
        ->group(group);
    command
        .add_option("--separation", options.settings.minimum_separation,
                    "Metres between layers, of layer2.* planes and of the oracle")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->group(group);
}

void add_oracle(CLI::App& command, CLI::Option* emitters, ReferenceOptions& options) {
    const std::string group = "Oracle: the best that a method could make of what the view's layers hold";
    CLI::Option* oracle =
        command
            .add_option("--oracle", options.oracle_layers, "Rays meet only the first K layers; 0: all that is in view")
            ->type_name("K")
            ->check(CLI::Range(0, 99))
            ->excludes(emitters)  // an oracle always samples the lights
            ->group(group);
    command
        .add_option("--oracle-guard-band", options.oracle_guard_band, "Pixels that the layers go on beyond each edge")
        ->type_name("PIXELS")
        ->check(CLI::Range(0, 16384))
        ->needs(oracle)
        ->group(group);
}

bool needs_quotes(const std::string& argument) {
    return argument.empty() ||
           argument.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%") !=
               std::string::npos;
}

std::string shard_stem(const ReferenceOptions& options, const View& view) {
    return fmt::format("{}_{}", file_name_of(options.view.scene), file_name_of(view.camera().name));
}

}  // namespace

void ReferenceOptions::add_to(CLI::App& command) {
    view.add_to(command, {"ao", "direct", "indirect", "total"});
    command.get_option("--planes")
        ->description(
            "Planes to render, separated by commas: ao, direct, indirect, indirect.K, irradiance, reflection, "
            "emission, total, and depth, normal, albedo, position, motion, seen_before, instance, also as layer2.depth "
            "and so on");

    add_samples(command, *this);
    CLI::Option* emitters = add_light_paths(command, *this);
    add_camera(command, *this);
    add_oracle(command, emitters, *this);
}

ReferenceSettings ReferenceOptions::settings_for(const Scene& scene, const View& view_at_end) const {
    ReferenceSettings result = settings;
    result.quantities = view.read_quantities();
    if (oracle_layers >= 0) {
        result.oracle = {view_at_end.with_guard_band(oracle_guard_band), oracle_layers, settings.minimum_separation};
    }
    if (has_shutter) {
        // Also where the camera stands still: it tells the path tracer that samples have a time.
        result.view_at_shutter_opening = view.make_view(scene, span.begin);
        result.previous_view = result.view_at_shutter_opening;
    }
    return result;
}

std::filesystem::path ReferenceOptions::shard_file(const View& view_at_end) const {
    return view.output /
           fmt::format("{}.{}-{}.shard", shard_stem(*this, view_at_end), settings.first_sample, settings.samples);
}

std::string merge_command(const std::vector<std::string>& arguments, const ReferenceOptions& options,
                          const View& view) {
    std::string command = "plumbline";
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (arguments[i].starts_with("--samples=")) continue;
        if (arguments[i] == "--samples") {
            ++i;
            continue;
        }
        command += needs_quotes(arguments[i]) ? fmt::format(" '{}'", arguments[i]) : " " + arguments[i];
    }
    return fmt::format("{} --merge {}.*.shard", command, (options.view.output / shard_stem(options, view)).string());
}

}  // namespace plumb
