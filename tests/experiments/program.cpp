#include "tests/experiments/program.h"

#include <array>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace plumb {
namespace {

std::string quoted(const std::string& argument) {
    std::string result = "'";
    for (const char letter : argument) letter == '\'' ? result.append("'\\''") : result.append(1, letter);
    return result.append("'");
}

int exit_code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

// Whether a process has a handler for a signal, as Linux tells it in proc(5).
bool catches(pid_t process, int signal) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("SigCgt:", 0) != 0) continue;
        return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
    }
    return false;
}

// The program on its way, with the end of a pipe that its output comes from.
struct Child {
    pid_t process = -1;
    int output = -1;

    explicit Child(const std::vector<std::string>& arguments) {
        int pipe[2];
        if (::pipe(pipe) != 0) throw std::runtime_error("cannot make a pipe");
        std::vector<std::string> texts = {PLUMBLINE_PROGRAM};
        texts.insert(texts.end(), arguments.begin(), arguments.end());
        std::vector<char*> pointers;
        pointers.reserve(texts.size() + 1);
        for (std::string& text : texts) pointers.push_back(text.data());
        pointers.push_back(nullptr);
        process = ::fork();
        if (process < 0) throw std::runtime_error("cannot start another process");
        if (process == 0) {
            ::dup2(pipe[1], STDOUT_FILENO);
            ::dup2(pipe[1], STDERR_FILENO);
            ::close(pipe[0]), ::close(pipe[1]);
            ::execv(PLUMBLINE_PROGRAM, pointers.data());
            ::_exit(127);
        }
        ::close(pipe[1]);
        output = pipe[0];
    }

    std::string read() const {
        std::string text;
        std::array<char, 4096> buffer;
        while (true) {
            const ssize_t count = ::read(output, buffer.data(), buffer.size());
            if (count <= 0) break;
            text.append(buffer.data(), static_cast<std::size_t>(count));
        }
        ::close(output);
        return text;
    }
};

}  // namespace

ProgramRun run_shell(const std::string& command) {
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) throw std::runtime_error("cannot start " + command);
    ProgramRun run;
    std::array<char, 4096> buffer;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
        run.output.append(buffer.data(), count);
    const int status = ::pclose(pipe);
    run.exit_code = exit_code_of(status);
    return run;
}

ProgramRun run_plumbline(const std::vector<std::string>& arguments) { return run_shell(quoted_command(arguments)); }

std::string quoted_command(const std::vector<std::string>& arguments) {
    std::string command = quoted(PLUMBLINE_PROGRAM);
    for (const std::string& argument : arguments) command.append(" ").append(quoted(argument));
    return command;
}

ProgramRun signal_plumbline(const std::vector<std::string>& arguments, int signal) {
    const Child child(arguments);
    int status = 0;
    bool ended = false;
    while (!ended && !catches(child.process, signal)) {
        ended = ::waitpid(child.process, &status, WNOHANG) == child.process;
        ::usleep(2000);
    }
    if (!ended) ::kill(child.process, signal);
    ProgramRun run;
    run.output = child.read();
    if (ended) throw std::runtime_error("plumbline ended before it caught a signal: " + run.output);
    ::waitpid(child.process, &status, 0);
    run.exit_code = exit_code_of(status);
    return run;
}

ProgramRun measure_plumbline(const std::vector<std::string>& arguments) {
    const Child child(arguments);
    ProgramRun run;
    run.output = child.read();
    int status = 0;
    rusage usage{};
    ::wait4(child.process, &status, 0, &usage);
    run.exit_code = exit_code_of(status);
    run.peak_bytes = 1024 * usage.ru_maxrss;  // kilobytes on Linux
    return run;
}

}  // namespace plumb
