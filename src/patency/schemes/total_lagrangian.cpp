// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/solid_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
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

template <class T, bool is_steep>
class TotalLagrangianBody final : public SolidBody {
public:
    TotalLagrangianBody(Solid& solid, const SolidNumerics& numerics)
        : SolidBody(solid, numerics), frame_(make_frame()), scale_(pair_scale<T>(frame_, numerics.kernel().support())) {
        SolidParticles& p = particles();
        p.take(cells_.find_order(frame_, numerics.spacing, {p.reference.data(), p.size()}));
        cells_.index(frame_, numerics.spacing, {p.reference.data(), p.size()});
        rows_.find_own(frame_, cells_, numerics.kernel().support(), native_lanes<T>);
        if constexpr (sizeof(T) == 4) displacement_unit_ = numerics.spacing / displacement_quanta_per_spacing;
        is_metal_ = std::any_of(solid.materials.begin(), solid.materials.end(), [](const SolidMaterial& m) { return std::holds_alternative<J2Plastic>(m.law); });
        make_records();
        correct_gradients();
        sort_members();
        find_damping();
        find_constrained();
        find_selective_mass();
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
            inside_out = std::min(inside_out, compute_stress(solid_.materials[m], members_[m], input_, particles(), stress_));
        if (inside_out != no_particle) report_inside_out(inside_out, time);
        if (is_metal_) soften_hourglass();
        if (numerics_.viscosity > 0) sum_force<true>();
        else sum_force<false>();
    }

    Mat3 deformation(std::size_t i) const override { return is_deformed_ ? deformation_gradient(input_, i) : identity<double>(); }
    double mean_neighbours() const override { return double(rows_.pair_count()) / double(std::max<std::size_t>(1, rows_.member_count())); }

    /// The body's, and the deformation as it was computed last: the next stable step is told by it.
    std::vector<double> state() const override {
        std::vector<double> state = SolidBody::state();
        state.insert(state.end(), {displacement_unit_, input_.displacement_scale, is_deformed_ ? 1.0 : 0.0});
        for (const auto& column : input_.sums)
            for (std::size_t i = 0; i < particles().size(); ++i) state.push_back(double(column[i]));
        return state;
    }
    void restore(std::span<const double> state) override {
        SolidBody::restore(state);
        const std::size_t n = particles().size();
        const double* at = state.data() + state.size() - 9 * n - 3;
        displacement_unit_ = *at++, input_.displacement_scale = *at++, is_deformed_ = *at++ != 0;
        for (auto& column : input_.sums)
            for (std::size_t i = 0; i < n; ++i) column[i] = T(*at++);
    }

private:
    Frame make_frame() const {
        const SolidParticles& p = solid_.particles;
        if (p.size() == 0) throw GeometryError("a solid has no particles: its spacing is too large");
        Vec3 low = p.reference[0], high = low;
        for (const Vec3& x : p.reference) {
            low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
            high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
        }
        const double support = numerics_.kernel().support();
        const Vec3 margin = support * Vec3{1, 1, 1};
        return Frame(low - margin, high + margin, support);
    }

    void make_records() {
        const SolidParticles& p = particles();
        const std::size_t n = p.size();
        geometry_.reset(n + 1), displacement_.reset(n + 1);
        for (auto& row : stress_) row.reset(n + 1, zero_record<T>());
        for (auto& column : input_.sums) column.reset(n);
        if (is_metal_) stretching_.reset(n);
        for (auto& column : input_.correction) column.reset(n);
        input_.hourglass.reset(n);
        elastic_hourglass_.resize(n);
        damping_power_.assign(n, 0);
        for_each_index(n, [&](std::size_t i) {
            geometry_[i] = position_record<T>(frame_, p.reference[i], T(p.volume[i] / numerics_.cell()));
        });
        geometry_[n] = dummy_record<T>();
        displacement_[n] = zero_record<T>();
    }

    /// B = (sum w d d^T)^-1 and the hourglass modulus.                                        THEORY (20.2), (20.6)
    void correct_gradients() {
        const SolidParticles& p = particles();
        std::vector<std::uint8_t> is_flat(p.size(), 0);
        sum<solid_terms::Moment<is_steep>>(records_of(geometry_), records_of(geometry_), {}, [&](std::uint32_t i, const std::array<T, 6>& s) {
            Mat3 M{{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}};
            const double mean = trace(M) / dimensions();
            if (numerics_.planar) M.z.z = mean;   // of no account: F_zz = 1
            is_flat[i] = !(determinant(M) > flattest * mean * mean * mean);
            if (is_flat[i]) return;
            const Mat3 B = inverse(M);
            const std::array<double, 6> b = {B.x.x, B.y.y, numerics_.planar ? 0.0 : B.z.z, B.x.y, B.x.z, B.y.z};
            for (std::size_t k = 0; k < 6; ++k) input_.correction[k][i] = T(b[k]);
            const double shear = solid_.materials[std::size_t(p.material[i])].moduli().shear;
            elastic_hourglass_[i] = numerics_.hourglass * shear * mean_correction(i);
        });
        for (std::size_t i = 0; i < p.size(); ++i)
            if (is_flat[i])
                throw GeometryError(fmt::format("the solid is too thin for its spacing of {:.3g} m: the neighbours of the particle at "
                                                "({:.4g}, {:.4g}, {:.4g}) m lie {}; at least three particles are needed across every part",
                                                numerics_.spacing, p.reference[i].x, p.reference[i].y, p.reference[i].z,
                                                numerics_.planar ? "on one line" : "in one plane"));
    }
    double dimensions() const { return numerics_.planar ? 2 : 3; }
    double mean_correction(std::size_t i) const {
        const auto& b = input_.correction;
        return (double(b[0][i]) + double(b[1][i]) + (numerics_.planar ? 0.0 : double(b[2][i]))) / dimensions();
    }

    void sort_members() {
        members_.resize(solid_.materials.size());
        for (std::size_t i = 0; i < particles().size(); ++i) members_.at(std::size_t(particles().material[i])).push_back(std::uint32_t(i));
    }

    /// D of the loop, from the viscosity eta = alpha rho c h (d + 2)/3 of (20.9), with the body's means.
    void find_damping() {
        const SolidParticles& p = particles();
        const double count = double(p.size());
        const double b = sum_of(p.size(), [&](std::size_t i) { return mean_correction(i); }) / count;
        const double impedance = sum_of(p.size(), [&](std::size_t i) {
                                     const SolidMaterial& m = solid_.materials[std::size_t(p.material[i])];
                                     return std::sqrt(m.density * m.moduli().p_wave());
                                 }) / count;
        const double h = numerics_.smoothing_ratio * numerics_.spacing;
        damping_ = numerics_.viscosity * impedance * h * (dimensions() + 2) / 3 * b / scale_.unit;
    }

    /// Records of where the particles are, and of their velocities.
    void write_records() override {
        SolidParticles& p = particles();
        if constexpr (sizeof(T) == 4) {
            const double farthest = largest_of(p.size(), [&](std::size_t i) {
                const Vec3 u = p.position[i] - p.reference[i];
                return std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z)});
            });
            while (farthest > largest_fixed * displacement_unit_) displacement_unit_ *= 2;
        }
        input_.displacement_scale = displacement_unit_ / scale_.unit;
        for_each_index(p.size(), [&](std::size_t i) {
            const double c = hourglass_modulus(i);
            input_.hourglass[i] = T(c);
            displacement_[i] = displacement_record(p.position[i] - p.reference[i], T(c * input_.displacement_scale));
            stress_[0][i].d = T(p.velocity[i].x), stress_[1][i].d = T(p.velocity[i].y), stress_[2][i].d = T(p.velocity[i].z);
        });
    }
    Quad<T> displacement_record(const Vec3& u, T value) const {
        if constexpr (sizeof(T) == 4) {
            const auto fixed = [&](double x) { return std::bit_cast<float>(std::int32_t(std::lrint(x / displacement_unit_))); };
            return {fixed(u.x), fixed(u.y), fixed(u.z), value};
        } else {
            return {u.x, u.y, u.z, value};
        }
    }
    /// A metal that flows is less stiff against hourglass modes too.                             THEORY (19.14), (20.6)
    double hourglass_modulus(std::size_t i) const {
        const double a = particles().plastic_strain[i];
        if (a == 0) return elastic_hourglass_[i];
        const auto& law = std::get<J2Plastic>(solid_.materials[std::size_t(particles().material[i])].law);
        return elastic_hourglass_[i] * law.secant_share(strain_ahead * a);
    }

    /// What hourglass modes have less of since the stress of this step was computed.                        THEORY (20.16)
    void soften_hourglass() {
        yielded_ += sum_of(particles().size(), [&](std::size_t i) {
            if (particles().plastic_strain[i] == 0) return 0.0;
            const double fell = double(input_.hourglass[i]) - hourglass_modulus(i);
            return fell > 0 ? 0.5 * particles().volume[i] * fell * unfitted(i, double(stretching_[i])) : 0.0;
        });
    }

    /// sum w |e|^2 of particle i, from its sums [units of distance squared].                              THEORY (20.7)
    double unfitted(std::size_t i, double stretching) const {
        std::array<double, 9> u;   // sum w (u_i - u_j) d^T
        for (std::size_t k = 0; k < 9; ++k) u[k] = input_.displacement_scale * double(input_.sums[k][i]);
        const Mat3 S{{u[0], u[1], u[2]}, {u[3], u[4], u[5]}, {u[6], u[7], u[8]}};
        return input_.displacement_scale * input_.displacement_scale * stretching - double_dot(deformation(i) - identity<double>(), S);
    }

    template <class Term, class Finish>
    void sum(const Records<T, Term::own_extras>& own, const Records<T, Term::extras>& other, const Term& term, const Finish& finish) const {
        sum_over_neighbours<T>(rows_, scale_, own, other, term, finish, numerics_.loop);
    }

    void sum_deformation() {
        if (is_metal_) sum_deformation_of<true>();
        else sum_deformation_of<false>();
        is_deformed_ = true;
    }
    template <bool is_metal>
    void sum_deformation_of() {
        const auto records = records_of(geometry_, displacement_);
        using Term = solid_terms::Deformation<is_steep, is_metal>;
        sum<Term>(records, records, {}, [&](std::uint32_t i, const std::array<T, std::size_t(Term::sums)>& s) {
            for (std::size_t k = 0; k < 9; ++k) input_.sums[k][i] = s[k];
            if constexpr (is_metal) stretching_[i] = s[9];
        });
    }

    template <bool is_damped>
    void sum_force() {
        SolidParticles& p = particles();
        const auto records = records_of(geometry_, displacement_, stress_[0], stress_[1], stress_[2]);
        const double per_unit = 1 / scale_.unit;
        using Term = solid_terms::Force<is_steep, is_damped>;
        sum<Term>(records, records, Term{input_.displacement_scale, damping_}, [&](std::uint32_t i, const std::array<T, std::size_t(Term::sums)>& s) {
            const double scale = p.volume[i] * per_unit;
            p.force[i] = scale * Vec3{double(s[0]), double(s[1]), double(s[2])};
            if constexpr (is_damped) damping_power_[i] = scale * double(s[3]);
        });
    }

    /// Half of c V sum w |e|^2, in which the deviations e from a linear deformation are those of its best fit.
    ///                                                                                            THEORY (20.7)
    double hourglass_energy() const override {
        const SolidParticles& p = particles();
        std::vector<double> energy(p.size());
        const auto records = records_of(geometry_, displacement_);
        sum<solid_terms::Stretching<is_steep>>(records, records, {}, [&](std::uint32_t i, const std::array<T, 1>& s) {
            energy[i] = 0.5 * p.volume[i] * double(input_.hourglass[i]) * unfitted(i, double(s[0]));
        });
        return sum_of(p.size(), [&](std::size_t i) { return energy[i]; });
    }

    double viscous_power() const override {   // a pair is in two sums
        return 0.5 * sum_of(damping_power_.size(), [&](std::size_t i) { return damping_power_[i]; });
    }

    [[noreturn]] void report_inside_out(std::uint32_t i, double time) const {
        const SolidParticles& p = particles();
        const Vec3 &x = p.position[i], &v = p.velocity[i];
        throw DivergedError(fmt::format("the solid was turned inside out at t = {:.6g} s: the particle at ({:.4g}, {:.4g}, {:.4g}) m, "
                                        "at first ({:.4g}, {:.4g}, {:.4g}) m, with velocity ({:.3g}, {:.3g}, {:.3g}) m/s has det F = {:.3g}",
                                        time, x.x, x.y, x.z, p.reference[i].x, p.reference[i].y, p.reference[i].z, v.x, v.y, v.z,
                                        determinant(deformation_gradient(input_, i))));
    }

    Frame frame_;
    PairScale scale_;
    Cells cells_;
    Neighbours rows_;
    AlignedVector<Quad<T>> geometry_, displacement_;   // (X, volume), (u, hourglass modulus)
    AlignedVector<T> stretching_;                      // sum w |u_i - u_j|^2, of metals
    std::array<AlignedVector<Quad<T>>, 3> stress_;     // (row of A, component of v)
    StressInput<T> input_;
    std::vector<std::vector<std::uint32_t>> members_;  // by material
    std::vector<double> elastic_hourglass_, damping_power_;
    double displacement_unit_ = 1, damping_ = 0;
    bool is_deformed_ = false, is_metal_ = false;
};

template <class T>
std::unique_ptr<SolidBody> make_body_of(Solid& solid, const SolidNumerics& numerics) {
    if (numerics.weights == SolidWeights::steep) return std::make_unique<TotalLagrangianBody<T, true>>(solid, numerics);
    return std::make_unique<TotalLagrangianBody<T, false>>(solid, numerics);
}

}   // namespace

std::unique_ptr<SolidBody> make_solid_body(Solid& solid, const SolidNumerics& numerics) {
    return numerics.precision == Precision::double_precision ? make_body_of<double>(solid, numerics) : make_body_of<float>(solid, numerics);
}

}   // namespace patency
