// SPDX-License-Identifier: Apache-2.0
// An estimate as numbers for files: summary.json and the pullbacks. Writes none.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "patency/stages/estimate.h"

namespace patency {

/// Openings, branches and lesions, the unit in every key; with the band if there is one.
nlohmann::ordered_json estimate_summary(const deck::Case& config, const Vessel& vessel, const Estimate& estimate,
                                        const std::optional<EstimateBand>& band);

/// Of a treated vessel, with FFR and its band where the lesions of the vessel before had theirs read ("at_lesions", as these lesions).
/// `before` and `after` are the decks, the vessels theirs.
nlohmann::ordered_json estimate_after_summary(const deck::Case& before, const Vessel& vessel_before,
                                              const deck::Case& after, const Vessel& vessel_after);

/// Along the line to every outlet, one after the other: arc, number of the outlet (1: the first after the inlet), area, flow, static
/// pressure and, with an aortic pressure, FFR.
struct Pullback {
    std::vector<std::string> columns;
    std::vector<std::vector<double>> rows;
};
Pullback estimate_pullback(const Vessel& vessel, const Estimate& estimate);

}   // namespace patency
