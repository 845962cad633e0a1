#include "frames/frame.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "frames/image_error.h"

namespace plumb {

bool is_derived_plane(std::string_view name) {
    return name.starts_with("half_a.") || name.starts_with("half_b.") || name.starts_with("variance.");
}

Image& Frame::set(std::string name, Image image) {
    if (image.width() != width_ || image.height() != height_) {
        throw ImageError(fmt::format("plane '{}' is {}x{}, but its frame is {}x{}", name, image.width(), image.height(),
                                     width_, height_));
    }
    return planes_.insert_or_assign(std::move(name), std::move(image)).first->second;
}

bool Frame::has(std::string_view name) const { return planes_.find(name) != planes_.end(); }

const Image& Frame::plane(std::string_view name) const& {
    const auto found = planes_.find(name);
    if (found == planes_.end()) {
        throw ImageError(fmt::format("the frame has no plane '{}'; it has: {}", name, fmt::join(plane_names(), ", ")));
    }
    return found->second;
}

Image& Frame::plane(std::string_view name) & { return const_cast<Image&>(std::as_const(*this).plane(name)); }

Image Frame::plane(std::string_view name) && { return std::move(plane(name)); }

std::vector<std::string> Frame::plane_names() const {
    std::vector<std::string> names;
    names.reserve(planes_.size());
    for (const auto& [name, image] : planes_) names.push_back(name);
    return names;
}

}  // namespace plumb
