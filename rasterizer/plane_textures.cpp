#include "rasterizer/plane_textures.h"

#include <fmt/format.h>

#include "rasterizer/gl_error.h"

namespace plumb {

std::string layer_prefix(int layer) { return layer == 0 ? "" : fmt::format("layer{}.", layer + 1); }

LayeredName split_layer(std::string_view plane) {
    for (int layer = 1; layer < most_layers; ++layer) {
        const std::string prefix = layer_prefix(layer);
        if (plane.starts_with(prefix)) return {layer, std::string(plane.substr(prefix.size()))};
    }
    return {0, std::string(plane)};
}

GlTexture& PlaneTextures::create(const std::string& name, GLenum format, int layers, int levels) {
    return adopt(name, GlTexture::array(context_, format, width_, height_, layers, levels));
}

GlTexture& PlaneTextures::adopt(const std::string& name, GlTexture texture) {
    const auto [entry, added] = textures_.emplace(name, std::move(texture));
    if (!added) throw GlError(fmt::format("two passes allocate the plane '{}'", name));
    return entry->second;
}

const PlaneHistory& PlaneTextures::create_history(const std::string& name, const std::string& before) {
    const GlTexture& now = get(name);
    create(before, now.format(), now.layers(), now.levels());
    return histories_.emplace(name, PlaneHistory(textures_.at(name), textures_.at(before))).first->second;
}

const PlaneHistory* PlaneTextures::history_of(std::string_view name) const {
    const auto found = histories_.find(name);
    return found == histories_.end() ? nullptr : &found->second;
}

const GlTexture* PlaneTextures::find(std::string_view name) const {
    const auto found = textures_.find(name);
    return found == textures_.end() ? nullptr : &found->second;
}

const GlTexture& PlaneTextures::get(std::string_view name) const {
    const auto found = textures_.find(name);
    if (found != textures_.end()) return found->second;
    std::string names;
    for (const auto& [known, texture] : textures_) names += names.empty() ? known : ", " + known;
    throw GlError(
        fmt::format("no pass has allocated the plane '{}'; there are: {}", name, names.empty() ? "none" : names));
}

}  // namespace plumb
