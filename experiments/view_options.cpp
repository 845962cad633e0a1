#include "experiments/view_options.h"

#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/pictures.h"
#include "experiments/scene_finder.h"
#include "frames/exr.h"
#include "frames/picture.h"
#include "metrics/comparison.h"

namespace plumb {

void ViewOptions::add_to(CLI::App& command, const std::vector<std::string>& default_planes) {
    planes = default_planes;
    command.add_option("scene", scene, "Built-in scene, scene of the scenes folder, or file")
        ->required()
        ->type_name("SCENE");
    command.add_option("--view", view, "Camera by name; the scene's first by default")->type_name("NAME");
    command.add_option("--size", size, "Width and height in pixels")
        ->expected(2)
        ->check(CLI::Range(1, 16384))
        ->capture_default_str();
    command.add_option("--planes", planes, "Planes to render, separated by commas")
        ->delimiter(',')
        ->capture_default_str();
    command.add_option("-o,--output", output, "Folder for the files")->capture_default_str();
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
        ->check(CLI::Range(1, 64))
        ->capture_default_str()
        ->group(group);
    command
        .add_option("--indirect-radius", quantities.indirect_radius,
                    "Only light from within so many metres is indirect; inf: all")
        ->check(CLI::PositiveNumber)
        ->group(group);
}

Quantities ViewOptions::read_quantities() const {
    Quantities result = quantities;
    result.planes = planes;
    result.ao_falloff = falloff_from_string(ao_falloff);
    return result;
}

View ViewOptions::make_view(const Scene& loaded) const { return View(choose_camera(loaded, view), size[0], size[1]); }

void write_frame_files(const Frame& frame, const ViewOptions& options, const std::string& view,
                       const std::string& name) {
    const std::string stem =
        fmt::format("{}.{}.{}", file_name_of(options.scene), file_name_of(view), file_name_of(name));
    const auto exr = options.output / (stem + ".exr");
    write_exr(exr, frame);
    fmt::print("{}\n", exr.string());
    for (const std::string& plane : frame.plane_names()) {
        if (plane.starts_with("half_") || plane.starts_with("variance.")) continue;
        PictureSettings look;
        look.exposure = static_cast<float>(std::log2(0.9 / default_data_range(plane, frame.plane(plane))));
        const auto png = options.output / fmt::format("{}.{}.png", stem, plane);
        write_png(png, plane, frame.plane(plane), look);
        fmt::print("{}\n", png.string());
    }
}

}  // namespace plumb
