#include "metrics/regions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

// Reads depth and normal of a G-buffer and finds pixels at edges.
class EdgeFinder {
public:
    EdgeFinder(const Image& depth, const Image& normal, const RegionSettings& settings)
        : depth_(depth),
          normal_(normal),
          least_cosine_(std::cos(settings.silhouette_normal_angle * std::numbers::pi / 180.0)),
          most_bend_(settings.silhouette_depth_bend) {}

    bool at_edge(int x, int y) const {
        const bool here = is_surface(depth_.at(x, y));
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                if (!inside(x + dx, y + dy)) continue;
                if (is_surface(depth_.at(x + dx, y + dy)) != here) return true;
                if (here && cosine(x, y, x + dx, y + dy) < least_cosine_) return true;
            }
        }
        return here && (bend(x, y, 1, 0) > most_bend_ || bend(x, y, 0, 1) > most_bend_);
    }

private:
    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < depth_.width() && y < depth_.height(); }

    double cosine(int x0, int y0, int x1, int y1) const {
        const auto a = normal_.pixel(x0, y0), b = normal_.pixel(x1, y1);
        return double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
    }

    // Only called where all neighbours that exist show a surface.
    double bend(int x, int y, int dx, int dy) const {
        if (!inside(x - dx, y - dy) || !inside(x + dx, y + dy)) return 0.0;
        const double z = depth_.at(x, y);
        return std::abs(z / depth_.at(x - dx, y - dy) - 2.0 + z / depth_.at(x + dx, y + dy));
    }

    const Image &depth_, &normal_;
    double least_cosine_, most_bend_;
};

template <typename Belongs>
Region make_region(std::string name, const Image& like, const Belongs& belongs) {
    Region region{std::move(name), Image(like.width(), like.height(), 1), 0};
    for (int y = 0; y < like.height(); ++y) {
        for (int x = 0; x < like.width(); ++x) {
            if (!belongs(x, y)) continue;
            region.mask.at(x, y) = 1.0f;
            ++region.pixels;
        }
    }
    return region;
}

// 1 within `width` pixels (of the larger of the two distances) of a pixel that is 1: rows first, then columns.
Image widened(const Image& mask, int width) {
    const auto pass = [&](const Image& from, int dx, int dy) {
        Image to(from.width(), from.height(), 1);
        for (int y = 0; y < from.height(); ++y) {
            for (int x = 0; x < from.width(); ++x) {
                for (int i = -width; i <= width && to.at(x, y) == 0.0f; ++i) {
                    const int nx = std::clamp(x + i * dx, 0, from.width() - 1),
                              ny = std::clamp(y + i * dy, 0, from.height() - 1);
                    to.at(x, y) = from.at(nx, ny);
                }
            }
        }
        return to;
    };
    return pass(pass(mask, 1, 0), 0, 1);
}

Region silhouettes_of(const Image& depth, const Image& normal, const RegionSettings& settings) {
    const EdgeFinder finder(depth, normal, settings);
    const Region edges = make_region("edges", depth, [&](int x, int y) { return finder.at_edge(x, y); });
    const Image near = widened(edges.mask, settings.silhouette_width);
    return make_region(region_names()[0], depth, [&](int x, int y) { return near.at(x, y) != 0.0f; });
}

Region newly_seen_from_motion(const Frame& now, const Frame& before, double tolerance) {
    require_motion(now, "the G-buffer");
    const Image &motion = now.plane("motion"), &depth = now.plane("depth"), &position = now.plane("position"),
                &position_before = before.plane("position");
    require_same_shape(position_before, position, "plane 'position' of two frames");
    return make_region(region_names()[1], depth, [&](int x, int y) {
        return is_surface(depth.at(x, y)) && !place_before(motion, depth, position, position_before, x, y, tolerance);
    });
}

void require_settings(const RegionSettings& settings) {
    if (settings.silhouette_width < 0 || !(settings.border >= 0.0 && settings.border <= 0.5) ||
        !(settings.silhouette_normal_angle > 0.0) || !(settings.silhouette_depth_bend > 0.0)) {
        throw ImageError(fmt::format(
            "regions need a silhouette width of 0 or more pixels, an angle and a bend above 0 and a border from 0 to "
            "0.5, not {}, {}, {} and {}",
            settings.silhouette_width, settings.silhouette_normal_angle, settings.silhouette_depth_bend,
            settings.border));
    }
}

}  // namespace

const std::vector<std::string>& region_names() {
    static const std::vector<std::string> names = {"silhouettes", "newly_seen", "second_layer", "border", "rest"};
    return names;
}

std::vector<Region> regions_of(const Frame& truth_gbuffer, const Frame* before, const RegionSettings& settings) {
    require_settings(settings);
    const Image &depth = truth_gbuffer.plane("depth"), &normal = truth_gbuffer.plane("normal");
    if (depth.channels() != 1 || normal.channels() != 3) {
        throw ImageError(fmt::format("regions need planes depth with 1 channel and normal with 3, not {} and {}",
                                     depth.channels(), normal.channels()));
    }
    std::vector<Region> regions;
    regions.push_back(silhouettes_of(depth, normal, settings));
    if (truth_gbuffer.has("seen_before")) {
        const Image& seen = truth_gbuffer.plane("seen_before");
        regions.push_back(make_region(region_names()[1], depth, [&](int x, int y) {
            return is_surface(depth.at(x, y)) && seen.at(x, y) == 0.0f;
        }));
    } else if (before) {
        regions.push_back(newly_seen_from_motion(truth_gbuffer, *before, settings.tolerance));
    }
    if (truth_gbuffer.has("layer2.depth")) {
        const Image& second = truth_gbuffer.plane("layer2.depth");
        regions.push_back(
            make_region(region_names()[2], depth, [&](int x, int y) { return is_surface(second.at(x, y)); }));
    }
    const double margin = settings.border * std::min(depth.width(), depth.height());
    regions.push_back(make_region(region_names()[3], depth, [&](int x, int y) {
        // Distances of the pixel's centre.
        return std::min({x + 0.5, y + 0.5, depth.width() - x - 0.5, depth.height() - y - 0.5}) < margin;
    }));
    Region rest = make_region(region_names()[4], depth, [&](int x, int y) {
        return std::ranges::none_of(regions, [&](const Region& region) { return region.mask.at(x, y) != 0.0f; });
    });
    regions.push_back(std::move(rest));
    return regions;
}

std::vector<ErrorInRegion> errors_in_regions(const Frame& method, const Frame& reference, std::string_view plane,
                                             int reference_samples, const std::vector<Region>& regions,
                                             const ReferencedErrorSettings& settings) {
    std::vector<ErrorInRegion> errors;
    for (const Region& region : regions) {
        if (region.pixels == 0) continue;
        ReferencedErrorSettings inside = settings;
        inside.mask = &region.mask;
        errors.push_back(
            {region.name, region.pixels, referenced_error(method, reference, plane, reference_samples, inside)});
    }
    return errors;
}

}  // namespace plumb
