// Screen-space radiosity over one or two layers: diffuse light after one or several bounces.
//
// Each bounce k is a chain of passes over the same layers:
//
//     gathering    E_k at each pixel, from what the layers sent (radiosity_gather.h)
//     blur         of E_k and its confidence (bilateral_blur.h), and its average over frames (temporal_filter.h)
//     reflection   indirect.k = albedo / pi E_k, which bounce k + 1 gathers (radiosity_reflection.h)
//
// What bounce 1 gathers is the plane `direct`. With `bounces` = K all K follow each other in a frame, as Nielsen 2015
// has it; with `carry` each frame adds one to what the frame before reflected, as Mara et al. 2016 have it
// (radiosity_carry.h). Then radiosity_sum.h makes the planes `irradiance` and `indirect`, which hold all bounces, and
// `confidence`. A plane indirect.k exists for k up to K; `indirect.1` costs no more bounces than one.
//
// Light that reaches X from emissive surfaces in one segment is `direct`, so they do not shine through taps. With
// `emitters_shine` they do, as in the sources: bounce 1 then gathers direct + emission. The emitters' light must be
// left out of `direct` (direct.emitters = false), or it would be counted twice, and takes the place of one bounce:
// `irradiance`, `indirect.k` and `indirect` hold light of emitters after one bounce less besides light of lamps, suns
// and the environment. No plane then means what the truth's plane of its name means; what is to be compared is the sum
// direct + indirect, with the truth's direct + indirect of one bounce less for emitters, which is the truth's `direct`
// where emissive surfaces are the only lights and there is one bounce.
#pragma once

#include <vector>

#include "rasterizer/pass.h"

namespace plumb {

// All passes of it, in the order of execution.
std::vector<PassDeclaration> declare_radiosity(const Scene& scene, const Method& method);

}  // namespace plumb
