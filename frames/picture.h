// Pictures to look at: planes turned into display values, and PNG files. The only place where values are clamped;
// nothing that comes out of here is ever measured.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "frames/colour_map.h"
#include "frames/image.h"
#include "frames/tone_map.h"

namespace plumb {

struct PictureSettings {
    float exposure = 0.0f;                     // stops: radiance is multiplied by 2^exposure before the sRGB curve
    float low = 0.0f;                          // the scalar shown black...
    float high = 1.0f;                         // ...and white; depth finds its own range
    ToneCurve tone_curve = ToneCurve::linear;  // of radiance
    float bloom = 0.0f;                        // of radiance, 0 to 1
};

// Each returns sRGB-encoded values in 0..1 (Image of 3 channels); NaN is magenta, infinities are the nearest end.
// Radiance: 3 channels, or 1 shown grey.
Image picture_of_radiance(const Image& radiance, float exposure = 0.0f, ToneCurve curve = ToneCurve::linear);
Image picture_of_scalar(const Image& scalar, float low = 0.0f, float high = 1.0f);  // 1 channel, grey, no curve
Image picture_of_vectors(const Image& vectors);  // normals: 0.5 n + 0.5; 2 channels leave blue at 0.5
Image picture_of_depth(const Image& depth);  // near is bright, its finite positive range normalised; nothing is black

// The one of these that suits the plane's name: depth, normal, ao, motion and position (both scaled by their largest
// magnitude), alpha; anything else is radiance.
Image picture_of_plane(std::string_view plane, const Image& image, const PictureSettings& settings = {});

// Writes display values (1 or 3 channels) as 8-bit PNG, atomically. Values are clamped to 0..1 and rounded.
void write_png(const std::filesystem::path& path, const Image& displayed);
// picture_of_plane, written.
void write_png(const std::filesystem::path& path, std::string_view plane, const Image& image,
               const PictureSettings& settings = {});
// The bytes of such a file, for pages that contain their pictures.
std::string encode_png(const Image& displayed);
// The same as JPEG, without subsampling of colour: smaller where there are many, and never to be measured. `quality` is
// 1 to 100.
std::string encode_jpeg(const Image& displayed, int quality);

}  // namespace plumb
