// A scene's textures as rays read them: at places that nobody can foresee.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/lanes.h"
#include "scenes/material.h"
#include "scenes/texture.h"

namespace plumb {

// What a look-up costs is the cache lines and the memory pages that it touches. Row by row in half floats its four
// texels lie in two lines or more, of two pages. Here a line holds a tile of 4 x 4 texels of 4 bytes, and more than
// half of all look-ups need but one. Nothing is rounded: a byte tells which of at most 256 values the channel has, and
// pictures of 8 bits have no more. Other textures are read where they are.
class PackedTextures {
public:
    // Refers to `textures`, which must outlive it.
    explicit PackedTextures(const std::vector<Texture>& textures);

    // As Texture::sample.
    glm::vec4 sample(int texture, const glm::vec2& uv) const;

    // The same for `count` lanes at once, red, green and blue alone; the lanes of `no_texture` are left as they are.
    // Most of the time goes by until the first byte of a page is there: all lanes wait for theirs together.
    void sample(const Lanes<int>& texture, const Lanes<float>& u, const Lanes<float>& v, int count,
                VectorLanes& colour) const;

    bool is_packed(int texture) const { return packed_[texture].colour != nullptr; }

private:
    static constexpr int tile_side = 4;
    struct Texel {
        std::array<std::uint8_t, 4> codes;  // red, green, blue, alpha
    };
    struct alignas(64) Tile {
        std::array<Texel, std::size_t{tile_side} * tile_side> texels;  // row-major
    };
    using Values = std::array<float, 256>;
    struct Packed {
        const Texture* texture = nullptr;
        std::size_t first_tile = 0;  // row-major from there
        int tiles_per_row = 0;
        const float *colour = nullptr, *alpha = nullptr;  // values of the codes; null: read the texture itself

        std::size_t tile(int x, int y) const {
            return first_tile + static_cast<std::size_t>(y / tile_side) * tiles_per_row + x / tile_side;
        }
        static std::size_t within_tile(int x, int y) {
            return tile_side * (static_cast<std::size_t>(y) % tile_side) + x % tile_side;
        }
    };
    class CodeTable;
    void pack(const CodeTable& colour, const CodeTable& alpha, const Packed& packed);
    const Texel& texel(const Packed& packed, int x, int y) const {
        return tiles_[packed.tile(x, y)].texels[Packed::within_tile(x, y)];
    }

    std::vector<Packed> packed_;
    std::vector<Tile> tiles_;  // of all textures
    // Shared by all textures that they have room for, so that they stay in the nearest cache. Their places are kept.
    std::list<Values> values_;
};

}  // namespace plumb
