#include "frames/quantities.h"

#include <algorithm>

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {

std::string_view to_string(Falloff falloff) {
    switch (falloff) {
        case Falloff::hard:
            return "hard";
        case Falloff::quadratic:
            return "quadratic";
        case Falloff::cubic:
            return "cubic";
    }
    return "";
}

Falloff falloff_from_string(std::string_view name) {
    for (const Falloff falloff : {Falloff::hard, Falloff::quadratic, Falloff::cubic}) {
        if (name == to_string(falloff)) return falloff;
    }
    throw ImageError(fmt::format("unknown falloff '{}'; use hard, quadratic or cubic", name));
}

bool Quantities::wants(std::string_view plane) const { return std::ranges::find(planes, plane) != planes.end(); }

bool Quantities::wants_any(std::string_view prefix) const {
    return std::ranges::any_of(planes, [&](const std::string& plane) {
        return plane == prefix ||
               (plane.starts_with(prefix) && plane.size() > prefix.size() && plane[prefix.size()] == '.');
    });
}

}  // namespace plumb
