// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/solid_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/base/symmetric_eigen.h"
#include "patency/schemes/solid_pairs.h"
#include "patency/schemes/solid_stress.h"
#include "patency/schemes/solid_terms.h"

namespace patency {

namespace {

// Displacements in fixed point: fine enough that a strain is known to 1e-7, coarse enough for 500 spacings; more is made
// room for as a body moves.
constexpr double displacement_quanta_per_spacing = 4194304;
constexpr double largest_fixed = 2.0e9;

constexpr double flattest = 1e-3;   // det of the moment over its mean cubed; 1 in the middle, 0.3 in a corner

/// Hourglass control is as soft as the metal would be at this multiple of its plastic strain. What it bears in a strut that bends
/// is curvature, which the flow of the metal should: at 1 it took a fifth of the work of opening a ring of crowns.
constexpr double strain_ahead = 10;
/// But no further ahead than this strain: a third of the stress of flow against a mode as large as the distances is what keeps particles
/// of tissue in their places, which flows by a strain of several.
constexpr double most_ahead = 1;

/// Distances are in spacings, displacements in fixed point where numbers are floats.
template <class T>
class TotalLagrangianBody final : public SolidBody {
public:
    TotalLagrangianBody(Solid& solid, const SolidNumerics& numerics)
        : SolidBody(solid, numerics), distance_unit_(numerics.spacing) {
        if constexpr (sizeof(T) == 4) displacement_unit_ = numerics.spacing / displacement_quanta_per_spacing;
        is_metal_ = std::any_of(solid.materials.begin(), solid.materials.end(),
                                [](const SolidMaterial& m) { return std::holds_alternative<J2Plastic>(m.law); });
        pairs_ = pair_up<T>(solid.particles, numerics);
        make_records();
        correct_gradients();
        sort_members();
        find_damping();
        find_constrained();
        if (numerics_.mass_scaling != 1) find_selective_mass(vibrations());
    }

    void compute_deformation() override {
        write_records();
        sum_deformation();
        for (std::uint32_t i = 0; i < particles().size(); ++i)
            if (!(determinant(deformation(i)) > 0)) report_inside_out(i, time_);
    }

    void compute_force(double time) override {
        write_records();
        sum_deformation();
        std::uint32_t inside_out = no_particle;
        for (std::size_t m = 0; m < members_.size(); ++m)
            inside_out =
                std::min(inside_out, compute_stress(solid_.materials[m], members_[m], input_, particles(), stress_));
        if (inside_out != no_particle) report_inside_out(inside_out, time);
        if (numerics_.second_order) lead_stress_back();
        if (is_metal_) soften_hourglass();
        if (numerics_.viscosity > 0)
            sum_force<true>();
        else
            sum_force<false>();
    }

    Mat3 deformation(std::size_t i) const override {
        return is_deformed_ ? deformation_gradient(input_, i) : identity<double>();
    }
    double mean_neighbours() const override {
        return double(pairs_.pair_count()) / double(std::max<std::size_t>(1, pairs_.size()));
    }

    /// The body's, and the deformation as it was computed last: the next stable step is told by it.
    std::vector<double> state() const override {
        std::vector<double> state = SolidBody::state();
        state.insert(state.end(), {displacement_unit_, input_.displacement_scale, is_deformed_ ? 1.0 : 0.0});
        for (const auto* columns : {&input_.sums, &input_.around})
            for (const auto& column : *columns)
                for (std::size_t i = 0; i < std::min(particles().size(), column.size()); ++i)
                    state.push_back(double(column[i]));
        return state;
    }
    void restore(std::span<const double> state) override {
        SolidBody::restore(state);
        const std::size_t n = particles().size();
        const double* at = state.data() + state.size() - (numerics_.second_order ? 18 : 9) * n - 3;
        displacement_unit_ = *at++, input_.displacement_scale = *at++, is_deformed_ = *at++ != 0;
        for (auto* columns : {&input_.sums, &input_.around})
            for (auto& column : *columns)
                for (std::size_t i = 0; i < std::min(n, column.size()); ++i) column[i] = T(*at++);
        for (std::size_t i = 0; i < n; ++i)
            input_.hourglass[i] = T(hourglass_modulus(i)), softened_at_[i] = particles().plastic_strain[i];
    }

private:
    void make_records() {
        const std::size_t n = particles().size(), padded = pairs_.padded_size();
        mean_volume_ = sum_of(n, [&](std::size_t i) { return particles().volume[i]; }) / double(n);
        displacement_.reset(padded, zero_record<T>());
        for (auto& row : stress_.rows) row.reset(padded, zero_record<T>());
        for (auto& column : input_.sums) column.reset(padded, T(0));
        for (auto& column : input_.correction) column.reset(padded, T(0));
        input_.hourglass.reset(padded, T(0)), input_.share.reset(padded, T(0));
        for (std::size_t i = 0; i < n; ++i) input_.share[i] = T(particles().volume[i] / mean_volume_);
        if (is_metal_) stretching_.reset(padded, T(0));
        if (numerics_.second_order) {
            for (auto& column : input_.around) column.reset(padded, T(0));
            for (auto& column : stress_around_) column.reset(padded, T(0));
            for (auto& row : gradient_) row.reset(padded, zero_record<T>());
        }
        elastic_hourglass_.resize(n), softened_at_.assign(n, 0);
        if (numerics_.viscosity > 0) damping_power_.assign(padded, 0);
    }

    /// B = (sum w d d^T)^-1 and the hourglass modulus.                                        THEORY (20.2), (20.6)
    void correct_gradients() {
        const SolidParticles& p = particles();
        std::vector<std::uint8_t> is_flat(p.size(), 0);
        std::vector<Mat3> moment(p.size(), Mat3{});
        pairs_.for_each_pair([&](std::uint32_t i, std::uint32_t j, const FixedPair<T>& pair) {
            const Vec3 wd = {double(pair.wd.x), double(pair.wd.y), double(pair.wd.z)};
            moment[i] += outer(wd, (1 / distance_unit_) * (p.reference[i] - p.reference[j]));
        });
        for_each_index(p.size(), [&](std::size_t i) {
            Mat3 M = 0.5 * (moment[i] + transpose(moment[i]));
            const double mean = trace(M) / dimensions();
            if (numerics_.planar) M.z.z = mean;   // of no account: F_zz = 1
            is_flat[i] = !(determinant(M) > flattest * mean * mean * mean);
            if (is_flat[i]) return;
            const Mat3 B = inverse(M);
            const std::array<double, 6> b = {B.x.x, B.y.y, numerics_.planar ? 0.0 : B.z.z, B.x.y, B.x.z, B.y.z};
            for (std::size_t k = 0; k < 6; ++k) input_.correction[k][i] = T(b[k]);
            const double shear = solid_.materials[std::size_t(p.material[i])].moduli().shear;
            elastic_hourglass_[i] = numerics_.hourglass * shear * mean_correction(i);
            input_.hourglass[i] = T(hourglass_modulus(i)), softened_at_[i] = p.plastic_strain[i];
        });
        for (std::size_t i = 0; i < p.size(); ++i)
            if (is_flat[i])
                throw GeometryError(fmt::format(
                    "the solid is too thin for its spacing of {:.3g} m: the neighbours of the particle at "
                    "({:.4g}, {:.4g}, {:.4g}) m lie {}; at least three particles are needed across every part",
                    numerics_.spacing, p.reference[i].x, p.reference[i].y, p.reference[i].z,
                    numerics_.planar ? "on one line" : "in one plane"));
    }
    double dimensions() const { return numerics_.planar ? 2 : 3; }
    double mean_correction(std::size_t i) const {
        const auto& b = input_.correction;
        return (double(b[0][i]) + double(b[1][i]) + (numerics_.planar ? 0.0 : double(b[2][i]))) / dimensions();
    }

    /// What the square of a particle's circular frequency against its neighbours is at the most [1/s^2].        THEORY (20.20)
    std::vector<double> vibrations() const {
        const SolidParticles& p = particles();
        std::vector<double> stiffness(p.size()), vibration(p.size(), 0);
        for_each_index(p.size(), [&](std::size_t i) {
            const Vec3 b = symmetric_eigen(correction_at(input_, i)).values;
            stiffness[i] =
                p.volume[i] * (material(i).moduli().p_wave() * std::max({b.x, b.y, b.z}) + elastic_hourglass_[i]);
        });
        pairs_.for_each_pair([&](std::uint32_t i, std::uint32_t j, const FixedPair<T>& pair) {
            vibration[i] += double(pair.w) * (stiffness[i] + stiffness[j]);
        });
        for (std::size_t i = 0; i < p.size(); ++i) vibration[i] *= 2 / (p.mass[i] * distance_unit_ * distance_unit_);
        return vibration;
    }

    void sort_members() {
        members_.resize(solid_.materials.size());
        for (std::size_t i = 0; i < particles().size(); ++i)
            members_.at(std::size_t(particles().material[i])).push_back(std::uint32_t(i));
    }

    /// D of the loop, from the viscosity eta = alpha rho c h (d + 2)/3 of (20.9), with the body's means.
    void find_damping() {
        const SolidParticles& p = particles();
        const double count = double(p.size());
        const double b = sum_of(p.size(), [&](std::size_t i) { return mean_correction(i); }) / count;
        const double impedance = sum_of(p.size(),
                                        [&](std::size_t i) {
                                            const SolidMaterial& m = solid_.materials[std::size_t(p.material[i])];
                                            return std::sqrt(m.density * m.moduli().p_wave());
                                        }) /
                                 count;
        const double h = numerics_.smoothing_ratio * numerics_.spacing;
        damping_ = numerics_.viscosity * impedance * h * (dimensions() + 2) / 3 * b / distance_unit_;
    }

    /// Records of where the particles are, and of their velocities.
    void write_records() override {
        double farthest = write_records_with(displacement_unit_);
        if constexpr (sizeof(T) == 4) {
            if (farthest <= largest_fixed * displacement_unit_) return;
            while (farthest > largest_fixed * displacement_unit_) displacement_unit_ *= 2;
            write_records_with(displacement_unit_);
        }
    }
    /// Returns the largest displacement along an axis [m]; if that is too large for the unit the records mean nothing.
    double write_records_with(double unit) {
        SolidParticles& p = particles();
        input_.displacement_scale = unit / distance_unit_;
        const T scale = T(input_.displacement_scale);
        const double per_unit = 1 / unit;
        return largest_of(p.size(), [&](std::size_t i) {
            const Vec3 u = p.position[i] - p.reference[i], &v = p.velocity[i];
            displacement_[i] = displacement_record(u, per_unit, scale * input_.share[i] * input_.hourglass[i]);
            stress_.rows[0][i].d = T(v.x), stress_.rows[1][i].d = T(v.y), stress_.rows[2][i].d = T(v.z);
            return std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z)});
        });
    }
    static Quad<T> displacement_record(const Vec3& u, double per_unit, T value) {
        if constexpr (sizeof(T) == 4) {
            const auto fixed = [&](double x) { return std::bit_cast<float>(std::int32_t(std::lrint(x * per_unit))); };
            return {fixed(u.x), fixed(u.y), fixed(u.z), value};
        } else {
            return {per_unit * u.x, per_unit * u.y, per_unit * u.z, value};
        }
    }
    /// A metal that flows is less stiff against hourglass modes too.                             THEORY (19.14), (20.6)
    double hourglass_modulus(std::size_t i) const {
        const double a = particles().plastic_strain[i];
        if (a == 0) return elastic_hourglass_[i];
        const auto& law = std::get<J2Plastic>(solid_.materials[std::size_t(particles().material[i])].law);
        return elastic_hourglass_[i] * law.secant_share(std::min(strain_ahead * a, most_ahead));
    }

    /// What hourglass modes have less of since the stress of this step was computed; from now on they are as soft as the metal is.
    ///                                                                                            THEORY (20.16)
    void soften_hourglass() {
        const SolidParticles& p = particles();
        yielded_ += sum_of(p.size(), [&](std::size_t i) {
            if (p.plastic_strain[i] == softened_at_[i]) return 0.0;
            softened_at_[i] = p.plastic_strain[i];
            const double before = double(input_.hourglass[i]), now = hourglass_modulus(i);
            input_.hourglass[i] = T(now);
            return before > now ? 0.5 * p.volume[i] * (before - now) * unfitted(i, double(stretching_[i])) : 0.0;
        });
    }

    /// sum w |e|^2 of particle i, from its sums [units of distance squared].                              THEORY (20.7)
    double unfitted(std::size_t i, double stretching) const {
        std::array<double, 9> u;   // sum w (u_i - u_j) d^T
        for (std::size_t k = 0; k < 9; ++k) u[k] = input_.displacement_scale * double(input_.sums[k][i]);
        const Mat3 S{{u[0], u[1], u[2]}, {u[3], u[4], u[5]}, {u[6], u[7], u[8]}};
        return input_.displacement_scale * input_.displacement_scale * stretching -
               double_dot(fitted_gradient(input_, i) - identity<double>(), S);
    }

    void sum_deformation() {
        if (is_metal_)
            sum_deformation_of<true>();
        else
            sum_deformation_of<false>();
        if (numerics_.second_order) {
            for_each_index(particles().size(), [&](std::size_t i) {
                put_rows(gradient_, i, fitted_gradient(input_, i) - identity<double>());
            });
            sum_around(gradient_, input_.around);
        }
        is_deformed_ = true;
    }
    using Rows = std::array<AlignedVector<Quad<T>>, 3>;
    static void put_rows(Rows& rows, std::size_t i, const Mat3& m) {
        const std::array<const Vec3*, 3> from = {&m.x, &m.y, &m.z};
        for (std::size_t k = 0; k < 3; ++k)
            rows[k][i].a = T(from[k]->x), rows[k][i].b = T(from[k]->y), rows[k][i].c = T(from[k]->z);
    }
    static Mat3 rows_at(const Rows& rows, std::size_t i) {
        const auto row = [&](std::size_t k) {
            return Vec3{double(rows[k][i].a), double(rows[k][i].b), double(rows[k][i].c)};
        };
        return {row(0), row(1), row(2)};
    }
    void sum_around(const Rows& rows, std::array<AlignedVector<T>, 9>& around) {
        pairs_.template sum<solid_terms::Surroundings>(
            {rows[0].data()}, {rows[0].data(), rows[1].data(), rows[2].data()}, {},
            [&](std::size_t i, const auto& s) {
                for (std::size_t k = 0; k < 9; ++k) store(s[k], &around[k][i]);
            },
            numerics_.loop);
    }

    /// F of second order depends on that of the neighbours, so that their stress works on this particle's too: from v P B the A of
    /// the forces.                                                                                 THEORY (20.19)
    void lead_stress_back() {
        sum_around(stress_.rows, stress_around_);
        for_each_index(particles().size(), [&](std::size_t i) {
            const Mat3 PB =
                1.5 * rows_at(stress_.rows, i) - 0.5 * (matrix_at(stress_around_, i) * correction_at(input_, i));
            put_rows(stress_.rows, i,
                     double(input_.share[i]) * double(input_.hourglass[i]) * rows_at(gradient_, i) - PB);
        });
    }
    template <bool is_metal>
    void sum_deformation_of() {
        pairs_.template sum<solid_terms::Deformation<is_metal>>(
            {displacement_.data()}, {displacement_.data()}, {},
            [&](std::size_t i, const auto& s) {
                for (std::size_t k = 0; k < 9; ++k) store(s[k], &input_.sums[k][i]);
                if constexpr (is_metal) store(s[9], &stretching_[i]);
            },
            numerics_.loop);
    }

    template <bool is_damped>
    void sum_force() {
        SolidParticles& p = particles();
        const std::array<const Quad<T>*, 4> records = {displacement_.data(), stress_.rows[0].data(),
                                                       stress_.rows[1].data(), stress_.rows[2].data()};
        const double scale = mean_volume_ / distance_unit_;
        using Term = solid_terms::Force<is_damped>;
        pairs_.template sum<Term>(
            records, records, Term{input_.displacement_scale, damping_},
            [&](std::size_t first, const auto& s) {
                const auto finish = [&](std::size_t i, const Vec<T>& pairs, T power) {
                    p.force[i] = scale * Vec3{double(pairs.x), double(pairs.y), double(pairs.z)};
                    if constexpr (is_damped) damping_power_[i] = scale * double(power);
                };
                if constexpr (std::is_same_v<std::decay_t<decltype(s[0])>, T>) {
                    finish(first, {s[0], s[1], s[2]}, s[s.size() - 1]);
                } else {
                    for (int l = 0; l < int(pairs_.lanes) && first + std::size_t(l) < p.size(); ++l)
                        finish(first + std::size_t(l), {s[0][l], s[1][l], s[2][l]}, s[s.size() - 1][l]);
                }
            },
            numerics_.loop);
    }

    /// Half of c V sum w |e|^2, in which the deviations e from a linear deformation are those of its best fit.
    ///                                                                                            THEORY (20.7)
    double hourglass_energy() const override {
        const SolidParticles& p = particles();
        AlignedVector<T> stretching;
        stretching.reset(pairs_.padded_size());
        pairs_.template sum<solid_terms::Stretching>(
            {displacement_.data()}, {displacement_.data()}, {},
            [&](std::size_t i, const auto& s) { store(s[0], &stretching[i]); }, numerics_.loop);
        return sum_of(p.size(), [&](std::size_t i) {
            return 0.5 * p.volume[i] * double(input_.hourglass[i]) * unfitted(i, double(stretching[i]));
        });
    }

    double viscous_power() const override {   // a pair is in two sums
        return 0.5 * sum_of(particles().size(), [&](std::size_t i) { return damping_power_[i]; });
    }

    [[noreturn]] void report_inside_out(std::uint32_t i, double time) const {
        const SolidParticles& p = particles();
        const Vec3 &x = p.position[i], &v = p.velocity[i];
        throw DivergedError(fmt::format(
            "the solid was turned inside out at t = {:.6g} s: the particle at ({:.4g}, {:.4g}, {:.4g}) m, "
            "at first ({:.4g}, {:.4g}, {:.4g}) m, with velocity ({:.3g}, {:.3g}, {:.3g}) m/s has det F = {:.3g}",
            time, x.x, x.y, x.z, p.reference[i].x, p.reference[i].y, p.reference[i].z, v.x, v.y, v.z,
            determinant(deformation_gradient(input_, i))));
    }

    FixedPairs<T> pairs_;
    AlignedVector<Quad<T>> displacement_;             // (u, hourglass modulus)
    AlignedVector<T> stretching_;                     // sum w |u_i - u_j|^2, of metals
    Rows gradient_;                                   // F - 1 as it fits, of a body of second order
    std::array<AlignedVector<T>, 9> stress_around_;   // sum w (v P B of j, d) d^T
    StressOutput<T> stress_;                          // with a component of the velocity as fourth of each row
    StressInput<T> input_;
    std::vector<std::vector<std::uint32_t>> members_;   // by material
    std::vector<double> elastic_hourglass_, softened_at_,
        damping_power_;   // softened_at_: the plastic strain that the hourglass modulus is for
    double distance_unit_, displacement_unit_ = distance_unit_, damping_ = 0,
                           mean_volume_ = 0;   // m, m, D of the loop, m^3
    bool is_deformed_ = false, is_metal_ = false;
};

}   // namespace

std::unique_ptr<SolidBody> make_solid_body(Solid& solid, const SolidNumerics& numerics) {
    if (numerics.precision == Precision::double_precision)
        return std::make_unique<TotalLagrangianBody<double>>(solid, numerics);
    return std::make_unique<TotalLagrangianBody<float>>(solid, numerics);
}

}   // namespace patency
