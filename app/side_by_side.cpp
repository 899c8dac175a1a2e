// SPDX-License-Identifier: Apache-2.0
#include "side_by_side.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <map>
#include <thread>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"

namespace patency::app {

namespace {

/// Its number. Between fork and exec only calls that may follow a fork among threads.
pid_t start(const Job& job) {
    std::vector<char*> argv{const_cast<char*>("patency")};
    for (const std::string& argument : job.arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const int output = ::open(job.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (output < 0) throw FileError(file_error_sentence("write", job.output, errno));
    const pid_t parent = ::getpid(), child = ::fork();
    if (child == 0) {
        ::setpgid(0, 0);   // a terminal's Ctrl-C comes to the parent alone, which hands it on once
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (::getppid() != parent) ::_exit(128 + SIGKILL);   // it went before we asked for that
        ::dup2(output, STDOUT_FILENO);
        ::dup2(output, STDERR_FILENO);
        ::execv("/proc/self/exe", argv.data());
        ::_exit(127);
    }
    const int error = errno;
    ::close(output);
    if (child < 0) throw FileError(file_error_sentence("start a run that writes", job.output, error));
    return child;
}

}   // namespace

void run_side_by_side(const std::vector<Job>& jobs, int at_once, const Interruption& interruption,
                      const JobCalls& calls) {
    std::map<pid_t, std::size_t> running;
    bool is_handed_on = false;
    for (std::size_t next = 0;;) {
        while (next < jobs.size() && int(running.size()) < at_once && !interruption.is_wanted()) {
            running[start(jobs[next])] = next;
            calls.begun(next++);
        }
        if (running.empty()) return;
        if (interruption.is_wanted() && !is_handed_on) {
            for (const auto& [process, job] : running)
                ::kill(process, interruption.exit_code() == ExitCode::terminated ? SIGTERM : SIGINT);
            is_handed_on = true;
        }
        int status = 0;
        const pid_t process = ::waitpid(-1, &status, WNOHANG);
        if (process <= 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            continue;
        }
        const std::size_t job = running.at(process);
        running.erase(process);
        calls.ended(job, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
    }
}

}   // namespace patency::app
