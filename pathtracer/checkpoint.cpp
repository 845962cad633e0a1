#include "pathtracer/checkpoint.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

#include "frames/atomic_file.h"
#include "pathtracer/reference_error.h"

namespace plumb {
namespace {

constexpr std::array<char, 8> magic = {'P', 'L', 'U', 'M', 'B', 'R', 'E', 'F'};
constexpr std::uint32_t format_version = 4;  // also of the samples that the sums are made of

// As it lies in the file; the sums follow, then the checksum of all before it. Little-endian, as all machines we build
// on.
struct Header {
    std::array<char, 8> magic;
    std::uint32_t version;
    std::int32_t begin, end;
    std::uint32_t unused;
    std::uint64_t scene, view, settings;
    std::uint64_t rays;
    double seconds;
    std::uint64_t sum_count;
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) == 72, "no padding may reach the file");

std::uint64_t checksum(const Header& header, std::span<const double> sums) {
    const std::uint64_t of_header = XXH3_64bits(&header, sizeof header);
    return XXH3_64bits_withSeed(sums.data(), sums.size_bytes(), of_header);
}

template <typename T>
void append(std::string& bytes, const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_view(std::string& bytes, const View& view) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) append(bytes, view.camera().world_from_camera[column][row]);
    }
    append(bytes, view.tan_half().x), append(bytes, view.tan_half().y);
    append(bytes, view.camera().aperture_radius), append(bytes, view.camera().focus_distance);
    append(bytes, view.camera().near_plane), append(bytes, view.camera().far_plane);
    append(bytes, view.width()), append(bytes, view.height());
    if (view.offset() != glm::vec2(0.0f)) append(bytes, view.offset().x), append(bytes, view.offset().y);
}

std::uint64_t hash(const std::string& bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

}  // namespace

CheckpointKey CheckpointKey::of(const Scene& scene, const TimeSpan& span, const View& view,
                                const ReferenceSettings& settings) {
    CheckpointKey key;
    key.scene = scene.content_hash();
    std::string bytes;
    append_view(bytes, view);
    key.view = hash(bytes);

    bytes.clear();
    append(bytes, span.begin), append(bytes, span.end);
    const Quantities& quantities = settings.quantities;
    // Sums know no order of planes.
    std::vector<std::string> planes = quantities.planes;
    std::ranges::sort(planes);
    for (const std::string& plane : planes) bytes += plane + '\n';
    append(bytes, quantities.ao_radius), append(bytes, quantities.ao_falloff);
    append(bytes, quantities.bounces), append(bytes, quantities.indirect_radius);
    append(bytes, quantities.indirect_falloff);
    append(bytes, quantities.reflection_radius), append(bytes, quantities.reflection_falloff);
    append(bytes, settings.seed), append(bytes, settings.minimum_separation), append(bytes, settings.antialias);
    append(bytes, settings.emitter_sampling), append(bytes, settings.points), append(bytes, settings.roulette_after);
    if (settings.oracle) {
        append_view(bytes, settings.oracle->view);
        append(bytes, settings.oracle->layers), append(bytes, settings.oracle->minimum_separation);
    }
    bytes += settings.view_at_shutter_opening ? "shutter" : "";
    if (settings.view_at_shutter_opening) append_view(bytes, *settings.view_at_shutter_opening);
    if (settings.previous_view) append_view(bytes, *settings.previous_view);
    key.settings = hash(bytes);
    return key;
}

void write_checkpoint(const std::filesystem::path& path, const CheckpointKey& key, const CheckpointState& state,
                      std::span<const double> sums) {
    const Header header{magic,    format_version, state.begin, state.end,     0,          key.scene,
                        key.view, key.settings,   state.rays,  state.seconds, sums.size()};
    const std::uint64_t sum_of_all = checksum(header, sums);
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), "wb"), &std::fclose);
        const bool written = file && std::fwrite(&header, sizeof header, 1, file.get()) == 1 &&
                             std::fwrite(sums.data(), sizeof(double), sums.size(), file.get()) == sums.size() &&
                             std::fwrite(&sum_of_all, sizeof sum_of_all, 1, file.get()) == 1 &&
                             std::fflush(file.get()) == 0;
        if (!written) {
            throw ReferenceError(
                fmt::format("cannot write checkpoint or shard '{}': {}; free space there or choose another path",
                            path.string(), std::strerror(errno)));
        }
    });
}

CheckpointState read_checkpoint(const std::filesystem::path& path, const CheckpointKey& key, std::span<double> sums) {
    const auto refuse = [&path](std::string_view reason) {
        return ReferenceError(
            fmt::format("checkpoint or shard '{}' {}; remove it or name another", path.string(), reason));
    };
    std::ifstream file(path, std::ios::binary);
    if (!file) throw refuse("cannot be opened for reading");
    Header header;
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != magic) {
        throw refuse("is not a checkpoint of a reference, or is cut off");
    }
    if (header.version != format_version) {
        throw refuse(fmt::format("has format version {}, this program reads {}", header.version, format_version));
    }
    if (header.scene != key.scene) throw refuse("belongs to another scene, or to an older state of this one");
    if (header.view != key.view) throw refuse("belongs to another view: camera or size differ");
    if (header.settings != key.settings || header.sum_count != sums.size()) {
        throw refuse("belongs to other settings: planes, radii, bounces, seed or sampling differ");
    }
    std::uint64_t sum_of_all = 0;
    if (!file.read(reinterpret_cast<char*>(sums.data()), static_cast<std::streamsize>(sums.size_bytes())) ||
        !file.read(reinterpret_cast<char*>(&sum_of_all), sizeof sum_of_all)) {
        throw refuse("is cut off");
    }
    const bool sensible =
        header.begin >= 0 && header.begin % 2 == 0 && header.end >= header.begin && header.end % 2 == 0;
    if (sum_of_all != checksum(header, sums) || !sensible) throw refuse("is damaged");
    return {header.begin, header.end, header.rays, header.seconds};
}

}  // namespace plumb
