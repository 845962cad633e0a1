// The error of an image against a reference that is itself noisy, with an interval, and whether to believe it.
//
// A path-traced reference keeps two independent halves A and B; its mean is R = (A + B) / 2. The noise of R adds to the
// plain mean (I - R)^2, so that a perfect method would still look wrong. The product of the two halves' errors is free
// of it:
//
//   mse = mean (I - A)(I - B) = mean (I - R)^2 - mean (A - B)^2 / 4
//
// E[(I - A)(I - B)] = (I - T)^2 for the truth T, because A and B are independent and unbiased. The second term of the
// right side is the noise: (A - B)^2 / 4 estimates the variance of R. (Two half-buffers for error estimates: Rousselle,
// Knaus, Zwicker 2012, "Adaptive Rendering with Non-Local Means Filtering".) The estimate may come out below zero where
// the error is lost in the noise.
//
// The 95 % interval is the percentile interval of a block bootstrap (Efron 1979; blocks: Kuensch 1989): square blocks
// of pixels are drawn with replacement. Pixels cannot be drawn one by one: errors of neighbours are alike over the
// width of filters and gathering radii. Blocks are 32 pixels wide, wider than the blurs; where that leaves fewer than
// 64 blocks, which makes percentiles coarse, they are halved until it does not. The interval covers both the noise and
// how evenly the error is spread over the image; it is the same on every run (fixed seed).
//
// `trustworthy` asks for two things: the reference's noise is at most a tenth of the error (noise_limit), and the
// interval excludes zero. A tenth, because measures which have no unbiased form (SSIM, percentiles, relative MSE, the
// error images) see error plus noise: sqrt(1.1) inflates an RMSE by 5 %. An error of exactly zero against a noiseless
// reference is trusted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "frames/frame.h"

namespace plumb {

struct ReferencedErrorSettings {
    double noise_limit = 0.1;  // largest share of the error that the reference's noise may have
    int block_size = 32;       // pixels, at most; halved for small images
    int resamples = 1000;      // bootstrap draws: the 2.5 % tail then holds 25
    std::uint64_t seed = 1;
    const Image* mask = nullptr;  // pixels that count
};

struct ReferencedError {
    double mse = 0;                  // unbiased
    double lower = 0, upper = 0;     // 95 % interval of mse
    double plain_mse = 0;            // mean (I - R)^2, biased upwards by the noise
    double reference_noise_mse = 0;  // mean variance of R
    double ratio = 0;                // reference_noise_mse / mse; infinite where mse is not positive but the noise is
    bool trustworthy = false;
    double noise_limit = 0;
    int reference_samples = 0;  // per pixel, both halves together; 0: unknown
    int block_size = 0;         // that was used
    std::size_t left_out = 0;   // values that are not finite in the image or a half

    // Samples per pixel (even, both halves together) with which the noise would fall below the limit, noise falling
    // with 1 / samples. Where mse is not positive its upper bound is taken, so that the answer is "at least". None
    // where even that is not positive, or the samples are unknown.
    std::optional<std::int64_t> samples_needed() const;
};

// Throws ImageError where shapes differ or nothing is left to compare.
ReferencedError referenced_error(const Image& test, const Image& half_a, const Image& half_b, int reference_samples,
                                 const ReferencedErrorSettings& settings = {});

// The same of a plane of two frames; the reference has "half_a." and "half_b." of it.
ReferencedError referenced_error(const Frame& method, const Frame& reference, std::string_view plane,
                                 int reference_samples, const ReferencedErrorSettings& settings = {});

}  // namespace plumb
