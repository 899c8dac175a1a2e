// SPDX-License-Identifier: Apache-2.0
// Outlets tuned to the bed of small vessels behind them: from an aortic pressure and the flow that the bed takes to a
// resistance per outlet.
#pragma once

#include <vector>

namespace patency {

/// How vessels of these diameters [m] share a flow: D^exponent of each over the sum. 3: Murray 1926; coronary trees were
/// found to follow 7/3 (Huo & Kassab 2012).                                                        THEORY.md (9.9)
std::vector<double> murray_shares(const std::vector<double>& diameters, double exponent);

struct BedDemand {
    double aortic_pressure, venous_pressure;   ///< mean [Pa]
    double flow;   ///< of all outlets together, in a vessel without a loss of its own [m^3/s]
    double murray_exponent;
};
/// The resistance behind each outlet [Pa s/m^3]: the pressure from the aorta to the veins over the outlet's share of the flow.
/// A lesion then lowers its flow, as it does in a patient. Throws DeckError if nothing drives the flow. THEORY.md (9.10)
std::vector<double> bed_resistances(const std::vector<double>& diameters, const BedDemand& demand);

/// How a coronary bed is made up (SimVascular's clinical case of normal coronary arteries, after Sankaran et al., Ann Biomed Eng
/// 2012; 40: 2228): of its resistance what arteries, small vessels and veins have, of its compliance what arteries and the vessels
/// within the muscle have.                                                                         THEORY.md (9.14)
struct CoronaryBed {
    double arteries = 0.32, small_vessels = 0.52, veins = 0.16;
    double arterial = 0.11, myocardial = 0.89;
    /// Compliance times the resistance at rest [s]: 3.6e-5 cm^5/dyn and three fifths of 4 % of 80 mL/s at 93 mmHg there.
    double time_at_rest = 2.2;
};

/// Of the resistance behind a Windkessel's outlet what lies before its compliance (the same source, for the aorta).
inline constexpr double proximal_share = 0.09;

// Mean over the section of the velocity in a proximal coronary artery [m/s], half of the average peak velocity of a Doppler
// wire in the left anterior descending artery of nine people without disease, 55.8 cm/s at hyperaemia and 24.6 cm/s at rest
// (J. Korean Soc. Echocardiogr. 2000; 8: 146): half, because a parabola's peak is twice its mean.
inline constexpr double hyperaemic_velocity = 0.279, resting_velocity = 0.123;

}   // namespace patency
