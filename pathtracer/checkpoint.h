// A part of a reference on disk, an interrupted run or a shard: the sums so far and what they belong to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "pathtracer/reference.h"

namespace plumb {

// Tells runs apart: sums may only be continued with the same scene, view and settings, by a program that makes the same
// samples of them, where Embree computes the same bits. The number of samples and the target error may differ.
struct CheckpointKey {
    std::uint64_t scene = 0, view = 0, settings = 0, integrator = 0, embree = 0;

    // Of this program. `span` is the path tracer's, `embree` the fingerprint of its Embree.
    static CheckpointKey of(const Scene& scene, const TimeSpan& span, const View& view,
                            const ReferenceSettings& settings, std::uint64_t embree);
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

// Adds the file's sums to `sums`. Throws ReferenceError for a file that is not a checkpoint, is truncated or damaged,
// or belongs to another scene, view, settings, build or Embree; `sums` may then be of no use.
CheckpointState add_checkpoint(const std::filesystem::path& path, const CheckpointKey& key, std::span<double> sums);

}  // namespace plumb
