// A lock between programs, held for as long as the object lives; the system lets go of it when a program dies.
#pragma once

#include <filesystem>
#include <functional>

namespace plumb {

class FileLock {
public:
    // Waits until no other FileLock holds `file` (created where absent); `on_wait` is called once if it has to wait.
    // Throws ImageError where the file cannot be created.
    explicit FileLock(const std::filesystem::path& file, const std::function<void()>& on_wait = {});
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    int descriptor_ = -1;
};

}  // namespace plumb
