#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace plumb {

// An image or frame that cannot be read, written or combined; the message names the file or plane and the remedy.
class ImageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

[[noreturn]] inline void cannot_read(const std::filesystem::path& path, std::string_view reason) {
    throw ImageError(fmt::format("cannot read '{}': {}", path.string(), reason));
}

}  // namespace plumb
