// A part of a reference on disk, an interrupted run or a shard: the sums so far and what they belong to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "pathtracer/reference.h"

namespace plumb {

// Tells runs apart: sums may only be continued with the same scene, view and settings. The number of samples and the
// target error may differ.
struct CheckpointKey {
    std::uint64_t scene = 0, view = 0, settings = 0;

    // `span` is the path tracer's.
    static CheckpointKey of(const Scene& scene, const TimeSpan& span, const View& view,
                            const ReferenceSettings& settings);
};

// Samples begin to end - 1 of every pixel are in the sums.
struct CheckpointState {
    int begin = 0, end = 0;
    std::uint64_t rays = 0;
    double seconds = 0.0;
};

// Atomic: a crash, a full disk or an unwritable folder leaves an older checkpoint as it was. Throws ImageError.
void write_checkpoint(const std::filesystem::path& path, const CheckpointKey& key, const CheckpointState& state,
                      std::span<const double> sums);

// Fills `sums`. Throws ReferenceError for a file that is not a checkpoint, is truncated or damaged, or belongs to
// another scene, view or settings.
CheckpointState read_checkpoint(const std::filesystem::path& path, const CheckpointKey& key, std::span<double> sums);

}  // namespace plumb
