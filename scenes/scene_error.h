#pragma once

#include <stdexcept>

namespace plumb {

// A scene, view or path that cannot be used; the message names the file, the element and the remedy.
class SceneError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace plumb
