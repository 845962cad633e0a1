#include "metrics/shape.h"

#include <fmt/format.h>

#include "frames/image_error.h"

namespace plumb {

void require_same_shape(const Image& test, const Image& reference, std::string_view what) {
    if (!test.same_shape(reference)) {
        throw ImageError(
            fmt::format("{} cannot be compared: {}x{} with {} channels against {}x{} with {} channels in the "
                        "reference; render both at one size and with the same planes",
                        what, test.width(), test.height(), test.channels(), reference.width(), reference.height(),
                        reference.channels()));
    }
    if (test.empty()) {
        throw ImageError(fmt::format("{} cannot be compared: {}x{} with {} channels hold no value", what, test.width(),
                                     test.height(), test.channels()));
    }
}

void require_mask_fits(const Image& mask, const Image& image) {
    if (mask.width() != image.width() || mask.height() != image.height() || mask.channels() != 1) {
        throw ImageError(
            fmt::format("a mask of {}x{} with {} channels does not fit images of {}x{}; it needs their size "
                        "and one channel",
                        mask.width(), mask.height(), mask.channels(), image.width(), image.height()));
    }
}

}  // namespace plumb
