// SPDX-License-Identifier: Apache-2.0
// A heartbeat as the coronary arteries feel it, when only its mean and its swing are known: the pressure in the aorta, which
// drives them, and that in the left ventricle, which squeezes the vessels within its muscle.
#pragma once

#include <vector>

namespace patency {

struct Heartbeat {
    double period;   ///< [s]
    double mean;     ///< of the aortic pressure [Pa]
    double pulse;    ///< the largest aortic pressure less the least [Pa]
};

/// Pressures over one period, linear in between; the last is the first. The ventricle begins to contract at time 0.
struct BeatPressures {
    std::vector<double> times;              ///< [s]
    std::vector<double> aorta, ventricle;   ///< [Pa]
    double decay;                           ///< the time in which the arteries run empty in diastole, R C [s]
};

/// The aorta is a three-element Windkessel that the ventricle ejects a half sine into; its compliance follows from the pulse.
/// The ventricle's pressure is the aorta's while its valve is open. THEORY.md (9.11), (9.12)
/// @throws DeckError for a period that is no heart's (0.33 to 2 s), and a pulse that is not between zero and the mean.
BeatPressures make_beat(const Heartbeat& beat);

}   // namespace patency
