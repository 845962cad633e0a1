#include "rasterizer/plane_pool.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace plumb {

int PlanePool::most_levels() const {
    return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(width_, height_))));
}

GlTexture& PlanePool::take(GLenum format, int layers, int levels) {
    Place place = find_place(format, layers, levels);
    if (!place.storage) {
        // Chains of any length fit into one another's memory; beyond a few levels they take next to nothing.
        Storage& added = storages_.emplace_back(Storage{
            GlTexture::array(context_, format, width_, height_, layers, levels > 1 ? most_levels() : 1), {}, {}});
        added.holders.resize(static_cast<std::size_t>(layers));
        place.storage = &added;
    }
    GlTexture& whole = place.storage->texture;
    const bool fits = whole.format() == format && whole.layers() == layers && whole.levels() == levels;
    GlTexture& taken =
        fits ? whole
             : place.storage->views.emplace_back(GlTexture::view(whole, format, place.first_layer, layers, levels));
    std::fill_n(place.storage->holders.begin() + place.first_layer, layers, &taken);
    return taken;
}

void PlanePool::give_back(const GlTexture& taken, int first_layer) {
    for (Storage& storage : storages_) {
        int layer = 0;
        for (const GlTexture*& holder : storage.holders) {
            if (holder == &taken && layer++ >= first_layer) holder = nullptr;
        }
    }
}

PlanePool::Place PlanePool::find_place(GLenum format, int layers, int levels) {
    Place best;
    std::pair least_left{std::numeric_limits<int>::max(), std::ptrdiff_t{0}};  // levels, then layers
    for (Storage& storage : storages_) {
        const GlTexture& texture = storage.texture;
        if (bytes_per_texel(texture.format()) != bytes_per_texel(format) || texture.levels() < levels) continue;
        const auto run = std::ranges::search_n(storage.holders, layers, nullptr);
        if (run.empty()) continue;
        const std::pair left{texture.levels() - levels, std::ranges::count(storage.holders, nullptr) - layers};
        if (left >= least_left) continue;
        least_left = left;
        best = {&storage, static_cast<int>(run.begin() - storage.holders.begin())};
    }
    return best;
}

}  // namespace plumb
