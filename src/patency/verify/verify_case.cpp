// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/verify_case.h"

#include <algorithm>

#include "patency/base/errors.h"

namespace patency {

const RunData& Results::operator[](const std::string& run) const {
    const auto found = runs_.find(run);
    if (found == runs_.end()) throw UsageError("the run " + run + " was not done");
    if (!found->second.failure.empty()) throw DivergedError("run " + run + ": " + found->second.failure);
    return found->second;
}

void FigureList::add(const Head& head, const std::vector<std::string>& runs, const std::function<double()>& value) {
    if (!std::all_of(runs.begin(), runs.end(), [&](const std::string& run) { return results_.was_tried(run); })) return;
    Figure figure{.key = head.key, .value = {}, .unit = head.unit, .bar = head.bar, .reason = ""};
    try {
        figure.value = value();
    } catch (const Error& error) {
        figure.reason = error.what();
    }
    figures_.push_back(std::move(figure));
}

std::span<const VerifyCase> verification_cases() {
    static const std::vector<VerifyCase> cases = [] {
        std::vector<VerifyCase> all;
        for (auto group :
             {operator_cases, plane_cases, pipe_cases, windkessel_cases, nozzle_cases, coronary_cases, cell_cases,
              cell_shape_cases, vessel_cell_cases, solid_point_cases, solid_cases, contact_cases, stent_cases})
            for (VerifyCase& c : group()) all.push_back(std::move(c));
        return all;
    }();
    return cases;
}

}   // namespace patency
