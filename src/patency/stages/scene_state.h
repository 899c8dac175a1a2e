// SPDX-License-Identifier: Apache-2.0
// What a checkpoint must hold of a scene beside its particles: everything between two steps that is not a function of
// the deck. Knows no file format.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "patency/stages/scene.h"

namespace patency {

struct NamedNumbers {
    std::map<std::string, std::vector<double>> reals;
    std::map<std::string, std::vector<std::int64_t>> integers;
    bool operator==(const NamedNumbers&) const = default;
};

/// Times, counters, the moving level, the openings' states and audits.
NamedNumbers numbers_of(const Scene& scene);

/// Puts them back into a scene of the same deck (build_frame). Throws CheckpointError naming what is missing or does not
/// fit the deck's openings. Particles are put back by the caller, then start_scheme.
void restore_numbers(Scene& scene, const NamedNumbers& numbers);

}   // namespace patency
