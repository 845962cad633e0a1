#include "frames/exr_writing.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>

#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include "frames/atomic_file.h"
#include "frames/image_error.h"

namespace plumb {
namespace {

// Remembers the first error.
class CheckedStream final : public Imf::OStream {
public:
    explicit CheckedStream(const std::filesystem::path& path)
        : OStream(path.c_str()), file_(std::fopen(path.c_str(), "wb")) {
        if (!file_) error_ = errno;
    }
    ~CheckedStream() override { close(); }
    CheckedStream(const CheckedStream&) = delete;
    CheckedStream& operator=(const CheckedStream&) = delete;

    void write(const char data[], int size) override {
        if (!error_ && std::fwrite(data, 1, static_cast<std::size_t>(size), file_) != static_cast<std::size_t>(size)) {
            error_ = errno;
        }
    }
    std::uint64_t tellp() override { return error_ ? 0 : static_cast<std::uint64_t>(std::ftell(file_)); }
    void seekp(std::uint64_t position) override {
        if (!error_ && std::fseek(file_, static_cast<long>(position), SEEK_SET) != 0) error_ = errno;
    }

    // The first error of all, 0 for none.
    int close() {
        if (file_ && std::fclose(file_) != 0 && !error_) error_ = errno;
        file_ = nullptr;
        return error_;
    }

private:
    std::FILE* file_;
    int error_ = 0;
};

}  // namespace

void use_all_exr_threads() {
    static std::once_flag once;
    std::call_once(once, [] {
        Imf::setGlobalThreadCount(
            std::max(Imf::globalThreadCount(), static_cast<int>(std::thread::hardware_concurrency())));
    });
}

void add_facts(const std::filesystem::path& path, const Frame& frame, Imf::Header& header) {
    for (const auto& [key, value] : frame.facts) {
        const std::string name = std::string(exr_fact_prefix) + key;
        if (key.empty() || name.size() > longest_exr_name) {
            throw ImageError(fmt::format("cannot write '{}': the name of fact '{}' must have 1 to {} characters",
                                         path.string(), key, longest_exr_name - exr_fact_prefix.size()));
        }
        header.insert(name, Imf::StringAttribute(value));
    }
}

void write_exr_atomically(const std::filesystem::path& path, const std::function<void(Imf::OStream& stream)>& write) {
    use_all_exr_threads();
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        CheckedStream stream(temporary);
        std::string reason;
        try {
            write(stream);
        } catch (const std::exception& error) {
            reason = error.what();
        }
        if (const int error = stream.close()) reason = std::strerror(error);
        if (!reason.empty()) {
            throw ImageError(
                fmt::format("cannot write '{}': {}; check space and permissions of its folder", path.string(), reason));
        }
    });
}

}  // namespace plumb
