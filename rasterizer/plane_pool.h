// Memory for planes that matter during a part of each frame only: what one no longer needs, a later one takes over.
//
// A plane takes layers of a texture that are free, with their format where that fits, else as a view of another format
// of the same size. Who takes and gives back in the order in which the passes run gets planes that disturb each other
// in no frame; nothing is decided, and nothing is allocated, while frames are rendered.
//
// What a plane held in the frame before (plane_history.h) matters only until the last pass has read it: from then on,
// and in the next frame until the two trade places, others may have its memory. With the texture, all views of it trade
// places, so that these others stay in the memory that is not kept.
#pragma once

#include <list>
#include <vector>

#include "rasterizer/gl_objects.h"
#include "rasterizer/plane_history.h"

namespace plumb {

struct PooledHistory {
    PlaneHistory history;
    GlTexture* taken;  // what the history calls `before`
};

class PlanePool {
public:
    PlanePool(GlContext& context, int width, int height) : context_(context), width_(width), height_(height) {}

    int most_levels() const;
    // An array texture whose contents are undefined; the reference stays valid.
    GlTexture& take(GLenum format, int layers, int levels);
    // Its layers, from `first_layer` on, are free for others from here on; who holds the reference may still draw and
    // read before these do.
    void give_back(const GlTexture& taken, int first_layer = 0);
    // Takes memory of the shape of `now`, for what that held in the frame before.
    PooledHistory take_history(GlTexture& now);

private:
    // A kept plane that trades places with a storage, and what takes the places of the storage's views then.
    struct Trader {
        GlTexture* now;
        std::list<GlTexture> views;
    };
    struct Storage {
        GlTexture texture;
        std::list<GlTexture> views;             // of it, for planes of another shape
        std::vector<int> first_layers;          // of the views
        std::vector<const GlTexture*> holders;  // of each layer: the texture, or a view; null: it is free
        std::list<Trader> traders;
    };
    struct Place {
        Storage* storage = nullptr;
        int first_layer = 0;
    };
    Storage& add_storage(GLenum format, int layers, int levels);
    GlTexture& add_view(Storage& storage, GLenum format, int first_layer, int layers, int levels);
    // The smallest free place; without storage: there is none.
    Place find_place(GLenum format, int layers, int levels);

    GlContext& context_;
    int width_, height_;
    std::list<Storage> storages_;
};

}  // namespace plumb
