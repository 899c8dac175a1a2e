// SPDX-License-Identifier: Apache-2.0
#include "patency/cells/cell_mesh.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "patency/base/errors.h"
#include "patency/cells/point_tree.h"
#include "tests/cells/point_sets.h"

namespace patency {
namespace {

using testing_cells::PointSet;
using testing_cells::shaken_lattice;

constexpr double pi = std::numbers::pi;
const RigidMotion tilt = motion_along({1, 2, -0.5}, {0.3, -0.2, 0.1});

CellMesh mesh_of(const PointSet& set, const Lumen& lumen) { return make_cell_mesh(set.point, set.spacing, lumen); }

/// The largest sum of a cell's areas, over the largest area of its sides.
double largest_gap(const CellMesh& mesh) {
    double worst = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        Vec3 sum{};
        double largest = 0;
        const auto add = [&](const Vec3& area) { sum += area, largest = std::max(largest, norm(area)); };
        for (const CellNeighbour& n : mesh.neighbours(i))
            add((mesh.faces[n.face].a == i ? 1.0 : -1.0) * mesh.faces[n.face].area);
        for (const CellPatch& patch : mesh.patches_of(i)) add(patch.area);
        worst = std::max(worst, norm(sum) / largest);
    }
    return worst;
}

double total_volume(const CellMesh& mesh) { return std::accumulate(mesh.volume.begin(), mesh.volume.end(), 0.0); }
double wall_area(const CellMesh& mesh) {
    double sum = 0;
    for (const CellPatch& patch : mesh.patches)
        if (patch.opening == CellPatch::wall) sum += norm(patch.area);
    return sum;
}

/// Corners and edges where two and three walls meet, openings, and a lumen that is no box.
std::vector<Lumen> lumens() {
    return {make_box({.size = {1, 0.8, 0.6}}),
            make_box({.size = {1, 0.8, 0.6}, .sides = {Side::open, Side::wall, Side::wall}}),
            make_tube({.length = 1, .radius = 0.4}),
            make_cone({.length = 1, .inlet_radius = 0.45, .outlet_radius = 0.3}),
            make_nozzle({{{0, 0.25}, {0.5, 0.25}, {0.5, 0.45}, {1, 0.45}}})};
}

TEST(PointTree, findsAllPointsAndNoOthers) {
    const PointSet set = shaken_lattice(make_box({.size = {1, 0.5, 0.5}}), 0.05, 0.4);
    const std::vector<std::uint32_t> order = find_compact_order(set.point);
    std::vector<Vec3> points;
    for (const std::uint32_t i : order) points.push_back(set.point[i]);
    std::vector<std::uint32_t> all = order, found, slow;
    std::sort(all.begin(), all.end());
    for (std::uint32_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i) << "a permutation";
    const PointTree tree(points);
    for (const Vec3& x : {Vec3{0.5, 0.2, 0.3}, Vec3{0, 0, 0}, Vec3{2, 0, 0}}) {
        found.clear(), slow.clear();
        tree.find(x, 0.17, found);
        for (std::uint32_t j = 0; j < points.size(); ++j)
            if (dot(points[j] - x, points[j] - x) < 0.17 * 0.17) slow.push_back(j);
        EXPECT_EQ(found, slow);
    }
}

TEST(CellMesh, ofALatticeIsOfCubes) {
    const double h = 0.1;
    const Lumen box = make_box({.size = {1, 0.8, 0.6}, .sides = {Side::open, Side::wall, Side::wall}});
    const CellMesh mesh = mesh_of(shaken_lattice(box, h, 0), box);
    ASSERT_EQ(mesh.size(), 480u);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        ASSERT_NEAR(mesh.volume[i], h * h * h, 1e-14);
        ASSERT_EQ(mesh.neighbours(i).size() + mesh.patches_of(i).size(), 6u);
    }
    for (const CellFace& face : mesh.faces) {
        ASSERT_NEAR(norm(face.area), h * h, 1e-14);
        ASSERT_NEAR(face.conductance, h, 1e-14);
        ASSERT_LT(norm(face.centroid - 0.5 * (mesh.point[face.a] + mesh.point[face.b])), 1e-14);
    }
    for (const CellPatch& patch : mesh.patches) {
        ASSERT_NEAR(patch.distance, 0.5 * h, 1e-14);
        ASSERT_LT(norm(patch.area - h * h * patch.normal), 1e-13);
    }
}

TEST(CellMesh, closesEveryCellToRoundOff) {
    for (const Lumen& lumen : lumens())
        for (const double shake : {0.0, 0.3}) {
            const CellMesh mesh = mesh_of(shaken_lattice(lumen, 0.09, shake, motion_along({1, 0.2, 0.1}, {})), lumen);
            ASSERT_GT(mesh.size(), 200u);
            EXPECT_LT(largest_gap(mesh), 1e-13);
        }
}

// Edges and corners of a box are cut by two and three planes: nothing is lost and nothing too much.
TEST(CellMesh, fillsABoxOfDisorder) {
    const Lumen box = make_box({.size = {1, 0.8, 0.6}, .sides = {Side::open, Side::wall, Side::wall}});
    const CellMesh mesh = mesh_of(shaken_lattice(box, 0.09, 0.3, motion_along({1, 0.2, 0.1}, {})), box);
    EXPECT_NEAR(total_volume(mesh), box.volume, 1e-12);
    EXPECT_NEAR(wall_area(mesh), box.wall_area, 1e-3 * box.wall_area) << "areas of two cells differ at the wall";
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(mesh.opening_area[k], box.openings[k].area, 1e-14);
}

TEST(CellMesh, approachesATubeAtSecondOrder) {
    const Lumen tube = make_tube({.length = 0.4, .radius = 0.4});
    double volume[2], area[2];
    for (const int k : {0, 1}) {
        const CellMesh mesh = mesh_of(shaken_lattice(tube, k == 0 ? 0.05 : 0.025, 0.2), tube);
        volume[k] = total_volume(mesh) / tube.volume - 1;
        area[k] = wall_area(mesh) / tube.wall_area - 1;
        EXPECT_NEAR(mesh.opening_area[1], tube.openings[1].area, 1e-13);
    }
    // A circle in a polygon of sides h: the area is too large by h^2 / 12 R^2, 0.13 % for even sides; these are not.
    EXPECT_LT(std::abs(volume[0]), 0.004);
    EXPECT_LT(std::abs(area[0]), 0.004);
    EXPECT_GT(std::log2(volume[0] / volume[1]), 1.8);
    EXPECT_GT(std::log2(area[0] / area[1]), 1.8);
}

// Gauss: the volume of a cell is a third of the flux of x through its sides.
TEST(CellMesh, hasCentroidsThatGiveItsVolumes) {
    const Lumen box = make_box({.size = {1, 0.8, 0.6}});
    const CellMesh mesh = mesh_of(shaken_lattice(box, 0.09, 0.3), box);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        double flux = 0;
        for (const CellNeighbour& n : mesh.neighbours(i)) {
            const CellFace& face = mesh.faces[n.face];
            flux += (face.a == i ? 1.0 : -1.0) * dot(face.area, face.centroid - mesh.point[i]);
        }
        for (const CellPatch& patch : mesh.patches_of(i)) flux += dot(patch.area, patch.centroid - mesh.point[i]);
        if (mesh.patches_of(i).empty()) {
            ASSERT_NEAR(flux / 3, mesh.volume[i], 1e-13);
        }
    }
}

TEST(CellMesh, turnsWithItsPoints) {
    const Lumen tube = make_tube({.length = 1, .radius = 0.4}), turned = moved(tube, tilt);
    const PointSet set = shaken_lattice(tube, 0.1, 0.3);
    PointSet turned_set = set;
    for (Vec3& x : turned_set.point) x = tilt.place(x);
    const CellMesh a = mesh_of(set, tube), b = mesh_of(turned_set, turned);
    std::vector<std::size_t> where(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) where[b.source[i]] = i;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::size_t j = where[a.source[i]];
        ASSERT_NEAR(a.volume[i], b.volume[j], 1e-13);
        Vec3 p{}, q{};
        for (const CellPatch& patch : a.patches_of(i)) p += patch.area;
        for (const CellPatch& patch : b.patches_of(j)) q += patch.area;
        ASSERT_LT(norm(tilt.turn(p) - q), 1e-12);
    }
}

TEST(CellMesh, isTheSameForAnyNumberOfThreads) {
    const Lumen tube = make_tube({.length = 1, .radius = 0.4});
    const PointSet set = shaken_lattice(tube, 0.05, 0.3);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const CellMesh one = mesh_of(set, tube);
    omp_set_num_threads(4);
    const CellMesh four = mesh_of(set, tube);
    omp_set_num_threads(threads);
    ASSERT_EQ(one.faces.size(), four.faces.size());
    EXPECT_EQ(one.volume, four.volume);
    for (std::size_t f = 0; f < one.faces.size(); ++f) ASSERT_EQ(one.faces[f].area, four.faces[f].area);
    for (std::size_t k = 0; k < one.patches.size(); ++k) ASSERT_EQ(one.patches[k].area, four.patches[k].area);
}

TEST(CellMesh, takesPointsOfAnySpacing) {
    // Three quarters of the way the spacing halves at once.
    const Lumen box = make_box({.size = {1, 0.4, 0.4}, .sides = {Side::open, Side::wall, Side::wall}});
    const PointSet coarse = shaken_lattice(box, 0.1, 0.2), fine = shaken_lattice(box, 0.05, 0.2);
    PointSet set;
    for (const PointSet* from : {&coarse, &fine})
        for (std::size_t i = 0; i < from->point.size(); ++i)
            if ((from->point[i].x < 0.7) == (from == &coarse)) {
                set.point.push_back(from->point[i]);
                set.spacing.push_back(from->spacing[i]);
            }
    const CellMesh mesh = mesh_of(set, box);
    EXPECT_LT(largest_gap(mesh), 1e-13);
    EXPECT_NEAR(total_volume(mesh), box.volume, 1e-12);
}

TEST(CellMesh, makesASlabOfAPlane) {
    const Lumen channel = make_channel({.length = 1, .gap = 0.5});
    const CellMesh mesh = mesh_of(shaken_lattice(channel, 0.1, 0.2), channel);
    EXPECT_NEAR(mesh.depth, 0.1, 1e-15);
    EXPECT_NEAR(total_volume(mesh) / mesh.depth, channel.volume, 1e-12);
    EXPECT_NEAR(mesh.opening_area[0], 0.5 * mesh.depth, 1e-15);
    for (std::size_t i = 0; i < mesh.size(); ++i)
        EXPECT_EQ(std::count_if(mesh.patches_of(i).begin(), mesh.patches_of(i).end(),
                                [](const CellPatch& p) { return p.opening == CellPatch::symmetry; }),
                  2);
}

TEST(CellMesh, leadsPointsBackFromTheWall) {
    const Lumen tube = make_tube({.length = 1, .radius = 0.4});
    PointSet set = shaken_lattice(tube, 0.1, 0);
    set.point.push_back({0.5, 0.3999, 0.02});
    set.spacing.push_back(0.1);
    const CellMesh mesh = mesh_of(set, tube);
    EXPECT_GE(mesh.led_back, 1u);
    for (const CellPatch& patch : mesh.patches) ASSERT_GT(patch.distance, 0.02);
    EXPECT_LT(largest_gap(mesh), 1e-13);
}

TEST(CellMesh, refusesWhatHasNoCells) {
    const Lumen tube = make_tube({.length = 1, .radius = 0.4});
    const PointSet good = shaken_lattice(tube, 0.1, 0);
    const auto with = [&](const Vec3& x, double spacing) {
        PointSet set = good;
        set.point.push_back(x);
        set.spacing.push_back(spacing);
        return mesh_of(set, tube);
    };
    EXPECT_THROW(mesh_of({}, tube), GeometryError);
    EXPECT_THROW(with({0.5, 0.7, 0}, 0.1), GeometryError) << "outside";
    EXPECT_THROW(with({1.05, 0, 0}, 0.1), GeometryError) << "past the opening";
    EXPECT_THROW(with(good.point[0], 0.1), GeometryError) << "twice the same place";
    EXPECT_THROW(with({0.5, 0, NAN}, 0.1), GeometryError);
    EXPECT_THROW(with({0.5, 0, 0}, -1), GeometryError);
    PointSet hole = good;
    for (std::size_t i = 0; i < hole.point.size(); ++i) hole.spacing[i] = 0.01;
    EXPECT_THROW(mesh_of(hole, tube), GeometryError) << "too far apart for their spacing";
}

}   // namespace
}   // namespace patency
