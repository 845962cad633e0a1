#include "frames/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "frames/atomic_file.h"
#include "frames/image_error.h"
#include "frames/image_file.h"

namespace plumb {
namespace {

// The picture whose channels are display(value of the image's channel); grey where the image has one channel.
template <typename Display>
Image picture(const Image& image, float missing_channel, Display display) {
    Image result(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const auto in = image.pixel(x, y);
            const auto out = result.pixel(x, y);
            if (std::ranges::any_of(in, [](float value) { return std::isnan(value); })) {
                std::ranges::copy(colour_of_non_finite, out.begin());
                continue;
            }
            for (int c = 0; c < 3; ++c) {
                const bool present = c < image.channels() || image.channels() == 1;
                out[c] = present ? std::clamp(display(in[image.channels() == 1 ? 0 : c]), 0.0f, 1.0f) : missing_channel;
            }
        }
    }
    return result;
}

void check_channels(const Image& image, std::string_view what, std::initializer_list<int> allowed) {
    if (std::ranges::find(allowed, image.channels()) == allowed.end()) {
        throw ImageError(fmt::format("a picture of {} cannot be made from {} channels; pick channels first", what,
                                     image.channels()));
    }
}

float largest_magnitude(const Image& image) {
    float largest = 0.0f;
    for (const float value : image.values()) {
        if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    }
    return largest > 0.0f ? largest : 1.0f;
}

Image scaled(Image image, float factor) {
    for (float& value : image.values()) value *= factor;
    return image;
}

// The bytes of a file of 8 bits a channel; `format` is the extension of its name.
std::string encode(const Image& displayed, const std::string& format, OIIO::ImageSpec spec) {
    check_channels(displayed, "display values", {1, 3});
    if (displayed.empty()) throw ImageError(fmt::format("a picture of no pixels cannot be written as {}", format));
    std::vector<std::uint8_t> bytes;
    bytes.reserve(displayed.values().size());
    for (const float value : displayed.values()) {
        const float clamped = std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, 1.0f);
        bytes.push_back(static_cast<std::uint8_t>(std::lround(clamped * 255.0f)));
    }
    spec["oiio:ColorSpace"] = "sRGB";
    std::vector<unsigned char> file;
    OIIO::Filesystem::IOVecOutput memory(file);
    void* proxy = &memory;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const std::string name = fmt::format("memory.{}", format);
    const auto output = OIIO::ImageOutput::create(name);
    if (!output || !output->open(name, spec) || !output->write_image(OIIO::TypeDesc::UINT8, bytes.data()) ||
        !output->close()) {
        throw ImageError(fmt::format("cannot encode a {} of {}x{} pixels: {}", format, displayed.width(),
                                     displayed.height(), output ? output->geterror() : OIIO::geterror()));
    }
    return {file.begin(), file.end()};
}

OIIO::ImageSpec byte_spec(const Image& image) {
    return OIIO::ImageSpec(image.width(), image.height(), image.channels(), OIIO::TypeDesc::UINT8);
}

}  // namespace

Image picture_of_radiance(const Image& radiance, float exposure, ToneCurve curve) {
    check_channels(radiance, "radiance", {1, 3});
    const float factor = std::exp2(exposure);
    return picture(radiance, 0.0f, [factor, curve](float value) {
        if (std::isinf(value)) return value > 0.0f ? 1.0f : 0.0f;
        return linear_to_srgb(apply_tone_curve(curve, std::max(value, 0.0f) * factor));
    });
}

Image picture_of_scalar(const Image& scalar, float low, float high) {
    check_channels(scalar, "a scalar", {1, 3});
    if (!(low < high))
        throw ImageError(fmt::format("a picture of a scalar needs low < high, not {} and {}", low, high));
    return picture(scalar, 0.0f, [low, high](float value) { return (value - low) / (high - low); });
}

Image picture_of_vectors(const Image& vectors) {
    check_channels(vectors, "vectors", {2, 3});
    return picture(vectors, 0.5f, [](float value) { return 0.5f * value + 0.5f; });
}

Image picture_of_depth(const Image& depth) {
    check_channels(depth, "depth", {1});
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0f;
    for (const float value : depth.values()) {
        if (!std::isfinite(value) || value <= 0.0f) continue;
        nearest = std::min(nearest, value);
        farthest = std::max(farthest, value);
    }
    const float range = std::max(farthest - nearest, 1e-6f * farthest);
    return picture(depth, 0.0f, [nearest, range](float value) {
        // 0.15: the farthest surface stays visible beside the black of no surface at all.
        return std::isfinite(value) && value > 0.0f ? 1.0f - 0.85f * (value - nearest) / range : 0.0f;
    });
}

Image picture_of_plane(std::string_view plane, const Image& image, const PictureSettings& settings) {
    const auto dot = plane.rfind('.');
    const std::string_view name = dot == std::string_view::npos ? plane : plane.substr(dot + 1);
    if (name == "depth") return picture_of_depth(image);
    if (name == "normal") return picture_of_vectors(image);
    if (name == "motion" || name == "position")
        return picture_of_vectors(scaled(image, 1.0f / largest_magnitude(image)));
    if (name == "ao" || name == "alpha" || name == "seen_before")
        return picture_of_scalar(image, settings.low, settings.high);
    return picture_of_radiance(with_bloom(image, settings.bloom), settings.exposure, settings.tone_curve);
}

std::string encode_png(const Image& displayed) { return encode(displayed, "png", byte_spec(displayed)); }

std::string encode_jpeg(const Image& displayed, int quality) {
    OIIO::ImageSpec spec = byte_spec(displayed);
    spec["Compression"] = fmt::format("jpeg:{}", quality);
    spec["jpeg:subsampling"] = "4:4:4";
    return encode(displayed, "jpg", spec);
}

void write_png(const std::filesystem::path& path, const Image& displayed) {
    write_text_atomically(path, encode_png(displayed));
}

void write_png(const std::filesystem::path& path, std::string_view plane, const Image& image,
               const PictureSettings& settings) {
    write_png(path, picture_of_plane(plane, image, settings));
}

}  // namespace plumb
