#include "pathtracer/reference_identity.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plumb {
namespace {

std::string optional_view_identity(const std::optional<View>& view) { return view ? view_identity(*view) : "none"; }

std::string oracle_identity(const std::optional<OracleSettings>& oracle) {
    if (!oracle) return "none";
    return fmt::format("{} layers {:a} apart of {}", oracle->layers, oracle->minimum_separation,
                       view_identity(oracle->view));
}

}  // namespace

std::string view_identity(const View& view) {
    const Camera& camera = view.camera();
    std::string text = "camera";
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) text += fmt::format(" {:a}", camera.world_from_camera[column][row]);
    }
    // The width that is seen tells views with a guard band apart.
    text += fmt::format(" sees {:a} {:a} near {:a} far {:a} aperture {:a} focus {:a} size {}x{}", view.tan_half().x,
                        view.tan_half().y, camera.near_plane, camera.far_plane, camera.aperture_radius,
                        camera.focus_distance, view.width(), view.height());
    if (view.offset() != glm::vec2(0.0f)) text += fmt::format(" offset {:a} {:a}", view.offset().x, view.offset().y);
    return text;
}

std::string sampling_identity(const ReferenceSettings& settings, const TimeSpan& span) {
    const Quantities& quantities = settings.quantities;
    std::vector<std::string> planes = quantities.planes;
    std::ranges::sort(planes);  // their order changes nothing
    std::string text = fmt::format("time {:a} to {:a}; previous {}; planes {}", span.begin, span.end,
                                   optional_view_identity(settings.previous_view), fmt::join(planes, ","));
    text += fmt::format("; ao_radius {:a} {}; bounces {}; indirect_radius {:a} {}; reflection_radius {:a} {}",
                        quantities.ao_radius, to_string(quantities.ao_falloff), quantities.bounces,
                        quantities.indirect_radius, to_string(quantities.indirect_falloff),
                        quantities.reflection_radius, to_string(quantities.reflection_falloff));
    text += fmt::format("; seed {}; minimum_separation {:a}; antialias {}; emitter_sampling {}; points {}",
                        settings.seed, settings.minimum_separation, settings.antialias,
                        static_cast<int>(settings.emitter_sampling), static_cast<int>(settings.points));
    text += fmt::format("; roulette_after {}; oracle {}; shutter opens at {}", settings.roulette_after,
                        oracle_identity(settings.oracle), optional_view_identity(settings.view_at_shutter_opening));
    return text;
}

}  // namespace plumb
