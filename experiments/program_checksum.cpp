#include "experiments/program_checksum.h"

#include <fstream>
#include <iterator>

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace plumb {

std::string program_checksum() {
    std::ifstream file("/proc/self/exe", std::ios::binary);
    return text_checksum(std::string(std::istreambuf_iterator<char>(file), {}));
}

std::string text_checksum(const std::string& text) {
    const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace plumb
