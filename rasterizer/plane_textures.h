// The planes of a frame while they live on the GPU: array textures by name, one layer per G-buffer layer.
//
// On the GPU the lower row comes first (as OpenGL); rows are flipped once, on the way in or out (texture_transfer.h).
// `depth` holds linear metres along the camera's -Z, +infinity where nothing is seen, in every layer; where it is
// infinite the other planes mean nothing.
#pragma once

#include <list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "rasterizer/plane_history.h"
#include "rasterizer/plane_lifetimes.h"
#include "rasterizer/plane_pool.h"

namespace plumb {

constexpr int most_layers = 4;

// "" for layer 0, "layer2." for layer 1...
std::string layer_prefix(int layer);
struct LayeredName {
    int layer;  // from 0
    std::string base;
};
LayeredName split_layer(std::string_view plane);

class PlaneTextures {
public:
    // Planes whose contents matter only within a frame share their memory (plane_pool.h); all others have theirs alone.
    PlaneTextures(GlContext& context, int width, int height, PlaneLifetimes lifetimes = {})
        : context_(context),
          width_(width),
          height_(height),
          lifetimes_(std::move(lifetimes)),
          pool_(context, width, height) {}

    // Size of every plane: the view's with its guard band.
    int width() const { return width_; }
    int height() const { return height_; }

    // Allocates a plane; the reference stays valid. Throws GlError where the name is taken.
    GlTexture& create(const std::string& name, GLenum format, int layers, int levels = 1);
    // Adds a texture of another shape (a shadow map) under a name.
    GlTexture& adopt(const std::string& name, GlTexture texture);
    // Adds a texture that belongs to others, who outlive this.
    void borrow(const std::string& name, const GlTexture& texture);
    // The passes made from here on do not know the plane or its last layers: where it shares its memory, they may take
    // that. Who looks up a plane of which no layer is left gets a GlError.
    void give_up(const PlaneLifetimes::Ended& ended);
    // Allocates what the plane `name`, which there is, held in the frame before, under the name `before`; where that
    // matters only within a frame, it shares its memory with others. Throws GlError where `name` does.
    const PlaneHistory& create_history(const std::string& name, const std::string& before);
    // Null where the plane has none.
    const PlaneHistory* history_of(std::string_view name) const;
    bool has(std::string_view name) const { return find(name) != nullptr; }
    // Null where there is none.
    const GlTexture* find(std::string_view name) const;
    // Throws GlError that lists the planes there are.
    const GlTexture& get(std::string_view name) const;
    // By name, also those that were given up.
    const std::map<std::string, const GlTexture*, std::less<>>& all() const { return textures_; }

private:
    // Of memory that is not shared.
    GlTexture& allocate(const std::string& name, GLenum format, int layers, int levels);
    // Of memory that is shared.
    GlTexture& take(const std::string& name, GLenum format, int layers, int levels);

    GlContext& context_;
    int width_, height_;
    PlaneLifetimes lifetimes_;
    PlanePool pool_;
    std::map<std::string, GlTexture*, std::less<>> shared_;  // now, of the pool
    std::map<std::string, GlTexture, std::less<>> own_;
    std::map<std::string, const GlTexture*, std::less<>> textures_;
    std::set<std::string, std::less<>> given_up_;
    std::map<std::string, PlaneHistory, std::less<>> histories_;
};

}  // namespace plumb
