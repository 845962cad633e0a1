// Image files as textures.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "scenes/texture.h"

namespace plumb {

enum class TextureContent {
    colour,  // 8- and 16-bit integers are sRGB and become linear; floats are linear already
    data,    // masks, roughness, metallic: taken as they are
};

// Reads the first image of `file`. One channel becomes grey, two grey with alpha; a missing alpha is 1. Throws
// SceneError that names the file and the reason: it cannot be read, or it holds floats that are not finite, or colours
// below 0.
Texture load_texture(const std::filesystem::path& file, TextureContent content);

// The same from a picture file held in memory (an image embedded in a scene file); `name` must keep its extension where
// it has one, as the format is told by it.
Texture decode_texture(std::span<const std::byte> bytes, const std::string& name, TextureContent content);

// Turns the picture upside down.
void flip_rows(Texture& texture);

// A magenta and black checker, the visible stand-in for a texture that could not be read.
Texture missing_texture(const std::string& name);

// The value of the 8-bit sRGB code divided by 255, made linear (IEC 61966-2-1).
float linear_from_srgb(float encoded);

}  // namespace plumb
