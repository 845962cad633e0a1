#include "experiments/packed_plane.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <vector>

#include <Imath/half.h>
#include <fmt/format.h>
#include <zlib.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

constexpr std::string_view format_name = "plumbline-plane";
constexpr int half_range_exponent = 15;  // of 32768: half floats reach 65504
constexpr int compression_level = 6;     // 9 takes twice the time for 1 % fewer bytes

// Half floats without the last bit of their 11 significant ones.
using Code = std::uint16_t;

int exponent_of_largest(const Image& image) {
    float largest = 0.0f;
    for (const float value : image.values()) {
        if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    }
    return largest > 0.0f ? std::ilogb(largest) + 1 - half_range_exponent : 0;
}

Code encode(float value, int exponent) {
    if (std::isnan(value)) return 0x3f00;
    // To 10 bits in one step; by way of the half's 11 it would be rounded twice. A carry into the exponent is the next
    // power of two.
    constexpr std::uint32_t last_kept_bit = 1u << 14u;
    const std::uint32_t rounded =
        (std::bit_cast<std::uint32_t>(std::ldexp(value, -exponent)) + last_kept_bit / 2) & ~(last_kept_bit - 1);
    const std::uint16_t bits = Imath::half(std::bit_cast<float>(rounded)).bits();
    return static_cast<Code>((bits + 1u) >> 1u);  // the last bit is set in subnormal numbers only
}

float decode(Code code, int exponent) {
    Imath::half value;
    value.setBits(static_cast<std::uint16_t>(code << 1u));
    return std::ldexp(static_cast<float>(value), exponent);
}

int predict(const std::vector<Code>& codes, int x, int y, int width) {
    const auto at = [&](int i, int j) -> int { return codes[static_cast<std::size_t>(j) * width + i]; };
    if (x == 0) return y == 0 ? 0 : at(0, y - 1);
    if (y == 0) return at(x - 1, 0);
    const int left = at(x - 1, y), above = at(x, y - 1), corner = at(x - 1, y - 1);
    if (corner >= std::max(left, above)) return std::min(left, above);
    if (corner <= std::min(left, above)) return std::max(left, above);
    return left + above - corner;
}

// Small numbers of either sign become small numbers: 0, -1, 1, -2...
std::uint16_t fold(std::uint16_t difference) {
    const auto value = std::bit_cast<std::int16_t>(difference);
    return static_cast<std::uint16_t>((static_cast<unsigned>(value) << 1u) ^ static_cast<unsigned>(value >> 15));
}
std::uint16_t unfold(std::uint16_t folded) { return static_cast<std::uint16_t>((folded >> 1u) ^ (0u - (folded & 1u))); }

std::string deflated(const std::vector<std::uint8_t>& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string result(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, bytes.data(), bytes.size(), compression_level) !=
        Z_OK) {
        throw ImageError(fmt::format("cannot compress {} bytes of a plane: no memory left", bytes.size()));
    }
    result.resize(size);
    return result;
}

ImageError broken(const std::string& what) {
    return ImageError(fmt::format("a packed plane {}; write the pictures again", what));
}

}  // namespace

std::string pack_plane(const Image& image) {
    if (image.empty()) throw ImageError("an image without pixels cannot be packed");
    const int width = image.width(), height = image.height(), channels = image.channels();
    const int exponent = exponent_of_largest(image);
    const std::size_t pixels = image.pixel_count(), values = pixels * static_cast<std::size_t>(channels);
    std::vector<std::uint8_t> bytes(2 * values);
    std::vector<Code> codes(pixels);
    std::vector<std::uint16_t> missed(pixels), missed_before(pixels, 0);
    for (int channel = 0; channel < channels; ++channel) {
        for (std::size_t i = 0; i < pixels; ++i) {
            codes[i] = encode(image.values()[i * static_cast<std::size_t>(channels) + channel], exponent);
        }
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * width + x;
                missed[i] = static_cast<std::uint16_t>(codes[i] - predict(codes, x, y, width));
                const std::uint16_t folded = fold(static_cast<std::uint16_t>(missed[i] - missed_before[i]));
                const std::size_t place = static_cast<std::size_t>(channel) * pixels + i;
                bytes[place] = static_cast<std::uint8_t>(folded >> 8u);
                bytes[values + place] = static_cast<std::uint8_t>(folded & 0xffu);
            }
        }
        std::swap(missed, missed_before);
    }
    return fmt::format("{} {} {} {} {}\n", format_name, width, height, channels, exponent) + deflated(bytes);
}

Image unpack_plane(std::string_view bytes) {
    const auto end = bytes.substr(0, 100).find('\n');
    if (end == std::string_view::npos) throw broken("does not begin with a line that describes it");
    std::istringstream header{std::string(bytes.substr(0, end))};
    std::string name;
    int width = 0, height = 0, channels = 0, exponent = 0;
    constexpr int most = 1 << 16;
    if (!(header >> name >> width >> height >> channels >> exponent) || name != format_name ||
        std::min({width, height, channels}) < 1 || std::max({width, height, channels}) > most) {
        throw broken(fmt::format("begins with '{}'", bytes.substr(0, end)));
    }
    Image image(width, height, channels);
    const std::size_t pixels = image.pixel_count(), values = pixels * static_cast<std::size_t>(channels);
    std::vector<std::uint8_t> inflated(2 * values);
    uLongf size = inflated.size();
    const std::string_view stream = bytes.substr(end + 1);
    if (uncompress(inflated.data(), &size, reinterpret_cast<const Bytef*>(stream.data()), stream.size()) != Z_OK ||
        size != inflated.size()) {
        throw broken(fmt::format("of {}x{} pixels is damaged or not whole", width, height));
    }
    std::vector<Code> codes(pixels);
    std::vector<std::uint16_t> missed(pixels, 0);
    for (int channel = 0; channel < channels; ++channel) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * width + x;
                const std::size_t place = static_cast<std::size_t>(channel) * pixels + i;
                const auto folded =
                    static_cast<std::uint16_t>((inflated[place] << 8u) | unsigned{inflated[values + place]});
                missed[i] = static_cast<std::uint16_t>(missed[i] + unfold(folded));
                codes[i] = static_cast<Code>(predict(codes, x, y, width) + missed[i]);
                image.values()[i * static_cast<std::size_t>(channels) + channel] = decode(codes[i], exponent);
            }
        }
    }
    return image;
}

}  // namespace plumb
