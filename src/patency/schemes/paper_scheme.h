// SPDX-License-Identifier: Apache-2.0
// The scheme of the reference paper, its misprints mended: what the default scheme is compared with. Conservative pair
// forces from a Riemann problem, dummy wall particles, density by summation.                   THEORY.md (11)
#pragma once

#include "patency/schemes/flow_scheme.h"

namespace patency {

/// Of `numerics` it does not use `dissipation` and `shift`: the paper's are those of THEORY.md (4.3) and (6.2).
/// Particle volumes are volumes at rest: a particle's mass is rho_0 times it. A start under pressure is quiet if the
/// volumes are the actual ones times rho(p)/rho_0, because the density is summed from the masses.
/// Throws DeckError where double precision is wanted in a periodic box.
std::unique_ptr<FlowScheme> make_paper_scheme(Precision precision, const FlowDomain& domain,
                                              const FluidMaterial& material, const FlowNumerics& numerics);

}   // namespace patency
