// SPDX-License-Identifier: Apache-2.0
// The pairs of a solid, found once, in the reference configuration.                                  THEORY (20.1)
#pragma once

#include "patency/pairs/fixed_pairs.h"
#include "patency/schemes/solid_body.h"

namespace patency {

/// Pairs within a support, distances in spacings, with the weights w. The particles get the order in which pairs are packed, and their places are
/// put on whole quanta: pairs are kept in those (PairUnits), so that what is linear stays so to the last bit. Nothing moves by more than 1e-4 spacings,
/// the body as it is now with its reference; for both T the same. Throws GeometryError if there are no particles.
template <class T>
FixedPairs<T> pair_up(SolidParticles& particles, const SolidNumerics& numerics);

}   // namespace patency
