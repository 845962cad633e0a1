// A loop whose steps run on all threads.
#pragma once

#include <tbb/parallel_for.h>

#if defined(__SANITIZE_THREAD__)
#define PLUMBLINE_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PLUMBLINE_THREAD_SANITIZER
#endif
#endif
#ifdef PLUMBLINE_THREAD_SANITIZER
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <tbb/task_arena.h>
#endif

namespace plumb {

// Calls body(0) to body(count - 1), in any order and side by side, on the threads of the current TBB arena. What the
// caller did before is seen by every step, and what the steps did by the caller afterwards. Rethrows what a step
// throws.
template <typename Body>
void parallel_for(int count, const Body& body) {
#ifdef PLUMBLINE_THREAD_SANITIZER
    // Debian's TBB is not built with the sanitizer, which would take every task that TBB hands over for a race; threads
    // of the standard library it understands.
    std::atomic<int> next{0};
    std::exception_ptr thrown;
    std::mutex mutex;
    const auto work = [&] {
        try {
            for (int i = next++; i < count; i = next++) body(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!thrown) thrown = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    for (int i = 1; i < tbb::this_task_arena::max_concurrency(); ++i) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();
    if (thrown) std::rethrow_exception(thrown);
#else
    tbb::parallel_for(0, count, body);
#endif
}

}  // namespace plumb
