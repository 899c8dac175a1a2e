// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/cell_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/config/deck.h"
#include "patency/io/pvd.h"
#include "patency/io/summary.h"
#include "patency/io/vtp.h"
#include "patency/stages/cell_vessel.h"
#include "patency/stages/flow_checkpoint.h"
#include "patency/stages/flow_means.h"
#include "patency/stages/offenders.h"
#include "patency/stages/outlet_summary.h"
#include "patency/stages/stopwatch.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

PointArray vectors(const std::string& name, const std::string& unit, std::span<const Vec3> values) {
    PointArray array{name, unit, 3, {}};
    for (const Vec3& v : values) array.values.insert(array.values.end(), {v.x, v.y, v.z});
    return array;
}

void write_cells(const OutputFolder& folder, const CellScene& scene) {
    const CellFields fields = scene.balance->fields();
    PolyData data{.points = scene.mesh.point};
    data.arrays = {vectors("velocity", "m/s", fields.velocity),
                   {"pressure", "Pa", 1, fields.pressure},
                   {"volume", "m^3", 1, scene.mesh.volume}};
    const auto file = frame_file("fluid", 0);
    write_polydata(folder.file(file.string()), data);
    PvdWriter(folder.file("fluid.pvd")).add(0, file);
}

/// Middles of the cells' sides at the wall.
void write_wall(const OutputFolder& folder, const CellScene& scene) {
    PolyData data;
    std::vector<Vec3> stress, normal;
    std::vector<double> area;
    const std::vector<Vec3> all = scene.balance->wall_shear_stress();
    for (std::size_t k = 0; k < all.size(); ++k) {
        const CellPatch& patch = scene.mesh.patches[k];
        if (patch.opening != CellPatch::wall) continue;
        data.points.push_back(patch.centroid);
        stress.push_back(all[k]);
        normal.push_back(patch.normal);
        area.push_back(norm(patch.area));
    }
    data.arrays = {
        vectors("wall_shear_stress", "Pa", stress), vectors("normal_direction", "1", normal), {"area", "m^2", 1, area}};
    const auto file = frame_file("wall", 0);
    write_polydata(folder.file(file.string()), data);
    PvdWriter(folder.file("wall.pvd")).add(0, file);
}

/// Writes the cells that lack most, those without numbers first, and says where the first of them is.
std::string describe_remains(const OutputFolder& folder, const CellScene& scene) {
    std::vector<double> lack;
    for (std::size_t i = 0; i < scene.mesh.size(); ++i) lack.push_back(scene.balance->lack(i));
    const std::vector<std::uint32_t> worst = worst_of(lack);
    const CellFields fields = scene.balance->fields();
    std::vector<Vec3> velocity;
    PolyData data;
    std::vector<double> pressure, volume, lacked;
    for (const std::uint32_t i : worst) {
        data.points.push_back(scene.mesh.point[i]), velocity.push_back(fields.velocity[i]);
        pressure.push_back(fields.pressure[i]), volume.push_back(scene.mesh.volume[i]), lacked.push_back(lack[i]);
    }
    data.arrays = {vectors("velocity", "m/s", velocity),
                   {"pressure", "Pa", 1, pressure},
                   {"volume", "m^3", 1, volume},
                   {"lack", "1", 1, lacked}};
    write_polydata(folder.file("offenders.vtp"), data, {.non_finite = NonFinite::allow});
    const Vec3& x = data.points[0];
    return fmt::format(
        "; most of it near ({:.4g}, {:.4g}, {:.4g}) mm, where it goes at {:.3g} m/s. The cells that lack most are in "
        "{}",
        1e3 * x.x, 1e3 * x.y, 1e3 * x.z, norm(velocity[0]), folder.file("offenders.vtp").string());
}

}   // namespace

Json make_cell_summary(const CellScene& scene) {
    const deck::Case& config = scene.config;
    Json summary;
    summary["name"] = config.about.name;
    summary["scheme"] = deck::word_of(config.scheme());
    summary["planar"] = scene.lumen.planar;
    summary["pressure_datum"] = config.aorta.pressure ? "absolute" : "gauge";
    Json openings = Json::object();
    const std::vector<CellEndState> ends = scene.balance->end_states();
    double out = 0, through = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
        const Opening& opening = scene.lumen.openings[k];
        Json& here = openings[opening.name];
        here = {{"flow_m3_per_s", ends[k].flow},
                {"mean_pressure_pa", ends[k].pressure},
                {"mean_velocity_m_per_s", ends[k].flow / opening.area},
                {"area_m2", opening.area}};
        add_outlet(here, config.openings.at(opening.name));
        out += ends[k].flow, through += 0.5 * std::abs(ends[k].flow);
    }
    summary["openings"] = openings;
    summary["gauge_pressure_ratio"] = nullptr;   // of a vessel with a lesion only (vessel_results.h)
    summary["ffr"] = {
        {"lesion", nullptr},
        {"reason", config.aorta.pressure ? "a shape has no lesions" : "the deck gives no aortic pressure"}};
    summary["mass_imbalance_percent"] = through > 0 ? 100 * std::abs(out) / through : 0;
    const CellFields fields = scene.balance->fields();
    const auto mean = [&](auto value) {
        return sum_of(scene.mesh.size(), [&](std::size_t i) { return scene.mesh.volume[i] * value(i); }) /
               sum_of(scene.mesh.size(), [&](std::size_t i) { return scene.mesh.volume[i]; });
    };
    summary["largest_speed_m_per_s"] =
        largest_of(scene.mesh.size(), [&](std::size_t i) { return norm(fields.velocity[i]); });
    summary["mean_speed_m_per_s"] = mean([&](std::size_t i) { return norm(fields.velocity[i]); });
    summary["mean_pressure_pa"] = mean([&](std::size_t i) { return fields.pressure[i]; });
    double finest = INFINITY, coarsest = 0;
    for (const Vec3& x : scene.mesh.point) {
        const double here = scene.spacing_at(x);
        finest = std::min(finest, here), coarsest = std::max(coarsest, here);
    }
    summary["particles"] = {{"fluid", scene.mesh.size()},
                            {"inside", scene.mesh.size()},
                            {"wall", 0},
                            {"across_narrowest", scene.lumen.narrowest / finest},
                            {"led_back_from_wall", scene.mesh.led_back}};
    summary["spacing_m"] = finest;
    summary["largest_spacing_m"] = coarsest;
    summary["reference_speed_m_per_s"] = scene.reference_speed;
    summary["acoustic_steps"] = 0;
    summary["iterations"] = scene.solution.history.size();
    summary["linear_steps"] = scene.solution.linear_steps;
    summary["convergence"] = {{"is_converged", scene.solution.is_converged},
                              {"change_percent", 100 * scene.solution.swing},
                              {"is_damped", scene.solution.is_damped}};
    summary["volume_residual"] = scene.balance->volume_residual();
    summary["momentum_residual"] = scene.balance->momentum_residual();
    expect_finite(summary, "");
    return summary;
}

Outcome run_cell_flow(const deck::Case& config, const FlowStage& stage,
                      const std::function<Outcome(const CellScene&)>& follow) {
    const Stopwatch watch;
    const auto say = [&](const std::string& line) { stage.log(LogLevel::info, line); };
    deck::write_case(config, stage.folder.file("case.resolved.yaml"));
    if (!config.output.probes.empty() || !config.output.profiles.empty())
        stage.log(LogLevel::warning,
                  "output.probes and output.profiles are of flows in time: a steady flow on cells writes none; "
                  "fluid.pvd has the flow everywhere");
    std::size_t cells = 0;
    std::int64_t steps = 0;
    double build_cpu = 0, build_wall = 0;
    const double wanted = CellSolverSettings{}.tolerance;
    const auto progress_of = [&](const CellScene& scene) {
        const double residual = std::max(scene.balance->volume_residual(), scene.balance->momentum_residual());
        double out = 0;
        for (const CellEndState& end : scene.balance->end_states()) out += end.flow;
        return ProgressState{.stage = "flow",
                             .fraction = std::clamp(std::log(residual) / std::log(wanted), 0.0, 1.0),
                             .time = 0,
                             .step = steps,
                             .net_inflow = -out};
    };
    const auto scene = make_solved_scene(
        config,
        [&](const CellScene& now) {
            if (now.mesh.size() != cells) {
                cells = now.mesh.size();
                build_cpu = watch.cpu(), build_wall = watch.wall();
                say(fmt::format("{} cells", cells));
            }
            ++steps;
            if (stage.progress) stage.progress->update(progress_of(now));
            return stage.interrupted && stage.interrupted();
        },
        [&](const CellScene& lost) { return describe_remains(stage.folder, lost); });
    if (is_interrupted(scene->solution)) {
        say("interrupted; the flow on cells begins anew the next time");
        return Outcome::interrupted;
    }
    if (stage.progress) stage.progress->finish(progress_of(*scene));
    if (scene->solution.is_given_up) {
        say(
            fmt::format("the flow has no rest: after {} steps its cells lack {:.1g} of it. It is followed in time, and "
                        "means over time are the answer",
                        scene->solution.history.size(),
                        std::max(scene->balance->volume_residual(), scene->balance->momentum_residual())));
        return follow(*scene);
    }
    write_cells(stage.folder, *scene);
    write_wall(stage.folder, *scene);
    Json summary = make_cell_summary(*scene);
    summary["made_from"] = origin_summary(origin_of(config, stage.binary_hash));
    if (config.has_vessel()) add_vessel_results(summary, *scene, stage.folder);
    write_summary(stage.folder.file("summary.json"), summary);
    write_timing(stage.folder,
                 {{"build", {{"cpu_s", build_cpu}, {"wall_s", build_wall}}},   // the coarse solution included
                  {"flow", {{"cpu_s", watch.cpu() - build_cpu}, {"wall_s", watch.wall() - build_wall}}},
                  {"resumed", false}});
    say(fmt::format("done: {} steps in {:.1f} s", scene->solution.history.size(), watch.wall()));
    if (scene->solution.is_damped)
        say("solved by the damped transport (THEORY 18.5), for the sharp one finds no rest here: a pressure drop may "
            "be some per cent less exact");
    if (scene->solution.is_converged) return Outcome::done;
    stage.log(
        LogLevel::warning,
        fmt::format(
            "the flow does not come to rest (the cells lack {:.1g} of it): the results are marked; they are means "
            "over the last steps, while flows and pressures at the openings stood within {:.2g} %; "
            "numerics.without_rest: follow takes means over time, which lasts ten times as long",
            std::max(scene->balance->volume_residual(), scene->balance->momentum_residual()),
            100 * scene->solution.swing));
    return Outcome::unsettled;
}

}   // namespace patency
