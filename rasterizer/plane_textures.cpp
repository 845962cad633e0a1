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
    if (!lifetimes_.within_frame.contains(name)) return allocate(name, format, layers, levels);
    GlTexture& taken = take(name, format, layers, levels);
    borrow(name, taken);
    shared_.emplace(name, &taken);
    return taken;
}

GlTexture& PlaneTextures::allocate(const std::string& name, GLenum format, int layers, int levels) {
    GlTexture& texture = adopt(name, GlTexture::array(context_, format, width_, height_, layers, levels));
    texture.set_trading();  // it may get a history
    return texture;
}

GlTexture& PlaneTextures::take(const std::string& name, GLenum format, int layers, int levels) {
    const auto overwritten = lifetimes_.in_place.find(name);
    if (overwritten == lifetimes_.in_place.end())
        return pool_.take(format, layers, lifetimes_.chained.contains(name) ? pool_.most_levels() : levels);
    GlTexture& texture = *shared_.at(overwritten->second);
    // Of a chain's layers the last ones may be read by nobody.
    const bool is_chain = lifetimes_.chained.contains(overwritten->second);
    const bool has_layers = is_chain ? texture.layers() >= layers : texture.layers() == layers;
    if (texture.format() != format || !has_layers || texture.levels() < levels) {
        throw GlError(
            fmt::format("the plane '{}' cannot overwrite '{}', which has another shape", name, overwritten->second));
    }
    return texture;
}

GlTexture& PlaneTextures::adopt(const std::string& name, GlTexture texture) {
    borrow(name, texture);
    GlTexture& kept = own_.emplace(name, std::move(texture)).first->second;
    textures_[name] = &kept;
    return kept;
}

void PlaneTextures::borrow(const std::string& name, const GlTexture& texture) {
    if (!textures_.emplace(name, &texture).second)
        throw GlError(fmt::format("two passes allocate the plane '{}'", name));
}

void PlaneTextures::give_up(const PlaneLifetimes::Ended& ended) {
    const auto found = shared_.find(ended.plane);
    if (found == shared_.end()) return;
    pool_.give_back(*found->second, ended.first_layer);
    if (ended.first_layer > 0) return;
    shared_.erase(found);
    given_up_.insert(ended.plane);
}

const PlaneHistory& PlaneTextures::create_history(const std::string& name, const std::string& before) {
    const auto found = own_.find(name);
    if (found == own_.end()) {
        throw GlError(
            fmt::format("the plane '{}' can have no history: it shares its memory with others, unless the pass "
                        "that makes it declares it as kept",
                        name));
    }
    GlTexture& now = found->second;
    if (!lifetimes_.within_frame.contains(before)) {
        GlTexture& then = allocate(before, now.format(), now.layers(), now.levels());
        return histories_.emplace(name, PlaneHistory(now, then)).first->second;
    }
    const PooledHistory pooled = pool_.take_history(now);
    borrow(before, *pooled.taken);
    shared_.emplace(before, pooled.taken);
    return histories_.emplace(name, pooled.history).first->second;
}

const PlaneHistory* PlaneTextures::history_of(std::string_view name) const {
    const auto found = histories_.find(name);
    return found == histories_.end() ? nullptr : &found->second;
}

const GlTexture* PlaneTextures::find(std::string_view name) const {
    const auto found = textures_.find(name);
    if (found == textures_.end()) return nullptr;
    if (given_up_.contains(name)) {
        throw GlError(
            fmt::format("the plane '{}' was given up after the last pass that declares it; let the one that "
                        "reads it now name it among its inputs",
                        name));
    }
    return found->second;
}

const GlTexture& PlaneTextures::get(std::string_view name) const {
    if (const GlTexture* found = find(name)) return *found;
    std::string names;
    for (const auto& [known, texture] : textures_) names += names.empty() ? known : ", " + known;
    throw GlError(
        fmt::format("no pass has allocated the plane '{}'; there are: {}", name, names.empty() ? "none" : names));
}

}  // namespace plumb
