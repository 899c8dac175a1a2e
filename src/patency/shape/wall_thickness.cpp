// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/wall_thickness.h"

#include <algorithm>

namespace patency {

double coronary_wall_thickness(double healthy_diameter) {
    return std::min(1e-3, 0.55e-3 + 0.225 * std::max(0.0, healthy_diameter - 2e-3));
}

}   // namespace patency
