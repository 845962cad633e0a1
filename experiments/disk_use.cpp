#include "experiments/disk_use.h"

#include <fmt/format.h>

#include "experiments/view_truths.h"
#include "frames/image_error.h"
#include "scenes/scene_error.h"

namespace plumb {
namespace {

std::uintmax_t channels_of(const std::string& plane) {
    return plane == "ao" || plane.ends_with("depth") ? 1 : plane == "motion" ? 2 : 3;
}

std::string gigabytes(std::uintmax_t bytes) { return fmt::format("{:.2g} GB", static_cast<double>(bytes) * 1e-9); }

// Of a scene that cannot be loaded there will be none, but a failure on record.
std::uintmax_t view_count(const ExperimentScene& entry, LoadedScenes& scenes) {
    if (!entry.views.empty()) return entry.views.size();
    try {
        return scenes.load(entry.scene).cameras.size();
    } catch (const SceneError&) {
        return 0;
    }
}

// The nearest folder that is there: the one that is asked for may not be made yet.
std::uintmax_t free_space(std::filesystem::path folder) {
    folder = std::filesystem::absolute(folder);
    while (!std::filesystem::exists(folder) && folder.has_relative_path()) folder = folder.parent_path();
    return std::filesystem::space(folder).available;
}

}  // namespace

DiskUse disk_use(const Experiment& experiment, LoadedScenes& scenes, bool write_frames) {
    const auto pixels = static_cast<std::uintmax_t>(experiment.width) * static_cast<std::uintmax_t>(experiment.height);
    constexpr std::uintmax_t planes_of_truth = 4;  // itself, its halves, its variance
    std::uintmax_t full = 0, limited = 0;          // bytes of one image of every plane
    for (const std::string& plane : experiment.planes) {
        const std::uintmax_t bytes = pixels * channels_of(plane) * sizeof(float);
        full += bytes;
        if (has_limited_truth(plane)) limited += bytes;
    }
    const std::uintmax_t methods = experiment.methods.size(),
                         oracles = experiment.oracle_layers.size() + experiment.oracle_bounces.size();
    const auto seeds = static_cast<std::uintmax_t>(experiment.seeds);
    const std::uintmax_t curve = experiment.path_tracer_samples.size();
    DiskUse use;
    for (const ExperimentScene& entry : experiment.scenes) {
        const std::uintmax_t views = view_count(entry, scenes);
        std::uintmax_t frames = 0;
        for (const ExperimentPath& path : entry.paths) frames += static_cast<std::uintmax_t>(path.frames);
        use.cache += planes_of_truth * ((views + frames) * (1 + oracles) * full + views * limited);
        use.output += views * (methods * seeds + curve) * full + frames * methods * full;  // cells
        if (write_frames) use.output += views * (planes_of_truth * (full + limited) + methods * full);
        // Pictures: a byte or less per value, of truths, methods and error maps.
        use.output += (views + frames) * (2 * methods + 1) * full / sizeof(float);
        // The values of truths and methods, as half floats.
        use.output += views * (methods + oracles + 1) * full / 2;
    }
    return use;
}

std::string print_disk_use(const DiskUse& use) {
    return fmt::format("at most {} of references and {} of results", gigabytes(use.cache), gigabytes(use.output));
}

std::string describe_disk_use(const DiskUse& use, const std::filesystem::path& cache,
                              const std::filesystem::path& output) {
    const std::uintmax_t cache_free = free_space(cache), output_free = free_space(output);
    for (const auto& [needed, available, folder, option] : {std::tuple{use.cache, cache_free, cache, "--cache-dir"},
                                                            std::tuple{use.output, output_free, output, "--output"}}) {
        if (needed <= available) continue;
        throw ImageError(
            fmt::format("the run may need {} in '{}', where only {} are free; make room or name another "
                        "folder with {}",
                        gigabytes(needed), folder.string(), gigabytes(available), option));
    }
    return fmt::format("Disk: at most {} of references in '{}' ({} free), {} in '{}' ({} free)", gigabytes(use.cache),
                       cache.string(), gigabytes(cache_free), gigabytes(use.output), output.string(),
                       gigabytes(output_free));
}

}  // namespace plumb
