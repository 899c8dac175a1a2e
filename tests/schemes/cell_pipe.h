// SPDX-License-Identifier: Apache-2.0
// For tests of flow on cells: blood, meshes of shaken lattices, and a pipe.
#pragma once

#include <numbers>
#include <vector>

#include "patency/schemes/cell_solver.h"
#include "tests/cells/point_sets.h"

namespace patency::testing_cells {

inline constexpr double pi = std::numbers::pi, density = 1060, mu = 3.5e-3;
inline const CellFluid blood{.density = density, .rheology = Newtonian{mu}};

inline CellMesh mesh_of(const Lumen& lumen, double spacing, double shake) {
    const PointSet set = shaken_lattice(lumen, spacing, shake);
    return make_cell_mesh(set.point, set.spacing, lumen);
}

inline CellFields still(const CellMesh& mesh) {
    return {std::vector<double>(mesh.size()), std::vector<Vec3>(mesh.size())};
}

/// A pipe of 4 mm: the parabola of mean speed U in, a pressure or a resistance behind the outlet.
struct Pipe {
    double radius = 2e-3, length = 8e-3, speed = 0.02, spacing;
    Lumen lumen = make_tube({.length = length, .radius = radius});
    CellMesh mesh;
    CellEnd inlet, outlet;

    explicit Pipe(double across, double shake = 0.2)
        : spacing(2 * radius / across), mesh(mesh_of(lumen, spacing, shake)) {
        inlet = {.kind = CellEnd::Kind::velocity,
                 .velocity =
                     [this](const Vec3& x) {
                         return Vec3{2 * speed * (1 - (x.y * x.y + x.z * x.z) / (radius * radius)), 0, 0};
                     },
                 .flow = -flow()};
    }
    Pipe(const Pipe&) = delete;
    double flow() const { return pi * radius * radius * speed; }
    double slope() const { return 8 * mu * speed / (radius * radius); }   // Pa/m
    double stress() const { return 4 * mu * speed / radius; }

    CellBalance balance(const CellFluid& fluid = blood) const {
        return CellBalance(mesh, fluid, std::vector{inlet, outlet}, 2 * speed);
    }
};

}   // namespace patency::testing_cells
