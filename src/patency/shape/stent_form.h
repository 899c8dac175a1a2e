// SPDX-License-Identifier: Apache-2.0
// A stent as it was made, straight along x with its middle at the origin: struts of a pattern, or the surface of its metal.
#pragma once

#include <variant>

#include "patency/shape/stent_import.h"
#include "patency/shape/stent_pattern.h"

namespace patency {

using StentForm = std::variant<StrutCurves, ImportedStent>;

/// The thinner of a strut's thickness and the width of the narrowest [m]; of a surface the width that its volume and area would
/// give bars of that thickness.
double least_strut(const StentForm& form);

/// [m^3]
double metal_volume(const StentForm& form);

}   // namespace patency
