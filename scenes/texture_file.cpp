#include "scenes/texture_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "scenes/scene_error.h"

namespace plumb {
namespace {

using OIIO::ImageInput;
using OIIO::TypeDesc;

// The values of 8-bit codes in both contents, computed once per call: 256 powers are nothing beside a picture.
std::array<half, 256> code_values(TextureContent content) {
    std::array<half, 256> values;
    for (int i = 0; i < 256; ++i) {
        const float encoded = static_cast<float>(i) / 255.0f;
        values[i] = half(content == TextureContent::colour ? linear_from_srgb(encoded) : encoded);
    }
    return values;
}

// Where each of R, G, B, A comes from; -1: alpha is 1.
using ChannelMap = std::array<int, 4>;

ChannelMap channel_map(int channels) {
    if (channels == 1) return {0, 0, 0, -1};
    if (channels == 2) return {0, 0, 0, 1};
    return {0, 1, 2, channels > 3 ? 3 : -1};
}

// `values` are those of a picture of floats, as they lie in the file.
void require_light(const std::vector<float>& values, const OIIO::ImageSpec& spec, TextureContent content,
                   const std::string& name) {
    const auto channels = static_cast<std::size_t>(spec.nchannels), width = static_cast<std::size_t>(spec.width);
    const ChannelMap from = channel_map(spec.nchannels);
    for (std::size_t pixel = 0; pixel < values.size() / channels; ++pixel) {
        for (int c = 0; c < 4; ++c) {
            if (from[c] < 0) continue;
            const float value = values[pixel * channels + static_cast<std::size_t>(from[c])];
            const bool is_light = content == TextureContent::colour && c < 3;
            if (std::isfinite(value) && !(is_light && value < 0.0f)) continue;
            throw SceneError(fmt::format(
                "texture '{0}': channel {1} of pixel ({2}, {3}) is {4}, and must be {5}; repair the picture, for "
                "example with: oiiotool '{0}' --fixnan box3 --clamp:min=0 -o repaired.exr",
                name, from[c], pixel % width, pixel / width, value, is_light ? "finite and not negative" : "finite"));
        }
    }
}

Texture read(ImageInput& input, const std::string& name, TextureContent content) {
    const OIIO::ImageSpec& spec = input.spec();
    const int channels = spec.nchannels;
    Texture texture;
    texture.name = name;
    texture.width = spec.width;
    texture.height = spec.height;
    const std::size_t pixels = static_cast<std::size_t>(spec.width) * spec.height;

    const ChannelMap from = channel_map(channels);
    const auto fill = [&](auto& texels, const auto& source, auto&& convert) {
        texels.resize(4 * pixels, 1.0f);
        for (std::size_t i = 0; i < pixels; ++i) {
            for (int c = 0; c < 4; ++c) {
                if (from[c] >= 0) texels[4 * i + c] = convert(source[i * channels + from[c]], c == 3);
            }
        }
    };
    const auto read_into = [&](auto& values, TypeDesc type) {
        values.resize(pixels * channels);
        if (!input.read_image(0, 0, 0, channels, type, values.data())) {
            throw SceneError(fmt::format("texture '{}' cannot be read: {}", name, input.geterror()));
        }
    };
    if (spec.format == TypeDesc::UINT8) {
        std::vector<unsigned char> values;
        read_into(values, TypeDesc::UINT8);
        const std::array<half, 256> colour = code_values(content), data = code_values(TextureContent::data);
        fill(texture.texels, values, [&](unsigned char code, bool alpha) { return alpha ? data[code] : colour[code]; });
    } else {
        std::vector<float> values;
        read_into(values, TypeDesc::FLOAT);
        if (spec.format.is_floating_point()) require_light(values, spec, content, name);
        const bool encoded = content == TextureContent::colour && !spec.format.is_floating_point();
        const auto linear = [&](float value, bool alpha) {
            return encoded && !alpha ? linear_from_srgb(value) : value;
        };
        if (std::ranges::any_of(values, [](float value) { return std::abs(value) > largest_half; })) {
            fill(texture.wide_texels, values, linear);
        } else {
            fill(texture.texels, values, [&](float value, bool alpha) { return half(linear(value, alpha)); });
        }
    }
    return texture;
}

// Alpha is a mask here, never a coverage that colours were multiplied with.
OIIO::ImageSpec reading_settings() {
    OIIO::ImageSpec settings;
    settings.attribute("oiio:UnassociatedAlpha", 1);
    return settings;
}

}  // namespace

float linear_from_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

Texture load_texture(const std::filesystem::path& file, TextureContent content) {
    const OIIO::ImageSpec settings = reading_settings();
    const std::unique_ptr<ImageInput> input = ImageInput::open(file.string(), &settings);
    if (!input) {
        throw SceneError(fmt::format("texture '{}' cannot be opened: {}", file.string(), OIIO::geterror()));
    }
    return read(*input, file.string(), content);
}

Texture decode_texture(std::span<const std::byte> bytes, const std::string& name, TextureContent content) {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
    const OIIO::ImageSpec settings = reading_settings();
    const std::unique_ptr<ImageInput> input = ImageInput::open(name, &settings, &memory);
    if (!input) throw SceneError(fmt::format("embedded texture '{}' cannot be decoded: {}", name, OIIO::geterror()));
    return read(*input, name, content);
}

void flip_rows(Texture& texture) {
    const auto flip = [&](auto& texels) {
        const std::ptrdiff_t row = 4 * static_cast<std::ptrdiff_t>(texture.width);
        for (int j = 0; j < texture.height / 2; ++j) {
            const auto upper = texels.begin() + j * row, lower = texels.begin() + (texture.height - 1 - j) * row;
            std::swap_ranges(upper, upper + row, lower);
        }
    };
    texture.is_wide() ? flip(texture.wide_texels) : flip(texture.texels);
}

Texture missing_texture(const std::string& name) {
    Texture texture;
    texture.name = name + " (missing)";
    texture.width = texture.height = 16;
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 16; ++i) {
            const float value = (i / 2 + j / 2) % 2 == 0 ? 1.0f : 0.0f;
            for (const float channel : {value, 0.0f, value, 1.0f}) texture.texels.push_back(half(channel));
        }
    }
    return texture;
}

}  // namespace plumb
