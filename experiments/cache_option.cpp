#include "experiments/cache_option.h"

#include <cstdlib>

#include <CLI/CLI.hpp>

namespace plumb {
namespace {

std::filesystem::path default_cache() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return std::filesystem::path(cache) / "plumbline";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".cache" / "plumbline";
    return "cache";
}

}  // namespace

void add_cache_option(CLI::App& command, std::filesystem::path& folder) {
    folder = default_cache();
    command.add_option("--cache-dir", folder, "Folder of kept references")
        ->capture_default_str()
        ->envname("PLUMBLINE_CACHE");
}

}  // namespace plumb
