// Which dimension of a sample's sequence decides what along its path.
#pragma once

#include <cstdint>

#include "frames/quantities.h"

namespace plumb {

// What chooses the primary ray.
constexpr std::uint32_t pixel_dimension = 0, lens_dimension = 1, time_dimension = 2;
constexpr std::uint32_t primary_dimensions = 4;

// What every vertex of a path decides by a number, or a pair of them, of its own.
enum class VertexUse : std::uint32_t { extended_light, other_light, next_direction, lobe_pick, roulette, pane_pick };
constexpr std::uint32_t uses_per_vertex = 8;

// Of vertex k. Paths that start with the specular lobe have their own, as has each pane that a ray meets in a row.
constexpr std::uint32_t path_dimension(int vertex, bool from_specular_start, VertexUse use, std::uint32_t pane = 0) {
    constexpr std::uint32_t specular_paths = 1u << 16, panes_apart = 1u << 20;
    return primary_dimensions + uses_per_vertex * static_cast<std::uint32_t>(vertex) + static_cast<std::uint32_t>(use) +
           (from_specular_start ? specular_paths : 0u) + pane * panes_apart;
}

static_assert(path_dimension(most_diffuse_bounces + 1, false, VertexUse::pane_pick) <
                  path_dimension(0, true, VertexUse::extended_light),
              "paths that start with the specular lobe would share the numbers of the others");

}  // namespace plumb
