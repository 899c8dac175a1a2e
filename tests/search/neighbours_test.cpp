// SPDX-License-Identifier: Apache-2.0
// Rows are what looking at every pair would find, in any box, for any number of threads and lanes.
#include "patency/search/neighbours.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/search/rows.h"

using namespace patency;
using namespace patency::testing_rows;

namespace {

constexpr double spacing = 1, reach = 2.6;

double distance(const Vec3& a, const Vec3& b, const Box& box, const std::array<bool, 3>& periodic) {
    const Vec3 side = box.high - box.low;
    Vec3 d = a - b;
    if (periodic[0]) d.x = std::remainder(d.x, side.x);
    if (periodic[1]) d.y = std::remainder(d.y, side.y);
    if (periodic[2]) d.z = std::remainder(d.z, side.z);
    return norm(d);
}

/// Every row holds all that is within reach and nothing that is farther than the margin, once each, itself left out.
void expect_complete(const std::vector<std::vector<std::uint32_t>>& rows, const std::vector<Vec3>& own,
                     const std::vector<Vec3>& other, const Box& box, const std::array<bool, 3>& periodic, bool same) {
    // Search is in single precision: positions are whole quanta, of which there are 2^21 or more to a reach, and 1e-4 of
    // the reach is added so that nothing is missed.
    const double least = reach * (1 - 1e-6), most = reach * (1 + 1.1e-4);
    for (std::size_t i = 0; i < own.size(); ++i) {
        std::vector<bool> in_row(other.size());
        for (const std::uint32_t j : rows[i]) {
            ASSERT_LT(j, other.size());
            ASSERT_FALSE(in_row[j]) << "a neighbour twice";
            in_row[j] = true;
        }
        for (std::uint32_t j = 0; j < other.size(); ++j) {
            if (same && i == j) {
                EXPECT_FALSE(in_row[j]) << "itself";
                continue;
            }
            const double r = distance(own[i], other[j], box, periodic);
            ASSERT_TRUE(r >= least || in_row[j]) << i << " misses " << j << " at " << r;
            ASSERT_TRUE(r <= most || !in_row[j]) << i << " has " << j << " at " << r;
        }
    }
}

void expect_rising(const std::vector<std::vector<std::uint32_t>>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(std::adjacent_find(rows[i].begin(), rows[i].end(), std::greater_equal<>()), rows[i].end())
            << "row " << i;
}

struct Arrangement {
    std::string name;
    Box box;
    std::array<bool, 3> periodic;
    std::vector<Vec3> own, other;
};

std::vector<Vec3> lattice(const Box& box, double cell) {
    std::vector<Vec3> points;
    for (double x = box.low.x; x <= box.high.x; x += cell)
        for (double y = box.low.y; y <= box.high.y; y += cell)
            for (double z = box.low.z; z <= box.high.z; z += cell) points.push_back({x, y, z});
    return points;
}

std::vector<Arrangement> arrangements() {
    const Box cube{{0, 0, 0}, {9, 9, 9}}, plane{{0, 0, 0}, {30, 20, 0}}, thread{{-200, 0, 0}, {200, 1, 1}},
        plate{{0, 0, -3}, {40, 1, 40}}, flat{{0, 0, 0}, {12, 12, 0}};
    const auto two = [](const Box& box, std::size_t n, std::size_t m) {
        return std::pair(random_points(box, n, 11), random_points(box, m, 12));
    };
    std::vector<Arrangement> list;
    const auto add = [&](std::string name, const Box& box, std::array<bool, 3> periodic, std::vector<Vec3> own,
                         std::vector<Vec3> other) {
        list.push_back({std::move(name), box, periodic, std::move(own), std::move(other)});
    };
    const auto add_random = [&](std::string name, const Box& box, std::array<bool, 3> periodic, std::size_t n) {
        auto [own, other] = two(box, n, n / 3);
        add(std::move(name), box, periodic, std::move(own), std::move(other));
    };
    add_random("a cube", cube, {}, 900);
    add_random("a plane", plane, {}, 700);
    add_random("a thread", thread, {}, 500);
    add_random("a plate", plate, {}, 1600);
    add_random("a cube, periodic in x", {{0, 0, 0}, {9, 6, 6}}, {true, false, false}, 500);
    add_random("a cube, periodic in y", {{0, 0, 0}, {6, 9, 6}}, {false, true, false}, 500);
    add_random("a cube, periodic in x and z", {{1, 0, -9}, {10, 6, 0}}, {true, false, true}, 600);
    add_random("a cube, periodic all around", cube, {true, true, true}, 900);
    add_random("a plane, periodic", flat, {true, true, false}, 400);
    add_random("the least periodic box", {{0, 0, 0}, {7.81, 7.81, 7.81}}, {true, true, true}, 600);
    add("a lattice on the faces of the cells", cube, {}, lattice(cube, 0.5 * 2.3), lattice(cube, 1));
    add("a periodic lattice", cube, {true, true, true}, lattice({{0, 0, 0}, {8.9, 8.9, 8.9}}, 1),
        lattice({{0, 0, 0}, {8.9, 8.9, 8.9}}, 1.5));
    add("pairs at exactly the reach", {{0, 0, 0}, {30, 30, 30}}, {}, lattice({{0, 0, 0}, {15, 8, 8}}, reach),
        lattice({{0, 0, 0}, {15, 8, 8}}, reach));
    add("one particle", cube, {}, {{4, 4, 4}}, {{4.5, 4, 4}});
    add("one particle, none elsewhere", cube, {}, {{4, 4, 4}}, {});
    add("none", cube, {}, {}, {{1, 1, 1}});
    add("nothing", cube, {}, {}, {});
    add("the corners", cube, {}, lattice(cube, 9), lattice(cube, 9));
    add("the corners, periodic", cube, {true, true, true}, lattice(cube, 4.5), random_points(cube, 50, 13));
    auto twice = random_points(cube, 150, 14);
    twice.insert(twice.end(), twice.begin(), twice.begin() + 100);
    add("coincident particles", cube, {}, twice, std::vector<Vec3>(twice.begin(), twice.begin() + 30));
    add("bodies far from each other", {{0, 0, 0}, {300, 9, 9}}, {}, random_points({{0, 0, 0}, {9, 9, 9}}, 200, 15),
        random_points({{290, 0, 0}, {299, 9, 9}}, 200, 16));
    return list;
}

TEST(Neighbours, AreAllWithinReachAndNoOthers) {
    for (const Arrangement& a : arrangements()) {
        SCOPED_TRACE(a.name);
        const Frame frame(a.box.low, a.box.high, reach, a.periodic);
        const Sorted own(frame, spacing, a.own), other(frame, spacing, a.other);
        Neighbours rows;
        for (const int lanes : {1, 4, 16}) {
            rows.find_own(frame, own.cells, reach, lanes);
            const auto mine = rows_of(rows, own.points.size(), none);
            expect_complete(mine, own.points, own.points, a.box, a.periodic, true);
            expect_rising(mine);
            EXPECT_EQ(rows.member_count(), own.points.size());   // a row for everybody, be it empty
            rows.find_other(frame, own.cells, other.cells, reach, lanes);
            const auto theirs = rows_of(rows, own.points.size(), std::uint32_t(other.points.size()));
            expect_complete(theirs, own.points, other.points, a.box, a.periodic, false);
            expect_rising(theirs);
            std::size_t with = 0;
            for (const auto& row : theirs) with += !row.empty();
            EXPECT_EQ(rows.member_count(), with);   // only those that have foreign neighbours
        }
    }
}

TEST(Neighbours, AreMutual) {
    const Box box{{0, 0, 0}, {12, 12, 12}};
    const Frame frame(box.low, box.high, reach, {true, true, true});
    const Sorted own(frame, spacing, random_points(box, 1800, 21));
    Neighbours rows;
    rows.find_own(frame, own.cells, 2.0, 8);
    const auto lists = rows_of(rows, own.points.size(), none);
    std::size_t lonely = 0, pairs = 0;
    for (std::uint32_t i = 0; i < lists.size(); ++i)
        for (const std::uint32_t j : lists[i]) {
            ++pairs;
            lonely += std::find(lists[j].begin(), lists[j].end(), i) == lists[j].end();
        }
    // A pair at the very edge of the margin may be seen from one side only, where the kernel is zero anyway.
    EXPECT_LE(lonely, 2u);
    EXPECT_GT(pairs, 40000u);   // 4/3 pi 2^3 neighbours at one per unit volume, of 1800
}

TEST(Neighbours, AreTheSameForAnyNumberOfThreadsAndLanes) {
    const Box box{{0, 0, 0}, {20, 14, 14}};
    const Frame frame(box.low, box.high, reach);
    const Sorted own(frame, spacing, random_points(box, 4000, 22)), other(frame, spacing, random_points(box, 1000, 23));
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    Neighbours rows;
    rows.find_own(frame, own.cells, reach, 1);
    const auto mine = rows_of(rows, 4000, none);
    rows.find_other(frame, own.cells, other.cells, reach, 1);
    const auto theirs = rows_of(rows, 4000, 1000);
    for (int threads = 1; threads <= 4; ++threads)
        for (const int lanes : {2, 8, 16}) {
            omp_set_num_threads(threads);
            rows.find_own(frame, own.cells, reach, lanes);
            EXPECT_EQ(rows_of(rows, 4000, none), mine) << threads << " threads, " << lanes << " lanes";
            rows.find_other(frame, own.cells, other.cells, reach, lanes);
            EXPECT_EQ(rows_of(rows, 4000, 1000), theirs) << threads << " threads, " << lanes << " lanes";
        }
    omp_set_num_threads(before);
}

TEST(Neighbours, OfADifferentSpacingAreFoundAsWell) {
    // A wall of a finer spacing, searched in its own cells.
    const Box box{{0, 0, 0}, {12, 10, 10}};
    const Frame frame(box.low, box.high, reach);
    const Sorted own(frame, 1, random_points(box, 900, 24)),
        other(frame, 0.25, random_points({{4, 4, 4}, {6, 6, 6}}, 800, 25));
    Neighbours rows;
    rows.find_other(frame, own.cells, other.cells, reach, 4);
    expect_complete(rows_of(rows, 900, 800), own.points, other.points, box, {}, false);
    rows.find_other(frame, other.cells, own.cells, reach, 4);
    expect_complete(rows_of(rows, 800, 900), other.points, own.points, box, {}, false);
}

}   // namespace
