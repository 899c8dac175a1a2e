// SPDX-License-Identifier: Apache-2.0
// How thick the wall of a coronary is where nobody measured it.
#pragma once

namespace patency {

/// The thickness [m] by the diameter of the healthy lumen [m]: the range of the reference paper. THEORY.md (17.4)
/// 0.55 mm up to 2 mm, 1 mm from 4 mm on, never falling.
double coronary_wall_thickness(double healthy_diameter);

}   // namespace patency
