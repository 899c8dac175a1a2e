// SPDX-License-Identifier: Apache-2.0
// What a vessel's particles start with: the estimate as a field, or the flow on cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/stages/build.h"
#include "patency/stages/estimated_field.h"
#include "patency/stages/initial_state.h"
#include "patency/stages/scene_sampling.h"
#include "patency/stages/vessel_results.h"
#include "tests/stages/results_folder.h"
#include "tests/stages/vessel_decks.h"

namespace patency {
namespace {

TEST(EstimatedField, CarriesTheEstimatesFlowThroughEverySection) {
    const EstimatedField field(*scene().vessel, *scene().estimate);
    const WallHint hint = wall_hint(scene());
    for (const VesselStation& station : make_stations(*scene().vessel, 1e-3)) {
        const SectionGrid grid = make_section_grid(station.plane, hint, 12);
        const BranchedLines& lines = scene().vessel->along->lines;
        const bool is_behind_a_bifurcation =
            station.arc < lines.start_arc(lines.branches[station.branch]) + 2 * station.plane.radius;
        if (!grid.closed || (station.branch > 0 && is_behind_a_bifurcation)) continue;   // where fields meet they jump
        double flow = 0;
        for (std::size_t k = 0; k < grid.place.size(); ++k)
            flow += grid.area[k] * dot(field.at(grid.place[k], -hint.distance(grid.place[k])).velocity, grid.normal);
        // The parabola over the wall's distance is that of a round section; these are round to some per cent.
        EXPECT_NEAR(flow / scene().estimate->flow.flow[station.branch], 1, 0.08)
            << station.branch << " at " << station.arc;
    }
}

TEST(EstimatedField, HasThePressureOfTheStationsAndRestAtTheWall) {
    const EstimatedField field(*scene().vessel, *scene().estimate);
    const Estimate& e = *scene().estimate;
    const VesselAlong& along = *scene().vessel->along;
    for (std::size_t b = 0; b < along.lines.branches.size(); ++b) {
        const Branch& branch = along.lines.branches[b];
        const std::size_t middle = (branch.first + branch.last) / 2;
        const CentrelinePoint& point = along.lines.point(branch, middle);
        const auto& pressure = e.flow.pressure[b];   // the last stations are the branch's points
        const double expected = pressure[pressure.size() - 1 - (branch.last - middle)];
        EXPECT_NEAR(field.at(point.place, point.radius).pressure, expected, 1e-9);
        EXPECT_EQ(norm(field.at(point.place, 0).velocity), 0);
        EXPECT_GT(dot(field.at(point.place, point.radius).velocity, point.tangent), 0);
    }
    EXPECT_GT(field.pressure_range(), 0);
}

TEST(VesselScene, ExpectsTheSpeedOfItsNarrowestPlace) {
    // Twice the mean of a parabola, where flow over area is largest along the estimate.
    double largest = 0;
    for (std::size_t b = 0; b < scene().estimate->tree.branches.size(); ++b)
        for (double area : scene().estimate->tree.branches[b].area)
            largest = std::max(largest, 2 * scene().estimate->flow.flow[b] / area);
    EXPECT_NEAR(scene().numerics.reference_speed, largest, 1e-12);
    EXPECT_NEAR(scene().lumen.narrowest, scene().vessel->along->assessment.lesions.at(0).minimum_diameter, 1e-6);
}

TEST(VesselScene, CompliancesBeginWhereTheEstimateLeavesThem) {
    Folder folder;
    const auto made = build_frame(narrowed_tube(folder.path, "duration: \"1 ms\""));
    const std::size_t k = 1;
    ASSERT_EQ(made->ends[k].name, "outlet");
    const Estimate& e = *made->estimate;
    EXPECT_NEAR(made->laws[k].state[0] + 1e8 * e.opening_flows[k], e.opening_pressures[k], 1e-9);
    EXPECT_GT(made->laws[k].state[0], 0);
}

std::vector<double> carried_by(const Scene& scene) {
    const FluidParticles& fluid = scene.fluid;
    return EstimatedField(*scene.vessel, *scene.estimate)
        .carried({&fluid.position[0], fluid.size()}, {&fluid.velocity[0], fluid.size()}, fluid.volume[0]);
}

TEST(EstimatedField, TellsWhatPlacesCarry) {   // a plug along every branch: area times speed
    const Scene& s = scene();
    const EstimatedField field(*s.vessel, *s.estimate);
    std::vector<Vec3> along;
    for (std::size_t i = 0; i < s.fluid.size(); ++i) {
        const Vec3 v = field.at(s.fluid.position[i], 1).velocity;
        along.push_back(v / norm(v));
    }
    const auto carried = field.carried({&s.fluid.position[0], s.fluid.size()}, along, s.fluid.volume[0]);
    EXPECT_NEAR(carried[0] / (std::numbers::pi * 4e-6), 1, 0.02);   // the left main is round, 4 mm wide
}

TEST(VesselFlow, StartsFromTheEstimateWithWhatItsBranchesCarry) {
    const std::vector<double> carried = carried_by(scene());
    for (std::size_t b = 0; b < carried.size(); ++b)
        EXPECT_NEAR(carried[b] / scene().estimate->flow.flow[b], 1, 1e-9) << b;
    for (std::size_t k = 1; k < scene().ends.size(); ++k)
        EXPECT_EQ(scene().ends[k].absorber.mean, scene().estimate->opening_flows[k]);
}

TEST(VesselFlow, StartsFromTheFlowOnCellsWhereOneIsWaitedFor) {
    deck::Case config = bifurcation();
    config.initial = {};
    const auto made = build_scene(config);
    EXPECT_NE(made->start_remark.find("from the flow on"), std::string::npos) << made->start_remark;
    const double inflow = 0.315 * made->ends[0].area;
    const std::vector<double> carried = carried_by(*made);
    EXPECT_NEAR(carried[0], inflow, 1e-4 * inflow);
    EXPECT_NEAR(carried[1] + carried[2], inflow, 1e-3 * inflow);
    EXPECT_NEAR(carried[3] + carried[4], carried[2], 1e-3 * inflow);
    EXPECT_NEAR(carried[2], 0.2345 * inflow, 0.005 * inflow);   // finite volumes; the estimate has 0.247
    // Ends see it at once, as far as five particles across tell: none waits for a flow that first must come to it.
    find_members(made->fluid, made->numerics.spacing, made->ends);
    double out = 0;
    for (std::size_t k = 1; k < made->ends.size(); ++k) {
        measure_flow(made->ends[k], made->fluid, 0, 0);
        out += made->ends[k].flow;
        EXPECT_NEAR(made->ends[k].flow / made->ends[k].absorber.mean, 1, 0.07) << made->ends[k].name;
    }
    EXPECT_NEAR(out, 0.97 * inflow, 0.03 * inflow);
    EXPECT_NEAR(made->ends[1].absorber.mean, carried[1], 1e-3 * inflow);
    // At the inlet sound is heard against the pressure there, and the blood within has it.
    EXPECT_NEAR(made->ends[0].absorber.mean, 172, 8);
    // Kept by the deck's word, or where nothing waits.
    EXPECT_EQ(bifurcation().initial_velocity(), deck::InitialVelocity::estimate);
    config.numerics.convergence.reset();
    EXPECT_EQ(config.initial_velocity(), deck::InitialVelocity::estimate);
    EXPECT_EQ(config.initial_pressure(), deck::InitialPressure::estimate);
}

TEST(VesselFlow, StartsFromTheEstimateWhereCellsFindNone) {
    deck::Case config = bifurcation();
    const auto estimated = build_scene(config);
    config.initial = {};
    auto made = build_frame(config);
    made->fluid.resize(estimated->fluid.size());
    for (std::size_t i = 0; i < made->fluid.size(); ++i)
        made->fluid.position[i] = estimated->fluid.position[i], made->fluid.volume[i] = estimated->fluid.volume[i];
    made->reference_pressure = estimated->reference_pressure;
    const SolveOnCells lost = [](const Scene&) -> std::unique_ptr<const CellStart> {
        throw DivergedError("the flow on cells ran away");
    };
    compute_initial_state(*made, lost);
    EXPECT_NE(made->start_remark.find("from the estimate"), std::string::npos);
    EXPECT_NE(made->start_remark.find("ran away"), std::string::npos);
    for (std::size_t i = 0; i < made->fluid.size(); i += 97) {
        EXPECT_EQ(norm(made->fluid.velocity[i] - estimated->fluid.velocity[i]), 0);
        EXPECT_EQ(made->fluid.pressure[i], estimated->fluid.pressure[i]);
    }
    made->config.initial = {
        .velocity = deck::InitialVelocity::cells, .speed = {}, .pressure = {}};   // asked for: no other will do
    EXPECT_THROW(compute_initial_state(*made, lost), DivergedError);
}

}   // namespace
}   // namespace patency
