// SPDX-License-Identifier: Apache-2.0
// What a sweep compares: the numbers that a reader wants first of every kind of run.
#pragma once

#include <optional>

#include "patency/report/figures.h"
#include "patency/report/sweep.h"

namespace patency {

struct SweepQuantity {
    std::string label, column;   ///< for readers and for the CSV file
    Measure measure;
    std::string (*pointer)(const nlohmann::ordered_json& summary);   ///< into a run's summary; empty where it has none
};

/// Those that at least one run has.
std::vector<SweepQuantity> sweep_quantities(const Sweep& sweep);

/// In the measure's unit; none where the run has no such number.
std::optional<double> value_of(const SweepRow& row, const SweepQuantity& quantity);

/// The values of a key as numbers, with their unit: {"mPa s", {3.5, 4}}; none where one of them is no number or has no unit like the
/// first one's.
struct SweepScale {
    std::string unit;
    std::vector<double> values;   ///< one for each row
};
std::optional<SweepScale> scale_of(const Sweep& sweep, std::size_t key);

}   // namespace patency
