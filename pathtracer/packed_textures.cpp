#include "pathtracer/packed_textures.h"

#include <algorithm>
#include <bitset>

#include <tbb/parallel_for.h>

#include "scenes/bilinear_lookup.h"

namespace plumb {
namespace {

constexpr std::size_t half_count = 0x10000;  // bit patterns of a half float
using Halves = std::bitset<half_count>;

struct ChannelHalves {
    Halves colour, alpha;

    void find(const Texture& texture) {
        for (std::size_t i = 0; i < texture.texels.size(); i += 4) {
            for (std::size_t c = 0; c < 3; ++c) colour.set(texture.texels[i + c].bits());
            alpha.set(texture.texels[i + 3].bits());
        }
    }
};

}  // namespace

// Which code stands for which half float.
class PackedTextures::CodeTable {
public:
    explicit CodeTable(Values& values) : values_(values), codes_(half_count) {}

    // Gives a code to each of `halves` that has none; false where there are too many, and then to none of them.
    bool take(const Halves& halves) {
        const Halves missing = halves & ~taken_;
        if (taken_.count() + missing.count() > values_.size()) return false;
        std::size_t next = taken_.count();
        for (std::size_t bits = missing._Find_first(); bits < half_count; bits = missing._Find_next(bits)) {
            codes_[bits] = static_cast<std::uint8_t>(next);
            half value;
            value.setBits(static_cast<std::uint16_t>(bits));
            values_[next++] = value;
        }
        taken_ |= missing;
        return true;
    }
    std::uint8_t operator[](half value) const { return codes_[value.bits()]; }
    const float* values() const { return values_.data(); }

private:
    Values& values_;
    Halves taken_;
    std::vector<std::uint8_t> codes_;
};

void PackedTextures::pack(const CodeTable& colour, const CodeTable& alpha, const Packed& packed) {
    const Texture& texture = *packed.texture;
    for (int y = 0; y < texture.height; ++y) {
        for (int x = 0; x < texture.width; ++x) {
            const half* values = &texture.texels[4 * (static_cast<std::size_t>(y) * texture.width + x)];
            tiles_[packed.tile(x, y)].texels[Packed::within_tile(x, y)] = {
                {colour[values[0]], colour[values[1]], colour[values[2]], alpha[values[3]]}};
        }
    }
}

PackedTextures::PackedTextures(const std::vector<Texture>& textures) : packed_(textures.size()) {
    std::vector<ChannelHalves> halves(textures.size());
    tbb::parallel_for(std::size_t{0}, textures.size(), [&](std::size_t i) {
        packed_[i].texture = &textures[i];
        halves[i].find(textures[i]);
    });
    std::list<CodeTable> tables;
    const auto table_for = [&](const Halves& needed) -> const CodeTable* {
        if (needed.count() > std::tuple_size_v<Values>) return nullptr;
        const auto with_room = std::ranges::find_if(tables, [&](CodeTable& table) { return table.take(needed); });
        if (with_room != tables.end()) return &*with_room;
        tables.emplace_back(values_.emplace_back()).take(needed);
        return &tables.back();
    };
    std::size_t tile_count = 0;
    struct Codes {
        const CodeTable *colour = nullptr, *alpha = nullptr;  // null: the texture is not packed
    };
    std::vector<Codes> codes(textures.size());
    for (std::size_t i = 0; i < textures.size(); ++i) {
        if (textures[i].is_wide()) continue;
        const CodeTable *colour = table_for(halves[i].colour), *alpha = table_for(halves[i].alpha);
        if (!colour || !alpha) continue;
        codes[i] = {colour, alpha};
        Packed& packed = packed_[i];
        packed.colour = colour->values(), packed.alpha = alpha->values();
        packed.first_tile = tile_count;
        packed.tiles_per_row = (textures[i].width + tile_side - 1) / tile_side;
        tile_count +=
            static_cast<std::size_t>(packed.tiles_per_row) * ((textures[i].height + tile_side - 1) / tile_side);
    }
    tiles_.resize(tile_count);
    tbb::parallel_for(std::size_t{0}, textures.size(), [&](std::size_t i) {
        if (codes[i].colour) pack(*codes[i].colour, *codes[i].alpha, packed_[i]);
    });
}

glm::vec4 PackedTextures::sample(int texture, const glm::vec2& uv) const {
    const Packed& packed = packed_[texture];
    if (!packed.colour) return packed.texture->sample(uv);
    return BilinearLookup(*packed.texture, uv).mix([&](int x, int y) {
        const auto [red, green, blue, alpha] = texel(packed, x, y).codes;
        return BilinearLookup::Rgba{packed.colour[red], packed.colour[green], packed.colour[blue], packed.alpha[alpha]};
    });
}

void PackedTextures::sample(const Lanes<int>& texture, const Lanes<float>& u, const Lanes<float>& v, int count,
                            VectorLanes& colour) const {
    // Three rounds. The first finds the texels, but touches none.
    std::array<Lanes<const Texel*>, 4> texels;
    Lanes<float> right, lower;
    Lanes<const float*> values;
    Lanes<int> lane;
    int packed_count = 0;
    for (int i = 0; i < count; ++i) {
        if (texture[i] == no_texture) continue;
        const Packed& packed = packed_[texture[i]];
        if (!packed.colour) {
            colour.set(i, packed.texture->sample({u[i], v[i]}));
            continue;
        }
        const BilinearLookup lookup(*packed.texture, {u[i], v[i]});
        const int to = packed_count++;
        lane[to] = i, right[to] = lookup.right, lower[to] = lookup.lower, values[to] = packed.colour;
        texels[0][to] = &texel(packed, lookup.x0, lookup.y0), texels[1][to] = &texel(packed, lookup.x1, lookup.y0);
        texels[2][to] = &texel(packed, lookup.x0, lookup.y1), texels[3][to] = &texel(packed, lookup.x1, lookup.y1);
    }
    // The second has them fetched, with nothing in between, for a processor looks ahead but some hundred instructions.
    for (const int corner : {0, 3, 1, 2}) {
        for (int i = 0; i < packed_count; ++i) __builtin_prefetch(texels[corner][i]);
    }
    for (int i = 0; i < packed_count; ++i) {
        const float* value = values[i];
        colour.set(lane[i], BilinearLookup::mix(right[i], lower[i], [&](int column, int row) {
                       const auto [red, green, blue, alpha] = texels[2 * row + column][i]->codes;
                       return BilinearLookup::Rgba{value[red], value[green], value[blue], 1.0f};
                   }));
    }
}

}  // namespace plumb
