// The built command `plumbline`, run as a user would.
#pragma once

#include <string>
#include <vector>

namespace plumb {

struct ProgramRun {
    int exit_code = -1;
    std::string output;   // standard output and standard error together
    long peak_bytes = 0;  // the most memory at once, where it was measured
};

// Runs a shell command line.
ProgramRun run_shell(const std::string& command);
// Runs plumbline with arguments, which may hold spaces.
ProgramRun run_plumbline(const std::vector<std::string>& arguments);

// Starts plumbline, waits until it catches `signal`, sends it, and waits for the end. Throws std::runtime_error where
// the program ends before.
ProgramRun signal_plumbline(const std::vector<std::string>& arguments, int signal);

// Runs plumbline and measures the memory that it takes.
ProgramRun measure_plumbline(const std::vector<std::string>& arguments);

// Arguments as a shell takes them.
std::string quoted_command(const std::vector<std::string>& arguments);

}  // namespace plumb
