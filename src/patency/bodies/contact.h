// SPDX-License-Identifier: Apache-2.0
// Solids that touch: vertices of a surface that have gone into another surface, or into something rigid, are pushed out,
// and what they are pushed from is pushed back. By the signed distance to the surfaces themselves, so that spacings may
// differ and nothing stands off. Forces are equal and opposite to round-off.             THEORY (21.5) to (21.11)
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "patency/bodies/solid_surface.h"
#include "patency/physics/solid/contact.h"

namespace patency {

struct ContactNumerics {
    double friction = 0;   ///< Coulomb's coefficient
    double damping = 0;    ///< of the approach, over the critical                                     THEORY (21.9)
    double step = 0;       ///< the time step that the stiffness is set for [s]
    Hold hold{};   ///< of pushes between surfaces that last                                       THEORY (21.11)
};

/// What happened since the start, and the state now.
struct ContactReport {
    double energy = 0;          ///< stored in the pushes and sticks now [J]
    double friction_loss = 0;   ///< [J]
    double damping_loss = 0;    ///< [J]
    double work = 0;            ///< by what moves something rigid [J]
    double deepest = 0;         ///< largest depth so far [m]
    Vec3 force{};               ///< on the first surface now [N]
    double normal_force = 0;    ///< sum of the pushes' lengths now, friction apart [N]
    double pressure = 0;        ///< of a radial tool on the length that it touches now [Pa]          THEORY (21.13)
    std::size_t touching = 0;   ///< vertices now
};

class Contact {
public:
    virtual ~Contact() = default;
    /// Adds to the forces of the surfaces' vertices as they are at `time`; dt: since the last call [s].
    virtual void add_forces(double time, double dt) = 0;
    virtual ContactReport report() const = 0;
    /// Pushes on the vertices of the first surface now, where there are any.
    struct Push {
        std::uint32_t vertex;
        Vec3 force;   ///< [N]
    };
    virtual std::vector<Push> pushes() const = 0;

    /// All that the next step and the report depend on beside the surfaces, for a checkpoint; taken back as it was given.
    virtual std::vector<double> state() const = 0;
    virtual void restore(std::span<const double> state) = 0;
};

/// Each surface's vertices against the other's elements; the same surface twice: its parts against each other, near ones
/// along it left out.
std::unique_ptr<Contact> make_surface_contact(SolidSurface& first, SolidSurface& second,
                                              const ContactNumerics& numerics);

/// Where a vertex is in something rigid.
struct RigidHit {
    double depth = 0;   ///< [m]; zero or less: it is not in
    Vec3 normal{};      ///< of the way out, unit
    Vec3 velocity{};    ///< of the rigid surface there [m/s]
};

/// Vertices of a surface against something rigid: hit_of(vertex, place [m], time [s]), called from many threads.
class RigidContact final : public Contact {
public:
    using HitOf = std::function<RigidHit(std::size_t vertex, const Vec3& place, double time)>;
    RigidContact(SolidSurface& surface, HitOf hit_of, const ContactNumerics& numerics);

    void add_forces(double time, double dt) override;
    ContactReport report() const override;
    std::vector<Push> pushes() const override;
    std::vector<double> state() const override;
    void restore(std::span<const double> state) override;

private:
    struct Touch {
        Vec3 force{}, normal{};                                 // [N], unit
        double push = 0, unsprung = 0, depth = 0, energy = 0;   // N, N, m, J
        double approach = 0, tool_speed = 0;                    // before the step; along the normal [m/s]
        double friction_loss = 0, damping_loss = 0, work = 0;   // in the last step [J]
    };
    Touch touch_at(std::size_t v, double time, double dt);

    SolidSurface& surface_;
    HitOf hit_of_;
    ContactNumerics numerics_;
    std::vector<Vec3> stick_;
    std::vector<Touch> touches_;
    double friction_loss_ = 0, damping_loss_ = 0, work_ = 0, deepest_ = 0, last_step_ = 0;
};

/// A rigid plane at rest; normal: unit, to the solid.
std::unique_ptr<Contact> make_plane_contact(SolidSurface& surface, const Vec3& point, const Vec3& normal,
                                            const ContactNumerics& numerics);

}   // namespace patency
