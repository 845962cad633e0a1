// The options --fail-above and --fail-below of every command that measures images.
#pragma once

#include <string>
#include <vector>

#include "experiments/gate.h"

namespace CLI {
class App;
}

namespace plumb {

struct GateOptions {
    std::string fail_above, fail_below;

    void add_to(CLI::App& command);
    // Throws ConfigError.
    std::vector<Limit> limits() const;
};

}  // namespace plumb
