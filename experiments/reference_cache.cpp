#include "experiments/reference_cache.h"

#include <charconv>
#include <exception>
#include <system_error>

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "experiments/build_facts.h"
#include "experiments/file_lock.h"
#include "experiments/frame_checksum.h"
#include "frames/exr.h"
#include "frames/image_error.h"
#include "pathtracer/reference_identity.h"

namespace plumb {
namespace {

constexpr int file_format = 3;  // of the key and the facts below

const std::string& fact(const Frame& frame, const std::string& name) {
    const auto found = frame.facts.find(name);
    if (found == frame.facts.end()) throw ImageError(fmt::format("it lacks the attribute '{}'", name));
    return found->second;
}

template <class Number>
Number number_fact(const Frame& frame, const std::string& name) {
    const std::string& text = fact(frame, name);
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) {
        throw ImageError(fmt::format("its attribute '{}' is '{}', which is no number", name, text));
    }
    return number;
}

ReferenceResult read_reference(const std::filesystem::path& file, const std::string& key) {
    ReferenceResult result;
    result.frame = read_exr(file);
    if (fact(result.frame, "reference.key") != key) throw ImageError("it holds another reference");
    if (fact(result.frame, "reference.checksum") != frame_checksum(result.frame))
        throw ImageError("its pixels do not match its checksum");
    result.samples = number_fact<int>(result.frame, "reference.samples");
    result.seconds = number_fact<double>(result.frame, "reference.seconds");
    result.rays = number_fact<std::uint64_t>(result.frame, "reference.rays");
    return result;
}

void write_reference(const std::filesystem::path& file, const std::string& key, const ReferenceResult& result) {
    Frame frame = result.frame;
    frame.facts["reference.key"] = key;
    frame.facts["reference.checksum"] = frame_checksum(frame);
    frame.facts["reference.samples"] = fmt::format("{}", result.samples);
    frame.facts["reference.seconds"] = fmt::format("{}", result.seconds);
    frame.facts["reference.rays"] = fmt::format("{}", result.rays);
    write_exr(file, frame);
}

}  // namespace

std::string reference_key(const Scene& scene, const View& view, const ReferenceSettings& settings,
                          const TimeSpan& span) {
    return fmt::format("format {}; integrator {}; scene {:016x}; {}; samples {} to {}; target_error {:a}; {}",
                       file_format, build_facts().integrator_hash, scene.content_hash(), view_identity(view),
                       settings.first_sample, settings.samples, settings.target_error,
                       sampling_identity(settings, span));
}

ReferenceCache::ReferenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

std::filesystem::path ReferenceCache::file_of(const std::string& key) const {
    const XXH128_hash_t hash = XXH3_128bits(key.data(), key.size());
    return folder_ / fmt::format("{:016x}{:016x}.exr", hash.high64, hash.low64);
}

CachedReference ReferenceCache::get(const std::string& key, const Render& render,
                                    const std::function<void()>& on_wait) const {
    CachedReference cached;
    cached.file = file_of(key);
    std::filesystem::path lock_file = cached.file, checkpoint = cached.file;
    lock_file.replace_extension(
        ".lock");  // stays: removing it would let a third program lock another file of this name
    checkpoint.replace_extension(".partial");

    const FileLock lock(lock_file, on_wait);
    if (std::filesystem::exists(cached.file)) {
        try {
            cached.result = read_reference(cached.file, key);
            cached.from_cache = true;
            return cached;
        } catch (const std::exception& error) {
            cached.warning = fmt::format("cached reference '{}' cannot be used: {}; rendering it again",
                                         cached.file.string(), error.what());
        }
    }
    cached.result = render(checkpoint);
    if (cached.result.complete) {
        write_reference(cached.file, key, cached.result);
        std::error_code ignored;  // a checkpoint that is left behind costs space only
        std::filesystem::remove(checkpoint, ignored);
    } else {
        cached.file.clear();
    }
    return cached;
}

}  // namespace plumb
