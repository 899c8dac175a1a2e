// SPDX-License-Identifier: Apache-2.0
// This program itself, several times at once.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "interruption.h"

namespace patency::app {

struct Job {
    std::vector<std::string> arguments;   ///< of the program, without its name
    std::filesystem::path output;         ///< what it says goes into this file
};

struct JobCalls {
    std::function<void(std::size_t job)> begun;
    std::function<void(std::size_t job, int exit_code)> ended;   ///< 128 + N where signal N ended it
};

/// Runs the jobs in their order, `at_once` of them together. An interruption is handed on to those that run, whose ends are waited
/// for, and no other begins. If this process is killed they are killed too. Throws FileError.
void run_side_by_side(const std::vector<Job>& jobs, int at_once, const Interruption& interruption,
                      const JobCalls& calls);

}   // namespace patency::app
