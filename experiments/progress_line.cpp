#include "experiments/progress_line.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace plumb {

ProgressLine::ProgressLine() : terminal_(::isatty(STDERR_FILENO) == 1) {
    // A short job says nothing elsewhere than on a terminal.
    last_ = std::chrono::steady_clock::now() - (terminal_ ? std::chrono::hours(1) : std::chrono::hours(0));
}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::show(double fraction, const std::string& text) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < (terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000))) return;
    last_ = now;
    fraction = std::clamp(fraction, 0.0, 1.0);
    if (!terminal_) {
        fmt::print(stderr, "{:3.0f} %  {}\n", 100.0 * fraction, text);
    } else {
        constexpr int width = 24;
        const int filled = static_cast<int>(std::lround(fraction * width));
        fmt::print(stderr, "\r\x1b[K[{:#<{}}{: <{}}] {:3.0f} %  {}", "", filled, "", width - filled, 100.0 * fraction,
                   text);
        shown_ = true;
    }
    std::fflush(stderr);
}

void ProgressLine::clear() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
    shown_ = false;
}

void ProgressLine::log(const std::string& text) {
    clear();
    fmt::print(stderr, "{}\n", text);
}

}  // namespace plumb
