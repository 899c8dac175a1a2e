// SPDX-License-Identifier: Apache-2.0
// The program run from outside, as a user does.
#pragma once

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace patency {

struct Result {
    int exit_code;
    std::string output;   ///< what it printed, errors too
};
inline Result run_command(const std::string& command) {
    std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    Result result{-1, {}};
    std::array<char, 4096> chunk;
    while (const std::size_t n = std::fread(chunk.data(), 1, chunk.size(), pipe)) result.output.append(chunk.data(), n);
    const int status = pclose(pipe);
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return result;
}
inline Result patency(const std::string& arguments) {
    return run_command(fmt::format("'{}' {}", PATENCY_BINARY, arguments));
}

}   // namespace patency
