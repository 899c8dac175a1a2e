// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/paper_scheme.h"

#include <cmath>

#include "patency/base/parallel.h"
#include "patency/physics/fluid/shear_rate.h"
#include "patency/schemes/ends.h"
#include "patency/schemes/order.h"
#include "patency/schemes/paper_terms.h"
#include "patency/schemes/watch.h"

namespace patency {

namespace {

// How much of the wanted correction a buffer's masses take up per advection step: slow against the noise of the summed
// density from layer to layer, fast against the passage through the buffer.
constexpr double mass_correction = 0.1;
// The summed density takes over within so many spacings inside an opening. At once, it would answer every layer that
// passes the plane with a knock on the whole column of blood.
constexpr double summation_depth = 4;
constexpr double transport_share = 0.2;   // THEORY.md (6.2)

/// Sums over a square or cubic lattice of unit spacing, THEORY (1.4): sum W / sigma, itself included, and the second
/// moment sum t^3 x x.
struct LatticeSums {
    double shape = 0, moment = 0;
};
LatticeSums lattice_sums(double smoothing_ratio, bool planar) {
    LatticeSums sums;
    const int reach = int(2 * smoothing_ratio) + 1, depth = planar ? 0 : reach;
    for (int a = -reach; a <= reach; ++a)
        for (int b = -reach; b <= reach; ++b)
            for (int c = -depth; c <= depth; ++c) {
                const double t = std::max(0.0, 1 - std::sqrt(double(a * a + b * b + c * c)) / (2 * smoothing_ratio));
                sums.shape += t * t * t * t * (5 - 4 * t);
                sums.moment += t * t * t * a * a;
            }
    return sums;
}

template <class T>
class PaperScheme final : public FlowScheme {
public:
    PaperScheme(const FlowDomain& domain, const FluidMaterial& material, const FlowNumerics& numerics)
        : domain_(domain),
          material_(material),
          numerics_(numerics),
          kernel_(numerics.kernel()),
          scale_(pair_scale<T>(domain.frame, kernel_.support())),
          cell_(numerics.cell()),
          lattice_(lattice_sums(numerics.smoothing_ratio, numerics.planar)) {
        sort_wall(domain_.wall, wall_cells_, domain_.frame, numerics_.spacing);
        write_wall_records();
    }

    FlowStep step(double time, double longest) override {
        sort_blood(domain_.fluid, cells_, domain_.frame, numerics_.spacing);
        find_neighbours();
        find_members(domain_.fluid, numerics_.spacing, domain_.ends);
        find_shares();
        compute_density();
        write_records();
        compute_wall_velocity();
        compute_slow_part();

        const FlowStep report = choose_step(longest);
        for (int k = 0; k < report.acoustic_steps; ++k) {
            const double start = k * acoustic_step_;
            const double dt = std::min(acoustic_step_, report.dt - start);   // the last one is clipped
            advance_pressure(dt);
            measure_flows(domain_, numerics_, time + start, 0);
            update_wanted_pressures(domain_.ends, time + start, dt);
            impose_pressure(domain_, material_, pressure_);
            compute_wall_pressure();
            kick(dt);
            impose_velocity(domain_, time + start + dt, velocity_);
            compute_wall_velocity();
            compress(dt);
        }
        move_particles();
        exchange_particles(domain_.fluid, numerics_.spacing, kernel_.support(), domain_.ends);
        return report;
    }

private:
    void write_wall_records() {
        const WallParticles& wall = domain_.wall;
        const std::size_t n = wall.size();
        wall_pressure_.reset(n + 1), wall_velocity_.reset(n + 1);
        for (std::size_t w = 0; w < n; ++w) {
            wall_pressure_[w] = position_record(domain_.frame, wall.position[w], T(0));
            wall_velocity_[w] = vector_record(wall.velocity[w], T(wall.volume[w] / cell_));
        }
        wall_pressure_[n] = dummy_record<T>();
        wall_velocity_[n] = zero_record<T>();
    }

    void find_neighbours() {
        rows_.find_own(domain_.frame, cells_, kernel_.support(), native_lanes<T>);
        wall_rows_.find_other(domain_.frame, cells_, wall_cells_, kernel_.support(), native_lanes<T>);
        rows_of_wall_.find_other(domain_.frame, wall_cells_, cells_, kernel_.support(), native_lanes<T>);
        number_wall_rows(wall_rows_, domain_.fluid.size(), wall_of_);
    }

    /// How far each particle is in the grasp of its opening (0 inside), and how far its density is the summed one.
    void find_shares() {
        imposed_share_.assign(domain_.fluid.size(), 0.0);
        summed_share_.assign(domain_.fluid.size(), 1.0);
        for (const OpenEnd& end : domain_.ends) {
            for (const auto& m : end.buffer) imposed_share_[m.index] = m.weight, summed_share_[m.index] = 0;
            for (const auto& m : end.inside) {
                const double q = std::min(1.0, -m.s / (summation_depth * numerics_.spacing));
                summed_share_[m.index] *= q * q * (3 - 2 * q);
            }
        }
    }

    /// Density by summation, so that it cannot drift away from the arrangement.                   THEORY.md (7.6)
    /// In a buffer the density is imposed, and it is the masses that follow.                       THEORY.md (11.6)
    void compute_density() {
        FluidParticles& fluid = domain_.fluid;
        const std::size_t n = fluid.size();
        geometry_.reset(n + 1);
        for_each_index(n, [&](std::size_t i) {
            geometry_[i] =
                position_record(domain_.frame, fluid.position[i], T(fluid.viscosity[i] / material_.viscosity));
        });
        geometry_[n] = dummy_record<T>();
        std::vector<double> by_wall(wall_rows_.member_count());
        sum_over_neighbours<T>(
            wall_rows_, scale_, records_of(geometry_), records_of(wall_pressure_), terms::NumberDensity{},
            [&](std::uint32_t i, const std::array<T, 1>& s) { by_wall[wall_of_[i]] = double(s[0]); }, numerics_.loop);
        summed_density_.resize(n);
        sum_over_neighbours<T>(
            rows_, scale_, records_of(geometry_), records_of(geometry_), terms::NumberDensity{},
            [&](std::uint32_t i, const std::array<T, 1>& s) {
                const double sum = 1 + double(s[0]) + (wall_of_[i] == no_wall ? 0.0 : by_wall[wall_of_[i]]);
                summed_density_[i] = material_.density * (fluid.volume[i] / cell_) * (sum / lattice_.shape);
            },
            numerics_.loop);
        for_each_index(n, [&](std::size_t i) {
            const double summed = pressure_at_density(summed_density_[i], material_.density, material_.sound_speed);
            fluid.pressure[i] += summed_share_[i] * (summed - fluid.pressure[i]);
        });
        for (const OpenEnd& end : domain_.ends) fit_masses(end);
    }

    double density(std::size_t i) const {
        return density_at_pressure(domain_.fluid.pressure[i], material_.density, material_.sound_speed);
    }

    /// One factor for all masses of a buffer: the summed density there becomes, on the average, that of the imposed
    /// pressure. Otherwise blood would enter with a density that does not fit the pressure it enters at.
    void fit_masses(const OpenEnd& end) {
        double wanted = 0, summed = 0;
        for (const auto& m : end.buffer) {
            if (m.s < 0 || m.s > end.buffer_length - kernel_.support()) continue;   // only where nothing is missing
            wanted += density(m.index);
            summed += summed_density_[m.index];
        }
        if (!(summed > 0)) return;
        const double factor = 1 + mass_correction * (wanted / summed - 1);
        for (const auto& m : end.buffer) domain_.fluid.volume[m.index] *= factor;
    }

    void write_records() {
        const FluidParticles& fluid = domain_.fluid;
        const std::size_t n = fluid.size();
        pressure_.reset(n + 1), velocity_.reset(n + 1), kicked_.reset(n + 1);
        specific_volume_.resize(n), moved_.assign(n, Vec3{});
        for_each_index(n, [&](std::size_t i) {
            const double volume = fluid.volume[i] * material_.density / density(i);
            pressure_[i] = geometry_[i];
            velocity_[i] = vector_record(fluid.velocity[i], T(volume / cell_));
            specific_volume_[i] = 1 / density(i);
        });
        pressure_[n] = dummy_record<T>();
        velocity_[n] = kicked_[n] = zero_record<T>();
    }

    /// v_w = 2 v_s - average of the blood; where the wall slips only the normal part is turned round.  THEORY.md (11.4)
    void compute_wall_velocity() {
        const WallParticles& wall = domain_.wall;
        sum_over_neighbours<T>(
            rows_of_wall_, scale_, records_of(wall_pressure_), records_of(pressure_, velocity_), terms::WallVelocity{},
            [&](std::uint32_t w, const std::array<T, 4>& s) {
                if (!(s[0] > T(0))) return;
                const Vec3 blood = Vec3{s[1], s[2], s[3]} / double(s[0]);
                const Vec3 slip = blood - wall.velocity[w];
                const Vec3& n = wall.normal[w];
                const Vec3 v = blood - 2 * (numerics_.free_slip ? dot(slip, n) * n : slip);
                wall_velocity_[w] = vector_record(v, T(wall.volume[w] / cell_));
            },
            numerics_.loop);
    }

    /// Pressure behind the wall, so that blood at the wall stays there.                           THEORY.md (11.5)
    void compute_wall_pressure() {
        const terms::WallPressure<T> term{T(material_.density), T(material_.sound_speed)};
        const double unit = scale_.unit;
        const Vec3& g = numerics_.body_force;
        sum_over_neighbours<T>(
            rows_of_wall_, scale_, records_of(wall_pressure_), records_of(pressure_), term,
            [&](std::uint32_t w, const std::array<T, 5>& s) {
                const double weight = double(s[0]);
                if (weight > 0)
                    wall_pressure_[w].d = T((double(s[1]) + unit * dot(g, Vec3{s[2], s[3], s[4]})) / weight);
            },
            numerics_.loop);
    }

    /// Viscous and body acceleration, velocity gradient and shift, frozen over the advection step.
    void compute_slow_part() {
        using Sums = std::array<T, 21>;
        std::vector<Sums> by_wall(wall_rows_.member_count());
        sum_over_neighbours<T>(
            wall_rows_, scale_, records_of(geometry_, velocity_), records_of(wall_pressure_, wall_velocity_),
            terms::SlowSums<terms::Over::wall>{}, [&](std::uint32_t i, const Sums& s) { by_wall[wall_of_[i]] = s; },
            numerics_.loop);
        const std::size_t n = domain_.fluid.size();
        shift_.resize(n);
        sum_over_neighbours<T>(
            rows_, scale_, records_of(geometry_, velocity_), records_of(geometry_, velocity_),
            terms::SlowSums<terms::Over::blood>{},
            [&](std::uint32_t i, Sums s) {
                if (const std::uint32_t k = wall_of_[i]; k != no_wall)
                    for (std::size_t a = 0; a < s.size(); ++a)
                        if (a < 18 || !numerics_.free_slip) s[a] += by_wall[k][a];
                apply_slow_part(i, s);
            },
            numerics_.loop);
    }

    void apply_slow_part(std::uint32_t i, const std::array<T, 21>& s) {
        FluidParticles& fluid = domain_.fluid;
        const double unit = scale_.unit, slope = kernel_.slope() * cell_;   // per lattice cell, as V is
        const bool planar = numerics_.planar;
        const Mat3 moment{
            {s[3], s[6], s[7]}, {s[6], s[4], s[8]}, {s[7], s[8], planar ? T(0.5f) * (s[3] + s[4]) : s[5]}};
        const Mat3 jumps{{s[9], s[10], s[11]}, {s[12], s[13], s[14]}, {s[15], s[16], s[17]}};
        const double size = trace(moment) / 3;
        const bool surrounded = determinant(moment) > 1e-3 * size * size * size;
        fluid.velocity_gradient[i] = surrounded ? (1 / unit) * (jumps * inverse(moment)) : Mat3{};

        double completed = 1;
        if (fluid.opening[i] != 0) {
            // Nothing changes along the axis of an opening, so the friction with the layers that are missing behind the
            // buffer is that with those that are there.  THEORY.md (11.8)
            const Vec3& axis = end_of(domain_, i).normal;
            const double there = (planar ? double(s[3] + s[4]) : trace(moment)) - dot(axis, moment * axis);
            const double whole =
                (planar ? 1 : 2) * lattice_.moment * numerics_.spacing * numerics_.spacing / (unit * unit);
            if (there > 0) completed = 1 + imposed_share_[i] * (whole / there - 1);
        }
        const Vec3 friction{s[18], s[19], s[20]};
        if (material_.viscosity_at) fluid.viscosity[i] = material_.viscosity_at(shear_rate(fluid.velocity_gradient[i]));
        fluid.slow_acceleration[i] =
            (2 * material_.viscosity * slope * specific_volume_[i] * completed) * friction + numerics_.body_force;
        // Transport velocity towards where there are fewer: -2 sum V grad W = 2 slope sum V w d. THEORY.md (6.1), (6.2)
        const double scale = 2 * transport_share * kernel_.h * kernel_.h * slope * unit;
        shift_[i] = fluid.opening[i] == 0 ? scale * Vec3{s[0], s[1], s[2]} : Vec3{};
    }

    /// The advection step and the acoustic step in it.                                        THEORY.md (7.1), (7.2)
    FlowStep choose_step(double longest) {
        const double h = kernel_.h, c = material_.sound_speed;
        const double fastest = find_fastest(domain_.fluid, c);
        const double speed = std::max(fastest, numerics_.reference_speed);
        FlowStep report;
        report.fastest = fastest;
        report.dt = std::min({numerics_.advection_cfl * h / speed,
                              numerics_.advection_cfl * h * h / material_.kinematic_viscosity(), longest});
        acoustic_step_ = numerics_.acoustic_cfl * h / (c + speed);
        // A last step of round-off is none.
        report.acoustic_steps = std::max(1, int(std::ceil(report.dt / acoustic_step_ - 1e-9)));
        return report;
    }

    /// Half a step of density before the kick.                                                       THEORY.md (7.4)
    void advance_pressure(double dt) {
        const FluidParticles& fluid = domain_.fluid;
        for_each_index(fluid.size(), [&](std::size_t i) {
            pressure_[i].d = T(fluid.pressure[i] + 0.5 * dt * fluid.pressure_rate[i]);
        });
    }

    /// v += dt (pressure force / mass + slow acceleration), and the way of half a step before and after.
    void kick(double dt) {
        FluidParticles& fluid = domain_.fluid;
        const terms::RiemannForce<T> term{{T(material_.density), T(material_.sound_speed)}};
        force_by_wall_.resize(wall_rows_.member_count());
        sum_over_neighbours<T>(
            wall_rows_, scale_, records_of(pressure_, velocity_), records_of(wall_pressure_, wall_velocity_), term,
            [&](std::uint32_t i, const std::array<T, 3>& s) {
                force_by_wall_[wall_of_[i]] = {s[0], s[1], s[2]};
            },
            numerics_.loop);
        const double scale = kernel_.slope() * cell_ * scale_.unit;
        sum_over_neighbours<T>(
            rows_, scale_, records_of(pressure_, velocity_), records_of(pressure_, velocity_), term,
            [&](std::uint32_t i, const std::array<T, 3>& s) {
                Vec3 push{s[0], s[1], s[2]};
                if (const std::uint32_t k = wall_of_[i]; k != no_wall) push += force_by_wall_[k];
                Vec3 gradient = -scale * push;
                if (const double share = imposed_share_[i]; share > 0)
                    gradient += share * (imposed_gradient(i) - gradient);
                fluid.pressure_gradient[i] = gradient;
                const Vec3 a = fluid.slow_acceleration[i] - specific_volume_[i] * gradient;
                const Vec3 before = fluid.velocity[i], after = before + dt * a;
                fluid.velocity[i] = after;
                moved_[i] += 0.5 * dt * (before + after);
                kicked_[i] = vector_record(after, velocity_[i].d);
            },
            numerics_.loop);
        std::swap(velocity_, kicked_);
    }

    /// In a buffer the pressure is a straight line along the axis, and so its gradient is known.       THEORY.md (11.7)
    Vec3 imposed_gradient(std::uint32_t i) const {
        const OpenEnd& end = end_of(domain_, i);
        return end.slope * end.normal;
    }

    /// p += c^2 d rho/dt dt, half of it with the rate before and half with the rate now.
    void compress(double dt) {
        FluidParticles& fluid = domain_.fluid;
        const terms::RiemannCompression<T> term{{T(material_.density), T(material_.sound_speed)}};
        rate_by_wall_.resize(wall_rows_.member_count());
        sum_over_neighbours<T>(
            wall_rows_, scale_, records_of(pressure_, velocity_), records_of(wall_pressure_, wall_velocity_), term,
            [&](std::uint32_t i, const std::array<T, 1>& s) { rate_by_wall_[wall_of_[i]] = double(s[0]); },
            numerics_.loop);
        const double c = material_.sound_speed, scale = kernel_.slope() * cell_ * scale_.unit;
        sum_over_neighbours<T>(
            rows_, scale_, records_of(pressure_, velocity_), records_of(pressure_, velocity_), term,
            [&](std::uint32_t i, const std::array<T, 1>& s) {
                double sum = double(s[0]);
                if (const std::uint32_t k = wall_of_[i]; k != no_wall) sum += rate_by_wall_[k];
                const double density_now = density_at_pressure(double(pressure_[i].d), material_.density, c);
                // Pairs that approach have U* < U_L: the density grows.
                const double rate = -c * c * density_now * scale * sum;
                fluid.pressure[i] += 0.5 * dt * (fluid.pressure_rate[i] + rate);
                fluid.pressure_rate[i] = rate;
            },
            numerics_.loop);
    }

    /// With the blood, and by the transport velocity; the fields are carried along, as in the paper.
    void move_particles() {
        FluidParticles& fluid = domain_.fluid;
        for_each_index(fluid.size(), [&](std::size_t i) { fluid.position[i] += moved_[i] + shift_[i]; });
    }

    FlowDomain domain_;
    FluidMaterial material_;
    FlowNumerics numerics_;
    WendlandC2 kernel_;
    PairScale scale_;
    double cell_;
    LatticeSums lattice_;
    double acoustic_step_ = 0;
    Cells cells_, wall_cells_;
    Neighbours rows_, wall_rows_, rows_of_wall_;             // blood-blood, blood-wall, wall-blood
    AlignedVector<Quad<T>> geometry_, pressure_;             // records: (x, mu), (x, p)
    AlignedVector<Quad<T>> velocity_, kicked_;               // (v, V) before and after a kick
    AlignedVector<Quad<T>> wall_pressure_, wall_velocity_;   // (x, p), (v, V)
    std::vector<std::uint32_t> wall_of_;                     // member of wall_rows_, per particle
    std::vector<Vec3> force_by_wall_;
    std::vector<double> rate_by_wall_;
    std::vector<double> imposed_share_, summed_share_, summed_density_, specific_volume_;
    std::vector<Vec3> shift_, moved_;
};

}   // namespace

std::unique_ptr<FlowScheme> make_paper_scheme(Precision precision, const FlowDomain& domain,
                                              const FluidMaterial& material, const FlowNumerics& numerics) {
    check_precision(precision, domain.frame);
    if (precision == Precision::double_precision)
        return std::make_unique<PaperScheme<double>>(domain, material, numerics);
    return std::make_unique<PaperScheme<float>>(domain, material, numerics);
}

}   // namespace patency
