#include "rasterizer/radiosity_planes.h"

#include <fmt/format.h>

namespace plumb {

std::string radiosity_plane(int bounce) { return bounce == 1 ? "radiosity" : fmt::format("radiosity.{}", bounce); }

std::string gathered_plane(const RadiositySettings& settings, int bounce) {
    return settings.blur.radius > 0 ? radiosity_plane(bounce) + ".unfiltered" : blurred_plane(settings, bounce);
}

std::string blurred_plane(const RadiositySettings& settings, int bounce) {
    return radiosity_plane(bounce) + (settings.temporal.alpha > 0.0f ? ".of_frame" : "");
}

std::string indirect_plane(int bounce) { return fmt::format("indirect.{}", bounce); }

std::string sent_plane(const RadiositySettings& settings, int bounce) {
    if (bounce > 1) return indirect_plane(bounce - 1);
    return settings.carry ? std::string(sent_radiosity_plane) : "direct";
}

int receiving_layers(const RadiositySettings& settings, int bounce) {
    const bool gathers = settings.second_layer == SecondLayerIndirect::gather;
    return gathers && !plane_of_later_bounces(settings, bounce).empty() ? settings.layers : 1;
}

int sending_layers(const RadiositySettings& settings, int bounce) {
    return bounce > 1 && settings.second_layer == SecondLayerIndirect::none ? 1 : settings.layers;
}

std::string plane_of_later_bounces(const RadiositySettings& settings, int bounce) {
    if (settings.carry) return std::string(sent_radiosity_plane);
    return bounce < settings.bounces ? indirect_plane(bounce) : "";
}

}  // namespace plumb
