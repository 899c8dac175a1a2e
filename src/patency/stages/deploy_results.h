// SPDX-License-Identifier: Apache-2.0
// What a deployment is judged by, as numbers for summary.json and tables: the stent's shape, how it sits, the lumen it leaves.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "patency/analysis/stent_metrics.h"
#include "patency/stages/stent_placement.h"

namespace patency {

/// The outer faces of a stent's struts: places that stand for an area each.
struct OuterFaces {
    std::vector<Vec3> places;    ///< [m]
    std::vector<double> areas;   ///< [m^2]
};
/// Of struts as they are drawn, along an axis.
OuterFaces outer_faces_of(const StrutCurves& curves, const StentAxis& axis);
std::vector<StentPoint> seen_from(const StentAxis& axis, const std::vector<Vec3>& places);

/// A slice per ring at least, each long enough to hold struts all around.
int slices_for(const StentPattern& pattern);

/// The lumen along the stent, before and after, by spheres and sections.
struct LumenGain {
    double narrowest_before, narrowest_after;    ///< the largest sphere that passes along the stent [m]
    double least_area;                           ///< of the sections after [m^2]
    double reference_diameter, reference_area;   ///< of the healthy lumen at the stent's ends [m], [m^2]

    double residual_stenosis() const { return 1 - narrowest_after / reference_diameter; }
};
/// `after`: followed.
LumenGain lumen_gain(const StentPlace& place, const VesselAlong& before, const Vessel& after);

/// Keys of `deploy` that hold for every mode: mode, where, and the figures of the three.
nlohmann::ordered_json deploy_summary(const StentPlace& place, const StentProfile& shape, const StrutFit& fit,
                                      const std::vector<JailedOstium>& ostia, const LumenGain& gain);

/// stent.csv: a row per slice. Throws FileError.
void write_stent_table(const std::filesystem::path& path, const StentProfile& shape);

}   // namespace patency
