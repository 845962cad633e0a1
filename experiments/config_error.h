#pragma once

#include <stdexcept>

namespace plumb {

// A method, experiment or command line that cannot be used as written; the message names the file, the line and the
// remedy.
class ConfigError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace plumb
