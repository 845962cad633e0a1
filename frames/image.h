// A float image of any number of channels: the one container for everything that a renderer hands over.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "frames/zeroed_array.h"

namespace plumb {

// Row-major, top row first, channels interleaved; values are linear and never clamped.
class Image {
public:
    Image() = default;
    Image(int width, int height, int channels, float value = 0.0f)
        : width_(width),
          height_(height),
          channels_(channels),
          values_(static_cast<std::size_t>(width) * height * channels) {
        if (value != 0.0f) std::ranges::fill(values(), value);
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    std::size_t pixel_count() const { return static_cast<std::size_t>(width_) * height_; }
    bool empty() const { return values_.empty(); }

    float& at(int x, int y, int channel = 0) { return values_[index(x, y) + channel]; }
    float at(int x, int y, int channel = 0) const { return values_[index(x, y) + channel]; }
    std::span<float> pixel(int x, int y) { return {&values_[index(x, y)], static_cast<std::size_t>(channels_)}; }
    std::span<const float> pixel(int x, int y) const {
        return {&values_[index(x, y)], static_cast<std::size_t>(channels_)};
    }
    std::span<float> values() { return values_.values(); }
    std::span<const float> values() const { return values_.values(); }

    bool same_shape(const Image& other) const {
        return width_ == other.width_ && height_ == other.height_ && channels_ == other.channels_;
    }

private:
    std::size_t index(int x, int y) const { return (static_cast<std::size_t>(y) * width_ + x) * channels_; }

    int width_ = 0, height_ = 0, channels_ = 0;
    ZeroedArray<float> values_;
};

}  // namespace plumb
