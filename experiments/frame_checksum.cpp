#include "experiments/frame_checksum.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace plumb {

std::string frame_checksum(const Frame& frame) {
    XXH3_state_t* state = XXH3_createState();
    XXH3_128bits_reset(state);
    for (const std::string& name : frame.plane_names()) {
        const Image& plane = frame.plane(name);
        const int shape[] = {plane.width(), plane.height(), plane.channels()};
        XXH3_128bits_update(state, name.data(), name.size());
        XXH3_128bits_update(state, shape, sizeof(shape));
        XXH3_128bits_update(state, plane.values().data(), plane.values().size_bytes());
    }
    const XXH128_hash_t hash = XXH3_128bits_digest(state);
    XXH3_freeState(state);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace plumb
