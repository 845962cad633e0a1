#include "pathtracer/packed_textures.h"

#include <algorithm>
#include <bitset>
#include <functional>

#include <tbb/parallel_for.h>

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

void PackedTextures::pack(const CodeTable& colour, const CodeTable& alpha, Packed& packed) {
    const Texture& texture = *packed.texture;
    packed.colour = colour.values(), packed.alpha = alpha.values();
    packed.tiles_per_row = (texture.width + tile_side - 1) / tile_side;
    packed.tiles.resize(static_cast<std::size_t>(packed.tiles_per_row) *
                        ((texture.height + tile_side - 1) / tile_side));
    for (int y = 0; y < texture.height; ++y) {
        for (int x = 0; x < texture.width; ++x) {
            const half* texel = &texture.texels[4 * (static_cast<std::size_t>(y) * texture.width + x)];
            std::uint8_t* codes = packed.codes(x, y);
            for (int c = 0; c < 3; ++c) codes[c] = colour[texel[c]];
            codes[3] = alpha[texel[3]];
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
    std::vector<std::function<void()>> packings;
    for (std::size_t i = 0; i < textures.size(); ++i) {
        if (textures[i].is_wide()) continue;
        const CodeTable *colour = table_for(halves[i].colour), *alpha = table_for(halves[i].alpha);
        if (colour && alpha) packings.push_back([=, this] { pack(*colour, *alpha, packed_[i]); });
    }
    tbb::parallel_for(std::size_t{0}, packings.size(), [&](std::size_t i) { packings[i](); });
}

}  // namespace plumb
