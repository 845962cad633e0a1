// A scene's textures as rays read them: at places that nobody can foresee.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <vector>

#include <glm/glm.hpp>

#include "pathtracer/lanes.h"
#include "scenes/bilinear_lookup.h"
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
    PLUMBLINE_INLINE glm::vec4 sample(int texture, const glm::vec2& uv) const {
        const Packed& packed = packed_[texture];
        if (packed.tiles.empty()) return packed.texture->sample(uv);
        const float *colour = packed.colour, *alpha = packed.alpha;
        return BilinearLookup(*packed.texture, uv).mix([&](int x, int y) {
            const std::uint8_t* code = packed.codes(x, y);
            return BilinearLookup::Rgba{colour[code[0]], colour[code[1]], colour[code[2]], alpha[code[3]]};
        });
    }

    // Starts to fetch what `sample` will read. Inlined, since GCC 12 drops calls of functions that do nothing else.
    PLUMBLINE_INLINE void fetch(int texture, const glm::vec2& uv) const {
        const Packed& packed = packed_[texture];
        if (packed.tiles.empty()) return;
        const BilinearLookup lookup(*packed.texture, uv);
        __builtin_prefetch(packed.codes(lookup.x0, lookup.y0)), __builtin_prefetch(packed.codes(lookup.x1, lookup.y0));
        __builtin_prefetch(packed.codes(lookup.x0, lookup.y1)), __builtin_prefetch(packed.codes(lookup.x1, lookup.y1));
    }

    bool is_packed(int texture) const { return !packed_[texture].tiles.empty(); }

private:
    static constexpr int tile_side = 4;
    struct alignas(64) Tile {
        std::array<std::uint8_t, 4 * tile_side * tile_side> codes;  // row-major
    };
    using Values = std::array<float, 256>;
    struct Packed {
        const Texture* texture = nullptr;
        std::vector<Tile> tiles;  // row-major; empty: read the texture itself
        int tiles_per_row = 0;
        const float *colour = nullptr, *alpha = nullptr;  // values of the codes

        // Of a texel: red, green, blue, alpha.
        PLUMBLINE_INLINE const std::uint8_t* codes(int x, int y) const {
            return &tiles[tile(x, y)].codes[within_tile(x, y)];
        }
        PLUMBLINE_INLINE std::uint8_t* codes(int x, int y) { return &tiles[tile(x, y)].codes[within_tile(x, y)]; }

    private:
        PLUMBLINE_INLINE std::size_t tile(int x, int y) const {
            return static_cast<std::size_t>(y / tile_side) * tiles_per_row + x / tile_side;
        }
        PLUMBLINE_INLINE static std::size_t within_tile(int x, int y) {
            return 4 * (tile_side * (static_cast<std::size_t>(y) % tile_side) + x % tile_side);
        }
    };
    class CodeTable;
    static void pack(const CodeTable& colour, const CodeTable& alpha, Packed& packed);

    std::vector<Packed> packed_;
    // Shared by all textures that they have room for, so that they stay in the nearest cache. Their places are kept.
    std::list<Values> values_;
};

}  // namespace plumb
