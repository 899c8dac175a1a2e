// SPDX-License-Identifier: Apache-2.0
// How the particles of the default scheme lie: their order and rows, their distances to the wall, the shift to where
// there are fewer, and what is summed of positions alone, moments and correction matrices. Knows no force and no time.
#pragma once

#include "patency/base/symmetric_matrix.h"
#include "patency/schemes/flow_terms.h"
#include "patency/schemes/order.h"
#include "patency/schemes/records.h"
#include "patency/schemes/wall_mirror.h"

namespace patency {

template <class T>
Mat3 matrix(const Sym<T>& s) {
    return {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
}

/// How a particle's sums over blood become the divergence of its velocity, where a wall is near too.
template <class T>
struct Closure {
    Sym<T> correction;   ///< over blood and wall, per metre
    Vec<T> wall;         ///< divergence by the wall: -(v - v_surface) . wall
};

/// Velocity relative to the wall's surface: all of it, or its normal part if the wall slips.
struct Slip {
    Vec3 velocity;   ///< [m/s]
    Vec3 normal;     ///< out of the blood; zero where the wall's normals cancel
};

/// T: float (positions in fixed point) or double.
template <class T>
class Arrangement {
public:
    using Moments = std::array<T, std::size_t(terms::Moments::sums)>;
    using WallMoments = std::array<T, std::size_t(terms::WallMoments::sums)>;

    /// Sorts the wall; the domain's parts must outlive the arrangement.
    Arrangement(const FlowDomain& domain, const FlowNumerics& numerics);

    // The verbs of a step, in this order.
    void sort_particles();   ///< throws DivergedError if one has left the frame
    void find_neighbours();
    void write_records();
    void shift_particles();
    void compute_moments();
    void compute_corrections();

    /// [m] of the loop: in the sums and in the numbers below that have no unit of their own.
    double unit() const { return scale_.unit; }
    const AlignedVector<Quad<T>>& geometry() const { return geometry_; }             ///< (x, distance to the wall)
    const AlignedVector<Quad<T>>& wall_geometry() const { return wall_geometry_; }   ///< (x, depth)
    // What acoustic steps need, frozen over an advection step: each reads what it needs and nothing else, for memory is slow.
    const Sym<T>& blood_correction(std::size_t i) const {
        return blood_corrections_[i];
    }   ///< over blood alone, per metre
    const Closure<T>& closure(std::size_t i) const { return closures_[i]; }
    const Vec<T>& radial_moment(std::size_t i) const { return radial_moments_[i]; }   ///< sum w r d over blood
    /// The matrix of the Laplacian's weight, (xx, yy, zz, .) and (xy, xz, yz, .).                    THEORY.md (3.6)
    const AlignedVector<Quad<T>>& laplacian_diagonal() const { return laplacian_diagonal_; }
    const AlignedVector<Quad<T>>& laplacian_mixed() const { return laplacian_mixed_; }

    /// Particles near the wall are counted: the number of i, or no_wall.
    std::uint32_t wall_of(std::size_t i) const { return wall_of_[i]; }
    std::size_t wall_count() const { return wall_moments_.size(); }
    const WallMoments& wall_moments(std::uint32_t k) const { return wall_moments_[k]; }
    /// Of the particle with number k, which moves with v [m/s].
    Slip slip_at_wall(std::uint32_t k, const Vec3& v) const {
        const WallMoments& wall = wall_moments_[k];
        const double weight = wall[30];
        const Vec3 sum{wall[31], wall[32], wall[33]};
        const double length = norm(sum);
        const Vec3 normal = length > 1e-6 * weight ? sum / length : Vec3{};
        const Vec3 slip = v - Vec3{wall[35], wall[36], wall[37]} / weight;
        return {numerics_.free_slip ? dot(slip, normal) * normal : slip, normal};
    }

    /// How much of the wall that the particle with number k sees faces one way: 1 of a plane, 0 in the middle between two.
    double facing(std::uint32_t k) const {
        const WallMoments& m = wall_moments_[k];
        return m[30] > T(0) ? norm(Vec3{m[31], m[32], m[33]}) / double(m[30]) : 0;
    }
    /// The wall as the particle i with number k sees it, in the loop's unit; `normal` as slip_at_wall tells it.
    WallBehind behind_wall(std::size_t i, std::uint32_t k, const Vec3& normal) const {
        const WallMoments& m = wall_moments_[k];
        return {normal, double(geometry_[i].d), matrix(Sym<T>{m[38], m[39], m[40], m[41], m[42], m[43]}),
                Vec3{m[44], m[45], m[46]}};
    }

    /// finish(i, sums of a term over the row of i): over the blood, and over the wall for particles near it.
    template <class Term, class Finish>
    void sum_over_blood(const Records<T, Term::own_extras>& own, const Records<T, Term::extras>& other,
                        const Term& term, const Finish& finish) const {
        sum_over_neighbours<T>(rows_, scale_, own, other, term, finish, numerics_.loop);
    }
    template <class Term, class Finish>
    void sum_over_wall(const Records<T, Term::own_extras>& own, const Records<T, Term::extras>& other, const Term& term,
                       const Finish& finish) const {
        sum_over_neighbours<T>(wall_rows_, scale_, own, other, term, finish, numerics_.loop);
    }

private:
    void write_wall_records();
    void measure_wall_distances();
    std::array<double, terms::moments> correct_gradients(std::size_t i);
    Mat3 second_moment(const std::array<double, terms::moments>& m) const;

    FlowDomain domain_;
    FlowNumerics numerics_;
    WendlandC2 kernel_;
    PairScale scale_;
    Cells cells_, wall_cells_;
    Neighbours rows_, wall_rows_;
    AlignedVector<Quad<T>> geometry_;
    AlignedVector<Quad<T>> wall_geometry_, wall_normal_, wall_velocity_;   // (x, depth), (n, curvature), (v, .)
    std::vector<Vec3> shift_;
    std::vector<Moments> moments_;
    std::vector<WallMoments> wall_moments_;
    std::vector<std::uint32_t> wall_of_;   // index into wall_moments_, per particle
    AlignedVector<Sym<T>> blood_corrections_;
    AlignedVector<Closure<T>> closures_;
    AlignedVector<Vec<T>> radial_moments_;
    AlignedVector<Quad<T>> laplacian_diagonal_, laplacian_mixed_;
};

extern template class Arrangement<float>;
extern template class Arrangement<double>;

}   // namespace patency
