// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/bed.h"

#include <cmath>

#include "patency/base/errors.h"

namespace patency {

std::vector<double> murray_shares(const std::vector<double>& diameters, double exponent) {
    double sum = 0;
    std::vector<double> shares;
    for (double d : diameters) shares.push_back(std::pow(d, exponent)), sum += shares.back();
    for (double& s : shares) s /= sum;
    return shares;
}

std::vector<double> bed_resistances(const std::vector<double>& diameters, const BedDemand& demand) {
    const double driving = demand.aortic_pressure - demand.venous_pressure;
    if (!(driving > 0)) throw DeckError("bed.venous_pressure: is not below aorta.pressure, so nothing drives the flow");
    std::vector<double> resistances;
    for (double share : murray_shares(diameters, demand.murray_exponent))
        resistances.push_back(driving / (share * demand.flow));
    return resistances;
}

}   // namespace patency
