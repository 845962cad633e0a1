#include "pathtracer/checkpoint.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

#include "frames/atomic_file.h"
#include "pathtracer/integrator_hash.h"
#include "pathtracer/reference_error.h"
#include "pathtracer/reference_identity.h"

namespace plumb {
namespace {

constexpr std::array<char, 8> magic = {'P', 'L', 'U', 'M', 'B', 'R', 'E', 'F'};
constexpr std::uint32_t format_version = 7;

// As it lies in the file; the sums follow, then the checksum of all before it. Little-endian, as all machines we build
// on.
struct Header {
    std::array<char, 8> magic;
    std::uint32_t version;
    std::int32_t begin, end;
    std::uint32_t unused;
    std::uint64_t scene, view, settings, integrator, embree;
    std::uint64_t rays;
    double seconds;
    std::uint64_t sum_count;
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) == 88, "no padding may reach the file");

std::uint64_t checksum(const Header& header, std::span<const double> sums) {
    const std::uint64_t of_header = XXH3_64bits(&header, sizeof header);
    return XXH3_64bits_withSeed(sums.data(), sums.size_bytes(), of_header);
}

std::uint64_t hash(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

}  // namespace

CheckpointKey CheckpointKey::of(const Scene& scene, const TimeSpan& span, const View& view,
                                const ReferenceSettings& settings, std::uint64_t embree) {
    return {scene.content_hash(), hash(view_identity(view)), hash(sampling_identity(settings, span)),
            hash(integrator_hash()), embree};
}

void write_checkpoint(const std::filesystem::path& path, const CheckpointKey& key, const CheckpointState& state,
                      std::span<const double> sums) {
    const Header header{magic,      format_version, state.begin,  state.end,      0,
                        key.scene,  key.view,       key.settings, key.integrator, key.embree,
                        state.rays, state.seconds,  sums.size()};
    const std::uint64_t sum_of_all = checksum(header, sums);
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), "wb"), &std::fclose);
        const bool written = file && std::fwrite(&header, sizeof header, 1, file.get()) == 1 &&
                             std::fwrite(sums.data(), sizeof(double), sums.size(), file.get()) == sums.size() &&
                             std::fwrite(&sum_of_all, sizeof sum_of_all, 1, file.get()) == 1;
        // Closing writes what is left, and some file systems tell only then that there was no room for it.
        if (!written || std::fclose(file.release()) != 0) {
            throw ReferenceError(
                fmt::format("cannot write checkpoint or shard '{}': {}; free space there or choose another path",
                            path.string(), std::strerror(errno)));
        }
    });
}

CheckpointState add_checkpoint(const std::filesystem::path& path, const CheckpointKey& key, std::span<double> sums) {
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
    if (header.integrator != key.integrator) {
        throw refuse(fmt::format(
            "comes from another build of this program, with other sources of the path tracer than this one's "
            "(integrator_hash {}), so that its samples may not be those of one run; render all parts with one build",
            integrator_hash()));
    }
    if (header.embree != key.embree) {
        throw refuse(
            "comes from a machine on which Embree finds hits, or the C library rounds, with other last bits (another "
            "version of either, or another kind of processor), so that its samples are not those of one run; render "
            "all parts on machines of a kind");
    }
    // Piece by piece, so that the sums of an image are not in memory twice.
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> hash_of_all(XXH3_createState(), &XXH3_freeState);
    XXH3_64bits_reset_withSeed(hash_of_all.get(), XXH3_64bits(&header, sizeof header));
    std::vector<double> piece(std::min<std::size_t>(sums.size(), 1u << 16));
    for (std::size_t first = 0; first < sums.size(); first += piece.size()) {
        const std::size_t count = std::min(piece.size(), sums.size() - first);
        if (!file.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(count * sizeof(double)))) {
            throw refuse("is cut off");
        }
        XXH3_64bits_update(hash_of_all.get(), piece.data(), count * sizeof(double));
        for (std::size_t i = 0; i < count; ++i) sums[first + i] += piece[i];
    }
    std::uint64_t sum_of_all = 0;
    if (!file.read(reinterpret_cast<char*>(&sum_of_all), sizeof sum_of_all)) throw refuse("is cut off");
    const bool sensible =
        header.begin >= 0 && header.begin % 2 == 0 && header.end >= header.begin && header.end % 2 == 0;
    if (sum_of_all != XXH3_64bits_digest(hash_of_all.get()) || !sensible) throw refuse("is damaged");
    return {header.begin, header.end, header.rays, header.seconds};
}

}  // namespace plumb
