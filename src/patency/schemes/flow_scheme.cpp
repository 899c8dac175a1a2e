// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/flow_scheme.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/schemes/flow_terms.h"
#include "patency/search/cells.h"

namespace patency {

namespace {

/// A symmetric 3x3 matrix as the sums come: xx, yy, zz, xy, xz, yz.
template <class T>
struct Sym {
    T xx, yy, zz, xy, xz, yz;
};
Mat3 matrix(const Sym<double>& s) { return {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}; }
template <class T>
Sym<T> symmetric(const Mat3& m) {
    return {T(m.x.x), T(m.y.y), T(m.z.z), T(m.x.y), T(m.x.z), T(m.y.z)};
}

// A particle nearer to the wall than this share of a spacing is treated as if it were there: the mirror ratio D/s would
// grow without bound, and with it the stiffness of the viscous term.
constexpr double nearest_wall_distance = 0.3;
// A particle nearer than this share of a spacing is led back, by this share of what is missing per step. In a relaxed
// arrangement the first layer stands at 0.5.
constexpr double wall_clearance = 0.4;
constexpr double wall_return = 0.5;
// How much farther ahead than half a step the pressure of the next kick looks along its own change by compression: a bulk
// viscosity of this share of dt c^2 that quietens sound and leaves blood that does not expand alone.  THEORY.md (4.7)
constexpr double bulk_share = 0.5;
// Passes per advection step; a flow that strains undoes the order within a few steps (docs/VERIFICATION.md, taylor_green).
constexpr int shift_passes = 2;
// Advection cycles on one set of rows. Neighbours drift apart by less than a fifth of a spacing per cycle; what rows miss then
// are pairs at the kernel's edge, and every sum is normalised by the moments of the same rows.
constexpr int cycles_per_row = 2;
// The shift of one step is at most this share of a spacing: beyond it the correction of the fields is not linear.
constexpr double largest_shift = 0.1;
// Stability of the explicit slow terms: the largest eigenvalue of the operator (3.5) is about 12/h^2, that of (4.9) 2.6/h;
// both are held to about three quarters of the bound of an explicit step.                          THEORY.md (7.1)
constexpr double viscous_number = 0.125;
constexpr double upwind_number = 1.5;

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
    if (planar) a[2][2] = a[4][4] = a[5][5] = q[0];   // nothing happens across the plane
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

/// What the acoustic steps need of a particle, frozen over an advection step.
template <class T>
struct alignas(64) Closure {
    Sym<T> pressure;      ///< correction over blood alone, per metre
    Sym<T> velocity;      ///< correction over blood and wall, per metre
    Vec<T> wall;          ///< divergence by the wall: -(v - v_surface) . wall
    T pad = 0;
};

template <class T>
class SphScheme final : public FlowScheme {
public:
    SphScheme(const FlowDomain& domain, const FluidMaterial& material, const FlowNumerics& numerics)
        : domain_(domain), material_(material), numerics_(numerics),
          kernel_{numerics.smoothing_ratio * numerics.spacing, numerics.planar},
          scale_(pair_scale<T>(domain.frame, kernel_.support())) {
        if (sizeof(T) == 8 && domain.frame.any_periodic())
            throw DeckError("numerics.precision: double is not available in a periodic box; use mixed");
        prepare_wall();
    }

    FlowStep step(double time, double longest) override {
        sort_particles();
        find_neighbours();
        FlowStep report;
        for (int cycle = 0; cycle < cycles_per_row && report.dt < longest; ++cycle) {
            write_geometry_records();
            for (int pass = 0; pass < shift_passes; ++pass) shift_particles();
            find_members(domain_.fluid, numerics_.spacing, domain_.ends);
            measure_flows(time + report.dt);
            write_velocity_records();
            compute_moments();
            compute_corrections();
            const FlowStep advection = choose_step(longest - report.dt);
            compute_viscosity(are_gradients_known() ? std::max(advection.fastest, numerics_.reference_speed) : 0);

            const double dt = advection.dt / advection.acoustic_steps;
            start_acoustic_steps(dt);
            for (int k = 0; k < advection.acoustic_steps; ++k) {
                impose_pressure(time + report.dt + k * dt, dt);
                kick(dt);
                impose_velocity(time + report.dt + (k + 1) * dt);
                compress(dt);
                measure_flows(time + report.dt + (k + 1) * dt);
                balance_volume();
            }
            move_particles();
            // What is left of `longest` by rounding is none of another cycle's business.
            report.dt = advection.dt < longest - report.dt ? report.dt + advection.dt : longest;
            report.acoustic_steps += advection.acoustic_steps;
            report.fastest = std::max(report.fastest, advection.fastest);
        }
        exchange_particles(domain_.fluid, numerics_.spacing, kernel_.support(), domain_.ends);
        return report;
    }

private:
    using Sums = std::array<T, std::size_t(terms::Moments::sums)>;
    using WallSums = std::array<T, std::size_t(terms::WallMoments::sums)>;

    Quad<T> record(const Vec3& x, T value) const {
        if constexpr (sizeof(T) == 4) {
            const auto f = domain_.frame.fixed(x);
            return {std::bit_cast<float>(f[0]), std::bit_cast<float>(f[1]), std::bit_cast<float>(f[2]), value};
        } else {
            return {x.x, x.y, x.z, value};
        }
    }
    /// Far from everything that may ever be there (half the fixed-point range away), at rest.
    Quad<T> dummy_record() const {
        if constexpr (sizeof(T) == 4)
            return {std::bit_cast<float>(INT32_MIN), std::bit_cast<float>(INT32_MIN), std::bit_cast<float>(INT32_MIN), T(0)};
        else
            return {T(1e9), T(1e9), T(1e9), T(0)};
    }
    double loop_unit() const { return scale_.unit; }

    void prepare_wall() {
        WallParticles& wall = domain_.wall;
        wall.take(wall_cells_.find_order(domain_.frame, numerics_.spacing, {wall.position.data(), wall.size()}));
        wall_cells_.index(domain_.frame, numerics_.spacing, {wall.position.data(), wall.size()});
        const std::size_t n = wall.size();
        wall_geometry_.reset(n + 1), wall_normal_.reset(n + 1), wall_velocity_.reset(n + 1);
        for (std::size_t w = 0; w < n; ++w) {
            const Vec3& m = wall.normal[w];
            const Vec3& v = wall.velocity[w];
            wall_geometry_[w] = record(wall.position[w], T(wall.depth[w] / loop_unit()));
            wall_normal_[w] = {T(m.x), T(m.y), T(m.z), T(wall.curvature[w])};
            wall_velocity_[w] = {T(v.x), T(v.y), T(v.z), T(0)};
        }
        wall_geometry_[n] = dummy_record();
        wall_normal_[n] = wall_velocity_[n] = {T(0), T(0), T(0), T(0)};
    }

    void sort_particles() {
        FluidParticles& fluid = domain_.fluid;
        if (domain_.frame.any_periodic())
            for_each_index(fluid.size(), [&](std::size_t i) { fluid.position[i] = domain_.frame.wrapped(fluid.position[i]); });
        check_inside();
        fluid.take(cells_.find_order(domain_.frame, numerics_.spacing, {fluid.position.data(), fluid.size()}));
        cells_.index(domain_.frame, numerics_.spacing, {fluid.position.data(), fluid.size()});
    }

    void check_inside() const {
        const FluidParticles& fluid = domain_.fluid;
        const double outside = sum_of(fluid.size(), [&](std::size_t i) { return domain_.frame.contains(fluid.position[i]) ? 0.0 : 1.0; });
        if (outside == 0) return;
        for (std::size_t i = 0; i < fluid.size(); ++i) {
            const Vec3 &x = fluid.position[i], &v = fluid.velocity[i];
            if (!domain_.frame.contains(x))
                throw DivergedError(fmt::format("{} particles left the domain; the first is at ({:.4g}, {:.4g}, {:.4g}) m with velocity "
                                                "({:.3g}, {:.3g}, {:.3g}) m/s and pressure {:.3g} Pa",
                                                outside, x.x, x.y, x.z, v.x, v.y, v.z, fluid.pressure[i]));
        }
    }

    void find_neighbours() {
        rows_.find_own(domain_.frame, cells_, kernel_.support(), native_lanes<T>);
        wall_rows_.find_other(domain_.frame, cells_, wall_cells_, kernel_.support(), native_lanes<T>);
    }

    void write_geometry_records() {
        const std::size_t n = domain_.fluid.size();
        geometry_.reset(n + 1), pressure_.reset(n + 1), velocity_.reset(n + 1);
        const auto& x = domain_.fluid.position;
        for_each_index(n, [&](std::size_t i) { geometry_[i] = record(x[i], T(0)); });
        measure_wall_distances();
        geometry_[n] = pressure_[n] = dummy_record();
        geometry_[n].d = T(1);   // a distance to the wall, which is divided by
        velocity_[n] = {T(0), T(0), T(0), T(0)};
    }

    void measure_wall_distances() {
        const auto& x = domain_.fluid.position;
        for_each_index(wall_rows_.block_count(), [&](std::size_t b) {
            const auto& block = wall_rows_.block(b);
            for (std::size_t m = 0; m < block.member_count; ++m) {
                const std::uint32_t i = block.members[m];
                geometry_[i].d = T(-domain_.distance(x[i]) / loop_unit());
            }
        });
    }

    /// Moves particles towards where there are fewer, so that sum w d = 0 all but holds: then a constant pressure makes
    /// no force in any form, and the gradient and the divergence are adjoint, so that pressure does no work of its own.
    /// The fields stay where they are.                                                             THEORY.md (6.1)
    void shift_particles() {
        FluidParticles& fluid = domain_.fluid;
        const std::size_t n = fluid.size();
        const double scale = 2 * numerics_.shift * kernel_.h * kernel_.h * kernel_.slope() * numerics_.cell() * loop_unit();
        shift_.resize(n);
        const double limit = largest_shift * numerics_.spacing;
        const auto vector = [](const std::array<T, 3>& sum) { return Vec3{sum[0], sum[1], sum[2]}; };
        const auto limited = [&](const Vec3& shift) {
            const double length = norm(shift);
            return length > limit ? (limit / length) * shift : shift;
        };
        sum_over_neighbours<T>(rows_, scale_, Records<T, 0>{geometry_.data()}, Records<T, 0>{geometry_.data()}, terms::Crowding{},
                               [&](std::uint32_t i, const std::array<T, 3>& sum) { shift_[i] = scale * vector(sum); }, numerics_.loop);
        sum_over_neighbours<T>(wall_rows_, scale_, Records<T, 0>{geometry_.data()}, Records<T, 0>{wall_geometry_.data()}, terms::Crowding{},
                               [&](std::uint32_t i, const std::array<T, 3>& sum) {
                                   const double length = norm(vector(sum));
                                   if (!(length > 0)) return;
                                   const Vec3 away = vector(sum) / length;   // from the wall
                                   const double missing = wall_clearance * numerics_.spacing - double(geometry_[i].d) * loop_unit();
                                   shift_[i] += scale * vector(sum);
                                   if (missing > 0) shift_[i] += wall_return * missing * away;
                                   geometry_[i].d += T(dot(limited(shift_[i]), away) / loop_unit());   // to first order
                               },
                               numerics_.loop);
        for_each_index(n, [&](std::size_t i) {
            if (fluid.opening[i] < 0) return;
            Vec3 shift = limited(shift_[i]);
            if (fluid.opening[i] > 0) {   // what is pushed over a buffer's far end is lost, and nothing comes back for it
                const Vec3& axis = domain_.ends[std::size_t(fluid.opening[i]) - 1].normal;
                shift -= std::max(0.0, dot(shift, axis)) * axis;
            }
            fluid.position[i] += shift;
            fluid.velocity[i] += fluid.velocity_gradient[i] * shift;
            fluid.pressure[i] += dot(fluid.pressure_gradient[i], shift);
            geometry_[i] = record(fluid.position[i], geometry_[i].d);
        });
    }

    void write_velocity_records() {
        const FluidParticles& fluid = domain_.fluid;
        for (auto& row : gradient_) {
            row.reset(fluid.size() + 1);
            row[fluid.size()] = {T(0), T(0), T(0), T(0)};
        }
        const T nearest = T(nearest_wall_distance * numerics_.spacing / loop_unit());
        for_each_index(fluid.size(), [&](std::size_t i) {
            const Vec3& v = fluid.velocity[i];
            velocity_[i] = {T(v.x), T(v.y), T(v.z), T(fluid.viscosity[i] / material_.viscosity)};
            const Mat3 g = loop_unit() * fluid.velocity_gradient[i];
            gradient_[0][i] = {T(g.x.x), T(g.x.y), T(g.x.z), T(0)};
            gradient_[1][i] = {T(g.y.x), T(g.y.y), T(g.y.z), T(0)};
            gradient_[2][i] = {T(g.z.x), T(g.z.y), T(g.z.z), T(0)};
            geometry_[i].d = max(geometry_[i].d, nearest);
        });
    }

    void compute_moments() {
        const std::size_t n = domain_.fluid.size();
        moments_.resize(n);
        sum_over_neighbours<T>(rows_, scale_, Records<T, 0>{geometry_.data()}, Records<T, 0>{geometry_.data()}, terms::Moments{},
                               [&](std::uint32_t i, const Sums& sum) { moments_[i] = sum; }, numerics_.loop);
        wall_of_.assign(n, no_wall);
        wall_moments_.resize(wall_rows_.member_count());
        for_each_index(wall_rows_.block_count(), [&](std::size_t b) {
            const auto& block = wall_rows_.block(b);
            for (std::uint32_t m = 0; m < block.member_count; ++m) wall_of_[block.members[m]] = block.first_member + m;
        });
        sum_over_neighbours<T>(wall_rows_, scale_, Records<T, 0>{geometry_.data()},
                               Records<T, 2>{wall_geometry_.data(), wall_normal_.data(), wall_velocity_.data()}, terms::WallMoments{},
                               [&](std::uint32_t i, const WallSums& sum) {
                                   wall_moments_[wall_of_[i]] = sum;
                                   if (!(sum[30] > T(0))) wall_of_[i] = no_wall;   // just out of the kernel's reach
                               },
                               numerics_.loop);
    }

    /// Correction matrices of gradient and Laplacian, of every particle; a pack of particles at a time.
    void compute_corrections() {
        using P = Pack<double>;
        const std::size_t n = domain_.fluid.size();
        closures_.reset(n + 1), laplacian_diagonal_.reset(n + 1), laplacian_mixed_.reset(n + 1);
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
        laplacian_diagonal_[n] = laplacian_mixed_[n] = {T(0), T(0), T(0), T(0)};
    }

    /// Writes the closure of particle i; returns its moments over blood and wall.
    std::array<double, terms::moments> correct_gradients(std::size_t i) {
        const double unit = loop_unit();
        std::array<double, terms::moments> m;
        for (std::size_t s = 0; s < m.size(); ++s) m[s] = moments_[i][s];
        const Mat3 own = inverse(second_moment(m));
        Vec3 mirror{};
        if (const std::uint32_t k = wall_of_[i]; k != no_wall) {
            const WallSums& wall = wall_moments_[k];
            for (std::size_t s = 0; s < m.size(); ++s) m[s] += wall[s];
            mirror = {wall[27], wall[28], wall[29]};
        }
        const Mat3 all = inverse(second_moment(m));
        Closure<T>& c = closures_[i];
        c.pressure = symmetric<T>((1 / unit) * own);
        c.velocity = symmetric<T>((1 / unit) * all);
        const Vec3 by_wall = (1 / unit) * (all * mirror);
        c.wall = {T(by_wall.x), T(by_wall.y), T(by_wall.z)};
        return m;
    }

    Mat3 second_moment(const std::array<double, terms::moments>& m) const {
        return matrix({m[0], m[1], numerics_.planar ? 0.5 * (m[0] + m[1]) : m[2], m[3], m[4], m[5]});
    }

    /// Those of the last step, which a new flow has not made yet: then nothing can be told from noise.
    bool are_gradients_known() {
        const auto& gradient = domain_.fluid.velocity_gradient;
        const auto square = [&](std::size_t i) { return dot(gradient[i].x, gradient[i].x) + dot(gradient[i].y, gradient[i].y) + dot(gradient[i].z, gradient[i].z); };
        return gradients_known_ = gradients_known_ || sum_of(domain_.fluid.size(), square) > 0;
    }

    /// Velocity gradient, viscous acceleration, and the dissipation of what no gradient explains.   THEORY.md (3.5), (4.9)
    void compute_viscosity(double speed) {
        wall_viscosity_.resize(wall_moments_.size());
        sum_over_neighbours<T>(wall_rows_, scale_, Records<T, 2>{geometry_.data(), laplacian_diagonal_.data(), laplacian_mixed_.data()},
                               Records<T, 0>{wall_geometry_.data()}, terms::WallViscosity{},
                               [&](std::uint32_t i, const std::array<T, 5>& sum) {
                                   if (wall_of_[i] != no_wall) wall_viscosity_[wall_of_[i]] = sum;
                               },
                               numerics_.loop);
        surface_velocity_.resize(wall_moments_.size());
        sum_over_neighbours<T>(rows_, scale_, Records<T, 6>{geometry_.data(), velocity_.data(), gradient_[0].data(), gradient_[1].data(),
                                             gradient_[2].data(), laplacian_diagonal_.data(), laplacian_mixed_.data()},
                               Records<T, 4>{geometry_.data(), velocity_.data(), gradient_[0].data(), gradient_[1].data(), gradient_[2].data()},
                               terms::Viscosity{}, [&](std::uint32_t i, const std::array<T, 21>& sum) { apply_viscosity(i, sum, speed); },
                               numerics_.loop);
    }

    void apply_viscosity(std::uint32_t i, const std::array<T, 21>& sum, double speed) {
        FluidParticles& fluid = domain_.fluid;
        const double unit = loop_unit(), mu = fluid.viscosity[i] / material_.viscosity;   // relative, as in the sums
        const Vec3 v = fluid.velocity[i];
        const Sym<T>& c = closures_[i].velocity;
        const Mat3 correct = matrix({c.xx, c.yy, c.zz, c.xy, c.xz, c.yz});   // per metre
        Mat3 gradient{{sum[0], sum[1], sum[2]}, {sum[3], sum[4], sum[5]}, {sum[6], sum[7], sum[8]}};
        Vec3 laplacian{sum[9], sum[10], sum[11]}, first{sum[12], sum[13], sum[14]};
        const std::uint32_t k = wall_of_[i];
        Vec3 slip{}, normal{};
        if (k != no_wall) {
            const WallSums& wall = wall_moments_[k];
            const auto& friction = wall_viscosity_[k];
            slip = slip_at_wall(v, wall, normal);
            surface_velocity_[k] = v - slip;
            gradient += outer(slip, Vec3{wall[27], wall[28], wall[29]});
            laplacian -= mu * friction[0] * slip;
            first += mu * Vec3{friction[2], friction[3], friction[4]};
        }
        gradient = gradient * correct;
        if (fluid.opening[i] != 0) {   // natural outflow: nothing changes along the axis
            const Vec3& axis = domain_.ends[std::size_t(std::abs(fluid.opening[i])) - 1].normal;
            gradient = gradient - outer(gradient * axis, axis);
        }
        // What the gradient alone contributes is taken off: exact for linear fields.               THEORY.md (3.5)
        laplacian += unit * (gradient * first);
        // The other half of the stress of a viscosity that varies: (grad v)^T grad mu.             THEORY.md (3.7)
        const Vec3 thinning = correct * Vec3{sum[15], sum[16], sum[17]};
        const double nu = material_.kinematic_viscosity(), scale = nu / (unit * unit);
        Vec3 viscous = scale * laplacian + nu * (transpose(gradient) * thinning);
        if (k != no_wall && !numerics_.free_slip) {
            // At a wall that does not slip the blood moves with the wall, so the viscous force there balances the pressure
            // gradient: that is the curvature of the profile, which the linear mirror leaves out.      THEORY.md (5.3)
            const WallSums& wall = wall_moments_[k];
            const Vec3 balance = fluid.pressure_gradient[i] / material_.density - numerics_.body_force;
            const Vec3 slope = gradient * normal;   // dv/dn, n out of the blood
            const Vec3 second = tangential(balance, normal) - (nu * mu * double(wall[34]) / double(wall[30])) * tangential(slope, normal);
            viscous += double(wall_viscosity_[k][1]) * second;
        }
        const double upwind = numerics_.velocity_dissipation * speed * kernel_.slope() * numerics_.cell() * unit;
        if (fluid.opening[i] == 0) viscous -= upwind * Vec3{sum[18], sum[19], sum[20]};
        fluid.slow_acceleration[i] = viscous + numerics_.body_force;
        fluid.velocity_gradient[i] = gradient;
        if (material_.viscosity_at) fluid.viscosity[i] = material_.viscosity_at(shear_rate(gradient));
    }

    /// sqrt(2 D:D), D the rate of deformation [1/s].                                               THEORY.md (10.1)
    static double shear_rate(const Mat3& g) {
        const Mat3 d = 0.5 * (g + transpose(g));
        return std::sqrt(2 * (dot(d.x, d.x) + dot(d.y, d.y) + dot(d.z, d.z)));
    }

    static Vec3 tangential(const Vec3& a, const Vec3& normal) { return a - dot(a, normal) * normal; }

    /// Velocity relative to the wall's surface: all of it, or its normal part if the wall slips.
    Vec3 slip_at_wall(const Vec3& v, const WallSums& wall, Vec3& normal) const {
        const double weight = wall[30];
        normal = {wall[31], wall[32], wall[33]};
        const double length = norm(normal);
        normal = length > 1e-6 * weight ? normal / length : Vec3{};
        const Vec3 slip = v - Vec3{wall[35], wall[36], wall[37]} / weight;
        return numerics_.free_slip ? dot(slip, normal) * normal : slip;
    }

    FlowStep choose_step(double longest) const {
        const FluidParticles& fluid = domain_.fluid;
        const double h = kernel_.h;
        const double fastest = std::sqrt(largest_of(fluid.size(), [&](std::size_t i) {
            const double v2 = dot(fluid.velocity[i], fluid.velocity[i]);
            return v2 == v2 ? v2 : std::numeric_limits<double>::infinity();   // a NaN must not vanish in a comparison
        }));
        if (!(fastest < 20 * material_.sound_speed)) report_divergence();
        const double speed = std::max(fastest, numerics_.reference_speed);
        FlowStep report;
        report.fastest = fastest;
        const double slow = material_.kinematic_viscosity() / (viscous_number * h * h) + upwind_number * numerics_.velocity_dissipation * speed / h;
        report.dt = std::min({numerics_.advection_cfl * h / speed, 1 / slow, longest});
        const double acoustic = numerics_.acoustic_cfl * h / (material_.sound_speed + speed);
        report.acoustic_steps = std::max(1, int(std::ceil(report.dt / acoustic)));
        return report;
    }

    [[noreturn]] void report_divergence() const {
        const FluidParticles& fluid = domain_.fluid;
        std::size_t worst = 0;   // the first that is no number, or else the fastest
        double largest = -1;
        for (std::size_t i = 0; i < fluid.size(); ++i) {
            const double v2 = dot(fluid.velocity[i], fluid.velocity[i]);
            if (v2 <= largest) continue;
            worst = i, largest = v2;
            if (v2 != v2) break;
        }
        const Vec3 &x = fluid.position[worst], &v = fluid.velocity[worst];
        throw DivergedError(fmt::format("the flow diverged: particle at ({:.4g}, {:.4g}, {:.4g}) m has velocity ({:.3g}, {:.3g}, {:.3g}) m/s "
                                        "and pressure {:.3g} Pa; the sound speed is {:.3g} m/s",
                                        x.x, x.y, x.z, v.x, v.y, v.z, fluid.pressure[worst], material_.sound_speed));
    }

    /// Pressure leaps half a step ahead of the velocity.
    void start_acoustic_steps(double dt) {
        FluidParticles& fluid = domain_.fluid;
        moved_.resize(fluid.size());
        for_each_index(fluid.size(), [&](std::size_t i) {
            const double p = fluid.pressure[i] + 0.5 * dt * fluid.pressure_rate[i];
            pressure_[i] = geometry_[i];
            pressure_[i].d = T(p);
            moved_[i] = Vec3{};
        });
    }

    /// v += dt (-grad p / rho + slow acceleration), and the way of half a step before and after.    THEORY.md (7.4)
    void kick(double dt) {
        FluidParticles& fluid = domain_.fluid;
        const T inverse_density = T(-1 / material_.density);
        sum_over_neighbours<T>(
            rows_, scale_, Records<T, 0>{pressure_.data()}, Records<T, 0>{pressure_.data()}, terms::PressureGradient{},
            [&](std::uint32_t i, const std::array<T, 3>& g) {
                const Sym<T>& b = closures_[i].pressure;
                const Vec<T> gradient{b.xx * g[0] + b.xy * g[1] + b.xz * g[2], b.xy * g[0] + b.yy * g[1] + b.yz * g[2],
                                      b.xz * g[0] + b.yz * g[1] + b.zz * g[2]};
                fluid.pressure_gradient[i] = {gradient.x, gradient.y, gradient.z};
                const Vec3 a = fluid.slow_acceleration[i] +
                               Vec3{inverse_density * gradient.x, inverse_density * gradient.y, inverse_density * gradient.z};
                const Vec3 before = fluid.velocity[i];
                const Vec3 after = fluid.opening[i] >= 0 ? before + dt * a : before;   // a tail is renewed after the step
                fluid.velocity[i] = after;
                moved_[i] += 0.5 * dt * (before + after);
                velocity_[i] = {T(after.x), T(after.y), T(after.z), pressure_[i].d};
            },
            numerics_.loop);
    }

    /// p += -rho c^2 div v dt + dissipation, and half a step more for the next kick.                THEORY.md (4.6), (7.4)
    void compress(double dt) {
        FluidParticles& fluid = domain_.fluid;
        const double unit = loop_unit(), c = material_.sound_speed;
        const double stiffness = material_.density * c * c;
        const double smoothing = numerics_.pressure_dissipation * c * kernel_.slope() * numerics_.cell() * unit;
        const double excess = fluid.excess_divergence;
        divergence_.resize(fluid.size());
        sum_over_neighbours<T>(
            rows_, scale_, Records<T, 1>{geometry_.data(), velocity_.data()}, Records<T, 1>{geometry_.data(), velocity_.data()},
            terms::Compression{},
            [&](std::uint32_t i, const std::array<T, 7>& s) {
                const Closure<T>& b = closures_[i];
                T divergence = b.velocity.xx * s[0] + b.velocity.yy * s[1] + b.velocity.zz * s[2] + b.velocity.xy * s[3] +
                               b.velocity.xz * s[4] + b.velocity.yz * s[5];
                if (const std::uint32_t k = wall_of_[i]; k != no_wall) {
                    const Vec3 slip = fluid.velocity[i] - surface_velocity_of(i, k);
                    divergence += T(slip.x) * b.wall.x + T(slip.y) * b.wall.y + T(slip.z) * b.wall.z;
                }
                divergence_[i] = double(divergence);
                const double expansion = double(divergence) - excess;
                const Sums& m = moments_[i];   // of the linear part, whose diffusion vanishes: taken off
                const Vec3& g = fluid.pressure_gradient[i];
                const double jump = double(s[6]) - unit * (g.x * m[9] + g.y * m[10] + g.z * m[11]);
                // Blood does not expand on its way down a pressure gradient: the artificial compressibility acts at a
                // fixed place, and a particle takes up the pressure of the places it comes to.     THEORY.md (2.6)
                const double rate = -stiffness * expansion - smoothing * jump + dot(fluid.velocity[i], g);
                fluid.pressure[i] += 0.5 * dt * (fluid.pressure_rate[i] + rate);
                fluid.pressure_rate[i] = rate;
                pressure_[i].d = T(fluid.pressure[i] + 0.5 * dt * rate - bulk_share * stiffness * dt * expansion);
            },
            numerics_.loop);
    }

    Vec3 surface_velocity_of(std::uint32_t i, std::uint32_t k) const {
        if (!numerics_.free_slip) return surface_velocity_[k];
        Vec3 normal;
        const Vec3& v = domain_.fluid.velocity[i];
        return v - slip_at_wall(v, wall_moments_[k], normal);
    }

    void impose_pressure(double time, double dt) {
        if (domain_.ends.empty()) return;
        if (update_ends) update_ends(domain_.ends, time, dt);
        for (OpenEnd& end : domain_.ends) {
            fit_pressure(end, material_.density * material_.sound_speed, [&](std::uint32_t i) { return double(pressure_[i].d); });
            for (const auto& m : end.buffer) {
                double& p = domain_.fluid.pressure[m.index];
                const double wanted = end.mean_pressure + end.slope * m.s, predicted = pressure_[m.index].d;
                pressure_[m.index].d = T(predicted + m.weight * (wanted - predicted));
                p += m.weight * (wanted - p);
                domain_.fluid.pressure_rate[m.index] *= 1 - m.weight;
            }
        }
    }

    void impose_velocity(double time) {
        FluidParticles& fluid = domain_.fluid;
        for (OpenEnd& end : domain_.ends)
            for (const auto& m : end.buffer) {
                Vec3& v = fluid.velocity[m.index];
                if (end.kind == OpenEnd::Kind::velocity) v = end.velocity(fluid.position[m.index], time);
                else if (end.undisturbed || dot(v, end.normal) < 0) v = dot(v, end.normal) * end.normal;
                velocity_[m.index] = {T(v.x), T(v.y), T(v.z), velocity_[m.index].d};
            }
    }

    void move_particles() {
        FluidParticles& fluid = domain_.fluid;
        for_each_index(fluid.size(), [&](std::size_t i) { fluid.position[i] += moved_[i]; });
    }

    void measure_flows(double time) {
        for (OpenEnd& end : domain_.ends) measure_flow(end, domain_.fluid, numerics_.section_spread(), time);
    }

    /// Gauss's theorem for the domain as a whole: the divergences of its blood must add up to the flow through its openings.
    /// The sums over neighbours know that to their order only; the rest is taken off evenly.          THEORY.md (4.10)
    void balance_volume() {
        const FluidParticles& fluid = domain_.fluid;
        const auto inside = [&](std::size_t i) { return fluid.opening[i] == 0; };
        const double count = sum_of(fluid.size(), [&](std::size_t i) { return inside(i) ? 1.0 : 0.0; });
        const double sum = sum_of(fluid.size(), [&](std::size_t i) { return inside(i) ? divergence_[i] : 0.0; });
        double outflow = 0;
        for (const OpenEnd& end : domain_.ends) outflow += end.flow;
        domain_.fluid.excess_divergence = (sum - outflow / numerics_.cell()) / count;
    }

    bool gradients_known_ = false;
    static constexpr std::uint32_t no_wall = UINT32_MAX;

    FlowDomain domain_;
    FluidMaterial material_;
    FlowNumerics numerics_;
    WendlandC2 kernel_;
    PairScale scale_;
    Cells cells_, wall_cells_;
    Neighbours rows_, wall_rows_;
    AlignedVector<Quad<T>> geometry_, pressure_, velocity_;                  // records: (x, .), (x, p), (v, p)
    std::array<AlignedVector<Quad<T>>, 3> gradient_;
    AlignedVector<Quad<T>> wall_geometry_, wall_normal_, wall_velocity_;     // (x, depth), (n, curvature), (v, .)
    std::vector<Sums> moments_;
    std::vector<WallSums> wall_moments_;
    std::vector<std::array<T, 5>> wall_viscosity_;
    AlignedVector<Quad<T>> laplacian_diagonal_, laplacian_mixed_;
    std::vector<std::uint32_t> wall_of_;   // index into wall_moments_, per particle
    std::vector<Vec3> surface_velocity_;   // of the wall, per member
    AlignedVector<Closure<T>> closures_;
    std::vector<Vec3> shift_, moved_;
    std::vector<double> divergence_;       // of the velocity, as the sums report it [1/s]
};

}  // namespace

std::unique_ptr<FlowScheme> make_flow_scheme(Precision precision, const FlowDomain& domain, const FluidMaterial& material,
                                             const FlowNumerics& numerics) {
    if (precision == Precision::double_precision) return std::make_unique<SphScheme<double>>(domain, material, numerics);
    return std::make_unique<SphScheme<float>>(domain, material, numerics);
}

}  // namespace patency
