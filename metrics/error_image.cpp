#include "metrics/error_image.h"

#include <cmath>
#include <limits>

#include "metrics/shape.h"

namespace plumb {
namespace {

template <typename Error>
Image error_image(const Image& test, const Image& reference, Error error) {
    require_same_shape(test, reference);
    Image result(test.width(), test.height(), test.channels());
    for (std::size_t i = 0; i < result.values().size(); ++i) {
        const double v = test.values()[i], r = reference.values()[i];
        result.values()[i] = std::isfinite(v) && std::isfinite(r) ? static_cast<float>(error(v, r))
                                                                  : std::numeric_limits<float>::quiet_NaN();
    }
    return result;
}

}  // namespace

Image absolute_error(const Image& test, const Image& reference) {
    return error_image(test, reference, [](double v, double r) { return std::abs(v - r); });
}

Image signed_difference(const Image& test, const Image& reference) {
    return error_image(test, reference, [](double v, double r) { return v - r; });
}

Image mean_of_channels(const Image& image) {
    Image result(image.width(), image.height(), 1);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            double sum = 0;
            for (const float value : image.pixel(x, y)) sum += value;
            result.at(x, y) = static_cast<float>(sum / image.channels());
        }
    }
    return result;
}

}  // namespace plumb
