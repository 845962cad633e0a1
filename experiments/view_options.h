// Options that `render` and `reference` share: which view of which scene, how large, and which quantities.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/command.h"
#include "experiments/scene_finder.h"
#include "frames/frame.h"
#include "frames/quantities.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace plumb {

struct ViewOptions {
    std::string scene, view;
    std::string path;   // a camera path that takes the view's place
    double time = 0.0;  // seconds of scene time: where the path's camera and moving objects are
    std::vector<int> size = {960, 540};
    std::vector<std::string> planes;
    Quantities quantities;
    std::string ao_falloff = "quadratic";
    std::string indirect_falloff = "hard", reflection_falloff = "hard";
    std::filesystem::path output = "out";
    bool deep = false;  // write a deep OpenEXR file too
    // Of the pictures alone.
    std::string tone_map = "linear";
    std::optional<float> exposure = {};  // stops; none: each plane's 99th percentile becomes nearly white
    float bloom = 0.0f;

    void add_to(CLI::App& command, const std::vector<std::string>& default_planes);
    // What `planes` are of: radii, falloffs, bounces. Part of add_to().
    void add_quantities_to(CLI::App& command);
    Quantities read_quantities() const;
    // The scene at `time`. Throws SceneError.
    Scene load(const SceneFinder& finder) const;
    View make_view(const Scene& loaded) const { return make_view(loaded, time); }
    View make_view(const Scene& loaded, double at) const;
};

// Makes the folder where it is missing. Throws ImageError unless files can be made in it, so that nobody learns it
// after hours of work.
void require_writable_folder(const std::filesystem::path& folder);

// Writes OUTPUT/SCENE.VIEW.NAME.exr, with --deep also .deep.exr, and one PNG per plane (no half-buffers or variances),
// and prints their paths. Radiance is exposed so that its 99th percentile is nearly white, unless an exposure is given.
void write_frame_files(const Frame& frame, const ViewOptions& options, const std::string& view,
                       const std::string& name);

}  // namespace plumb
