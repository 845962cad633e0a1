#pragma once

#include <stdexcept>

namespace plumb {

// An image or frame that cannot be read, written or combined; the message names the file or plane and the remedy.
class ImageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace plumb
