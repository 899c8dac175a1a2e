// SPDX-License-Identifier: Apache-2.0
// What surrounds a vessel holds it: springs from a face of a surface to where it was.                     THEORY (24.6)
#pragma once

#include <cstdint>

#include "patency/bodies/contact.h"

namespace patency {

/// stiffness [Pa/m] per area of the face in the reference configuration.
std::unique_ptr<Contact> make_tether(SolidSurface& surface, std::uint16_t face, double stiffness);

}   // namespace patency
