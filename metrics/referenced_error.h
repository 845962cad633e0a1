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
// An image under test may be noisy for reasons that are not its error: what the oracle makes of two layers, with ever
// more samples. Where it comes as two halves of its own, its noise is taken out as well:
//
//   mse = mean (Ia - A)(Ib - B)
//
// E[(Ia - A)(Ib - B)] = E[Ia - A] E[Ib - B] = (I - T)^2, because what has to do with half a (Ia and A) is independent
// of what has to do with half b (Ib and B). Ia and A need not be independent of each other: rendered with the same
// seed, the noise they share even cancels, and the estimate is the steadier for it.
//
// The relative MSE (pixel_errors.h) divide the same products by w(R). PSNR follows from mse (measure_blocks.h). A - B,
// which the products take off, has nothing to do with R, where both halves are equally noisy; what R's noise does to
// the denominator stays: a share of about 3 s^2 / r^2 of the relative MSE and 6 s^4 / r^4 beside it, for a variance s^2
// of R. That is the less, the more trustworthy the error.
//
// The 95 % interval is that of a block bootstrap (block_bootstrap.h). It covers both the noise and how evenly the error
// is spread over the image.
//
// `trustworthy` asks for two things: the reference's noise is at most a tenth of the error (noise_limit), and the
// interval excludes zero. A tenth, because measures which have no unbiased form (SSIM, percentiles, the error
// images) see error plus noise: sqrt(1.1) inflates an RMSE by 5 %. An error of exactly zero against a noiseless
// reference is trusted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frames/frame.h"
#include "metrics/block_bootstrap.h"
#include "metrics/pixel_errors.h"

namespace plumb {

// What the independent halves of a plane are called, and whether a frame has both.
std::string half_a_of(std::string_view plane);
std::string half_b_of(std::string_view plane);
bool has_halves(const Frame& frame, std::string_view plane);

struct ReferencedErrorSettings {
    double noise_limit = 0.1;  // largest share of the error that the noise may have
    BootstrapSettings bootstrap;
    const Image* mask = nullptr;  // pixels that count
};

struct ReferencedError {
    double mse = 0;                                           // unbiased
    double lower = 0, upper = 0;                              // 95 % interval of mse
    std::array<Estimate, relative_mses.size()> relative_mse;  // in order of relative_mses
    double plain_mse = 0;                                     // mean (I - R)^2, biased upwards by the noise
    double reference_noise_mse = 0;  // mean variance of R; of I - R where I comes as two halves
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

// Of an image that comes as two halves, each independent of the other half of both.
ReferencedError paired_referenced_error(const Image& test_a, const Image& test_b, const Image& half_a,
                                        const Image& half_b, int reference_samples,
                                        const ReferencedErrorSettings& settings = {});

// The same of a plane of two frames; the reference has "half_a." and "half_b." of it. Where the method has them too
// they are paired: its noise is then no error.
ReferencedError referenced_error(const Frame& method, const Frame& reference, std::string_view plane,
                                 int reference_samples, const ReferencedErrorSettings& settings = {});

// What a referenced error is made of.
struct ErrorSums {
    std::vector<BlockSum> products;                                    // of the errors against either half, per block
    std::array<std::vector<BlockSum>, relative_mses.size()> relative;  // the same over w(R)
    double plain = 0, noise = 0;                                       // sums over all blocks
    std::size_t values = 0, left_out = 0;
    int block_size = 0;
};

// Throws as paired_referenced_error, but not for having nothing to compare.
ErrorSums sum_errors(const Image& test_a, const Image& test_b, const Image& half_a, const Image& half_b,
                     const BlockGrid& grid, const Image* mask = nullptr);
// The same of a plane of two frames, paired as referenced_error() pairs them.
ErrorSums sum_errors(const Frame& method, const Frame& reference, std::string_view plane, const BlockGrid& grid,
                     const Image* mask = nullptr);
// Means of the products, plain and relative.
struct ErrorMeans {
    Estimate mse;
    std::array<Estimate, relative_mses.size()> relative_mse;
};
ErrorMeans bootstrap_means(const ErrorSums& sums, const BootstrapSettings& settings = {});
// Their ends are NaN.
ErrorMeans means_without_intervals(const ErrorSums& sums);

// Throws ImageError where nothing was compared.
ReferencedError referenced_error_of(const ErrorSums& sums, const ErrorMeans& means, int reference_samples,
                                    double noise_limit);

}  // namespace plumb
