#include "experiments/interruption.h"

#include <csignal>

#include <time.h>

namespace plumb {
namespace {

// A signal handler can reach nothing but a variable of this kind.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<long>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

std::atomic<long> first_second{0};

void on_signal(int signal) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (!interrupted.exchange(true)) {
        first_second = now.tv_sec;
    } else if (now.tv_sec > first_second + 1) {
        // Some tools (timeout) send a signal to the program and to its group: only a later one means "at once".
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

}  // namespace

const std::atomic<bool>& interruption_flag() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    return interrupted;
}

}  // namespace plumb
