// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/solid_body.h"

#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

/// What stands only on the axes that are held, or only on the others.
Vec3 masked(const Vec3& v, const std::array<bool, 3>& axes) {
    return {axes[0] ? v.x : 0, axes[1] ? v.y : 0, axes[2] ? v.z : 0};
}

Vec3 displacement_of(const Constraint& c, const Vec3& reference, double time) {
    return c.displacement ? c.displacement(reference, time) : Vec3{};
}

/// By how much (20.20) a particle may turn in a step: 2.44 at the most in a ring of crowns whose particles lie in layers. Its fastest vibration
/// turns by 1.5 of the 2 at which it would grow.
constexpr double borne_angle = 2.45;

Fibres<double> fibres_of(const SolidParticles& p, std::size_t i) { return {p.first_fibre[i], p.second_fibre[i]}; }

}   // namespace

double SolidBody::stable_step() const {
    const SolidParticles& p = particles();
    const double fastest = largest_of(p.size(), [&](std::size_t i) {
        const SolidMaterial& m = material(i);
        const Mat3 F = deformation(i);
        const double modulus = std::visit(
            [&](const auto& law) {
                if constexpr (std::is_same_v<std::decay_t<decltype(law)>, FibreArtery>)
                    return law.wave_modulus(F, fibres_of(p, i));
                else
                    return law.wave_modulus(F);
            },
            m.law);
        return modulus / m.density;
    });
    const double h = numerics_.smoothing_ratio * numerics_.spacing;
    const double gain =
        (selective_ ? std::sqrt(numerics_.mass_scaling) : 1.0) * (numerics_.second_order ? second_order_share : 1.0);
    return gain * numerics_.cfl * h / (std::sqrt(fastest) * (1 + numerics_.viscosity));
}

void SolidBody::drift(double dt, double time) {
    SolidParticles& p = particles();
    time_ = time;
    for_each_index(p.size(), [&](std::size_t i) {
        const Vec3 moved = p.position[i] + dt * p.velocity[i];
        if (p.constraint[i] == 0) {
            p.position[i] = moved;
            return;
        }
        const Constraint& c = solid_.constraints[std::size_t(p.constraint[i] - 1)];
        const Vec3 place = p.reference[i] + displacement_of(c, p.reference[i], time);
        p.position[i] = moved + masked(place - moved, c.held);
    });
}

void SolidBody::kick(double dt, double time, double drag) {
    const Powers powers = selective_ ? kick_selectively(dt, drag) : kick_free(dt, drag);
    load_work_ += dt * powers.load;
    drag_ += dt * powers.drag;
    kick_constrained(dt, time);
    if (numerics_.viscosity > 0) viscous_ += dt * viscous_power();
}

SolidBody::Powers SolidBody::kick_free(double dt, double drag) {
    SolidParticles& p = particles();
    const double slowing = 0.5 * drag * dt, keep = (1 - slowing) / (1 + slowing), push = dt / (1 + slowing);
    return reduce(
        p.size(), Powers{0, 0},
        [&](std::size_t i) {
            if (p.constraint[i] != 0) return Powers{0, 0};
            const Vec3 before = p.velocity[i], after = keep * before + (push / p.mass[i]) * (p.force[i] + p.load[i]);
            const Vec3 middle = 0.5 * (before + after);
            p.velocity[i] = after;
            return Powers{dot(p.load[i], middle), drag * p.mass[i] * dot(middle, middle)};
        },
        [](const Powers& a, const Powers& b) {
            return Powers{a.load + b.load, a.drag + b.drag};
        });
}

/// Forces push momenta, and these move the particles.                                                THEORY (20.17)
SolidBody::Powers SolidBody::kick_selectively(double dt, double drag) {
    SolidParticles& p = particles();
    const double slowing = 0.5 * drag * dt, keep = (1 - slowing) / (1 + slowing), push = dt / (1 + slowing);
    if (momentum_.empty())   // until now it moved as one
        for (std::size_t i = 0; i < p.size(); ++i) momentum_.push_back(p.mass[i] * p.velocity[i]);
    old_velocity_.assign(p.velocity.begin(), p.velocity.end());
    middle_momentum_.resize(p.size());
    for_each_index(p.size(), [&](std::size_t i) {
        const Vec3 after = keep * momentum_[i] + push * (p.force[i] + p.load[i]);
        middle_momentum_[i] = 0.5 * (momentum_[i] + after);
        momentum_[i] = after;
    });
    selective_->compute_velocity(momentum_, p);
    return reduce(
        p.size(), Powers{0, 0},
        [&](std::size_t i) {
            const Vec3 middle = 0.5 * (old_velocity_[i] + p.velocity[i]);
            return Powers{dot(p.load[i], middle), drag * dot(middle_momentum_[i], middle)};
        },
        [](const Powers& a, const Powers& b) {
            return Powers{a.load + b.load, a.drag + b.drag};
        });
}

double SolidBody::kinetic() const {
    const SolidParticles& p = particles();
    if (!momentum_.empty())
        return 0.5 * sum_of(p.size(), [&](std::size_t i) { return dot(momentum_[i], p.velocity[i]); });
    return 0.5 * sum_of(p.size(), [&](std::size_t i) { return p.mass[i] * dot(p.velocity[i], p.velocity[i]); });
}

/// Few particles, one after another: their reactions add up in one order.
void SolidBody::kick_constrained(double dt, double time) {
    SolidParticles& p = particles();
    for (std::size_t k = 0; k < constrained_.size(); ++k) {
        const Constraint& c = solid_.constraints[k];
        for (const std::uint32_t i : constrained_[k]) {
            const Vec3 before = p.velocity[i], total = p.force[i] + p.load[i];
            const Vec3 way = displacement_of(c, p.reference[i], time + dt) - displacement_of(c, p.reference[i], time);
            const Vec3 free = before + (dt / p.mass[i]) * total;
            const Vec3 after = free + masked(way / dt - free, c.held);
            const Vec3 impulse = p.mass[i] * (after - before) - dt * total;   // on the held axes; zero on the others
            p.velocity[i] = after;
            reactions_[k] += impulse;
            load_work_ += 0.5 * dt * dot(p.load[i], before + after);
            constraint_work_ += 0.5 * dot(impulse, before + after);
        }
    }
}

double SolidBody::find_present_frequency(double dt) {
    const SolidParticles& p = particles();
    Motion& m = motion_;
    const bool is_first = m.last_force.empty();
    if (is_first) m.last_force.assign(p.force.begin(), p.force.end());
    if (m.place.empty()) m.place.resize(p.size()), m.force.resize(p.size());
    const double mass = 2 * kinetic(), stiffness = -sum_of(p.size(), [&](std::size_t i) {
                                           return dot(p.velocity[i], p.force[i] - m.last_force[i]);
                                       }) / dt;
    for_each_index(p.size(), [&](std::size_t i) {
        m.last_force[i] = p.force[i], m.place[i] += p.position[i], m.force[i] += p.force[i];
    });
    if (++m.steps == m.steps_of_mean) take_means(dt);
    m.most = std::max(m.most, mass);
    if (mass < share_at_rest * std::min(m.most, 2 * m.elastic)) return m.frequency;
    return mass > 0 && stiffness > 0 ? std::sqrt(stiffness / mass) : 0.0;
}

void SolidBody::take_means(double dt) {
    const SolidParticles& p = particles();
    Motion& m = motion_;
    const double share = 1.0 / m.steps;
    for_each_index(p.size(), [&](std::size_t i) { m.place[i] *= share, m.force[i] *= share; });
    if (!m.place_before.empty()) {
        const auto way = [&](std::size_t i) { return m.place[i] - m.place_before[i]; };
        const double stiffness =
            -sum_of(p.size(), [&](std::size_t i) { return dot(way(i), m.force[i] - m.force_before[i]); });
        const double mass = sum_of(p.size(), [&](std::size_t i) { return p.mass[i] * dot(way(i), way(i)); });
        m.frequency = mass > 0 && stiffness > 0 ? std::sqrt(stiffness / mass) : 0.0;
        const double wanted = m.frequency > 0 ? turn_in_mean / (m.frequency * dt) : m.steps;
        const int half = m.steps / 2;
        m.steps_of_mean = int(std::clamp(wanted, std::max<double>(least_steps_of_mean, half), 2.0 * m.steps));
    }
    // A stiff body that was carried along fast may swing with little of that ride's energy, and yet with all of its own.
    if (2 * kinetic() < share_at_rest * m.most) m.elastic = elastic_energy() + hourglass_energy();
    m.place_before = std::move(m.place), m.force_before = std::move(m.force);
    m.place.clear(), m.force.clear(), m.steps = 0;
}

Mat3 SolidBody::cauchy(std::size_t i) const {
    const SolidParticles& p = particles();
    const Mat3 F = deformation(i);
    const Mat3 tau = std::visit(
        [&](const auto& law) {
            using Law = std::decay_t<decltype(law)>;
            if constexpr (std::is_same_v<Law, FibreArtery>)
                return law.kirchhoff(F, fibres_of(p, i));
            else if constexpr (std::is_same_v<Law, J2Plastic>)
                return law.stress(F, {p.inverse_plastic[i], p.plastic_strain[i]}).kirchhoff;
            else
                return law.kirchhoff(F);
        },
        material(i).law);
    return (1 / determinant(F)) * tau;
}

double SolidBody::elastic_energy() {
    compute_deformation();
    const SolidParticles& p = particles();
    const auto elastic = [&](std::size_t i) {
        const Mat3 F = deformation(i);
        return std::visit(
            [&](const auto& law) {
                using Law = std::decay_t<decltype(law)>;
                if constexpr (std::is_same_v<Law, FibreArtery>)
                    return law.energy(F, fibres_of(p, i));
                else if constexpr (std::is_same_v<Law, J2Plastic>)
                    return law.energy(F, {p.inverse_plastic[i], p.plastic_strain[i]});
                else
                    return law.energy(F);
            },
            material(i).law);
    };
    return sum_of(p.size(), [&](std::size_t i) { return p.volume[i] * elastic(i); });
}

SolidEnergy SolidBody::energy() {
    const SolidParticles& p = particles();
    const auto flow = [&](std::size_t i) {
        const auto* metal = std::get_if<J2Plastic>(&material(i).law);
        return metal ? metal->hardening.work(p.plastic_strain[i]) : 0.0;
    };
    SolidEnergy e;
    e.kinetic = kinetic();
    e.elastic = elastic_energy();
    e.plastic = sum_of(p.size(), [&](std::size_t i) { return p.volume[i] * flow(i); });
    e.hourglass = hourglass_energy();
    e.yielded = yielded_;
    e.viscous = viscous_;
    e.drag = drag_;
    e.load_work = load_work_;
    e.constraint_work = constraint_work_;
    return e;
}

std::vector<double> SolidBody::state() const {
    const Motion& m = motion_;
    std::vector<double> state = {time_,
                                 yielded_,
                                 viscous_,
                                 drag_,
                                 load_work_,
                                 constraint_work_,
                                 m.frequency,
                                 m.most,
                                 m.elastic,
                                 double(m.steps),
                                 double(m.steps_of_mean)};
    for (const std::vector<Vec3>* vectors :
         {&reactions_, &momentum_, &m.last_force, &m.place, &m.force, &m.place_before, &m.force_before}) {
        state.push_back(double(vectors->size()));
        for (const Vec3& v : *vectors) state.insert(state.end(), {v.x, v.y, v.z});
    }
    return state;
}

void SolidBody::restore(std::span<const double> state) {
    Motion& m = motion_;
    const double* at = state.data();
    for (double* x :
         {&time_, &yielded_, &viscous_, &drag_, &load_work_, &constraint_work_, &m.frequency, &m.most, &m.elastic})
        *x = *at++;
    m.steps = int(*at++), m.steps_of_mean = int(*at++);
    for (std::vector<Vec3>* vectors :
         {&reactions_, &momentum_, &m.last_force, &m.place, &m.force, &m.place_before, &m.force_before}) {
        vectors->resize(std::size_t(*at++));
        for (Vec3& v : *vectors) v = {at[0], at[1], at[2]}, at += 3;
    }
}

void SolidBody::find_selective_mass(const std::vector<double>& vibration) {
    if (!solid_.constraints.empty())
        throw DeckError("a solid whose particles are heavier against their neighbours cannot be held");
    const double step = stable_step();   // of its own mass
    std::vector<double> scaling;
    for (const double square : vibration)
        scaling.push_back(numerics_.mass_scaling * std::max(1.0, square * step * step / (borne_angle * borne_angle)));
    selective_.emplace(particles(), numerics_.spacing, scaling);
}

void SolidBody::find_constrained() {
    constrained_.assign(solid_.constraints.size(), {});
    reactions_.assign(solid_.constraints.size(), Vec3{});
    for (std::size_t i = 0; i < particles().size(); ++i)
        if (particles().constraint[i] != 0)
            constrained_.at(std::size_t(particles().constraint[i] - 1)).push_back(std::uint32_t(i));
}

}   // namespace patency
