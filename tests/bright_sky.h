// A scene below a picture of the sky whose sun is brighter than half floats hold.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "scenes/scene_file.h"
#include "tests/temporary_folder.h"

namespace plumb {

// Above a million, and what a .hdr file holds exactly: a power of two.
constexpr float sun_radiance = 1048576.0f, clear_sky_radiance = 0.25f;
constexpr int sky_columns = 16, sky_rows = 8, sun_column = 10, sun_row = 2;

// RGB floats, as `file`'s extension says: .exr or .hdr.
inline void write_float_picture(const std::filesystem::path& file, int width, int height,
                                const std::vector<float>& values) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(file.string());
    if (!output || !output->open(file.string(), OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT)) ||
        !output->write_image(OIIO::TypeDesc::FLOAT, values.data()) || !output->close()) {
        throw std::runtime_error("cannot write " + file.string());
    }
}

inline std::vector<float> bright_sky() {
    std::vector<float> values(std::size_t{3} * sky_columns * sky_rows, clear_sky_radiance);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        values[std::size_t{3} * (sun_row * sky_columns + sun_column) + channel] = sun_radiance;
    }
    return values;
}

// A floor of 20 m at height 0 below it, of albedo 0.5. `extension`: exr or hdr.
inline Scene floor_below_bright_sky(const std::string& extension) {
    const TemporaryFolder folder;
    write_float_picture(folder / ("sky." + extension), sky_columns, sky_rows, bright_sky());
    folder.write("floor.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
    folder.write("floor.obj",
                 "mtllib floor.mtl\nusemtl grey\nv -10 0 10\nv 10 0 10\nv 10 0 -10\nv -10 0 -10\nf 1 2 3 4\n");
    const std::string environment = "[environment]\nimage = \"sky." + extension + "\"\nrotation = 40.0\n";
    return load_scene(folder.write("sky.toml", "mesh = \"floor.obj\"\n" + environment).string());
}

// Unit, towards the middle of the sun's texel: the inverse of Environment::texture_coordinates.
inline glm::vec3 sun_direction(const Scene& scene) {
    const float longitude =
        6.2831853f * ((static_cast<float>(sun_column) + 0.5f) / sky_columns - 0.5f) - scene.environment.rotation;
    const float polar = 3.1415927f * (static_cast<float>(sun_row) + 0.5f) / sky_rows;
    return {std::sin(longitude) * std::sin(polar), std::cos(polar), -std::cos(longitude) * std::sin(polar)};
}

}  // namespace plumb
