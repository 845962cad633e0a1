// Numbers, or vectors of them, that begin as 0 and take memory only where they are written to; parts of them can give
// it back.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace plumb {

template <typename T>
class ZeroedArray {
    // All bits 0 have to stand for 0.
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    ZeroedArray() = default;
    // The operating system hands out large blocks page by page as they are touched, zeros by itself.
    explicit ZeroedArray(std::size_t size) : size_(size), values_(static_cast<T*>(std::calloc(size, sizeof(T)))) {
        if (size > 0 && !values_) throw std::bad_alloc();
    }
    ZeroedArray(const ZeroedArray& other) : ZeroedArray(other.size_) {
        std::copy_n(other.values_.get(), size_, values_.get());
    }
    ZeroedArray(ZeroedArray&& other) noexcept
        : size_(std::exchange(other.size_, 0)), values_(std::move(other.values_)) {}
    ZeroedArray& operator=(ZeroedArray other) noexcept {
        std::swap(size_, other.size_);
        std::swap(values_, other.values_);
        return *this;
    }
    ~ZeroedArray() = default;

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T& operator[](std::size_t i) { return values_.get()[i]; }
    const T& operator[](std::size_t i) const { return values_.get()[i]; }
    std::span<T> values() { return {values_.get(), size_}; }
    std::span<const T> values() const { return {values_.get(), size_}; }

    // Gives back the whole pages among values `first` to end - 1, which must not be read again.
    void give_back(std::size_t first, std::size_t end) {
#ifdef __linux__
        const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
        const auto from = (reinterpret_cast<std::uintptr_t>(values_.get() + first) + page - 1) / page * page;
        const auto to = reinterpret_cast<std::uintptr_t>(values_.get() + end) / page * page;
        // NOLINTNEXTLINE(performance-no-int-to-ptr): pages are told by their addresses
        if (from < to) ::madvise(reinterpret_cast<void*>(from), to - from, MADV_DONTNEED);
#else
        static_cast<void>(first), static_cast<void>(end);
#endif
    }

private:
    struct Free {
        void operator()(T* values) const { std::free(values); }
    };
    std::size_t size_ = 0;
    std::unique_ptr<T, Free> values_;
};

}  // namespace plumb
