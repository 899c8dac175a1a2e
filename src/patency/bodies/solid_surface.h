// SPDX-License-Identifier: Apache-2.0
// The surface of a solid, carried by its particles: every vertex moves with a linear fit to the particles around it, by
// weights that are found once; what pushes a vertex pushes those particles by the same weights. So forces keep momentum
// and angular momentum, do the work they should, and act where the real surface is.               THEORY (21.1) to (21.4)
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "patency/bodies/solid.h"

namespace patency {

/// Triangles, counter-clockwise seen from outside; in the plane segments, the solid on their left.
struct SurfaceElements {
    std::vector<Vec3> vertices;                           ///< in the reference configuration [m]
    std::vector<std::array<std::uint32_t, 3>> elements;   ///< of a segment the third is the second again
    std::vector<std::uint16_t> face;                      ///< index into faces, one per element
    std::vector<std::string> faces;                       ///< names
};

/// Numbers in rows of different lengths.
template <class T>
struct Ragged {
    std::vector<std::uint32_t> start{0};   ///< of every row, and the end
    std::vector<T> items;

    std::size_t rows() const { return start.size() - 1; }
    const T* begin(std::size_t row) const { return items.data() + start[row]; }
    const T* end(std::size_t row) const { return items.data() + start[row + 1]; }
};

class SolidSurface {
public:
    /// support [m]: how far a vertex looks for particles. Particles must be in their final order.
    /// Throws GeometryError if one finds too few to carry it.
    SolidSurface(SurfaceElements mesh, const SolidParticles& particles, double support, bool planar);

    std::size_t size() const { return position.size(); }
    bool planar() const { return planar_; }
    const SurfaceElements& mesh() const { return mesh_; }
    /// Elements at each vertex.
    const Ragged<std::uint32_t>& elements_at() const { return elements_at_; }

    /// Places of the vertices; forces to zero. The particles must stay where they are, and outlive what asks for velocities.
    void follow(const SolidParticles& particles);
    /// Of a vertex [m/s], with the particles' as they are now: most vertices touch nothing, and nobody asks for theirs.
    Vec3 velocity(std::size_t vertex) const;
    /// Of an element as it is now, outward [m^2; planar: m].
    Vec3 area_vector(std::size_t element) const {
        const auto& [a, b, c] = mesh_.elements[element];
        const Vec3 ab = position[b] - position[a];
        return planar_ ? Vec3{ab.y, -ab.x, 0} : 0.5 * cross(ab, position[c] - position[a]);
    }
    /// force += -pressure [Pa] times the outward area of the face as it is now, a third (a half) to each vertex.
    ///                                                                                             THEORY (21.4)
    void add_pressure(std::uint16_t face, double pressure);
    /// particles.load += the vertices' forces.
    void push(SolidParticles& particles) const;

    /// What the particles near each vertex have, in its unit, by the weights that carry the vertex.
    std::vector<double> carried(const std::vector<double>& by_particle) const;

    /// The mass [kg] that answers a push on a vertex: 1 over sum N^2/m.                                THEORY (21.3)
    double mass(std::size_t vertex) const { return mass_[vertex]; }
    /// Area [m^2; planar: m] in the reference configuration, a third of each of its elements.
    double area(std::size_t vertex) const { return area_[vertex]; }

    std::vector<Vec3> position, force;   ///< by vertex: m, N

private:
    struct Share {
        std::uint32_t index;
        double weight;
    };
    void find_carriers(const SolidParticles& particles, double support);
    void find_elements_at();
    void transpose_carriers(const SolidParticles& particles);
    Vec3 carried_at(std::size_t vertex, const Field<Vec3>& field) const;

    SurfaceElements mesh_;
    const SolidParticles* followed_ = nullptr;
    bool planar_;
    Ragged<Share> carriers_;   // of a vertex: particles
    Ragged<Share> carried_;    // of a carrier: vertices
    std::vector<std::uint32_t> carrier_particles_;
    Ragged<std::uint32_t> elements_at_;
    std::vector<double> mass_, area_;
};

}   // namespace patency
