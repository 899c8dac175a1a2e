// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/flow_scheme.h"

#include <algorithm>
#include <cmath>

#include "patency/base/parallel.h"
#include "patency/physics/fluid/shear_rate.h"
#include "patency/schemes/ends.h"
#include "patency/schemes/flow_arrangement.h"
#include "patency/schemes/volume_balance.h"
#include "patency/schemes/watch.h"

namespace patency {

namespace {

// How much farther ahead than half a step the pressure of the next kick looks along its own change by compression: a
// bulk viscosity of this share of dt c^2 that quietens sound and leaves blood that does not expand alone.
//                                                                                                 THEORY.md (4.7)
constexpr double bulk_share = 0.5;
// Passes per advection step; a flow that strains undoes the order within a few steps (docs/VERIFICATION.md,
// taylor_green).
constexpr int shift_passes = 2;
// Advection cycles on one set of rows. Neighbours drift apart by less than a fifth of a spacing per cycle; what rows
// miss then are pairs at the kernel's edge, and every sum is normalised by the moments of the same rows.
constexpr int cycles_per_row = 2;
// Stability of the explicit slow terms: the largest eigenvalue of the operator (3.5) is about 12/h^2, that of (4.9)
// 2.6/h; both are held to about three quarters of the bound of an explicit step.                  THEORY.md (7.1)
constexpr double viscous_number = 0.125;
constexpr double upwind_number = 1.5;
// Spacings. What rises from a wall is known by the blood that gathers there, over the distance to the wall: nearer than the first
// layer stands that is noise.                                                                      THEORY.md (5.6)
constexpr double nearest_rise = 0.5;
// Of the wall that a particle sees faces one way: half, where a corner of a right angle has 0.7.
constexpr double one_wall = 0.5;
// Of the speed of sound: as fast counts blood at rest, for what trembles there is sound. At a quarter of this the pipe of
// verify windkessel, whose sound is a hundred times as fast as its blood, blows up when its flow turns.   THEORY.md (4.9)
constexpr double sound_noise = 0.01;

Vec3 tangential(const Vec3& a, const Vec3& normal) { return a - dot(a, normal) * normal; }

template <class T>
class SphScheme final : public FlowScheme {
public:
    SphScheme(const FlowDomain& domain, const FluidMaterial& material, const FlowNumerics& numerics)
        : domain_(domain),
          material_(material),
          numerics_(numerics),
          kernel_(numerics.kernel()),
          arrangement_(domain, numerics),
          balance_(domain, numerics.cell()) {}

    FlowStep step(double time, double longest) override {
        arrangement_.sort_particles();
        arrangement_.find_neighbours();
        FlowStep report;
        for (int cycle = 0; cycle < cycles_per_row && report.dt < longest; ++cycle) {
            const double level = mean_pressure();
            arrangement_.write_records();
            for (int pass = 0; pass < shift_passes; ++pass) arrangement_.shift_particles();
            find_members(domain_.fluid, numerics_.spacing, domain_.ends);
            balance_.divide_into_parts();
            measure_flows(domain_, numerics_, time + report.dt, 0);
            arrangement_.compute_moments();
            arrangement_.compute_corrections();
            write_records();
            const FlowStep advection = choose_step(longest - report.dt);
            compute_viscosity();
            balance_.share_excess();

            const double dt = advection.dt / advection.acoustic_steps;
            start_acoustic_steps(dt);
            for (int k = 0; k < advection.acoustic_steps; ++k) {
                update_wanted_pressures(domain_.ends, time + report.dt + k * dt, dt);
                impose_pressure(domain_, material_, pressure_);
                kick(dt);
                impose_velocity(domain_, time + report.dt + (k + 1) * dt, velocity_);
                compress(dt);
                measure_flows(domain_, numerics_, time + report.dt + (k + 1) * dt, dt);
                if (!domain_.ends.empty()) balance_.find_excess(divergence_);
            }
            move_particles();
            if (domain_.ends.empty()) hold_mean_pressure(level);
            // What is left of `longest` by rounding is none of another cycle's business.
            report.dt = advection.dt < longest - report.dt ? report.dt + advection.dt : longest;
            report.acoustic_steps += advection.acoustic_steps;
            report.fastest = std::max(report.fastest, advection.fastest);
        }
        exchange_particles(domain_.fluid, numerics_.spacing, kernel_.support(), domain_.ends);
        return report;
    }

private:
    void write_records() {
        const FluidParticles& fluid = domain_.fluid;
        const std::size_t n = fluid.size();
        pressure_.reset(n + 1), velocity_.reset(n + 1);
        for (auto* records : {&gradient_[0], &gradient_[1], &gradient_[2], &correction_[0], &correction_[1]}) {
            records->reset(n + 1);
            (*records)[n] = zero_record<T>();
        }
        for_each_index(n, [&](std::size_t i) {
            velocity_[i] = vector_record(fluid.velocity[i], T(fluid.viscosity[i] / material_.viscosity));
            const Mat3 g = arrangement_.unit() * fluid.velocity_gradient[i];
            gradient_[0][i] = vector_record(g.x, T(dissipating_root(i)));
            gradient_[1][i] = vector_record(g.y, T(sees_curvature(i)));
            gradient_[2][i] = vector_record(g.z, T(0));
            const Sym<T>& c = arrangement_.closure(i).correction;
            correction_[0][i] = {c.xx, c.yy, c.zz, T(0)};
            correction_[1][i] = {c.xy, c.xz, c.yz, T(0)};
        });
        pressure_[n] = dummy_record<T>();
        velocity_[n] = zero_record<T>();
    }

    /// Near a wall the mirror is of first order, and in a buffer the velocity is told.                   THEORY.md (3.8)
    bool sees_curvature(std::size_t i) const {
        return arrangement_.wall_of(i) == no_wall && domain_.fluid.opening[i] == 0;
    }

    /// In a buffer the velocity is told; between two walls that are both near there is no one way to rise.
    bool rests_at_one_wall(std::size_t i, std::uint32_t k) const {
        return !numerics_.free_slip && domain_.fluid.opening[i] == 0 && arrangement_.facing(k) > one_wall;
    }

    /// Of a pair the product counts: the speed of the upwind flux between the two [m/s]. None at the wall, where gradients are of
    /// first order; all of it beyond the kernel's reach.                                              THEORY.md (4.9)
    double dissipating_root(std::size_t i) const {
        const double root = std::sqrt(std::max(norm(domain_.fluid.velocity[i]), quietest_speed()));
        if (arrangement_.wall_of(i) == no_wall) return root;
        const double distance = double(arrangement_.geometry()[i].d) * arrangement_.unit() / numerics_.spacing;
        return root * std::clamp(0.5 * (distance - 0.5), 0.0, 1.0);
    }
    double quietest_speed() const { return sound_noise * material_.sound_speed; }

    FlowStep choose_step(double longest) const {
        const double h = kernel_.h;
        const double fastest = find_fastest(domain_.fluid, material_.sound_speed);
        const double speed = std::max(fastest, numerics_.reference_speed);
        FlowStep report;
        report.fastest = fastest;
        const double slow = material_.kinematic_viscosity() / (viscous_number * h * h) +
                            upwind_number * numerics_.velocity_dissipation * std::max(speed, quietest_speed()) / h;
        report.dt = std::min({numerics_.advection_cfl * h / speed, 1 / slow, longest});
        const double acoustic = numerics_.acoustic_cfl * h / (material_.sound_speed + speed);
        report.acoustic_steps = std::max(1, int(std::ceil(report.dt / acoustic)));
        return report;
    }

    /// Those of the last step, which a new flow has not made yet: then nothing can be told from noise.
    bool are_gradients_known() {
        const auto& gradient = domain_.fluid.velocity_gradient;
        const auto square = [&](std::size_t i) {
            const Mat3& g = gradient[i];
            return dot(g.x, g.x) + dot(g.y, g.y) + dot(g.z, g.z);
        };
        return gradients_known_ = gradients_known_ || sum_of(domain_.fluid.size(), square) > 0;
    }

    /// Velocity gradient, viscous acceleration, and the dissipation of what no gradient explains.
    ///                                                                                     THEORY.md (3.5), (4.9)
    void compute_viscosity() {
        const double upwind = are_gradients_known() ? numerics_.velocity_dissipation : 0;
        const auto &geometry = arrangement_.geometry(), &wall_geometry = arrangement_.wall_geometry();
        const auto &diagonal = arrangement_.laplacian_diagonal(), &mixed = arrangement_.laplacian_mixed();
        const auto &row_x = gradient_[0], &row_y = gradient_[1], &row_z = gradient_[2];
        wall_viscosity_.resize(arrangement_.wall_count());
        arrangement_.sum_over_wall(records_of(geometry, diagonal, mixed), records_of(wall_geometry),
                                   terms::WallViscosity{}, [&](std::uint32_t i, const std::array<T, 5>& sum) {
                                       const std::uint32_t k = arrangement_.wall_of(i);
                                       if (k != no_wall) wall_viscosity_[k] = sum;
                                   });
        surface_velocity_.resize(arrangement_.wall_count());
        held_.reset(domain_.fluid.size());
        const auto sum_over_blood = [&](const auto& term) {
            arrangement_.sum_over_blood(
                records_of(geometry, velocity_, row_x, row_y, row_z, diagonal, mixed, correction_[0], correction_[1]),
                records_of(geometry, velocity_, row_x, row_y, row_z), term,
                [&](std::uint32_t i, const auto& sum) { apply_viscosity(i, sum, upwind); });
        };
        if (material_.viscosity_at)
            sum_over_blood(terms::Viscosity<true>{});
        else
            sum_over_blood(terms::Viscosity<false>{});
    }

    template <std::size_t sums>
    void apply_viscosity(std::uint32_t i, const std::array<T, sums>& sum, double upwind_share) {
        FluidParticles& fluid = domain_.fluid;
        const double unit = arrangement_.unit();
        const double mu = fluid.viscosity[i] / material_.viscosity;   // relative, as in the sums
        const Vec3 v = fluid.velocity[i];
        const Mat3 correct = matrix(arrangement_.closure(i).correction);   // per metre
        Mat3 gradient{{sum[0], sum[1], sum[2]}, {sum[3], sum[4], sum[5]}, {sum[6], sum[7], sum[8]}};
        Vec3 laplacian{sum[9], sum[10], sum[11]}, first = mu * Vec3{sum[12], sum[13], sum[14]};
        const std::uint32_t k = arrangement_.wall_of(i);
        Slip slip;
        if (k != no_wall) {
            const auto& wall = arrangement_.wall_moments(k);
            const auto& friction = wall_viscosity_[k];
            slip = arrangement_.slip_at_wall(k, v);
            surface_velocity_[k] = v - slip.velocity;
            gradient += outer(slip.velocity, Vec3{wall[27], wall[28], wall[29]});
            laplacian -= mu * friction[0] * slip.velocity;
            first += mu * Vec3{friction[2], friction[3], friction[4]};
        }
        // What acoustic steps do not see of the divergence and is held for them: the curvature of the velocity, or what
        // rises from a wall.
        double unseen = sum[15];
        const Mat3 seen = gradient * correct;
        if (k != no_wall && rests_at_one_wall(i, k)) {
            gradient =
                (1 / unit) * gradient_beside_wall(gradient, unit * correct, arrangement_.behind_wall(i, k, slip.normal),
                                                  nearest_rise * numerics_.spacing / unit);
            unseen = trace(gradient) - trace(seen);
        } else {
            gradient = seen;
        }
        const Vec<T>& radial = arrangement_.radial_moment(i);
        held_[i] = {T(unit * radial.x), T(unit * radial.y), T(unit * radial.z), T(unseen)};
        if (fluid.opening[i] != 0) {   // natural outflow: nothing changes along the axis
            const Vec3& axis = end_of(domain_, i).normal;
            gradient = gradient - outer(gradient * axis, axis);
        }
        // What the gradient alone contributes is taken off: exact for linear fields.               THEORY.md (3.5)
        laplacian += unit * (gradient * first);
        const double nu = material_.kinematic_viscosity(), scale = nu / (unit * unit);
        Vec3 viscous = scale * laplacian;
        Vec3 thinning{};   // grad mu, relative; walls have no viscosity
        if constexpr (sums == terms::Viscosity<true>::sums) {
            thinning = matrix(arrangement_.blood_correction(i)) * Vec3{sum[19], sum[20], sum[21]};
            viscous += nu * (transpose(gradient) * thinning);   // the other half of the stress          THEORY.md (3.7)
        }
        if (k != no_wall && !numerics_.free_slip) {
            // At a wall that does not slip the blood moves with the wall, so the viscous force there balances the
            // pressure gradient: the curvature of the profile, which the linear mirror leaves out.  THEORY.md (5.3)
            const auto& wall = arrangement_.wall_moments(k);
            const Vec3& normal = slip.normal;
            const Vec3 balance = fluid.pressure_gradient[i] / material_.density - numerics_.body_force;
            const Vec3 slope = gradient * normal;   // dv/dn, n out of the blood
            const Vec3 second = tangential(balance, normal) -
                                (nu * mu * double(wall[34]) / double(wall[30])) * tangential(slope, normal);
            viscous += double(wall_viscosity_[k][1]) * second;
            // A part of that balance is what grad mu makes of the slope: it reaches farther behind the wall.
            const double s = arrangement_.geometry()[i].d, farther = 0.5 * s * s * double(wall_viscosity_[k][0]);
            viscous += (farther * nu * dot(thinning, normal)) * tangential(slope, normal);   // THEORY.md (5.3)
        }
        const double upwind = upwind_share * kernel_.slope() * numerics_.cell() * unit;
        if (fluid.opening[i] == 0) viscous -= upwind * Vec3{sum[16], sum[17], sum[18]};
        fluid.slow_acceleration[i] = viscous + numerics_.body_force;
        fluid.velocity_gradient[i] = gradient;
        if (material_.viscosity_at) fluid.viscosity[i] = material_.viscosity_at(shear_rate(gradient));
    }

    /// Pressure leaps half a step ahead of the velocity.
    void start_acoustic_steps(double dt) {
        FluidParticles& fluid = domain_.fluid;
        moved_.resize(fluid.size());
        for_each_index(fluid.size(), [&](std::size_t i) {
            const double p = fluid.pressure[i] + 0.5 * dt * fluid.pressure_rate[i];
            pressure_[i] = arrangement_.geometry()[i];
            pressure_[i].d = T(p);
            moved_[i] = Vec3{};
        });
    }

    /// v += dt (-grad p / rho + slow acceleration), and the way of half a step before and after.    THEORY.md (7.4)
    void kick(double dt) {
        FluidParticles& fluid = domain_.fluid;
        const T inverse_density = T(-1 / material_.density);
        arrangement_.sum_over_blood(
            records_of(pressure_), records_of(pressure_), terms::PressureGradient{},
            [&](std::uint32_t i, const std::array<T, 3>& g) {
                const Vec<T> gradient = arrangement_.blood_correction(i) * Vec<T>{g[0], g[1], g[2]};
                fluid.pressure_gradient[i] = {gradient.x, gradient.y, gradient.z};
                const Vec<T> fast = inverse_density * gradient;
                const Vec3 a = fluid.slow_acceleration[i] + Vec3{fast.x, fast.y, fast.z};
                const Vec3 before = fluid.velocity[i];
                // A tail is renewed after the step.
                const Vec3 after = fluid.opening[i] >= 0 ? before + dt * a : before;
                fluid.velocity[i] = after;
                moved_[i] += 0.5 * dt * (before + after);
                velocity_[i] = vector_record(after, pressure_[i].d);
            });
    }

    /// p += -rho c^2 div v dt + dissipation, and half a step more for the next kick.             THEORY.md (4.6), (7.4)
    void compress(double dt) {
        FluidParticles& fluid = domain_.fluid;
        const double unit = arrangement_.unit(), c = material_.sound_speed;
        const double stiffness = material_.density * c * c;
        const double smoothing = numerics_.pressure_dissipation * c * kernel_.slope() * numerics_.cell() * unit;
        divergence_.resize(fluid.size());
        const auto records = records_of(arrangement_.geometry(), velocity_);
        arrangement_.sum_over_blood(
            records, records, terms::Compression{}, [&](std::uint32_t i, const std::array<T, 7>& s) {
                const Closure<T>& b = arrangement_.closure(i);
                T divergence = b.correction.xx * s[0] + b.correction.yy * s[1] + b.correction.zz * s[2] +
                               b.correction.xy * s[3] + b.correction.xz * s[4] + b.correction.yz * s[5];
                if (const std::uint32_t k = arrangement_.wall_of(i); k != no_wall) {
                    const Vec3 slip = fluid.velocity[i] - surface_velocity_of(i, k);
                    divergence += T(slip.x) * b.wall.x + T(slip.y) * b.wall.y + T(slip.z) * b.wall.z;
                }
                const Quad<T>& held = held_[i];
                divergence_[i] = double(divergence) + double(held.d);
                const double expansion = divergence_[i] - balance_.excess(i);
                const Vec3& g = fluid.pressure_gradient[i];   // the linear part, whose diffusion vanishes: taken off
                const double jump = double(s[6]) - (g.x * held.a + g.y * held.b + g.z * held.c);
                // Blood does not expand on its way down a pressure gradient: the artificial compressibility acts at a
                // fixed place, and a particle takes up the pressure of the places it comes to.     THEORY.md (2.6)
                const double rate = -stiffness * expansion - smoothing * jump + dot(fluid.velocity[i], g);
                fluid.pressure[i] += 0.5 * dt * (fluid.pressure_rate[i] + rate);
                fluid.pressure_rate[i] = rate;
                pressure_[i].d = T(fluid.pressure[i] + 0.5 * dt * rate - bulk_share * stiffness * dt * expansion);
            });
    }

    Vec3 surface_velocity_of(std::uint32_t i, std::uint32_t k) const {
        if (!numerics_.free_slip) return surface_velocity_[k];
        const Vec3& v = domain_.fluid.velocity[i];
        return v - arrangement_.slip_at_wall(k, v).velocity;
    }

    void move_particles() {
        FluidParticles& fluid = domain_.fluid;
        for_each_index(fluid.size(), [&](std::size_t i) { fluid.position[i] += moved_[i]; });
    }

    double mean_pressure() const {
        const auto& p = domain_.fluid.pressure;
        return sum_of(p.size(), [&](std::size_t i) { return p[i]; }) / double(p.size());
    }

    /// Nothing tells the level of the pressure in a closed domain but divergences and shifts, whose mean is zero and known to
    /// the order of the sums only: what a cycle has changed of it is taken back.                    THEORY.md (4.8)
    void hold_mean_pressure(double level) {
        auto& p = domain_.fluid.pressure;
        const double gained = mean_pressure() - level;
        for_each_index(p.size(), [&](std::size_t i) { p[i] -= gained; });
    }

    FlowDomain domain_;
    FluidMaterial material_;
    FlowNumerics numerics_;
    WendlandC2 kernel_;
    Arrangement<T> arrangement_;
    VolumeBalance balance_;
    AlignedVector<Quad<T>> pressure_, velocity_;         // records: (x, p), (v, mu) and from the first kick on (v, p)
    std::array<AlignedVector<Quad<T>>, 3> gradient_;     // records: rows of the velocity gradient, per unit of the loop
    std::array<AlignedVector<Quad<T>>, 2> correction_;   // records: of the divergence: (xx, yy, zz, .), (xy, xz, yz, .)
    std::vector<std::array<T, 5>> wall_viscosity_;       // by numbers of particles near the wall
    std::vector<Vec3> surface_velocity_;                 // of the wall, by the same numbers
    std::vector<Vec3> moved_;
    std::vector<double> divergence_;   // of the velocity, as the sums report it [1/s]
    // Over the acoustic steps: sum w r d [m], and what curvature or a wall adds to the divergence [1/s].
    AlignedVector<Quad<T>> held_;
    bool gradients_known_ = false;
};

}   // namespace

std::unique_ptr<FlowScheme> make_flow_scheme(Precision precision, const FlowDomain& domain,
                                             const FluidMaterial& material, const FlowNumerics& numerics) {
    check_precision(precision, domain.frame);
    if (precision == Precision::double_precision)
        return std::make_unique<SphScheme<double>>(domain, material, numerics);
    return std::make_unique<SphScheme<float>>(domain, material, numerics);
}

}   // namespace patency
