// A frame: the named float planes of one view, as a renderer hands them over and as a metric takes them.
//
// Plane names are those of the quantities: ao, direct, indirect, indirect.1, irradiance, reflection, emission, total,
// depth, normal, albedo, motion, position; "layer2." before a name means the second layer; "half_a.", "half_b." and
// "variance." before a name are the two independent halves of a reference and the variance of its mean.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "frames/image.h"

namespace plumb {

// True for planes that say something about another plane: half_a.*, half_b.* and variance.*.
bool is_derived_plane(std::string_view name);

class Frame {
public:
    Frame() = default;
    Frame(int width, int height) : width_(width), height_(height) {}

    int width() const { return width_; }
    int height() const { return height_; }

    // Adds or replaces a plane. Throws ImageError where its size is not the frame's.
    Image& set(std::string name, Image image);
    bool has(std::string_view name) const;
    // Throws ImageError that lists the planes there are.
    const Image& plane(std::string_view name) const&;
    Image& plane(std::string_view name) &;
    Image plane(std::string_view name) &&;  // of a frame about to vanish: the plane itself
    std::vector<std::string> plane_names() const;

    // Free-form facts that travel with the frame into its file: scene, view, method, samples, seed, renderer...
    std::map<std::string, std::string> facts;

private:
    int width_ = 0, height_ = 0;
    std::map<std::string, Image, std::less<>> planes_;
};

}  // namespace plumb
