// SPDX-License-Identifier: Apache-2.0
// What passes through the sides of cells, as arithmetic: volume and momentum over density. Pressures are over density too;
// any consistent units will do. THEORY.md section 18.
#pragma once

#include "patency/base/vec.h"

namespace patency::cell_terms {

/// A cell's values and their gradients at its point.
struct CellState {
    double p;   ///< pressure over density
    Vec3 u;     ///< velocity
    Vec3 grad_p;
    Mat3 grad_u;   ///< row a: gradient of u_a
    double nu;     ///< kinematic viscosity
    double c;      ///< artificial sound speed, THEORY.md (18.8)

    double p_at(const Vec3& d) const { return p + dot(grad_p, d); }
    Vec3 u_at(const Vec3& d) const { return u + grad_u * d; }
};

struct Flux {
    double volume;
    Vec3 momentum;
};

/// The artificial sound speed of a cell of width h.                                            THEORY.md (18.8)
inline double sound_speed(double kappa, double speed, double nu, double h) { return kappa * (speed + 4 * nu / h); }

/// How faces carry the velocity: so much of it is what the side upstream extrapolates, the rest is the mean of both sides; and the
/// second moment of a face over its squared area, 0 to leave out what varies along it. All of it is of second order; what comes from
/// upstream adds a friction of fourth order.                                                   THEORY.md (18.5), (18.15)
struct Transport {
    double upwinding, second_moment;
};
/// Half of the upstream's word damps what swings on the way to a flow, and jets on few cells.
inline constexpr Transport damped{0.5, 0};
/// With it the boundary layer behind a plug at D/12 errs a third as much. 1 / 12.5: of a hexagon and of a disc; a square has 1 / 12.
inline constexpr Transport sharp{0.2, 1 / 12.5};

/// What a velocity that varies over a side carries beyond its mean: size times the mean of (u' . n) u', u' = grad u d, with d
/// of a face that is about as wide as long.                                                     THEORY.md (18.15)
inline Vec3 carried_by_spread(double size, const Vec3& normal, const Mat3& grad_u, double second_moment) {
    const Vec3 slope = transpose(grad_u) * normal;
    return size * second_moment * size * (grad_u * (slope - dot(slope, normal) * normal));
}

/// From a to b through their face: area vector A, conductance |A| / r, and the way from either point to the centroid.
struct Face {
    Vec3 area;
    double size, conductance;
    Vec3 from_a, from_b;
};

/// Mean values carry mass and pressure; what the pressures on both sides differ by stabilises the flow, and vanishes for a
/// linear pressure. Swapping a and b flips the sign.                                            THEORY.md (18.4), (18.5)
inline Flux through_face(const Face& face, const CellState& a, const CellState& b, const Transport& transport,
                         bool is_newtonian) {
    const Vec3 off = 0.5 * (face.from_a + face.from_b);   // from the middle of the points to the centroid
    const Mat3 grad_u = 0.5 * (a.grad_u + b.grad_u);
    const Vec3 mean_u = 0.5 * (a.u + b.u) + grad_u * off;
    const double mean_p = 0.5 * (a.p + b.p) + 0.5 * dot(a.grad_p + b.grad_p, off);
    const double volume =
        dot(face.area, mean_u) - face.size / (a.c + b.c) * (b.p_at(face.from_b) - a.p_at(face.from_a));
    const Vec3 upstream = volume > 0 ? a.u_at(face.from_a) : b.u_at(face.from_b);
    const Vec3 carried = mean_u + transport.upwinding * (upstream - mean_u);
    const double nu = 0.5 * (a.nu + b.nu);
    Vec3 momentum = volume * carried +
                    carried_by_spread(face.size, (1 / face.size) * face.area, grad_u, transport.second_moment) +
                    mean_p * face.area - nu * face.conductance * (b.u - a.u);
    if (!is_newtonian) momentum -= nu * (transpose(grad_u) * face.area);
    return {volume, momentum};
}

/// The slope of the velocity along the wall's normal into the blood [velocity / length]: the parabola through the wall's
/// zero and the cell's value with the cell's slope. d: from the cell's point to the wall, distance: across it. THEORY.md (18.6)
inline Vec3 wall_slope(const CellState& cell, const Vec3& d, double distance) {
    return (cell.u + cell.u_at(d)) / distance;
}

/// What goes into a wall at rest: no volume. wall_nu: the viscosity at the wall's shear rate.    THEORY.md (18.7)
inline Flux into_wall(const CellState& cell, const Vec3& area, const Vec3& d, double distance, double wall_nu) {
    return {0, cell.p_at(d) * area + wall_nu * norm(area) * wall_slope(cell, d, distance)};
}
/// Into a wall that slips or a plane of symmetry.
inline Flux into_slip(const CellState& cell, const Vec3& area, const Vec3& d) { return {0, cell.p_at(d) * area}; }

/// Through an opening where the velocity u is imposed, which varies along it by grad_u.         THEORY.md (18.9)
inline Flux through_imposed(const CellState& cell, const Vec3& area, const Vec3& d, double distance, const Vec3& u,
                            const Mat3& grad_u, const Transport& transport) {
    const double volume = dot(u, area), size = norm(area);
    return {volume, volume * u + carried_by_spread(size, (1 / size) * area, grad_u, transport.second_moment) +
                        cell.p_at(d) * area - cell.nu * size / distance * (u - cell.u)};
}
/// The cell's velocity where an opening's patch lies along the opening, by at most half of itself more or less: in a cell whose
/// neighbours lie askew the slope alone may say anything. Across the opening it is the cell's own: blood that comes back would be sped
/// up by its own slope.                                                                         THEORY.md (18.10)
inline Vec3 velocity_along(const CellState& cell, const Vec3& area, const Vec3& d) {
    constexpr double share = 0.5;
    const Vec3 change = cell.grad_u * (d - (dot(d, area) / dot(area, area)) * area);
    const double size = norm(change), most = share * norm(cell.u);
    return cell.u + (size > most ? most / size : 1.0) * change;
}
/// Through an opening where the pressure is imposed; the volume of it that does not depend on the pressure is free_volume.
///                                                                                              THEORY.md (18.10)
inline double free_volume(const CellState& cell, const Vec3& area, const Vec3& d) {
    return dot(velocity_along(cell, area, d), area) + norm(area) / cell.c * cell.p_at(d);
}
/// What goes out carries the cell's velocity; what comes in brings `entering`: with its own again an inflow would feed itself.
inline Flux through_open(const CellState& cell, const Vec3& area, const Vec3& d, double pressure, const Vec3& entering,
                         const Transport& transport) {
    const double volume = free_volume(cell, area, d) - norm(area) / cell.c * pressure;
    const double size = norm(area);
    const Vec3 spread =
        volume < 0 ? Vec3{} : carried_by_spread(size, (1 / size) * area, cell.grad_u, transport.second_moment);
    return {volume, volume * (volume < 0 ? entering : velocity_along(cell, area, d)) + spread + pressure * area};
}

/// An opening whose pressure answers to its flow, p = p0 + R q, with q = free - conductance p: both at once. THEORY.md (18.11)
struct OpenResponse {
    double p0, resistance;

    double pressure(double free, double conductance) const {
        return (p0 + resistance * free) / (1 + resistance * conductance);
    }
    /// How the pressure answers to the free flow.
    double slope(double conductance) const { return resistance / (1 + resistance * conductance); }
};

}   // namespace patency::cell_terms
