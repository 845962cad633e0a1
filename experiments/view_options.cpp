#include "experiments/view_options.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "experiments/pictures.h"
#include "frames/deep_exr.h"
#include "frames/exr.h"
#include "frames/image_error.h"
#include "frames/picture.h"
#include "metrics/comparison.h"

namespace plumb {

void ViewOptions::add_to(CLI::App& command, const std::vector<std::string>& default_planes) {
    planes = default_planes;
    command.add_option("scene", scene, "Built-in scene, scene of the scenes folder, or file")
        ->required()
        ->type_name("SCENE");
    CLI::Option* view_option =
        command.add_option("--view", view, "Camera by name; the scene's first by default")->type_name("NAME");
    command.add_option("--path", path, "Camera path instead of a view; where on it, --time tells")
        ->type_name("NAME")
        ->excludes(view_option);
    command.add_option("--time", time, "Seconds of scene time: where moving objects and the path's camera are")
        ->check(CLI::Number)
        ->capture_default_str();
    command.add_option("--size", size, "Width and height in pixels")
        ->expected(2)
        ->check(CLI::Range(1, 16384))
        ->capture_default_str();
    command.add_option("--planes", planes, "Planes to render, separated by commas")
        ->delimiter(',')
        ->capture_default_str();
    command.add_option("-o,--output", output, "Folder for the files")->capture_default_str();
    command.add_flag("--deep", deep,
                     "Also write the layers as a deep OpenEXR file; wants the planes depth, layer2.depth...");
    const std::string pictures = "Pictures (PNG only: never EXR files or measures)";
    command.add_option("--tone-map", tone_map, "Curve of radiance: cut at white, Hable's filmic, or a fit to ACES")
        ->check(CLI::IsMember({"linear", "filmic", "aces"}))
        ->capture_default_str()
        ->group(pictures);
    command.add_option("--exposure", exposure, "Stops; by default each plane finds its own")
        ->check(CLI::Range(-100.0, 100.0))
        ->type_name("EV")
        ->group(pictures);
    command.add_option("--bloom", bloom, "Share of light that spreads around what is bright")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str()
        ->group(pictures);
    add_quantities_to(command);
}

void ViewOptions::add_quantities_to(CLI::App& command) {
    const std::string group = "Quantities";
    command.add_option("--ao-radius", quantities.ao_radius, "Reach of ambient visibility, metres")
        ->check(CLI::PositiveNumber)
        ->capture_default_str()
        ->group(group);
    command.add_option("--ao-falloff", ao_falloff, "How an occluder counts over its distance")
        ->check(CLI::IsMember({"hard", "quadratic", "cubic"}))
        ->capture_default_str()
        ->group(group);
    command.add_option("--bounces", quantities.bounces, "Diffuse bounces")
        ->check(CLI::Range(1, most_diffuse_bounces))
        ->capture_default_str()
        ->group(group);
    command
        .add_option("--indirect-radius", quantities.indirect_radius,
                    "Only light from within so many metres is indirect; inf: all")
        ->check(CLI::PositiveNumber)
        ->group(group);
    command.add_option("--indirect-falloff", indirect_falloff, "How light within that radius counts over its distance")
        ->check(CLI::IsMember({"hard", "quadratic", "cubic"}))
        ->capture_default_str()
        ->group(group);
    command
        .add_option("--reflection-radius", quantities.reflection_radius,
                    "Only what lies within so many metres is reflected; inf: all")
        ->check(CLI::PositiveNumber)
        ->group(group);
    command.add_option("--reflection-falloff", reflection_falloff, "How what is reflected counts over its distance")
        ->check(CLI::IsMember({"hard", "quadratic", "cubic"}))
        ->capture_default_str()
        ->group(group);
}

Quantities ViewOptions::read_quantities() const {
    Quantities result = quantities;
    result.planes = planes;
    result.ao_falloff = falloff_from_string(ao_falloff);
    result.indirect_falloff = falloff_from_string(indirect_falloff);
    result.reflection_falloff = falloff_from_string(reflection_falloff);
    return result;
}

Scene ViewOptions::load(const SceneFinder& finder) const {
    Scene loaded = finder.load(scene);
    loaded.move_to(time);
    return loaded;
}

View ViewOptions::make_view(const Scene& loaded, double at) const {
    const Camera camera = path.empty() ? choose_camera(loaded, view) : loaded.path(path).at(static_cast<float>(at));
    return View(camera, size[0], size[1]);
}

void require_writable_folder(const std::filesystem::path& folder) {
    const auto refuse = [&folder](int error) {
        throw ImageError(fmt::format("cannot write into folder '{}': {}; choose another with --output", folder.string(),
                                     std::strerror(error)));
    };
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) refuse(error.value());
    const auto probe = folder / fmt::format(".plumbline-{}.tmp", ::getpid());
    const int descriptor = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor < 0) refuse(errno);
    ::close(descriptor);
    std::filesystem::remove(probe, error);
}

void write_frame_files(const Frame& frame, const ViewOptions& options, const std::string& view,
                       const std::string& name) {
    const std::string stem =
        fmt::format("{}.{}.{}", file_name_of(options.scene), file_name_of(view), file_name_of(name));
    const auto exr = options.output / (stem + ".exr");
    write_exr(exr, frame);
    fmt::print("{}\n", exr.string());
    if (options.deep) {
        const auto deep = options.output / (stem + ".deep.exr");
        const std::vector<std::string> left_out = write_deep_exr(deep, frame);
        fmt::print("{}{}\n", deep.string(),
                   left_out.empty() ? "" : fmt::format(" (without {}: not of every layer)", fmt::join(left_out, ", ")));
    }
    for (const std::string& plane : frame.plane_names()) {
        if (plane.starts_with("half_") || plane.starts_with("variance.")) continue;
        PictureSettings look;
        look.tone_curve = tone_curve_from_string(options.tone_map);
        look.bloom = options.bloom;
        look.exposure = options.exposure
                            ? *options.exposure
                            : static_cast<float>(std::log2(0.9 / default_data_range(plane, frame.plane(plane))));
        const auto png = options.output / fmt::format("{}.{}.png", stem, plane);
        write_png(png, plane, frame.plane(plane), look);
        fmt::print("{}\n", png.string());
    }
}

}  // namespace plumb
