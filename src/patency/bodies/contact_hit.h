// SPDX-License-Identifier: Apache-2.0
// Whether a vertex of one surface is in another one, how deep, and which way out: the signed distance to its elements.
#pragma once

#include <array>
#include <cstdint>

#include "patency/bodies/contact_search.h"
#include "patency/bodies/solid_surface.h"

namespace patency {

/// Where a vertex that is in would come out, or one that is out would go in.
struct ContactHit {
    double depth = 0;   ///< [m]; negative: it is out by that; zero: nothing is near
    Vec3 normal;        ///< of the way out
    std::uint32_t element = 0;
    std::array<double, 3> weights{};   ///< of the element's corners
};

/// The vertex of that number, at x, against the elements of `other` that the search has near it: the depth is negative outside; clearance [m]: how
/// far it is from them at least, if it is not in.                                                       THEORY (21.5)
ContactHit find_contact_hit(const Vec3& x, std::size_t vertex, const SolidSurface& other, const ContactSearch& search,
                            double& clearance);

}   // namespace patency
