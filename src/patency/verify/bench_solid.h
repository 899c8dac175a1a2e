// SPDX-License-Identifier: Apache-2.0
// How fast the solid scheme is: particle-steps per CPU-second of the whole step, with hourglass control and viscosity, beside
// the slow reference loop in the same run, with the answers compared.
#pragma once

#include "patency/verify/bench_flow.h"

namespace patency {

/// block_mixed, block_double: 200,000 neo-Hookean particles in space with about 76 neighbours; metal_mixed: the same of a
/// metal, whose law is scalar. @throws UsageError if no name fits.
std::vector<BenchResult> run_solid_bench(const BenchRequest& request);

}   // namespace patency
