#include "frames/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view step, int error) {
    throw ImageError(fmt::format("cannot write '{}': {}: {}", path.string(), step, std::strerror(error)));
}

// The data must be on disk before the rename is, or a crash could leave an empty file under the final name.
void flush_to_disk(const std::filesystem::path& file, const std::filesystem::path& target) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) fail(target, "reopening its temporary file", errno);
    const int result = ::fsync(descriptor);
    const int error = errno;
    ::close(descriptor);
    if (result != 0) fail(target, "flushing it to disk", error);
}

}  // namespace

void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write) {
    static std::atomic<unsigned> counter{0};  // tells apart the temporary files of this process's threads
    std::error_code error;
    const auto folder = path.parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    if (error) fail(path, fmt::format("creating folder '{}'", folder.string()), error.value());

    const auto temporary =
        folder / fmt::format(".{}.{}-{}.tmp{}", path.stem().string(), ::getpid(), counter++, path.extension().string());
    try {
        write(temporary);
        flush_to_disk(temporary, path);
        std::filesystem::rename(temporary, path, error);
        if (error) fail(path, "renaming its temporary file", error.value());
    } catch (...) {
        std::filesystem::remove(temporary, error);
        throw;
    }
}

void write_text_atomically(const std::filesystem::path& path, std::string_view text) {
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        std::FILE* file = std::fopen(temporary.c_str(), "wb");
        if (!file) fail(path, "opening its temporary file", errno);
        const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
        const int error = errno;
        const bool closed = std::fclose(file) == 0;
        if (!written || !closed) fail(path, "writing its temporary file", written ? errno : error);
    });
}

}  // namespace plumb
