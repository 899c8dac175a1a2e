// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/flow_arrangement.h"

#include "patency/base/parallel.h"
#include "patency/schemes/ends.h"

namespace patency {

namespace {

// A particle nearer to the wall than this share of a spacing is treated as if it were there: the mirror ratio D/s would
// grow without bound, and with it the stiffness of the viscous term.
constexpr double nearest_wall_distance = 0.3;
// A particle nearer than this share of a spacing is led back, by this share of what is missing per step. In a relaxed
// arrangement the first layer stands at 0.5.
constexpr double wall_clearance = 0.4;
constexpr double wall_return = 0.5;
// The shift of one step is at most this share of a spacing: beyond it the correction of the fields is not linear.
constexpr double largest_shift = 0.1;

template <class T>
Sym<T> symmetric(const Mat3& m) {
    return {T(m.x.x), T(m.y.y), T(m.z.z), T(m.x.y), T(m.x.z), T(m.y.z)};
}

/// A with sum w (e.A e) d d = 2 I, so that the weighted sum of differences is the Laplacian of any quadratic field.
/// From the fourth moments m[12..26]; 6 equations for xx, yy, zz, xy, xz, yz. P: a double, or a pack of them.
///                                                                                                THEORY.md (3.6)
template <class P>
Sym<P> laplacian_correction(const std::array<P, terms::moments>& m, bool planar) {
    const P* q = &m[12];   // xxxx yyyy zzzz xxyy xxzz yyzz xxxy xxxz xyyy yyyz xzzz yzzz xxyz xyyz xyzz
    const P two(2), four(4);
    P a[6][6] = {{q[0], q[3], q[4], two * q[6], two * q[7], two * q[12]},
                 {q[3], q[1], q[5], two * q[8], two * q[13], two * q[9]},
                 {q[4], q[5], q[2], two * q[14], two * q[10], two * q[11]},
                 {q[3], q[3], q[3], four * q[3], four * q[12], four * q[13]},
                 {q[4], q[4], q[4], q[4], four * q[4], four * q[14]},
                 {q[5], q[5], q[5], q[5], q[5], four * q[5]}};   // only the upper half counts
    if (planar) a[2][2] = a[4][4] = a[5][5] = q[0];              // nothing happens across the plane
    P b[6] = {two, two, two, P(0), P(0), P(0)};
    // U^T D U of a symmetric positive matrix, in place, then the two substitutions.
    P pivot[6];
    for (int k = 0; k < 6; ++k) {
        pivot[k] = P(1) / a[k][k];
        for (int i = k + 1; i < 6; ++i) {
            const P f = a[k][i] * pivot[k];
            for (int j = i; j < 6; ++j) a[i][j] = fma(-f, a[k][j], a[i][j]);
            b[i] = fma(-f, b[k], b[i]);
        }
    }
    for (int k = 5; k >= 0; --k) {
        for (int j = k + 1; j < 6; ++j) b[k] = fma(-a[k][j], b[j], b[k]);
        b[k] *= pivot[k];
    }
    return {b[0], b[1], b[2], b[3], b[4], b[5]};
}

}   // namespace

template <class T>
Arrangement<T>::Arrangement(const FlowDomain& domain, const FlowNumerics& numerics)
    : domain_(domain),
      numerics_(numerics),
      kernel_(numerics.kernel()),
      scale_(pair_scale<T>(domain.frame, kernel_.support())) {
    sort_wall(domain_.wall, wall_cells_, domain_.frame, numerics_.spacing);
    write_wall_records();
}

template <class T>
void Arrangement<T>::write_wall_records() {
    const WallParticles& wall = domain_.wall;
    const std::size_t n = wall.size();
    wall_geometry_.reset(n + 1), wall_normal_.reset(n + 1), wall_velocity_.reset(n + 1);
    for (std::size_t w = 0; w < n; ++w) {
        wall_geometry_[w] = position_record(domain_.frame, wall.position[w], T(wall.depth[w] / unit()));
        wall_normal_[w] = vector_record(wall.normal[w], T(wall.curvature[w]));
        wall_velocity_[w] = vector_record(wall.velocity[w], T(0));
    }
    wall_geometry_[n] = dummy_record<T>();
    wall_normal_[n] = wall_velocity_[n] = zero_record<T>();
}

template <class T>
void Arrangement<T>::sort_particles() {
    sort_blood(domain_.fluid, cells_, domain_.frame, numerics_.spacing);
}

template <class T>
void Arrangement<T>::find_neighbours() {
    rows_.find_own(domain_.frame, cells_, kernel_.support(), native_lanes<T>);
    wall_rows_.find_other(domain_.frame, cells_, wall_cells_, kernel_.support(), native_lanes<T>);
}

template <class T>
void Arrangement<T>::write_records() {
    const auto& x = domain_.fluid.position;
    const std::size_t n = domain_.fluid.size();
    geometry_.reset(n + 1);
    for_each_index(n, [&](std::size_t i) { geometry_[i] = position_record(domain_.frame, x[i], T(0)); });
    geometry_[n] = dummy_record<T>();
    geometry_[n].d = T(1);   // a distance to the wall, which is divided by
    measure_wall_distances();
}

template <class T>
void Arrangement<T>::measure_wall_distances() {
    const auto& x = domain_.fluid.position;
    for_each_index(wall_rows_.block_count(), [&](std::size_t b) {
        const auto& block = wall_rows_.block(b);
        for (std::size_t m = 0; m < block.member_count; ++m) {
            const std::uint32_t i = block.members[m];
            geometry_[i].d = T(-domain_.distance(x[i]) / unit());
        }
    });
}

/// Moves particles towards where there are fewer, so that sum w d = 0 all but holds: then a constant pressure makes
/// no force in any form, and the gradient and the divergence are adjoint, so that pressure does no work of its own.
/// The fields stay where they are.                                                             THEORY.md (6.1)
template <class T>
void Arrangement<T>::shift_particles() {
    FluidParticles& fluid = domain_.fluid;
    const double scale = 2 * numerics_.shift * kernel_.h * kernel_.h * kernel_.slope() * numerics_.cell() * unit();
    const double limit = largest_shift * numerics_.spacing;
    const auto vector = [](const std::array<T, 3>& sum) { return Vec3{sum[0], sum[1], sum[2]}; };
    const auto limited = [&](const Vec3& shift) {
        const double length = norm(shift);
        return length > limit ? (limit / length) * shift : shift;
    };
    shift_.resize(fluid.size());
    sum_over_blood(records_of(geometry_), records_of(geometry_), terms::Crowding{},
                   [&](std::uint32_t i, const std::array<T, 3>& sum) { shift_[i] = scale * vector(sum); });
    sum_over_wall(records_of(geometry_), records_of(wall_geometry_), terms::Crowding{},
                  [&](std::uint32_t i, const std::array<T, 3>& sum) {
                      const double length = norm(vector(sum));
                      if (!(length > 0)) return;
                      const Vec3 away = vector(sum) / length;   // from the wall
                      const double missing = wall_clearance * numerics_.spacing - double(geometry_[i].d) * unit();
                      shift_[i] += scale * vector(sum);
                      if (missing > 0) shift_[i] += wall_return * missing * away;
                      geometry_[i].d += T(dot(limited(shift_[i]), away) / unit());   // to first order
                  });
    for_each_index(fluid.size(), [&](std::size_t i) {
        if (fluid.opening[i] < 0) return;
        Vec3 shift = limited(shift_[i]);
        if (fluid.opening[i] > 0) {
            // What is pushed over a buffer's far end is lost, and nothing comes back for it. Held back one way only,
            // though, what trembles drifts the other way: into the vessel, step by step.                 THEORY.md (8.11)
            const OpenEnd& end = end_of(domain_, i);
            if (end.axial(fluid.position[i]) > 0.5 * end.buffer_length) shift -= dot(shift, end.normal) * end.normal;
        }
        fluid.position[i] += shift;
        fluid.velocity[i] += fluid.velocity_gradient[i] * shift;
        fluid.pressure[i] += dot(fluid.pressure_gradient[i], shift);
        geometry_[i] = position_record(domain_.frame, fluid.position[i], geometry_[i].d);
    });
}

template <class T>
void Arrangement<T>::compute_moments() {
    const std::size_t n = domain_.fluid.size();
    const T nearest = T(nearest_wall_distance * numerics_.spacing / unit());
    for_each_index(n, [&](std::size_t i) { geometry_[i].d = max(geometry_[i].d, nearest); });
    moments_.resize(n);
    sum_over_blood(records_of(geometry_), records_of(geometry_), terms::Moments{},
                   [&](std::uint32_t i, const Moments& sum) { moments_[i] = sum; });
    number_wall_rows(wall_rows_, n, wall_of_);
    wall_moments_.resize(wall_rows_.member_count());
    sum_over_wall(records_of(geometry_), records_of(wall_geometry_, wall_normal_, wall_velocity_), terms::WallMoments{},
                  [&](std::uint32_t i, const WallMoments& sum) {
                      wall_moments_[wall_of_[i]] = sum;
                      if (!(sum[30] > T(0))) wall_of_[i] = no_wall;   // just out of the kernel's reach
                  });
}

/// Correction matrices of gradient and Laplacian, of every particle; a pack of particles at a time.
template <class T>
void Arrangement<T>::compute_corrections() {
    using P = Pack<double>;
    const std::size_t n = domain_.fluid.size();
    blood_corrections_.reset(n), closures_.reset(n), radial_moments_.reset(n);
    laplacian_diagonal_.reset(n + 1), laplacian_mixed_.reset(n + 1);
    for_each_block(n, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += P::lanes) {
            const std::size_t count = std::min<std::size_t>(P::lanes, end - first);
            alignas(64) double gathered[terms::moments][P::lanes];
            for (std::size_t l = 0; l < P::lanes; ++l) {   // the last pack repeats its first particle
                const auto m = correct_gradients(first + (l < count ? l : 0));
                for (std::size_t s = 0; s < m.size(); ++s) gathered[s][l] = m[s];
            }
            std::array<P, terms::moments> m;
            for (std::size_t s = 0; s < m.size(); ++s) m[s] = P::load(gathered[s]);
            const Sym<P> a = laplacian_correction(m, numerics_.planar);
            for (std::size_t l = 0; l < count; ++l) {
                const int k = int(l);
                laplacian_diagonal_[first + l] = {T(a.xx[k]), T(a.yy[k]), T(a.zz[k]), T(0)};
                laplacian_mixed_[first + l] = {T(a.xy[k]), T(a.xz[k]), T(a.yz[k]), T(0)};
            }
        }
    });
    laplacian_diagonal_[n] = laplacian_mixed_[n] = zero_record<T>();
}

/// Writes the corrections of gradients of particle i; returns its moments over blood and wall.
template <class T>
std::array<double, terms::moments> Arrangement<T>::correct_gradients(std::size_t i) {
    std::array<double, terms::moments> m;
    for (std::size_t s = 0; s < m.size(); ++s) m[s] = moments_[i][s];
    radial_moments_[i] = {moments_[i][9], moments_[i][10], moments_[i][11]};
    const Mat3 own = inverse(second_moment(m));
    Vec3 mirror{};
    if (const std::uint32_t k = wall_of_[i]; k != no_wall) {
        const WallMoments& wall = wall_moments_[k];
        for (std::size_t s = 0; s < m.size(); ++s) m[s] += wall[s];
        mirror = {wall[27], wall[28], wall[29]};
    }
    const Mat3 all = inverse(second_moment(m));
    blood_corrections_[i] = symmetric<T>((1 / unit()) * own);
    const Vec3 by_wall = (1 / unit()) * (all * mirror);
    closures_[i] = {symmetric<T>((1 / unit()) * all), {T(by_wall.x), T(by_wall.y), T(by_wall.z)}};
    return m;
}

template <class T>
Mat3 Arrangement<T>::second_moment(const std::array<double, terms::moments>& m) const {
    return matrix(Sym<double>{m[0], m[1], numerics_.planar ? 0.5 * (m[0] + m[1]) : m[2], m[3], m[4], m[5]});
}

template class Arrangement<float>;
template class Arrangement<double>;

}   // namespace patency
