// SPDX-License-Identifier: Apache-2.0
// Gauss's theorem for the blood of a domain: what its divergences add up to must be what flows through its sections. The sums over
// neighbours know that to their order only; what they have in excess is taken off in the step after.      THEORY.md (4.10)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patency/schemes/flow_scheme.h"

namespace patency {

/// The entrances of openings with an imposed flow are parts of their own; the rest of the domain is one. The excesses
/// themselves are kept with the blood and the ends, for the next step and for checkpoints.
class VolumeBalance {
public:
    /// The domain's parts must outlive this; `cell` is the volume of a particle [m^3].
    VolumeBalance(const FlowDomain& domain, double cell) : domain_(domain), cell_(cell) {}

    // The verbs of an advection step, after the ends have found their members and the velocity gradients are known.
    void divide_into_parts();
    void share_excess();
    /// And of an acoustic step: from the divergences of all particles [1/s], what each part has too much of them.
    void find_excess(std::span<const double> divergence);

    /// Of the divergence at particle i, by the last find_excess [1/s].
    double excess(std::size_t i) const {
        if (place_[i] == rest) return domain_.fluid.excess_divergence;
        const Place& place = places_[place_[i]];
        return place.share * domain_.ends[place.end].entrance_excess;
    }

private:
    struct Place {
        std::uint32_t end;
        double share = 1;   ///< of the entrance's mean
    };
    static constexpr std::uint32_t rest = ~0u;

    FlowDomain domain_;
    double cell_;
    std::vector<std::uint32_t> place_;   // of a particle in places_, or rest
    std::vector<Place> places_;          // of the particles in entrances, end by end
};

}   // namespace patency
