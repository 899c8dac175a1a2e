// SPDX-License-Identifier: Apache-2.0
// What a stage took, for timing.json.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>

#include "patency/io/output_folder.h"

namespace patency {

/// Wall and processor time since it was made [s].
class Stopwatch {
public:
    double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count(); }
    double cpu() const { return cpu_now() - cpu_; }

private:
    static double cpu_now();
    std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
    double cpu_ = cpu_now();
};

/// Writes timing.json: the stages' times, then what they depend on besides: threads, machine and date (UTC). Throws FileError.
void write_timing(const OutputFolder& folder, nlohmann::ordered_json times);

}   // namespace patency
