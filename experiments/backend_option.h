// The option --backend of every command that draws.
#pragma once

#include "experiments/command.h"
#include "rasterizer/gl_context.h"

namespace plumb {

void add_backend_option(CLI::App& command, GlBackend& backend);

}  // namespace plumb
