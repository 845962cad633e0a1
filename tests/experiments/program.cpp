#include "tests/experiments/program.h"

#include <array>
#include <cstdio>
#include <stdexcept>

#include <sys/wait.h>

namespace plumb {
namespace {

std::string quoted(const std::string& argument) {
    std::string result = "'";
    for (const char letter : argument) letter == '\'' ? result.append("'\\''") : result.append(1, letter);
    return result.append("'");
}

}  // namespace

ProgramRun run_shell(const std::string& command) {
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) throw std::runtime_error("cannot start " + command);
    ProgramRun run;
    std::array<char, 4096> buffer;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
        run.output.append(buffer.data(), count);
    const int status = ::pclose(pipe);
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return run;
}

ProgramRun run_plumbline(const std::vector<std::string>& arguments) {
    std::string command = quoted(PLUMBLINE_PROGRAM);
    for (const std::string& argument : arguments) command.append(" ").append(quoted(argument));
    return run_shell(command);
}

}  // namespace plumb
