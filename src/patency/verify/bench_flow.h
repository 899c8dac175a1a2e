// SPDX-License-Identifier: Apache-2.0
// How fast the flow scheme is, on pipes with openings and walls: particle-steps (fluid particles times acoustic steps)
// per CPU-second of the whole main loop, beside the slow reference loop in the same run, with the answers compared.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace patency {

struct BenchResult {
    std::string name;
    std::int64_t particles = 0;   ///< of blood, buffers included
    int threads = 1;
    double value = 0;
    std::string unit;
    double reference_value = 0;
    double ratio = 0;          ///< value over reference value
    double answer_error = 0;   ///< largest difference of velocity and of position, relative to the largest
};

struct BenchRequest {
    int threads = 1;
    std::vector<std::string> names;   ///< parts of names; empty: all
    double effort = 1;                ///< more steps for steadier numbers
    std::function<void(const BenchResult&)> report = {};
};

/// pipe_d16 (the size of the predecessor's 3d_mixed_poiseuille_flow) and pipe_d32 (200,000 particles), each in mixed and
/// double precision, against the reference loop; two_threads_*: rate per second of two threads over that of one,
/// the medians of turns and of their ratios; growth_*: CPU time per particle-step with 1,000,000 particles over that with 100,000.
/// @throws UsageError if no name fits.
std::vector<BenchResult> run_flow_bench(const BenchRequest& request);

/// [{"name","particles","threads","value","unit","reference_value","ratio","answer_error"}]
std::string format_bench(const std::vector<BenchResult>& results);

}   // namespace patency
