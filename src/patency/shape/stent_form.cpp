// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/stent_form.h"

#include <algorithm>

#include "patency/shape/stent_chart.h"

namespace patency {

namespace {

double least_strut_of(const StrutCurves& curves) {
    double least = curves.thickness;
    for (const Strut& strut : curves.struts) least = std::min(least, 2 * strut.half_width);
    return least;
}

/// Bars of width w and thickness t have volume over area w t / 2 (w + t).
double least_strut_of(const ImportedStent& stent) {
    const double t = stent.strut_thickness, twice = 2 * stent.volume / stent.area;
    return twice < t ? std::min(t, twice * t / (t - twice)) : t;
}

}   // namespace

double least_strut(const StentForm& form) {
    return std::visit([](const auto& f) { return least_strut_of(f); }, form);
}

double metal_volume(const StentForm& form) {
    if (const auto* stent = std::get_if<ImportedStent>(&form)) return stent->volume;
    return measure_stent(std::get<StrutCurves>(form)).volume;
}

}   // namespace patency
