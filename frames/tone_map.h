// How radiance is made fit for a screen: exposure, bloom, tone curve, sRGB. Only for pictures to look at: nothing that
// comes out of here is ever measured or kept in an EXR file.
//
// With x a channel of radiance, times 2^exposure:
//     linear   x                     what exceeds 1 is cut
//     filmic   h(2 x) / h(11.2),     h(x) = (x (A x + C B) + D E) / (x (A x + B) + D F) - E / F
//              A 0.15, B 0.50, C 0.10, D 0.20, E 0.02, F 0.30; 11.2 is the radiance that becomes white, the 2 an
//              exposure of its own
//              Source: Hable 2010, "Uncharted 2: HDR Lighting" (and his blog, "Filmic Tonemapping Operators").
//     aces     x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)
//              Source: Narkowicz 2016, "ACES Filmic Tone Mapping Curve": a fit, per channel, to the reference rendering
//              and output transforms for sRGB of the Academy Color Encoding System; times 1 / 0.6 brighter than those.
//     bloom    (1 - s) x + s b(x),   b the mean of the image averaged over squares of 2, 4... 64 pixels, each read
//              bilinearly; before the curve. Light is spread, none is added: a constant image stays as it is.
//              Squares in place of a lens's scattering, whose shape differs from lens to lens.
#pragma once

#include <string_view>

#include "frames/image.h"

namespace plumb {

enum class ToneCurve { linear, filmic, aces };

std::string_view to_string(ToneCurve curve);
ToneCurve tone_curve_from_string(std::string_view name);  // throws ImageError that lists the names

// The coefficients of aces: x (a x + b) / (x (c x + d) + e).
struct AcesFit {
    static constexpr float a = 2.51f, b = 0.03f, c = 2.43f, d = 0.59f, e = 0.14f;
};

// Of exposed radiance, 0 or more; 0 to 1 (linear: also more), still to be encoded as sRGB.
float apply_tone_curve(ToneCurve curve, float exposed);

// `strength` 0 to 1; throws ImageError else. Values that are not finite spread nothing and stay.
Image with_bloom(const Image& radiance, float strength);

}  // namespace plumb
