// References kept on disk, found again by what they depend on.
//
// The key is a text that names everything that can change a pixel of a reference: the scene's content hash and the time
// it spans, the camera and its lens, the resolution, every setting of the reference, and a hash of the integrator's
// source files, so that a changed integrator never meets the reference of the one before. The file is
// named by a hash of the key and carries the whole key and a checksum of its pixels, so that neither a stale nor a
// damaged file passes. Two programs that want the same reference at once: one renders, the other waits for it and reads
// the result.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "pathtracer/reference.h"

namespace plumb {

// `span` is the path tracer's.
std::string reference_key(const Scene& scene, const View& view, const ReferenceSettings& settings,
                          const TimeSpan& span = {});

struct CachedReference {
    ReferenceResult result;
    bool from_cache = false;
    std::string warning;         // what was wrong with a file that had to be rendered again
    std::filesystem::path file;  // where it is kept; empty where the result is incomplete and was not kept
};

class ReferenceCache {
public:
    // Renders a reference, with a checkpoint file to resume from and to write to.
    using Render = std::function<ReferenceResult(const std::filesystem::path& checkpoint)>;

    explicit ReferenceCache(std::filesystem::path folder);

    // The reference that `key` names: read, or else rendered and kept. `on_wait` is called once where another program
    // is rendering the same. Throws what `render` throws, and ImageError where the folder cannot be written.
    CachedReference get(const std::string& key, const Render& render, const std::function<void()>& on_wait = {}) const;

    // Where the reference of `key` lies or would lie.
    std::filesystem::path file_of(const std::string& key) const;

private:
    std::filesystem::path folder_;
};

}  // namespace plumb
