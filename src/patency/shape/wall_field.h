// SPDX-License-Identifier: Apache-2.0
// The wall of a vessel as a body: how thick it is, where plaque fills it, and the part of it around a stretch of one
// centreline, cut flat across every branch that leaves it. Makes no particles (bodies/vessel_wall.h).   THEORY (24.2), (24.3)
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "patency/shape/branches.h"
#include "patency/shape/signed_distance.h"

namespace patency {

struct WallSettings {
    std::optional<double> thickness{};   ///< [m]; none: by the healthy lumen's diameter, THEORY (17.4)
    bool is_filled =
        false;   ///< plaque fills what lies between the lumen and the healthy one; else the wall follows the lumen
    std::size_t line = 0;      ///< the wall around this line,
    double from = 0, to = 0;   ///< from and to these arcs [m],
    double reach =
        0;   ///< and this much farther along every way [m], or to its opening, or past a bifurcation that is a diameter or less away
};

/// Where a part of a vessel ends: a plane across it.
struct VesselEnd {
    Vec3 centre, normal;   ///< [m]; unit, out of the part
    double radius;         ///< of the healthy lumen [m]
    bool is_opening;       ///< the vessel's own end
};

/// A place as the wall sees it.
struct WallPlace {
    double lumen;       ///< distance to the lumen's wall, negative in the blood [m]
    double healthy;     ///< the same to the lumen without its lesions; that to the lumen where nothing is filled [m]
    double thickness;   ///< of the vessel's wall there [m]
    double region;      ///< past the nearest end, negative within the part [m]; not farther than a diameter
    Vec3 from_lumen;    ///< unit, the way in which `lumen` rises
    Vec3 past_end;      ///< unit, the way in which `region` rises; zero far from ends
};

/// A value that can be copied; safe to ask from several threads.
class WallField {
public:
    /// healthy_diameter: per line and point (Assessment). lumen: exact outside, at least as far as the wall. openings: the inlet
    /// first, then one per line. Throws GeometryError for a thickness that is none.
    WallField(const BranchedLines& lines, const std::vector<std::vector<double>>& healthy_diameter,
              const std::vector<Vec3>& opening_normals, SignedDistance lumen, const WallSettings& settings);

    WallPlace at(const Vec3& x) const;
    /// Negative in the wall: outside of the lumen, inside of the outer face, within the part.
    double value(const Vec3& x) const;
    SignedDistance wall() const;   ///< the same with its slope, that of the thickness left out
    const std::vector<VesselEnd>& ends() const;
    double thinnest() const;   ///< [m]
    Bounds bounds() const;     ///< around the part
    const SignedDistance& lumen() const;

private:
    class Impl;
    std::shared_ptr<const Impl> impl_;
};

}   // namespace patency
