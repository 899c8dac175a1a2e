// SPDX-License-Identifier: Apache-2.0
// A solid body by total Lagrangian particles: neighbours are those of the reference configuration, found once; the
// deformation gradient comes from the positions, forces from the stress; both momenta are conserved. The verbs of a step
// (position Verlet) are called by a scheme of one or several bodies. Does not know of other bodies.       THEORY (20)
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "patency/bodies/solid.h"
#include "patency/kernel/kernel.h"
#include "patency/pairs/sum_over_neighbours.h"
#include "patency/schemes/precision.h"
#include "patency/schemes/selective_mass.h"

namespace patency {

/// Of the step, where F is of second order: its stiffest mode is that much stiffer.                      THEORY (20.18)
inline constexpr double second_order_share = 0.9;

/// Numbers of the scheme. Their reasons stand where they are used.
struct SolidNumerics {
    double spacing = 0;              ///< dp [m]
    double smoothing_ratio = 1.15;   ///< h / dp
    bool second_order =
        false;   ///< F also beside a surface, where neighbours stand on one side; half as much work again   THEORY (20.18)
    bool planar = false;       ///< plane strain, z = 0
    bool across_gaps = true;   ///< whether particles are neighbours that no third one joins
    double cfl = 0.6;          ///< of the P-wave over h
    double hourglass =
        1;   ///< stiffness against what no linear deformation explains, over the shear modulus   THEORY (20.6)
    double mass_scaling = 1;   ///< of particles against their neighbours, not of what they do together   THEORY (20.17)
    double viscosity = 0;      ///< alpha: pairs part or approach against alpha rho c h                 THEORY (20.9)
    Precision precision = Precision::double_precision;
    LoopKind loop = LoopKind::packed;

    WendlandC2 kernel() const { return {smoothing_ratio * spacing, planar}; }
    double cell() const { return planar ? spacing * spacing : spacing * spacing * spacing; }
};

/// Where the energy of a body is, and where it came from and went since the start [J; planar: J/m].
struct SolidEnergy {
    double kinetic = 0, elastic = 0, hourglass = 0;
    double plastic = 0;     ///< work of flow, lost as heat
    double yielded = 0;     ///< hourglass energy given up where the metal flows                    THEORY (20.16)
    double viscous = 0;     ///< lost to the viscosity between particles
    double drag = 0;        ///< lost to the drag of dynamic relaxation
    double load_work = 0;   ///< by loads, gravity and contact among them
    double constraint_work = 0;

    double internal() const { return elastic + hourglass + plastic; }
    double lost() const { return yielded + viscous + drag; }
};

class SolidBody {
public:
    virtual ~SolidBody() = default;

    /// The longest stable step now [s]: P-waves in the deformed body.                                   THEORY (20.12)
    double stable_step() const;
    /// x += dt v; constrained axes go to their place at `time`, the end of the drift.
    void drift(double dt, double time);
    /// Overwrites particles.force [N]; metals flow. Throws DivergedError with particle, place and `time` if one is inside
    /// out.
    virtual void compute_force(double time) = 0;
    /// v += dt (force + load) / mass - dt drag v, over the step that begins at `time`; constrained axes take their velocity.
    void kick(double dt, double time, double drag = 0);
    /// The circular frequency [1/s] at which the body answers to its present motion: Rayleigh's quotient of the last two forces, dt
    /// apart; once it hardly moves any more, that of its slow mode, from means. For adaptive relaxation, once in every step after
    /// compute_force; zero at first.                                                                THEORY (20.14)
    double find_present_frequency(double dt);
    void forget_motion() { motion_ = {}; }   ///< where it is not relaxed

    /// F of the particles where they are now; compute_force does it too. A step leaves F of its middle. Throws DivergedError
    /// as compute_force does, at the time of the last drift.
    virtual void compute_deformation() = 0;
    virtual Mat3 deformation(std::size_t i) const = 0;   ///< F as last computed
    Mat3 cauchy(std::size_t i) const;                    ///< stress [Pa] at that deformation
    SolidEnergy energy();                                ///< of the particles where they are now
    /// What constraint (from 0) gave so far [N s].
    const Vec3& reaction_impulse(std::size_t constraint) const { return reactions_.at(constraint); }
    virtual double mean_neighbours() const = 0;

    /// What the next step and the reports depend on beside the particles, for a checkpoint; taken back as it was given.
    virtual std::vector<double> state() const;
    virtual void restore(std::span<const double> state);

    const Solid& solid() const { return solid_; }
    SolidParticles& particles() { return solid_.particles; }
    const SolidParticles& particles() const { return solid_.particles; }
    const SolidMaterial& material(std::size_t i) const {
        return solid_.materials[std::size_t(particles().material[i])];
    }
    const SolidNumerics& numerics() const { return numerics_; }

protected:
    SolidBody(Solid& solid, const SolidNumerics& numerics) : solid_(solid), numerics_(numerics) {}
    /// To be called when the particles have their final order.
    void find_constrained();
    /// Of a body whose mass_scaling is not 1. vibration: what the squares of its particles' circular frequencies against their neighbours
    /// are at the most [1/s^2]. Throws DeckError for one that is held.                               THEORY (20.17), (20.20)
    void find_selective_mass(const std::vector<double>& vibration);
    /// Whatever the loops need of positions and velocities; before they run.
    virtual void write_records() = 0;
    virtual double hourglass_energy() const = 0;   ///< [J]
    virtual double viscous_power() const = 0;      ///< [W] of the last compute_force

    Solid& solid_;
    SolidNumerics numerics_;
    double time_ = 0;      ///< to which the particles drifted [s]
    double yielded_ = 0;   ///< hourglass energy given up so far [J]

private:
    struct Powers {
        double load, drag;   // [W]
    };
    Powers kick_free(double dt, double drag);
    Powers kick_selectively(double dt, double drag);
    void kick_constrained(double dt, double time);
    double kinetic() const;
    double elastic_energy();   ///< [J]; finds F as energy() does

    std::vector<std::vector<std::uint32_t>> constrained_;   // particles, by constraint
    std::vector<Vec3> reactions_;
    // Of the motion that is to be relaxed. A mean lasts as long as the slow mode turns by a third; what trembles goes to and fro
    // in it many times.
    static constexpr double turn_in_mean = 0.3,
                            share_at_rest = 1e-3;   // of the largest kinetic energy, and of the body's own elastic one
    static constexpr int least_steps_of_mean = 8;
    struct Motion {
        std::vector<Vec3> last_force, place, force;     // place, force: sums over the steps of this mean
        std::vector<Vec3> place_before, force_before;   // means before
        int steps = 0, steps_of_mean = least_steps_of_mean;
        double frequency = 0;   // between the last two means [1/s]
        double most = 0;        // twice the largest kinetic energy [J]
        double elastic = 0;     // in the last mean, of a body that hardly moves any more [J]
    } motion_;
    void take_means(double dt);
    std::optional<SelectiveMass> selective_;
    std::vector<Vec3> momentum_, middle_momentum_, old_velocity_;   // of a body with selective mass
    double viscous_ = 0, drag_ = 0, load_work_ = 0, constraint_work_ = 0;
};

/// The scheme of a body, which must outlive it and whose particles it sorts. Throws GeometryError if a particle's neighbours
/// lie in one plane (planar: on one line): at least three particles are needed across every part.
std::unique_ptr<SolidBody> make_solid_body(Solid& solid, const SolidNumerics& numerics);

}   // namespace patency
