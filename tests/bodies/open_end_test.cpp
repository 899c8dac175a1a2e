// SPDX-License-Identifier: Apache-2.0
// Open ends: particles cross, are copied and removed, and none is lost; fits and flows are exact where they should be.
#include "patency/bodies/open_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

using namespace patency;

namespace {

constexpr double spacing = 0.1, side = 1.0, length = 3.0, buffer_length = 0.4, tail = 0.26;

/// A square duct along x with an end at both sides, particles on a lattice.
struct Duct {
    FluidParticles fluid;
    std::vector<OpenEnd> ends = std::vector<OpenEnd>(2);

    Duct() {
        ends[0].name = "inlet", ends[0].normal = {-1, 0, 0};
        ends[1].name = "outlet", ends[1].centre = {length, 0, 0}, ends[1].normal = {1, 0, 0};
        for (OpenEnd& end : ends)
            end.area = side * side, end.mean_square = side * side / 6, end.reach = side,
            end.buffer_length = buffer_length;
        std::vector<Vec3> points;
        for (double x = spacing / 2 - buffer_length; x < length + buffer_length; x += spacing)
            for (double y = (spacing - side) / 2; y < side / 2; y += spacing)
                for (double z = (spacing - side) / 2; z < side / 2; z += spacing) points.push_back({x, y, z});
        fluid.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            fluid.position[i] = points[i];
            fluid.volume[i] = spacing * spacing * spacing;
            fluid.opening[i] = points[i].x < 0 ? 1 : points[i].x > length ? 2 : 0;
        }
    }
    void find() { find_members(fluid, spacing, ends); }
    void exchange() { exchange_particles(fluid, spacing, tail, ends); }
    std::int64_t count(std::int32_t opening) const {
        return std::count(fluid.opening.begin(), fluid.opening.end(), opening);
    }
    std::size_t nearest(const Vec3& x) const {
        std::size_t best = 0;
        for (std::size_t i = 0; i < fluid.size(); ++i)
            if (norm(fluid.position[i] - x) < norm(fluid.position[best] - x)) best = i;
        return best;
    }
};

TEST(OpenEnd, MembersAreThoseNearThePlane) {
    Duct duct;
    duct.find();
    for (std::size_t k = 0; k < 2; ++k) {
        const OpenEnd& end = duct.ends[k];
        EXPECT_EQ(end.buffer.size(), 400u);   // four layers of ten by ten
        double previous = 0;
        for (const auto& m : end.buffer) {
            EXPECT_EQ(duct.fluid.opening[m.index], std::int32_t(k) + 1);
            EXPECT_NEAR(m.s, end.axial(duct.fluid.position[m.index]), 1e-15);
            EXPECT_GE(m.index, previous);   // in the order of the particles
            EXPECT_GE(m.weight, 0);
            EXPECT_LE(m.weight, 1);
            previous = m.index;
        }
        for (const auto& m : end.inside) {
            EXPECT_EQ(duct.fluid.opening[m.index], 0);
            EXPECT_LT(m.s, 0);
        }
        EXPECT_GE(end.inside.size(), 300u);
        for (const auto& m : end.section) EXPECT_GT(m.weight, 0);
    }
}

TEST(OpenEnd, AnotherBranchBesideIsNotAMember) {
    Duct duct;
    for (auto& x : duct.fluid.position) x.y += 3;   // behind the plane, out of reach of the axis
    std::fill(duct.fluid.opening.begin(), duct.fluid.opening.end(), 0);
    duct.find();
    for (const OpenEnd& end : duct.ends) EXPECT_TRUE(end.buffer.empty() && end.inside.empty() && end.section.empty());
    const std::size_t before = duct.fluid.size();
    duct.exchange();
    EXPECT_EQ(duct.fluid.size(), before);
}

TEST(OpenEnd, FlowOfAUniformVelocityIsExact) {
    Duct duct;
    duct.find();
    const Vec3 v{0.3, 0.1, -0.2};
    std::fill(duct.fluid.velocity.begin(), duct.fluid.velocity.end(), v);
    for (OpenEnd& end : duct.ends) measure_flow(end, duct.fluid, 0, 0);
    // A mean of equal numbers, rounded a few hundred times.
    EXPECT_NEAR(duct.ends[0].flow, -0.3 * side * side, 1e-14);
    EXPECT_NEAR(duct.ends[1].flow, 0.3 * side * side, 1e-14);
}

TEST(OpenEnd, FlowOfALinearVelocityIsThatAtThePlane) {
    Duct duct;
    duct.find();
    for (std::size_t i = 0; i < duct.fluid.size(); ++i) {
        const Vec3 x = duct.fluid.position[i];
        duct.fluid.velocity[i] = {1 + 0.5 * (x.x - length) + 2 * x.y, x.z, 0};
    }
    measure_flow(duct.ends[1], duct.fluid, 0, 0);
    EXPECT_NEAR(duct.ends[1].flow, side * side, 1e-14);   // the lattice is even about the plane and the axis
}

TEST(OpenEnd, FlowOfAParabolaIsExact) {   // THEORY.md (8.9)
    Duct duct;
    duct.find();
    const double a = 2, b = 0.3;
    for (std::size_t i = 0; i < duct.fluid.size(); ++i) {
        const Vec3 x = duct.fluid.position[i];
        duct.fluid.velocity[i] = {a - b * (x.y * x.y + x.z * x.z), 0, 0};
    }
    measure_flow(duct.ends[1], duct.fluid, 0, 0);
    // The integral over the square: the mean of y^2 + z^2 is side^2/6. Of the particles' centres it would be less.
    EXPECT_NEAR(duct.ends[1].flow, side * side * (a - b * side * side / 6), 1e-12 * side * side);
}

TEST(OpenEnd, WhatABufferMakesOfTheFlowIsLearntAndTakenOff) {   // THEORY.md (8.10)
    Duct duct;
    duct.find();
    OpenEnd& end = duct.ends[1];
    for (std::size_t i = 0; i < duct.fluid.size(); ++i)
        duct.fluid.velocity[i] = {duct.fluid.opening[i] == 2 ? 0.9 : 1.0, 0, 0};
    measure_flow(end, duct.fluid, 0, 0);
    EXPECT_NEAR(end.flow, 0.95 * side * side, 1e-12);   // half of the particles are the buffer's
    for (int k = 0; k < 100; ++k) measure_flow(end, duct.fluid, 0, 0.1);
    EXPECT_NEAR(end.flow, side * side, 1e-5);       // 0.9^100 of the 5 % are left
    for (auto& v : duct.fluid.velocity) v.x += 1;   // a knock is seen at once
    measure_flow(end, duct.fluid, 0, 0);
    EXPECT_NEAR(end.flow, 2 * side * side, 1e-5);
}

TEST(OpenEnd, AnImposedFlowIsTakenAtItsWord) {
    Duct duct;
    duct.find();
    duct.ends[0].imposed_flow = [](double t) { return -3 * t; };
    measure_flow(duct.ends[0], duct.fluid, 2, 0);
    EXPECT_EQ(duct.ends[0].flow, -6);
}

TEST(OpenEnd, FitOfALinearPressureIsExact) {
    Duct duct;
    duct.find();
    OpenEnd& end = duct.ends[1];
    const double at_plane = 1200, slope = -350;   // of the size of blood's in a coronary, Pa and Pa/m
    const auto pressure = [&](std::uint32_t i) { return at_plane + slope * end.axial(duct.fluid.position[i]); };
    end.kind = OpenEnd::Kind::velocity;
    fit_pressure(end, 1060, pressure);
    // Round-off of the normal equations: their condition is about 10, their terms 1e3 of 1e-16.
    EXPECT_NEAR(end.mean_pressure, at_plane, 1e-9);
    EXPECT_NEAR(end.slope, slope, 1e-9);
    end.kind = OpenEnd::Kind::pressure;
    end.pressure = at_plane;
    fit_pressure(end, 1060, pressure);
    EXPECT_DOUBLE_EQ(end.mean_pressure, at_plane);
    EXPECT_NEAR(end.slope, slope, 1e-9);
}

TEST(OpenEnd, AnOutletModelAndTheBloodAgree) {
    Duct duct;
    duct.find();
    OpenEnd& end = duct.ends[1];
    const double impedance = 1060 * 5.0, inside = 900;
    end.flow = 0.02, end.pressure = 300;
    const auto pressure = [&](std::uint32_t i) { return inside - 100 * end.axial(duct.fluid.position[i]); };
    for (const double resistance : {0.0, 1e2, 1e5, 1e12}) {
        end.resistance = resistance;
        fit_pressure(end, impedance, pressure);
        // The flow that the value makes is the flow that the value was wanted for.
        const double flow = end.flow + end.area / impedance * (inside - end.mean_pressure);
        EXPECT_NEAR(end.mean_pressure, end.pressure + resistance * flow, 1e-9 * (1 + resistance * end.flow))
            << resistance;
    }
    // Already in agreement: nothing changes.
    end.resistance = (inside - end.pressure) / end.flow;
    fit_pressure(end, impedance, pressure);
    EXPECT_NEAR(end.mean_pressure, inside, 1e-9);
}

TEST(OpenEnd, OutAndBackInIsCountedTwiceWithOppositeSigns) {
    Duct duct;
    const std::size_t i = duct.nearest({length - 0.05, 0.05, 0.05});
    duct.fluid.viscosity[i] = 77;   // a mark, to find it again
    const auto find = [&] {
        return std::size_t(std::find(duct.fluid.viscosity.begin(), duct.fluid.viscosity.end(), 77.0) -
                           duct.fluid.viscosity.begin());
    };
    const std::int64_t inside = duct.count(0);
    const double volume = duct.fluid.volume[i];

    duct.find();
    duct.fluid.position[i].x += 0.11;   // past the half spacing that tells a crossing from a trembling
    duct.exchange();
    EXPECT_EQ(duct.fluid.opening[find()], 2);
    EXPECT_EQ(duct.ends[1].crossed, 1);
    EXPECT_DOUBLE_EQ(duct.ends[1].crossed_volume, volume);
    EXPECT_EQ(duct.count(0), inside - 1);
    EXPECT_EQ(duct.count(2), 401);

    duct.find();
    duct.fluid.position[find()].x -= 0.11;
    duct.exchange();
    EXPECT_EQ(duct.fluid.opening[find()], 0);
    EXPECT_EQ(duct.ends[1].crossed, 0);
    EXPECT_EQ(duct.ends[1].crossed_volume, 0);
    EXPECT_EQ(duct.count(0), inside);
    EXPECT_EQ(duct.ends[0].crossed, 0);
}

TEST(OpenEnd, WhatEntersLeavesACopyAtTheFarEnd) {
    Duct duct;
    duct.ends[0].kind = OpenEnd::Kind::velocity;
    duct.find();
    const Vec3 before{-0.05, 0.15, 0.05}, after = before + Vec3{0.06, 0.01, 0};
    const std::size_t i = duct.nearest(before);
    duct.fluid.position[i] = after;
    duct.fluid.velocity[i] = {1, 2, 3};
    duct.exchange();
    EXPECT_EQ(duct.ends[0].crossed, -1);
    EXPECT_EQ(duct.count(1), 400);   // one left, its copy came
    const std::size_t copy = duct.nearest(after - Vec3{buffer_length, 0, 0});
    EXPECT_NEAR(norm(duct.fluid.position[copy] - (after - Vec3{buffer_length, 0, 0})), 0, 1e-15);
    EXPECT_EQ(duct.fluid.opening[copy], 1);
    EXPECT_EQ(duct.fluid.velocity[copy], (Vec3{1, 2, 3}));
    EXPECT_EQ(duct.fluid.volume[copy], spacing * spacing * spacing);
}

TEST(OpenEnd, BloodEntersAPressureEndAsItIsInside) {
    Duct duct;
    // A quadratic profile that does not change along the axis, as far as the buffer; there it is garbage.
    const auto profile = [](const Vec3& x) {
        return Vec3{1 - x.y * x.y - 2 * x.z * x.z + 0.5 * x.y * x.z, 0.2 * x.y, 0.1 * x.z * x.z};
    };
    const auto gradient = [](const Vec3& x) {
        return Mat3{{0, -2 * x.y + 0.5 * x.z, -4 * x.z + 0.5 * x.y}, {0, 0.2, 0}, {0, 0, 0.2 * x.z}};
    };
    for (std::size_t i = 0; i < duct.fluid.size(); ++i) {
        const Vec3& x = duct.fluid.position[i];
        duct.fluid.velocity[i] = duct.fluid.opening[i] ? Vec3{9, 9, 9} : profile(x);
        duct.fluid.velocity_gradient[i] = gradient(x);
    }
    duct.find();
    const std::size_t i = duct.nearest({-0.05, 0.15, 0.05});
    duct.fluid.position[i].x += 0.06;
    duct.exchange();
    const Vec3 place{0.01 - buffer_length, 0.15, 0.05};
    const std::size_t copy = duct.nearest(place);
    EXPECT_NEAR(norm(duct.fluid.velocity[copy] - profile(place)), 0, 1e-14);
}

TEST(OpenEnd, BuffersRepeatThemselves) {
    Duct duct;
    duct.find();
    duct.exchange();
    for (std::int32_t number = 1; number <= 2; ++number) {
        const OpenEnd& end = duct.ends[std::size_t(number) - 1];
        std::vector<std::size_t> parents, copies;
        for (std::size_t i = 0; i < duct.fluid.size(); ++i) {
            if (duct.fluid.opening[i] == number && end.axial(duct.fluid.position[i]) < tail) parents.push_back(i);
            if (duct.fluid.opening[i] == -number) copies.push_back(i);
        }
        ASSERT_EQ(copies.size(), parents.size());
        EXPECT_EQ(copies.size(), 300u);                   // three layers stand before 2.6 spacings
        for (std::size_t c = 0; c < copies.size(); ++c)   // in the order of their parents
            EXPECT_NEAR(
                norm(duct.fluid.position[copies[c]] - duct.fluid.position[parents[c]] - buffer_length * end.normal), 0,
                1e-15);
    }
    const std::size_t size = duct.fluid.size();
    duct.find();
    duct.exchange();   // renewed, not added
    EXPECT_EQ(duct.fluid.size(), size);
}

TEST(OpenEnd, NewParticlesAreOrderedByEndAndParent) {
    Duct duct;
    for (OpenEnd& end : duct.ends) end.kind = OpenEnd::Kind::velocity;
    for (std::size_t i = 0; i < duct.fluid.size(); ++i) duct.fluid.viscosity[i] = double(i);   // who it was
    duct.find();
    for (std::size_t i = 0; i < duct.fluid.size(); ++i)   // both buffers' first layers come in
        if (duct.fluid.opening[i])
            duct.fluid.position[i] -= 0.06 * duct.ends[std::size_t(duct.fluid.opening[i]) - 1].normal;
    const std::size_t before = duct.fluid.size();
    duct.exchange();
    std::vector<double> parents[2];
    std::int32_t last_end = 0;
    for (std::size_t i = before; i < duct.fluid.size(); ++i) {
        const std::int32_t end = std::abs(duct.fluid.opening[i]);
        EXPECT_GE(end, last_end);
        last_end = end;
        if (duct.fluid.opening[i] > 0) parents[end - 1].push_back(duct.fluid.viscosity[i]);
    }
    for (const auto& list : parents) {
        EXPECT_EQ(list.size(), 100u);
        EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
    }
}

TEST(OpenEnd, NoneIsLostAndNoneIsStuck) {
    // Particles that walk at random, with a drift that turns. Whatever they do, the books must balance.
    Duct duct;
    const std::int64_t inside = duct.count(0);
    double volume = double(inside) * spacing * spacing * spacing;
    const double start_volume = volume;
    std::mt19937_64 random(8);
    std::normal_distribution<double> walk(0, 0.02);
    std::int64_t entered = 0, left = 0;
    for (int step = 0; step < 300; ++step) {
        duct.find();
        const double drift = 0.03 * std::sin(step * 0.05);
        for (std::size_t i = 0; i < duct.fluid.size(); ++i) {
            Vec3& x = duct.fluid.position[i];
            if (duct.fluid.opening[i] < 0) continue;
            x.x += drift + std::clamp(walk(random), -0.1, 0.1);
            x.y = std::clamp(x.y + walk(random), -0.5, 0.5);
            x.z = std::clamp(x.z + walk(random), -0.5, 0.5);
        }
        const std::int64_t crossed = duct.ends[0].crossed + duct.ends[1].crossed;
        const std::int64_t in_buffers = duct.count(1) + duct.count(2);
        std::int64_t removed = 0, incoming = 0;
        for (std::size_t i = 0; i < duct.fluid.size(); ++i) {
            if (duct.fluid.opening[i] <= 0) continue;
            const OpenEnd& end = duct.ends[std::size_t(duct.fluid.opening[i]) - 1];
            removed += end.axial(duct.fluid.position[i]) > end.buffer_length;
            incoming += end.axial(duct.fluid.position[i]) < 0;
        }
        duct.exchange();
        const std::int64_t now_crossed = duct.ends[0].crossed + duct.ends[1].crossed;
        // Inside: what was there less what has crossed. In the buffers: one leaves inwards, its copy comes.
        ASSERT_EQ(duct.count(0) + now_crossed, inside) << "step " << step;
        ASSERT_EQ(duct.count(1) + duct.count(2), in_buffers + (now_crossed - crossed) + incoming - removed)
            << "step " << step;
        for (std::size_t i = 0; i < duct.fluid.size(); ++i) {
            const std::int32_t opening = duct.fluid.opening[i];
            const double x = duct.fluid.position[i].x;
            if (opening == 0) {
                ASSERT_TRUE(x > -0.5 * spacing && x < length + 0.5 * spacing)
                    << "stuck at " << x << " in step " << step;
            }
            if (opening > 0) {
                const double s = duct.ends[std::size_t(opening) - 1].axial(duct.fluid.position[i]);
                ASSERT_TRUE(s >= 0 && s <= buffer_length)
                    << "at " << s << " of buffer " << opening << " in step " << step;
            }
        }
        entered += incoming, left += now_crossed - crossed + incoming;
        volume = 0;
        for (std::size_t i = 0; i < duct.fluid.size(); ++i)
            volume += duct.fluid.opening[i] == 0 ? duct.fluid.volume[i] : 0.0;
    }
    EXPECT_NEAR(volume + duct.ends[0].crossed_volume + duct.ends[1].crossed_volume, start_volume, 1e-9);
    EXPECT_GT(entered, 1000);   // the walk has tried it
    EXPECT_GT(left, 1000);
}

}   // namespace
