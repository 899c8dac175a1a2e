// SPDX-License-Identifier: Apache-2.0
// A deployment as a user sees it: the quick one to its end, the phases of the other, and the lumen that a flow goes on with.
#include "patency/stages/deploy.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "patency/config/deck.h"
#include "patency/io/atomic_file.h"
#include "patency/io/checkpoint.h"
#include "patency/io/polydata_file.h"
#include "patency/io/pvd.h"
#include "patency/io/summary.h"
#include "patency/io/surface_file.h"
#include "patency/stages/deploy_contacts.h"
#include "patency/stages/deploy_program.h"
#include "patency/stages/deploy_record.h"
#include "patency/stages/deploy_state.h"
#include "patency/stages/lumen_after.h"
#include "patency/stages/vessel.h"
#include "tests/io/scratch_folder.h"
#include "tests/stages/results_folder.h"

namespace patency {
namespace {

const std::string bifurcation = std::string(PATENCY_SOURCE_DIR) + "/cases/coronary_bifurcation.yaml";

TEST(DeployGeometrically, LeavesAnOpenLumenThatAFlowAccepts) {
    deck::Case config =
        deck::read_case(bifurcation, {"stent={design: paper}", "deployment={diameter: 3.3 mm, mode: geometric}"});
    const Folder out;
    const OutputFolder folder(out.path);
    ASSERT_TRUE(run_deploy(config, {.folder = folder}));
    const auto deploy = read_summary(folder.file("summary.json"))["deploy"];
    EXPECT_FALSE(deploy["is_mechanical"].get<bool>());
    EXPECT_TRUE(deploy["recoil_percent"].is_null());
    EXPECT_NEAR(deploy["minimum_diameter_mm"].get<double>(), 3.3, 1e-6);
    EXPECT_NEAR(deploy["lumen"]["minimum_diameter_before_mm"].get<double>(), 2.0, 0.02);
    EXPECT_NEAR(deploy["lumen"]["minimum_diameter_mm"].get<double>(), 3.3, 0.04);
    EXPECT_LT(deploy["malapposed_percent"].get<double>(), 1);

    // The deck for the flow after has all openings, each with what it had, where it was.
    const deck::Case after = deck::read_case(folder.file("case_after.yaml"));
    EXPECT_FALSE(after.stent);
    ASSERT_EQ(after.openings.size(), config.openings.size());
    const Vessel before = read_vessel(config), vessel = read_vessel(after);
    for (const SurfaceOpening& o : before.openings) {
        const auto same = std::find_if(vessel.openings.begin(), vessel.openings.end(), [&](const SurfaceOpening& a) {
            return norm(a.opening.centre - o.opening.centre) < 0.02e-3;
        });
        ASSERT_NE(same, vessel.openings.end()) << o.opening.name;
        EXPECT_NEAR(same->opening.area, o.opening.area, 0.02 * o.opening.area);
        EXPECT_TRUE(after.openings.at(same->opening.name) == config.openings.at(o.opening.name)) << o.opening.name;
    }
    EXPECT_TRUE(vessel.along->assessment.lesions.empty());
    // And its branches are called what they were: each has its name where it was.
    ASSERT_EQ(vessel.along->lines.branches.size(), before.along->lines.branches.size());
    for (const Branch& branch : before.along->lines.branches) {
        const auto now = branch_around(vessel.along->lines,
                                       before.along->lines.point(branch, (branch.first + branch.last) / 2).place);
        ASSERT_TRUE(now) << branch.name;
        EXPECT_EQ(vessel.along->lines.branches[*now].name, branch.name);
    }
    // Both files are one surface.
    const Surface stl = read_surface(folder.file("lumen_after.stl"), "mm"),
                  vtp = read_surface(folder.file("lumen_after.vtp"), "mm");
    ASSERT_EQ(stl.triangles.size(), vtp.triangles.size());
    EXPECT_NEAR(volume(stl), volume(vtp), 1e-5 * volume(vtp));
}

/// Of two ends that are equally wide rounding in the file tells which is the first: the flow after goes the same way all the same.
TEST(DeployGeometrically, TheInletStaysWhereItWas) {
    const ScratchFolder inputs;
    nlohmann::json points;
    for (int k = 0; k <= 80; ++k) points.push_back({0.5 * k, 0, 0, 2.0});
    write_file(inputs / "straight.json",
               nlohmann::json{{"unit", "mm"}, {"tubes", {{{"name", "main"}, {"points", points}}}}}.dump());
    write_file(inputs / "case.yaml", R"(version: 1
geometry: {network: straight.json, lesion: {branch: main, position: 18 mm, length: 10 mm, diameter_stenosis_percent: 50}}
blood: {density: 1060 kg/m^3, viscosity: 3.5 mPa s}
openings: {inlet: {type: flow, flow: 120 mL/min}, outlet_1: {type: pressure, pressure: 0 Pa}}
stent: {design: paper}
deployment: {mode: geometric, diameter: 3.3 mm}
numerics: {scheme: cells, across: 8, duration: 1 s}
)");
    const Folder out;
    const OutputFolder folder(out.path);
    ASSERT_TRUE(run_deploy(deck::read_case(inputs / "case.yaml"), {.folder = folder}));
    const Vessel after = read_vessel(deck::read_case(folder.file("case_after.yaml")));
    ASSERT_EQ(after.openings.size(), 2u);
    EXPECT_EQ(after.openings[0].opening.name, "inlet");
    EXPECT_NEAR(after.openings[0].opening.centre.x, 0, 0.1e-3);
}

struct Traces {
    std::string table;
    std::vector<double> known;   // of the past, for the results at the end
};

/// A straight artery of 3.3 mm with a lesion of 55 %, which a balloon opens for a stent of one ring.
deck::Case small_deployment(const std::filesystem::path& folder) {
    nlohmann::json points;
    for (int k = 0; k <= 120; ++k) points.push_back({-2 + 0.2 * k, 0, 0, 1.65});
    const auto end = [](double x, double out) {
        return nlohmann::json{{"point", {x, 0, 0}}, {"outward_normal", {out, 0, 0}}, {"radius", 1.65}};
    };
    write_file(folder / "artery.json", nlohmann::json{{"unit", "mm"},
                                                      {"blend_width_k", 0.35},
                                                      {"tubes", {{{"name", "artery"}, {"points", points}}}},
                                                      {"ends", {{"inlet", end(0, -1)}, {"outlet", end(20, 1)}}}}
                                           .dump());
    write_file(folder / "case.yaml", R"(version: 1
case: {name: ring}
geometry: {network: artery.json, lesion: {branch: artery, position: 10 mm, length: 3 mm, diameter_stenosis_percent: 55}}
blood: {density: 1060 kg/m^3, viscosity: 3.5 mPa s}
openings: {inlet: {type: velocity, velocity: 0.2 m/s}, outlet: {type: pressure, pressure: 0 Pa}}
wall: {spacing: 0.25 mm, plaque: fills}
stent: {pattern: {rings: 1, crowns: 6, length: 1.2 mm, diameter: 2 mm, crimped_diameter: 1.8 mm, nominal_diameter: 3.3 mm, strut_width: 0.1 mm,
                  strut_thickness: 0.1 mm, crown_radius: 0.15 mm, gap: 0.2 mm, connectors: 3}}
deployment: {mode: balloon, crimped_diameter: 1.8 mm, predilation: 2.2 mm, ramp: 1.8 ms, steps: 900, frames: 4}
numerics: {scheme: cells, across: 12, duration: 1 s}
)");
    return deck::read_case(folder / "case.yaml");
}

/// Of a deployment by contact that is stopped after each of these numbers of steps and goes on.
Traces traces_of(const std::vector<int>& stops) {
    const ScratchFolder inputs;
    const deck::Case config = small_deployment(inputs.path());
    const Folder out;
    const OutputFolder folder(out.path);
    for (const int stop : stops) {
        int steps = 0;
        EXPECT_FALSE(run_deploy(config, {.folder = folder, .interrupted = [&] { return ++steps == stop; }}));
    }
    EXPECT_FALSE(std::filesystem::exists(folder.file("summary.json")));
    return {text_of(folder.file("deployment.csv")),
            CheckpointReader(folder.checkpoint("deploy")).read<std::vector<double>>("known")};
}

TEST(DeployByContact, GoesOnWithTheSameBits) {
    // Stopped while it is let go, while it enters, and while the balloon opens it against the wall.
    const Traces at_once = traces_of({660}), in_parts = traces_of({260, 240, 140, 20});
    EXPECT_GT(std::count(at_once.table.begin(), at_once.table.end(), '\n'), 50);
    EXPECT_EQ(at_once.table, in_parts.table);
    EXPECT_GT(std::count_if(at_once.known.begin(), at_once.known.end(), [](double x) { return x != 0; }), 0);
    EXPECT_EQ(at_once.known, in_parts.known);
    constexpr std::size_t touched = 4, deepest = 8;
    EXPECT_GT(at_once.known.at(touched), 0);
    EXPECT_GT(at_once.known.at(deepest), 0);
}

/// One that comes as narrow as it enters is not crimped: it shortens from what it was.
TEST(DeployByContact, KnowsHowLongAStentIsThatComesCrimped) {
    const ScratchFolder inputs;
    small_deployment(inputs.path());
    const deck::Case config =
        deck::read_case(inputs.path() / "case.yaml", {"deployment.crimped_diameter=2 mm", "deployment.predilation=null",
                                                      "geometry.lesion.diameter_stenosis_percent=30"});
    const Folder out;
    const OutputFolder folder(out.path);
    int steps = 0;
    EXPECT_FALSE(run_deploy(config, {.folder = folder, .interrupted = [&] { return ++steps == 3; }}));
    const auto known = CheckpointReader(folder.checkpoint("deploy")).read<std::vector<double>>("known");
    EXPECT_NEAR(known.at(0), 1.2e-3, 0.03e-3);   // length and diameter
    EXPECT_NEAR(known.at(1), 2e-3, 0.02e-3);
}

/// Whether the balloon, or the load, works on anything: then the stent is not let go.
TEST(DeployContacts, KnowWhetherAnythingHasPressed) {
    const ScratchFolder inputs;
    small_deployment(inputs.path());
    const auto opened = [&](std::vector<std::string> also) {
        for (const char* said : {"deployment.crimped_diameter=2 mm", "deployment.predilation=null",
                                 "geometry.lesion.diameter_stenosis_percent=30"})
            also.push_back(said);
        return build_deployment(deck::read_case(inputs.path() / "case.yaml", also));
    };
    {
        const auto scene = opened({});
        const DeployProgram program = make_deploy_program(scene->place, scene->config.deployment);
        const DeployPace pace(1, 1);
        DeployContacts contacts(*scene, program, pace);
        contacts.begin(DeployPhase::open, {});
        EXPECT_FALSE(contacts.have_pressed(0));
        while (scene->solids.time < 0.05e-3) step_solids(scene->solids, 0.05e-3);
        EXPECT_TRUE(contacts.have_pressed(0.05e-3));
        EXPECT_FALSE(contacts.have_pressed(0.05e-3)) << "nothing has happened since";
        scene->solids.time = program.end();   // when the balloon is as small as it was
        step_solids(scene->solids, scene->solids.time + 1e-6);
        EXPECT_FALSE(contacts.have_pressed(scene->solids.time));
    }
    const auto scene = opened({"deployment.mode=radial_load", "deployment.load=1 MPa"});
    const DeployProgram program = make_deploy_program(scene->place, scene->config.deployment);
    const DeployPace pace(1, 1);
    DeployContacts contacts(*scene, program, pace);
    contacts.begin(DeployPhase::open, {});
    contacts.load()->radius = [&] { return program.pumped(program.open_from); };   // it does not give way
    EXPECT_FALSE(contacts.have_pressed(program.open_from));
    EXPECT_TRUE(contacts.have_pressed(program.open_from + 0.1e-3));
    EXPECT_TRUE(contacts.have_pressed(program.deflate_from + 0.1e-3));
    EXPECT_FALSE(contacts.have_pressed(program.end())) << "it has been pumped out";
}

/// Wherever along the axis they are.
TEST(InnerFace, IsFarFromTheAxisAndMovesFromIt) {
    const ScratchFolder inputs;
    const auto scene = build_deployment(small_deployment(inputs.path()));
    SolidSurface& stent = *scene->stent->surface;
    SolidParticles& metal = scene->stent->body->particles();
    stent.follow(metal);
    const InnerFace face(stent, scene->place.axis);
    EXPECT_NEAR(face.radius(), 0.9e-3, 0.01e-3);
    EXPECT_EQ(face.speed(), 0);
    const std::vector<Vec3> beside = {{0, -5e-3, 0}, {20e-3, -5e-3, 0}};
    EXPECT_NEAR(InnerFace(stent, StentAxis(beside, 10e-3, 0, 1.2e-3, 1e-3)).radius(), 5e-3, 0.1e-3);
    const double before = face.radius();
    for (std::size_t i = 0; i < metal.size(); ++i) {
        const Vec3 x = metal.position[i];
        metal.velocity[i] = {100, 0.3e3 * x.y, 0.3e3 * x.z};
        metal.position[i] = x + 1e-3 * metal.velocity[i];
    }
    stent.follow(metal);
    EXPECT_NEAR(face.radius(), 1.3 * before, 1e-5 * before);   // the centreline of a surface is not quite y = z = 0
    EXPECT_NEAR(face.speed(), 0.3e3 * before, 1e-2 * before);
}

TEST(DeployRecord, TheLastInstantIsReplacedByWhatShowsMore) {
    const Folder out;
    const OutputFolder folder(out.path);
    DeployRecord record(folder, {});
    const PolyData little{.points = {{0, 0, 0}}}, more{.points = {{0, 0, 0}, {1, 0, 0}}};
    record.add_frames(0, little, little), record.add_frames(1, little, little), record.add_frames(1, more, little);
    const std::vector<PvdFrame> frames = read_pvd(folder.file("stent.pvd"));
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(read_polydata(out.path / frames.back().file).points.size(), 2u);
}

TEST(LumenAfter, KeepsNoBranchNamesThatWouldClash) {
    BranchedLines before, after;
    const auto straight = [](double y, double length) {
        Centreline line;
        for (int k = 0; k <= 20; ++k)
            line.points.push_back({{length * k / 20, y, 0}, {1, 0, 0}, 1e-3, length * k / 20});
        return line;
    };
    before.lines = {straight(0, 20e-3)};
    before.branches = {{.name = "branch_2", .line = 0, .first = 0, .last = 20, .parent = -1, .lines = {0}}};
    after.lines = {straight(0, 20e-3), straight(5e-3, 20e-3)};
    after.branches = {{.name = "branch_1", .line = 0, .first = 0, .last = 20, .parent = -1, .lines = {0}},
                      {.name = "branch_2", .line = 1, .first = 0, .last = 20, .parent = -1, .lines = {1}}};
    EXPECT_TRUE(keep_branch_names(before, after).empty());
    EXPECT_EQ(after.branches[0].name, "branch_1");
    before.branches[0].name = "circumflex";
    EXPECT_EQ(keep_branch_names(before, after).size(), 1u);
    EXPECT_EQ(after.branches[0].name, "circumflex");
    EXPECT_EQ(after.branches[1].name, "branch_2");
}

StentPlace place_of(double cut, double crimped, double opened) {
    StentPlace place{.pattern = {},
                     .form = {},
                     .diameter = opened,
                     .crimped_diameter = crimped,
                     .opened_length = 0,
                     .line = 0,
                     .arc = 0,
                     .axis = {},
                     .reference_diameter = opened,
                     .narrowest = 1e-3};
    place.pattern.diameter = cut, place.pattern.strut_thickness = 0.1e-3;
    return place;
}

TEST(DeployProgram, CrimpsOpensAndLetsGo) {
    deck::Deployment said;
    said.ramp = 2e-3;
    const DeployProgram p = make_deploy_program(place_of(2e-3, 1.2e-3, 3.2e-3), said);
    std::vector<DeployPhase> phases;
    for (const auto& entry : p.phases) phases.push_back(entry.phase);
    EXPECT_EQ(phases, (std::vector{DeployPhase::crimp, DeployPhase::release, DeployPhase::open, DeployPhase::hold,
                                   DeployPhase::deflate, DeployPhase::settle}));
    EXPECT_DOUBLE_EQ(p.phases[0].end, 0.4 * 2e-3);   // as fast as it opens: 0.8 mm of 2 mm
    EXPECT_DOUBLE_EQ(p.crimper(0), 1e-3);
    EXPECT_DOUBLE_EQ(p.crimper(p.phases[0].end), 0.6e-3);
    EXPECT_GT(p.crimper(p.phases[1].end), 1e-3);
    EXPECT_DOUBLE_EQ(p.open_to - p.open_from, 2e-3);
    EXPECT_DOUBLE_EQ(p.balloon(0), 0.5e-3);           // the crimped stent's inner face
    EXPECT_DOUBLE_EQ(p.balloon(p.open_to), 1.5e-3);   // the open one's
    EXPECT_DOUBLE_EQ(p.balloon(p.phases[3].end), 1.5e-3);
    EXPECT_DOUBLE_EQ(p.deflate_from, p.phases[3].end);
    EXPECT_DOUBLE_EQ(p.balloon(p.phases[4].end), 0.5e-3);
    EXPECT_GT(p.usual_end, p.deflate_from);
    EXPECT_LT(p.usual_end, p.phases[4].end) << "the balloon need not go all the way";
    EXPECT_FALSE(p.predilation);
}

/// The energy of motion goes with the square of the speed, and a stent goes back with what it has of having been opened.
TEST(DeployProgram, TheBalloonLeavesMoreSlowlyThanItCame) {
    const DeployProgram p = make_deploy_program(place_of(2e-3, 1.2e-3, 3.2e-3), {});
    const double ramp = p.open_to - p.open_from, recoils = 0.2 * ramp;   // a tenth of its way and more
    const auto gone = [&](double from, double to) { return p.balloon(from) - p.balloon(to); };
    EXPECT_GT(gone(p.deflate_from, p.deflate_from + recoils), 0.1e-3);
    for (double t = 0; t < recoils; t += 0.01 * ramp)
        EXPECT_LT(gone(p.deflate_from + t, p.deflate_from + t + 0.01 * ramp), 0.01 * 1e-3);
    EXPECT_GT(gone(p.open_to - 0.06 * ramp, p.open_to - 0.05 * ramp), -0.016e-3);
    EXPECT_LT(gone(p.open_to - 0.06 * ramp, p.open_to - 0.05 * ramp), -0.014e-3);
}

TEST(DeployProgram, OpensTheLesionBeforeIfAsked) {
    deck::Deployment said;
    said.predilation = 1.6e-3;
    const DeployProgram p = make_deploy_program(place_of(2e-3, 1.2e-3, 3.2e-3), said);
    ASSERT_EQ(p.phases[2].phase, DeployPhase::enter);
    EXPECT_LT(p.predilation(0), 0.5e-3);
    EXPECT_DOUBLE_EQ(p.predilation(p.phases[1].end), 0.8e-3);
    EXPECT_DOUBLE_EQ(p.predilation(p.phases[2].end),
                     p.balloon(p.open_from));   // the folded balloon goes on where it ends
    // A stent that comes as crimped needs no crimper.
    const DeployProgram q = make_deploy_program(place_of(1.2e-3, 1.2e-3, 3.2e-3), {});
    EXPECT_EQ(q.phases.front().phase, DeployPhase::open);
    EXPECT_GT(q.crimper(0), 1.2e-3);
}

}   // namespace
}   // namespace patency
