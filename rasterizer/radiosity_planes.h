// The planes by which the passes of radiosity hand light on, one set per bounce k of a frame:
//
//   radiosity.sent                            what bounce 1 gathers where the method carries light on from frame to
//                                             frame (radiosity_carry.h); else that is `direct`
//   radiosity.unfiltered, radiosity.2.unfiltered ...   what bounce k gathers, before the blur; rgb: E, a: confidence
//   radiosity.of_frame, radiosity.2.of_frame ...       the same, blurred, where the method filters it over time
//   radiosity, radiosity.2 ...                the same in the end
//   radiosity.history_weight                  the weight that the frame before has in `radiosity`, where that is so
//   indirect.1, indirect.2 ...                what is reflected of it, which bounce k + 1 gathers
//
// Of the second layer they exist where a later bounce, or the next frame, gathers from it.
#pragma once

#include <string>
#include <string_view>

#include "rasterizer/method.h"

namespace plumb {

constexpr std::string_view sent_radiosity_plane = "radiosity.sent";

// Without a layer's prefix; bounces count from 1.
std::string radiosity_plane(int bounce);
std::string gathered_plane(const RadiositySettings&, int bounce);  // as gathered: the next where nothing is blurred
std::string blurred_plane(const RadiositySettings&, int bounce);   // the first where nothing is filtered over time
std::string indirect_plane(int bounce);
// The radiance that bounce `bounce` gathers.
std::string sent_plane(const RadiositySettings&, int bounce);

// Of how many layers the irradiance is gathered in that bounce, for others to gather from.
int receiving_layers(const RadiositySettings&, int bounce);
// From how many layers that bounce gathers light; the others only count as hits.
int sending_layers(const RadiositySettings&, int bounce);
// The plane through which another bounce, of this frame or of the next one, gathers from what this one brings: then it
// must cover the guard band. Empty: there is none.
std::string plane_of_later_bounces(const RadiositySettings&, int bounce);

}  // namespace plumb
