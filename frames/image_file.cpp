#include "frames/image_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "frames/exr.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

bool is_exr(const std::filesystem::path& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) return false;
    unsigned char start[4] = {};
    const std::size_t count = std::fread(start, 1, 4, file);
    std::fclose(file);
    return count == 4 && start[0] == 0x76 && start[1] == 0x2f && start[2] == 0x31 && start[3] == 0x01;
}

// What turns a stored value into a linear one.
std::function<float(float)> decoding_of(const OIIO::ImageSpec& spec) {
    if (spec.format.is_floating_point()) return {};
    const std::string space = spec.get_string_attribute("oiio:ColorSpace", "sRGB");
    if (space == "Linear" || space == "linear" || space == "scene_linear" || space == "lin_srgb") return {};
    const float gamma = spec.get_float_attribute("oiio:Gamma", 0.0f);
    if (space.starts_with("Gamma") && gamma > 0.0f) return [gamma](float value) { return std::pow(value, gamma); };
    return srgb_to_linear;
}

Frame read_other(const std::filesystem::path& path) {
    OIIO::ImageSpec wishes;
    wishes["oiio:UnassociatedAlpha"] = 1;  // colours as stored
    const auto input = OIIO::ImageInput::open(path.string(), &wishes);
    if (!input) {
        const std::string reason = OIIO::geterror();
        cannot_read(path, fmt::format("{}; give an image file (EXR, PNG, TIFF, HDR...)", reason));
    }
    const OIIO::ImageSpec spec = input->spec();
    const int stored = spec.nchannels;
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || stored < 1) {
        cannot_read(path, fmt::format("it is {}x{}x{} with {} channels, not a flat image", spec.width, spec.height,
                                      spec.depth, stored));
    }
    Image values(spec.width, spec.height, stored);
    if (!input->read_image(0, 0, 0, stored, OIIO::TypeDesc::FLOAT, values.values().data())) {
        cannot_read(path, fmt::format("truncated or damaged ({}); write it again", input->geterror()));
    }
    const int alpha = spec.alpha_channel;
    const int colours = stored - (alpha >= 0 ? 1 : 0) >= 3 ? 3 : 1;
    const auto decode = decoding_of(spec);
    Frame frame(spec.width, spec.height);
    Image& total = frame.set("total", Image(spec.width, spec.height, colours));
    Image* coverage = alpha >= 0 ? &frame.set("alpha", Image(spec.width, spec.height, 1)) : nullptr;
    for (int y = 0; y < spec.height; ++y) {
        for (int x = 0; x < spec.width; ++x) {
            for (int c = 0; c < colours; ++c) {
                const float value = values.at(x, y, c);
                total.at(x, y, c) = decode ? decode(value) : value;
            }
            if (coverage) coverage->at(x, y) = values.at(x, y, alpha);
        }
    }
    return frame;
}

}  // namespace

Frame read_frame(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) cannot_read(path, "there is no such file; check the path");
    if (!std::filesystem::is_regular_file(status)) cannot_read(path, "it is not a file; name a file inside it");
    if (std::filesystem::file_size(path, error) == 0) cannot_read(path, "it is empty (0 bytes); write it again");
    if (is_exr(path)) return read_exr(path);
    try {
        return read_other(path);
    } catch (const ImageError&) {
        throw;
    } catch (const std::bad_alloc&) {
        cannot_read(path, "it does not fit into memory");
    } catch (const std::exception& failure) {
        cannot_read(path, fmt::format("truncated or damaged ({}); write it again", failure.what()));
    }
}

float srgb_to_linear(float encoded) {
    const float magnitude = std::abs(encoded);
    const float linear = magnitude <= 0.04045f ? magnitude / 12.92f : std::pow((magnitude + 0.055f) / 1.055f, 2.4f);
    return std::copysign(linear, encoded);
}

float linear_to_srgb(float linear) {
    const float magnitude = std::abs(linear);
    const float encoded =
        magnitude <= 0.0031308f ? magnitude * 12.92f : 1.055f * std::pow(magnitude, 1.0f / 2.4f) - 0.055f;
    return std::copysign(encoded, linear);
}

}  // namespace plumb
