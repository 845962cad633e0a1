#include "experiments/reference_cache.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "experiments/build_facts.h"
#include "experiments/file_lock.h"
#include "experiments/frame_checksum.h"
#include "frames/exr.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

constexpr int file_format = 2;  // of the key and the facts below

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

std::string optional_view_key(const std::optional<View>& view) { return view ? view_key(*view) : "none"; }

std::string oracle_key(const std::optional<OracleSettings>& oracle) {
    if (!oracle) return "none";
    return fmt::format("{} layers {:a} apart of {}", oracle->layers, oracle->minimum_separation,
                       view_key(oracle->view));
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

// Hexadecimal floats: two cameras that differ in the last bit are two cameras.
std::string view_key(const View& view) {
    const Camera& camera = view.camera();
    std::string text = "camera";
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) text += fmt::format(" {:a}", camera.world_from_camera[column][row]);
    }
    // The width that is seen tells views with a guard band apart.
    text += fmt::format(" sees {:a} {:a} near {:a} far {:a} aperture {:a} focus {:a} size {}x{}", view.tan_half().x,
                        view.tan_half().y, camera.near_plane, camera.far_plane, camera.aperture_radius,
                        camera.focus_distance, view.width(), view.height());
    if (view.offset() != glm::vec2(0.0f)) text += fmt::format(" offset {:a} {:a}", view.offset().x, view.offset().y);
    return text;
}

std::string reference_key(const Scene& scene, const View& view, const ReferenceSettings& settings,
                          const TimeSpan& span) {
    const Quantities& quantities = settings.quantities;
    std::vector<std::string> planes = quantities.planes;
    std::ranges::sort(planes);
    std::string key = fmt::format("format {}; integrator {}; scene {:016x}; time {:a} to {:a}; {}; previous {}",
                                  file_format, build_facts().integrator_hash, scene.content_hash(), span.begin,
                                  span.end, view_key(view), optional_view_key(settings.previous_view));
    key += fmt::format("; planes {}; ao_radius {:a}; ao_falloff {}; bounces {}; indirect_radius {:a} {}",
                       fmt::join(planes, ","), quantities.ao_radius, to_string(quantities.ao_falloff),
                       quantities.bounces, quantities.indirect_radius, to_string(quantities.indirect_falloff));
    key += fmt::format("; reflection_radius {:a} {}", quantities.reflection_radius,
                       to_string(quantities.reflection_falloff));
    key += fmt::format("; samples {} to {}; target_error {:a}; seed {}; minimum_separation {:a}; antialias {}",
                       settings.first_sample, settings.samples, settings.target_error, settings.seed,
                       settings.minimum_separation, settings.antialias);
    key += fmt::format("; emitter_sampling {}; points {}; roulette_after {}; oracle {}; shutter opens at {}",
                       static_cast<int>(settings.emitter_sampling), static_cast<int>(settings.points),
                       settings.roulette_after, oracle_key(settings.oracle),
                       optional_view_key(settings.view_at_shutter_opening));
    return key;
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
