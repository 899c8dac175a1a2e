// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_rest.h"

#include <algorithm>
#include <cmath>

namespace patency {

bool DeployRest::compare(double program, const StentProfile& profile, double span) {
    const bool is_first = from_ < 0;
    if (!is_first && program - from_ < span) return false;
    if (!is_first) {
        const double mean = profile.mean_diameter / mean_ - 1, least = profile.least_diameter / least_ - 1;
        shrunk_ = std::max(-mean, -least);
        moved_ = std::max(std::abs(mean), std::abs(least));
    }
    from_ = program, mean_ = profile.mean_diameter, least_ = profile.least_diameter;
    return !is_first;
}

}   // namespace patency
