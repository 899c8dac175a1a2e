// SPDX-License-Identifier: Apache-2.0
#include "patency/cells/cell_gradients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/cells/point_sets.h"

namespace patency {
namespace {

using testing_cells::shaken_lattice;
using Field = std::function<double(const Vec3&)>;

std::vector<Vec3> gradient_of(const Field& f, const CellMesh& mesh, const CellGradients& gradients) {
    std::vector<Vec3> result(mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const double here = f(mesh.point[i]);
        result[i] = here * gradients.self[i];
        for (std::size_t k = mesh.row_start[i]; k < mesh.row_start[i + 1]; ++k)
            result[i] += (f(mesh.point[mesh.row[k].cell]) - here) * gradients.row[k];
        for (std::size_t k = mesh.patch_start[i]; k < mesh.patch_start[i + 1]; ++k)
            result[i] += (f(mesh.patches[k].centroid) - here) * gradients.patch[k];
    }
    return result;
}

const Vec3 slope{0.3, -2, 0.7};

TEST(CellGradients, areExactForLinearFields) {
    const Lumen tube = make_tube({.length = 1, .radius = 0.4});
    const auto set = shaken_lattice(tube, 0.1, 0.3);
    const CellMesh mesh = make_cell_mesh(set.point, set.spacing, tube);
    for (const std::vector<char>& known : {std::vector<char>{0, 0}, {1, 0}, {1, 1}})
        for (const Vec3& g :
             gradient_of([](const Vec3& x) { return 5 + dot(slope, x); }, mesh, make_gradients(mesh, known)))
            ASSERT_LT(norm(g - slope), 1e-9);
}

TEST(CellGradients, areExactInASlab) {
    const Lumen channel = make_channel({.length = 1, .gap = 0.5});
    const auto set = shaken_lattice(channel, 0.1, 0.3);
    const CellMesh mesh = make_cell_mesh(set.point, set.spacing, channel);
    const Vec3 planar{0.3, -2, 0};
    for (const Vec3& g : gradient_of([&](const Vec3& x) { return dot(planar, x); }, mesh,
                                     make_gradients(mesh, std::vector<char>{1, 0})))
        ASSERT_LT(norm(g - planar), 1e-9);
}

bool is_at_wall(const CellMesh& mesh, std::size_t i) {
    const auto patches = mesh.patches_of(i);
    return std::any_of(patches.begin(), patches.end(), [](const CellPatch& p) { return p.opening == CellPatch::wall; });
}

/// The largest error of the slope across the wall, over the slope, in the cells at the wall.
double worst_slope(const Lumen& lumen, double h, const Field& profile, const std::function<Vec3(const Vec3&)>& exact) {
    const auto set = shaken_lattice(lumen, h, 0.3);
    const CellMesh mesh = make_cell_mesh(set.point, set.spacing, lumen);
    const auto found = gradient_of(profile, mesh, make_gradients_at_rest_on_walls(mesh, std::vector<char>{0, 0}));
    double worst = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (!is_at_wall(mesh, i)) continue;
        const Vec3 g = exact(mesh.point[i]);
        worst = std::max(worst, std::abs(dot(found[i] - g, mesh.wall_normal[i])) / norm(g));
    }
    return worst;
}

// Distance times a linear field, on any arrangement: Poiseuille's profile is one.
TEST(CellGradients, areExactForAParabolaAtAPlaneWall) {
    const Lumen channel = make_channel({.length = 1, .gap = 0.5});
    const auto error = worst_slope(
        channel, 0.06, [](const Vec3& x) { return x.y * (0.5 - x.y) * 4; },
        [](const Vec3& x) {
            return Vec3{0, 4 * (0.5 - 2 * x.y), 0};
        });
    EXPECT_LT(error, 1e-9);
}

// In a pipe the distance is curved, which costs (h/R)^2 / 8 or so.
TEST(CellGradients, areOfSecondOrderForAParabolaInAPipe) {
    const double radius = 0.4;
    const Lumen tube = make_tube({.length = 0.4, .radius = radius});
    double error[2];
    for (const int k : {0, 1})
        error[k] = worst_slope(
            tube, k == 0 ? 0.08 : 0.04, [&](const Vec3& x) { return radius * radius - x.y * x.y - x.z * x.z; },
            [](const Vec3& x) {
                return Vec3{0, -2 * x.y, -2 * x.z};
            });
    EXPECT_LT(error[0], 0.02);
    EXPECT_LT(error[1], error[0] / 3);
}

}   // namespace
}   // namespace patency
