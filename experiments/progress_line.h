// How far a long job is: one line that rewrites itself on a terminal, a plain log line every few seconds elsewhere.
#pragma once

#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

namespace plumb {

// Where progress is written to, and what time it is there.
struct ProgressOutput {
    std::FILE* stream = nullptr;
    bool terminal = false;
    std::function<std::chrono::steady_clock::time_point()> now;
};

class ProgressLine {
public:
    // Writes to standard error, so that standard output holds results only.
    ProgressLine();
    explicit ProgressLine(ProgressOutput output);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // `fraction` in 0..1. Shows at most ten times a second on a terminal, every five seconds elsewhere; with the time
    // that is left, once it can be told from what is done.
    void show(double fraction, const std::string& text);
    // Takes the line away on a terminal.
    void clear();
    // Clears the line and prints `text` as a line that stays.
    void log(const std::string& text);

private:
    ProgressOutput output_;
    bool shown_ = false;
    std::chrono::steady_clock::time_point start_, last_;
};

// "40 s", "3 min", "2.5 h".
std::string print_duration(double seconds);

}  // namespace plumb
