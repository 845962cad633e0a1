// What can go wrong on the OpenGL side, told apart by who has to act.
#pragma once

#include <stdexcept>
#include <string>

namespace plumb {

// The environment lacks something: a library, a driver, a GL version. The message names the Debian package that brings
// it.
class GlUnavailable : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// OpenGL refused a call, a framebuffer or a shader; the message names the pass or file.
class GlError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// A method whose parameters cannot be combined, would change nothing, or cannot give a wanted plane.
class MethodError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace plumb
