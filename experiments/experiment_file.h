// An experiment: a question asked as scenes x views x methods, with the quantities that are compared, the truth that
// they are compared with, and how often things are timed. Written in TOML (experiments/one_vs_two_layers.toml is an
// example).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/method_file.h"
#include "experiments/method_files.h"
#include "frames/quantities.h"
#include "metrics/comparison.h"

namespace plumb {

class LoadedScenes;
struct Scene;

// A walk along one of a scene's camera paths, frame by frame; instances that move are where they are at that time.
struct ExperimentPath {
    std::string path;
    double start = 0.0;  // seconds, on the path
    int frames = 12;
    double frames_per_second = 30.0;
};

struct ExperimentScene {
    std::string scene;               // a built-in scene's name or a scene file
    bool optional = false;           // left out, with a word, where its files are not there
    std::vector<std::string> views;  // camera names; empty: all
    std::vector<ExperimentPath> paths;
    float ao_radius = 1.0f;           // metres
    float indirect_radius = 1.0f;     // metres; what methods gather from, and the limit of the limited truth
    float minimum_separation = 0.1f;  // metres between the layers
    ConfigValue method_overrides{ConfigMembers{}, 0};  // parameters that suit the scene, for all methods
};

struct ExperimentReference {
    int samples = 256;          // per pixel, the most
    int path_samples = 64;      // per pixel of each frame of a path; the target error counts for both
    double target_error = 0.0;  // stop early below this relative error; 0: never
    std::uint64_t seed = 1;
    bool antialias = false;  // primary rays spread over the pixel, for methods that do so over frames
    // A difference counts as measured only where the mean squared noise of the reference is below this share of it.
    double most_noise = 0.1;
};

struct ExperimentMeasures {
    FlipRange flip = FlipRange::by_plane;  // none where its time matters more (metrics/comparison.h)
    double pixels_per_degree = flip_pixels_per_degree;
};

struct ExperimentTiming {
    int warm_up = 1;      // frames rendered before the clock runs
    int repetitions = 7;  // frames timed per method, interleaved; along a path at least (method_timing.h)
};

// Where a method stands on a curve of methods that differ in one parameter.
struct SweepPoint {
    std::string curve, parameter;
    double value = 0.0;
};

// A parameter that the experiment's file sets for a method.
struct MethodSetting {
    std::string method, parameter;
    int line = 0;
};

struct Experiment {
    std::string name;
    std::string title;
    std::string question;
    std::filesystem::path file;
    std::vector<std::string> planes = {"ao", "indirect", "total"};
    int width = 480, height = 270;
    Quantities quantities;  // defaults for all scenes; `planes` empty
    ExperimentReference reference;
    ExperimentMeasures measures;
    ExperimentTiming timing;
    int seeds = 1;  // pictures per view and method, each with other patterns of taps: errors are over all of them
    std::vector<int> path_tracer_samples = {4, 16};  // the path tracer's own points in the chart; empty: none
    // Layers that the oracle's rows may see, the best that any method could make of them; 0: all that is in view.
    std::vector<int> oracle_layers;
    // Bounces of further rows of the oracle, fewer than the truth's: the best that any method of so many could do.
    std::vector<int> oracle_bounces;
    std::vector<ExperimentScene> scenes;
    MethodList methods;
    MethodFiles method_files;                        // that some of them came from
    std::map<std::string, SweepPoint> sweep_points;  // of the methods that a sweep made, by their names
    std::vector<MethodSetting> method_settings;
    // The tables `figures`, `originals`, `claims` and `ladders` as the file has them: what is made of the results,
    // never of pixels.
    ConfigValue presentation{ConfigMembers{}, 0};
    bool quick = false;    // only the first view of each scene
    std::string baseline;  // the method that others are set against in the summary; the first by default
};

enum class ExperimentKind {
    comparison,   // methods against the truth: Experiment
    convergence,  // the path tracer against itself: ConvergenceExperiment
    generation,   // second layers against the exact ones: GenerationExperiment
};

// What the key `kind` says; comparison where it is missing. Throws ConfigError.
ExperimentKind kind_of(const ConfigValue& table, const std::filesystem::path& file);

struct MethodSelection {
    MethodList methods;
    std::map<std::string, SweepPoint> sweep_points;
    std::vector<MethodSetting> settings;
    MethodFiles files;
};

// The key `methods`: names of methods, method files (method_files.h; those in `kept` as they were), or tables. A table
// with `sweep = { "ao.samples" = [6, 20, 50] }` makes one method per value, named "NAME, ao.samples = 6"...; NAME
// itself is then no method. Throws ConfigError, also for parameters that have no effect on `planes`, which the
// experiment asks for: the swept one must have one at each of its values, the others of a sweep at one of them; and for
// two methods that differ in nothing but such parameters.
MethodSelection read_methods(ConfigReader& reader, const std::vector<std::string>& planes,
                             const MethodFiles& kept = {});

// Throws ConfigError with file and line. `kept`: texts of method files that are taken instead of those on the disk.
Experiment parse_experiment(const ConfigValue& table, const std::filesystem::path& file, const MethodFiles& kept = {});
Experiment load_experiment(const std::filesystem::path& file);

// A scene that is left out: its name and the reason, as one line.
struct LeftOutScene {
    std::string message;  // with all that helps on this machine
    std::string kept;     // without any folder of it, for files that are read elsewhere
};

// Takes those optional scenes out that cannot be loaded. Throws SceneError where none would be left.
std::vector<LeftOutScene> leave_out_absent_scenes(Experiment& experiment, LoadedScenes& scenes);

// Throws ConfigError for a parameter that the experiment's file sets and that nothing in any of the scenes is concerned
// with, or that a scene overrides and nothing in that scene is: light without lights, reflections without anything
// glossy. Scenes that cannot be loaded are taken to have everything.
void require_effects_in_scenes(const Experiment& experiment, LoadedScenes& scenes);

// The same question at a small size, for trying it out: a quarter of the resolution and few samples...
void make_small(Experiment& experiment);
// ...and one view per scene.
void make_quick(Experiment& experiment);

// Whether the light of further bounces is part of the plane.
bool has_light_of_bounces(const std::string& plane);

// The views of the scene that the experiment asks for; all where it names none.
std::vector<std::string> views_of(const ExperimentScene& entry, const Scene& scene);

// What a pipeline is asked for so that it renders nothing but `plane`, with the radius that suits the scene.
Quantities quantities_of(const Experiment& experiment, const ExperimentScene& entry, const std::string& plane);

// The method as it runs in `scene`: with its separation, its radius and its overrides.
Method method_in_scene(const Method& method, const ExperimentScene& scene, const std::string& source);

}  // namespace plumb
