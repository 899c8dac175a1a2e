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
    std::array<AlignedVector<T>, 9> sums;     ///< sum w (u_i - u_j) d^T, by rows, in units of the loop
    std::array<AlignedVector<T>, 9> around;   ///< sum w ((F_j - 1) d) d^T, of a body of second order; else empty
    SymColumns<T> correction;                 ///< B, per unit of distance squared
    AlignedVector<T> hourglass;               ///< c [Pa per unit of distance squared]
    AlignedVector<T> share;                   ///< of the volume, in the mean of all
    double displacement_scale = 1;            ///< the unit of displacements in that of distances

    bool is_second_order() const { return around[0].size() > 0; }
};

/// What the loop that sums forces needs of it: A = v [c (F - 1) - P B]. Of a body of second order v P B, of which it is made.   THEORY (20.8)
template <class T>
struct StressOutput {
    std::array<AlignedVector<Quad<T>>, 3> rows;   ///< of A, in three of four places
};

/// The stress of one material's particles; plastic particles take their step. Returns the first particle that is inside out
/// (det F <= 0, or no number), or no_particle.
template <class T>
std::uint32_t compute_stress(const SolidMaterial& material, const std::vector<std::uint32_t>& members,
                             const StressInput<T>& input, SolidParticles& particles, StressOutput<T>& stress);

inline constexpr std::uint32_t no_particle = UINT32_MAX;

template <class T>
Mat3 matrix_at(const std::array<AlignedVector<T>, 9>& columns, std::size_t i) {
    const auto at = [&](std::size_t k) { return double(columns[k][i]); };
    return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}};
}
/// B of particle i, per unit of distance squared.
template <class T>
Mat3 correction_at(const StressInput<T>& input, std::size_t i) {
    const auto b = [&](std::size_t k) { return double(input.correction[k][i]); };
    return {{b(0), b(3), b(4)}, {b(3), b(1), b(5)}, {b(4), b(5), b(2)}};
}

/// F of particle i that fits the displacements around it best.                                         THEORY (20.3)
template <class T>
Mat3 fitted_gradient(const StressInput<T>& input, std::size_t i);
/// F of particle i that its law sees: the fitted one, or that of second order.                        THEORY (20.18)
template <class T>
Mat3 deformation_gradient(const StressInput<T>& input, std::size_t i);

}   // namespace patency
