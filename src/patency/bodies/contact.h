// SPDX-License-Identifier: Apache-2.0
// Solids that touch: vertices of a surface that have gone into another surface, or through a rigid plane, are pushed out,
// and what they are pushed from is pushed back. By the signed distance to the surfaces themselves, so that spacings may
// differ and nothing stands off. Forces are equal and opposite to round-off.              THEORY (21.5) to (21.8)
#pragma once

#include <memory>

#include "patency/bodies/solid_surface.h"

namespace patency {

struct ContactNumerics {
    double friction = 0;   ///< Coulomb's coefficient
    double step = 0;       ///< the time step that the stiffness is set for [s]
};

/// What happened since the start, and the state now.
struct ContactReport {
    double energy = 0;          ///< stored in the pushes and sticks now [J]
    double friction_loss = 0;   ///< [J]
    double deepest = 0;         ///< largest depth so far [m]
    Vec3 force{};               ///< on the first surface now [N]
    std::size_t touching = 0;   ///< vertices now
};

class Contact {
public:
    virtual ~Contact() = default;
    /// Adds to the forces of the surfaces' vertices; dt: since the last call [s].
    virtual void add_forces(double dt) = 0;
    virtual ContactReport report() const = 0;
    /// Pushes on the vertices of the first surface now, where there are any.
    struct Push {
        std::uint32_t vertex;
        Vec3 force;   ///< [N]
    };
    virtual std::vector<Push> pushes() const = 0;
};

/// Each surface's vertices against the other's elements; the same surface twice: its parts against each other, near ones
/// along it left out.
std::unique_ptr<Contact> make_surface_contact(SolidSurface& first, SolidSurface& second, const ContactNumerics& numerics);

/// A rigid plane at rest; normal: unit, to the solid.
std::unique_ptr<Contact> make_plane_contact(SolidSurface& surface, const Vec3& point, const Vec3& normal, const ContactNumerics& numerics);

}   // namespace patency
