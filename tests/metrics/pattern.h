// Two images that differ, exact in float32 and easy to make again in another language; see test_ssim.cpp.
#pragma once

#include "frames/image.h"

namespace plumb::test {

inline Image pattern(int height, int width, bool changed) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const int change = changed ? (x / 8 + y / 8) * 5 : 0;
                image.at(x, y, c) = static_cast<float>((x * 37 + y * 91 + x * y + c * 17 + change) % 256) / 256.0f;
            }
        }
    }
    return image;
}

}  // namespace plumb::test
