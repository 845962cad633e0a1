// Ctrl-C as a flag: the first one asks the work to stop where it can be resumed, the second ends the program.
#pragma once

#include <atomic>

namespace plumb {

// Installs the handler for SIGINT and SIGTERM (once) and returns the flag that it sets.
const std::atomic<bool>& interruption_flag();

}  // namespace plumb
