// SPDX-License-Identifier: Apache-2.0
// From deformation to stress, particle by particle: the laws of a body's materials applied to the sums over neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "patency/bodies/solid.h"
#include "patency/schemes/records.h"

namespace patency {

/// A symmetric matrix per particle, in columns: xx, yy, zz, xy, xz, yz.
template <class T>
using SymColumns = std::array<AlignedVector<T>, 6>;

/// What the stress of a body is made of, by particle.
template <class T>
struct StressInput {
    std::array<AlignedVector<T>, 9> sums;   ///< sum w (u_i - u_j) d^T, by rows, in units of the loop
    SymColumns<T> correction;               ///< B, per unit of distance squared
    AlignedVector<T> hourglass;             ///< c [Pa per unit of distance squared]
    AlignedVector<T> share;                 ///< of the volume, in the mean of all
    double displacement_scale = 1;          ///< the unit of displacements in that of distances
};

/// What the loop that sums forces needs of it: A = v [c (F - 1) - P B].                                  THEORY (20.8)
template <class T>
struct StressOutput {
    std::array<AlignedVector<Quad<T>>, 3> rows;   ///< of A, in three of four places
};

/// The stress of one material's particles; plastic particles take their step. Returns the first particle that is inside out
/// (det F <= 0, or no number), or no_particle.
template <class T>
std::uint32_t compute_stress(const SolidMaterial& material, const std::vector<std::uint32_t>& members,
                             const StressInput<T>& input, SolidParticles& particles,
                             StressOutput<T>& stress);

inline constexpr std::uint32_t no_particle = UINT32_MAX;

/// F of particle i.                                                                                    THEORY (20.3)
template <class T>
Mat3 deformation_gradient(const StressInput<T>& input, std::size_t i);

}   // namespace patency
