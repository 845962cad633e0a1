#include "rasterizer/plane_pool.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace plumb {
namespace {

GlTexture trading_view(const GlTexture& array, GLenum format, int first_layer, int layers, int levels) {
    GlTexture view = GlTexture::view(array, format, first_layer, layers, levels);
    view.set_trading();
    return view;
}

}  // namespace

int PlanePool::most_levels() const {
    return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(width_, height_))));
}

GlTexture& PlanePool::take(GLenum format, int layers, int levels) {
    Place place = find_place(format, layers, levels);
    if (!place.storage) {
        // Chains of any length fit into one another's memory; beyond a few levels they take next to nothing.
        place.storage = &add_storage(format, layers, levels > 1 ? most_levels() : 1);
    }
    GlTexture& whole = place.storage->texture;
    const bool fits = whole.format() == format && whole.layers() == layers && whole.levels() == levels;
    GlTexture& taken = fits ? whole : add_view(*place.storage, format, place.first_layer, layers, levels);
    std::fill_n(place.storage->holders.begin() + place.first_layer, layers, &taken);
    return taken;
}

PooledHistory PlanePool::take_history(GlTexture& now) {
    const auto is_free = [](const GlTexture* holder) { return holder == nullptr; };
    auto place = std::ranges::find_if(storages_, [&](const Storage& storage) {
        const GlTexture& texture = storage.texture;
        return texture.format() == now.format() && texture.layers() == now.layers() &&
               texture.levels() == now.levels() && std::ranges::all_of(storage.holders, is_free);
    });
    Storage& storage = place == storages_.end() ? add_storage(now.format(), now.layers(), now.levels()) : *place;
    std::ranges::fill(storage.holders, &storage.texture);
    Trader& trader = storage.traders.emplace_back(Trader{&now, {}});
    auto first_layer = storage.first_layers.begin();
    for (const GlTexture& view : storage.views)
        trader.views.push_back(trading_view(now, view.format(), *first_layer++, view.layers(), view.levels()));
    return {PlaneHistory(now, storage.texture, &trader.views, &storage.views), &storage.texture};
}

PlanePool::Storage& PlanePool::add_storage(GLenum format, int layers, int levels) {
    Storage& added = storages_.emplace_back(
        Storage{GlTexture::array(context_, format, width_, height_, layers, levels), {}, {}, {}, {}});
    added.texture.set_trading();
    added.holders.resize(static_cast<std::size_t>(layers));
    return added;
}

GlTexture& PlanePool::add_view(Storage& storage, GLenum format, int first_layer, int layers, int levels) {
    for (Trader& trader : storage.traders)
        trader.views.push_back(trading_view(*trader.now, format, first_layer, layers, levels));
    storage.first_layers.push_back(first_layer);
    return storage.views.emplace_back(trading_view(storage.texture, format, first_layer, layers, levels));
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
        const std::vector<const GlTexture*>& holders = storage.holders;
        const auto run = std::search_n(holders.begin(), holders.end(), layers, nullptr);
        if (run == holders.end()) continue;
        const std::pair left{texture.levels() - levels, std::ranges::count(holders, nullptr) - layers};
        if (left >= least_left) continue;
        least_left = left;
        best = {&storage, static_cast<int>(run - holders.begin())};
    }
    return best;
}

}  // namespace plumb
