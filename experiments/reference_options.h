// What `plumbline reference` is told, and what it makes of it for the path tracer.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/view_options.h"
#include "pathtracer/reference.h"

namespace plumb {

struct ReferenceOptions {
    ViewOptions view;            // its time is the shutter's closing
    ReferenceSettings settings;  // what options name without further ado; the rest is filled in by settings_for()
    TimeSpan span;               // that the shutter is open; empty: an instant
    bool has_shutter = false;
    bool is_shard = false;      // only the samples from settings.first_sample on, into a file to be merged
    int oracle_layers = -1;     // -1: no oracle
    int oracle_guard_band = 0;  // pixels
    std::vector<std::filesystem::path> merge;  // shards
    int threads = 0;                           // 0: all

    void add_to(CLI::App& command);
    // The path tracer's settings for `view`, which is make_view() of `scene`.
    ReferenceSettings settings_for(const Scene& scene, const View& view) const;

    // OUTPUT/SCENE_VIEW.FIRST-END.shard
    std::filesystem::path shard_file(const View& view) const;
};

// The command line that merges all shards of a view, made from the one that rendered one of them.
std::string merge_command(const std::vector<std::string>& arguments, const ReferenceOptions& options, const View& view);

}  // namespace plumb
