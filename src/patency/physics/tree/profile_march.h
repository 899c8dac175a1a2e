// SPDX-License-Identifier: Apache-2.0
// Steady flow along one vessel whose area changes: Prandtl's equations in rings of equal area, marched downstream. Friction,
// entrance, jet and what pressure comes back behind a throat follow from the profile; no coefficient stands in it.
// THEORY section 15. Knows no particles.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace patency {

struct TreeBlood {
    double density;                               ///< [kg/m^3]
    std::function<double(double)> viscosity_at;   ///< of the shear rate [1/s]: dynamic viscosity [Pa s]
};

/// The axial speed in rings of equal area, from the axis out, over the section's mean.
struct TreeProfile {
    static constexpr int rings = 32;
    std::array<double, rings> speed;

    /// From a parabola (0) to a plug (1).
    static TreeProfile between(double flat);
    /// The same as a jet that fills a share of the area, with water at rest around it.
    TreeProfile as_jet(double share) const;
    /// At a distance from the axis, over the radius: 0 to 1, where it is 0.
    double at(double share) const;
};

/// What a march tells, by stations.
struct ProfileAlong {
    std::vector<double> pressure;       ///< static, less the first station's [Pa]
    std::vector<TreeProfile> profile;   ///< the first as given
};

/// A flow >= 0 [m^3/s] that comes with a profile. `arc` rises [m], `area` [m^2]; as many as stations. Pressures are NAN from
/// where no profile is found on: in a throat through which no pressure drives such a flow.             THEORY.md (15.1)
ProfileAlong march_profile(const TreeBlood& blood, std::span<const double> arc, std::span<const double> area,
                           double flow, const TreeProfile& first);

}   // namespace patency
