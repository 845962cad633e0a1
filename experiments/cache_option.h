// The option --cache-dir of every command that keeps references.
#pragma once

#include <filesystem>

#include "experiments/command.h"

namespace plumb {

// `folder` becomes $XDG_CACHE_HOME/plumbline, or ~/.cache/plumbline, or a folder here where there is no home, unless
// the option or PLUMBLINE_CACHE says otherwise.
void add_cache_option(CLI::App& command, std::filesystem::path& folder);

}  // namespace plumb
