// 95 % intervals of means over images and over series of images, by drawing blocks with replacement.
//
// Pixels cannot be drawn one by one: what neighbours show is alike over the width of filters and gathering radii, and
// drawing them singly would give intervals that are far too narrow. So square blocks of pixels are drawn (percentile
// interval of the bootstrap, Efron 1979; blocks: Kuensch 1989). A series of images is drawn in two ways at once: blocks
// of the image, each with its whole history, and runs of consecutive frames, each with its whole image; a block of a
// run counts as often as the block times as often as the run (Owen 2007, "The pigeonhole bootstrap"). That covers what
// sticks to a place through all frames and what hits all places of a frame; where neither is so, the interval comes
// out too wide, by a factor of at most the root of three.
//
// The same on every run and every machine (fixed seed, own generator).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "frames/image.h"

namespace plumb {

// A mean and its 95 % interval.
struct Estimate {
    double value = 0, lower = 0, upper = 0;

    // Of the root, for means of squares; below zero, where an unbiased estimate may lie, the root is 0.
    Estimate root() const;
};

struct BootstrapSettings {
    int block_size = 32;   // pixels, at most; wider than the blurs
    int resamples = 1000;  // draws: the 2.5 % tail then holds 25; 40 at least
    std::uint64_t seed = 1;
};

// Sum over values of a block.
struct BlockSum {
    double sum = 0;
    std::size_t values = 0;

    // A value, or the sum of `count` of them.
    void add(double value, std::size_t count = 1) {
        sum += value;
        values += count;
    }
};

// Over the values of all blocks; NaN where there are none.
double mean_of(const std::vector<BlockSum>& blocks);

// Which block a pixel is in. Blocks of the wanted size are halved until 64 of them hold pixels that count: fewer make
// percentiles coarse.
class BlockGrid {
public:
    // Throws ImageError where the mask does not fit.
    BlockGrid(int width, int height, int largest_size, const Image* mask = nullptr);

    int block_size() const { return size_; }
    int rows() const { return rows_; }
    std::size_t count() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
    std::size_t block_of(int x, int y) const {
        return static_cast<std::size_t>(y / size_) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(x / size_);
    }

private:
    int size_, columns_ = 0, rows_ = 0;
};

// Of the mean over all values of one image's blocks. NaN where no block holds a value; infinite to both sides where
// only one does. Throws ImageError for fewer than 40 resamples.
Estimate bootstrap_mean(std::vector<BlockSum> blocks, const BootstrapSettings& settings = {});

// Of any number that follows from an image's blocks, such as a ratio of two sums: `statistic` is told how often each of
// `blocks` blocks counts. Draws whose statistic is not finite are left out; infinite to both sides where fewer than 40
// are left. Throws ImageError for fewer than 40 resamples.
Estimate bootstrap_of_draws(std::size_t blocks, const std::function<double(const std::vector<double>&)>& statistic,
                            const BootstrapSettings& settings = {});

// The mean over a series, fed frame by frame; it keeps one sum per block and frame.
class BlockSeries {
public:
    // Frames are drawn in runs of so many at most, halved until there are 8 runs. 1: one by one, for members that have
    // nothing to do with their neighbours, such as other seeds.
    explicit BlockSeries(std::size_t longest_run = 8) : longest_run_(longest_run) {}

    // Every frame has the same number of blocks; throws ImageError else.
    void add(std::vector<BlockSum> frame);

    std::size_t frames() const { return frames_.size(); }
    // A series of one frame has the interval of an image.
    Estimate mean(const BootstrapSettings& settings = {}) const;

private:
    std::size_t longest_run_;
    std::vector<std::vector<BlockSum>> frames_;
};

}  // namespace plumb
