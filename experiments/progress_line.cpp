#include "experiments/progress_line.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace plumb {

std::string print_duration(double seconds) {
    if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400.0) return fmt::format("{:.0f} min", seconds / 60.0);
    return fmt::format("{:.1f} h", seconds / 3600.0);
}

ProgressLine::ProgressLine()
    : ProgressLine({stderr, ::isatty(STDERR_FILENO) == 1, [] { return std::chrono::steady_clock::now(); }}) {}

ProgressLine::ProgressLine(ProgressOutput output) : output_(std::move(output)), start_(output_.now()) {
    // A short job says nothing elsewhere than on a terminal.
    last_ = start_ - (output_.terminal ? std::chrono::hours(1) : std::chrono::hours(0));
}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::show(double fraction, const std::string& text) {
    const auto now = output_.now();
    if (now - last_ < (output_.terminal ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000))) return;
    last_ = now;
    fraction = std::clamp(fraction, 0.0, 1.0);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    std::string line = fmt::format("{:3.0f} %  ", 100.0 * fraction);
    // Before, the estimate jumps about.
    constexpr double enough_seconds = 3.0, enough_done = 0.01;
    if (elapsed > enough_seconds && fraction > enough_done)
        line += fmt::format("{} left  ", print_duration(elapsed * (1.0 - fraction) / fraction));
    line += text;
    if (!output_.terminal) {
        fmt::print(output_.stream, "{}\n", line);
    } else {
        constexpr int width = 24;
        const int filled = static_cast<int>(std::lround(fraction * width));
        fmt::print(output_.stream, "\r\x1b[K[{:#<{}}{: <{}}] {}", "", filled, "", width - filled, line);
        shown_ = true;
    }
    std::fflush(output_.stream);
}

void ProgressLine::clear() {
    if (shown_) fmt::print(output_.stream, "\r\x1b[K");
    std::fflush(output_.stream);
    shown_ = false;
}

void ProgressLine::log(const std::string& text) {
    clear();
    fmt::print(output_.stream, "{}\n", text);
}

}  // namespace plumb
