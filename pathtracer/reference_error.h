// The error of the path tracer.
#pragma once

#include <stdexcept>

namespace plumb {

// A reference that cannot be rendered as asked, or a checkpoint that cannot be used; the message says what to do.
class ReferenceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace plumb
