#include "experiments/file_lock.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

[[noreturn]] void fail_lock(const std::filesystem::path& file, int error) {
    throw ImageError(
        fmt::format("cannot lock '{}': {}; choose a folder that can be written", file.string(), std::strerror(error)));
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file, const std::function<void()>& on_wait) {
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    descriptor_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (descriptor_ < 0) fail_lock(file, errno);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    if (errno == EWOULDBLOCK && on_wait) on_wait();
    int result = 0;
    do {
        result = ::flock(descriptor_, LOCK_EX);
    } while (result != 0 && errno == EINTR);
    if (result != 0) {
        const int reason = errno;
        ::close(descriptor_);
        fail_lock(file, reason);
    }
}

FileLock::~FileLock() { ::close(descriptor_); }

}  // namespace plumb
