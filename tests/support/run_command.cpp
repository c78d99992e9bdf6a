// SPDX-License-Identifier: Apache-2.0
// fork, exec, wait; output goes through unnamed files, which never fill up as pipes do.
#include "support/run_command.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File unnamed_file() {
    File file(std::tmpfile(), std::fclose);
    if (!file)
        throw std::runtime_error("cannot make a temporary file");
    return file;
}

std::string read_all(std::FILE* file) {
    std::string text;
    char buffer[4096];
    std::rewind(file);
    while (const size_t count = std::fread(buffer, 1, sizeof buffer, file))
        text.append(buffer, count);
    return text;
}

/// The child: never returns.
[[noreturn]] void execute(const std::vector<std::string>& command, const CommandSettings& settings, int out,
                          int err) {
    constexpr int REPLACE = 1, CANNOT_EXECUTE = 127;
    for (const auto& [name, value] : settings.environment)
        setenv(name.c_str(), value.c_str(), REPLACE);
    for (const auto& [resource, bytes] : settings.limits) {
        const rlimit limit{bytes, bytes};
        setrlimit(__rlimit_resource_t(resource), &limit);
    }
    std::vector<char*> words;
    for (const std::string& word : command)
        words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    if ((settings.folder.empty() || chdir(settings.folder.c_str()) == 0) && dup2(out, STDOUT_FILENO) >= 0 &&
        dup2(err, STDERR_FILENO) >= 0)
        execv(words[0], words.data());
    _exit(CANNOT_EXECUTE);
}

/// Waits for a child, sends it its signals in time, and kills it at the limit.
int wait_for(pid_t child, const CommandSettings& settings, Clock::time_point start) {
    size_t sent = 0;
    bool counts = settings.signals_after_file.empty();
    auto signals_start = start;
    for (int status = 0;;) {
        if (waitpid(child, &status, WNOHANG) == child)
            return status;
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        if (!counts && access((settings.folder + "/" + settings.signals_after_file).c_str(), F_OK) == 0) {
            counts = true;
            signals_start = Clock::now();
        }
        const double waited = std::chrono::duration<double>(Clock::now() - signals_start).count();
        for (; counts && sent < settings.signals.size() && waited >= settings.signals[sent].first; ++sent)
            kill(child, settings.signals[sent].second);
        if (seconds > settings.limit_seconds)
            kill(child, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

} // namespace

CommandResult run_command(const std::vector<std::string>& command, const CommandSettings& settings) {
    const File out = unnamed_file(), err = unnamed_file();
    const auto start = Clock::now();
    const pid_t child = fork();
    if (child < 0)
        throw std::runtime_error("cannot start a process");
    if (child == 0)
        execute(command, settings, fileno(out.get()), fileno(err.get()));
    const int status = wait_for(child, settings, start);
    CommandResult result;
    if (WIFEXITED(status))
        result.exit_code = WEXITSTATUS(status);
    else
        result.signal = WTERMSIG(status);
    result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    result.out = read_all(out.get());
    result.err = read_all(err.get());
    return result;
}

} // namespace clrt
