// SPDX-License-Identifier: Apache-2.0
// The steady flow on cells against closed forms: a pipe, of relaxed particles and of disordered ones.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/stages/cell_scene.h"
#include "patency/stages/lumen_of_case.h"
#include "patency/verify/cell_shaking.h"
#include "patency/verify/closed_forms.h"
#include "patency/verify/measures.h"
#include "patency/verify/verify_case.h"

namespace patency {

namespace {

// The parabola comes in; its cells' own profile settles, and the outlet's plane is near, outside of these.
constexpr double measured_from = 0.3, measured_to = 0.8;

void measure_cells_pipe(const deck::Case& config, const std::string& run, const std::filesystem::path&,
                        const std::function<bool()>& interrupted, RunData& data) {
    const Lumen lumen = make_cell_lumen(config);
    CellPoints points = make_cell_points(lumen, config.numerics.spacing);
    if (run.ends_with("disordered")) shake(lumen, 0.25, points);
    const auto scene = make_cell_scene(config, lumen, points);
    solve_scene(*scene, nullptr, {.interrupted = interrupted});
    data.particles = std::int64_t(scene->mesh.size());
    if (!scene->solution.is_converged) return;

    const StraightAxis axis = find_straight_axis(config.geometry).value();
    const double radius = axis.outline.front().radius, mu = config.blood.viscosity,
                 area = std::numbers::pi * radius * radius;
    const double speed = config.openings.at("inlet").velocity.value(), flow = speed * area;
    const auto is_measured = [&](const Vec3& x) {
        const double share = axis.axial(x) / axis.length;
        return share > measured_from && share < measured_to;
    };
    const CellFields fields = scene->balance->fields();
    double w = 0, x = 0, p = 0, xx = 0, xp = 0, squares = 0;
    for (std::size_t i = 0; i < scene->mesh.size(); ++i) {
        if (!is_measured(scene->mesh.point[i])) continue;
        const double v = scene->mesh.volume[i], at = axis.axial(scene->mesh.point[i]),
                     s = axis.radial(scene->mesh.point[i]) / radius;
        w += v, x += v * at, p += v * fields.pressure[i], xx += v * at * at, xp += v * at * fields.pressure[i];
        const Vec3 error = fields.velocity[i] - 2 * speed * (1 - s * s) * axis.direction;
        squares += v * dot(error, error);
    }
    const auto stress = scene->balance->wall_shear_stress();
    double force = 0, wall = 0;
    for (std::size_t k = 0; k < stress.size(); ++k) {
        const CellPatch& patch = scene->mesh.patches[k];
        if (patch.opening != CellPatch::wall || !is_measured(patch.centroid)) continue;
        force += norm(patch.area) * dot(stress[k], axis.direction);
        wall += norm(patch.area);
    }
    const auto put = [&](const std::string& name, double value) { data.lists[name] = {value}; };
    put("gradient", -(w * xp - x * p) / (w * xx - x * x));
    put("exact_gradient", pipe_pressure_gradient(radius, mu, flow));
    put("wss", force / wall);
    put("exact_wss", pipe_wall_shear_stress(radius, mu, flow));
    put("velocity_error_percent", 100 * std::sqrt(squares / w) / (2 * speed));
    const auto ends = scene->balance->end_states();
    put("imbalance", std::abs(ends[0].flow + ends[1].flow) / flow);
    put("spacing", config.numerics.spacing);
    put("steps", double(scene->solution.history.size()));
}

double error_percent(const RunData& run, const std::string& name) {
    return 100 * std::abs(run.number(name) / run.number("exact_" + name) - 1);
}

void cells_pipe_figures(const Results& results, FigureList& figures) {
    for (const std::string disorder : {"", "_disordered"}) {
        const std::string d12 = "d12" + disorder, d20 = "d20" + disorder;
        const auto bar = [&](double ordered, double disordered) {
            return std::optional(Bar{disorder.empty() ? ordered : disordered});
        };
        figures.add(
            {"gradient_error_percent_" + d12, "percent", disorder.empty() ? std::optional(Bar{1.0}) : std::nullopt},
            {d12}, [&] { return error_percent(results[d12], "gradient"); });
        figures.add({"gradient_error_percent_" + d20, "percent", bar(0.5, 1.0)}, {d20},
                    [&] { return error_percent(results[d20], "gradient"); });
        figures.add({"wss_error_percent_" + d20, "percent", Bar{1.5}}, {d20},
                    [&] { return error_percent(results[d20], "wss"); });
        figures.add({"order" + disorder, "1", Bar{1.8, Sense::at_least}}, {d12, d20}, [&] {
            const RunData &coarse = results[d12], &fine = results[d20];
            return observed_order(coarse.number("velocity_error_percent"), coarse.number("spacing"),
                                  fine.number("velocity_error_percent"), fine.number("spacing"));
        });
        for (const std::string& run : {d12, d20})
            figures.add({"velocity_error_percent_" + run, "percent", {}}, {run},
                        [&] { return results[run].number("velocity_error_percent"); });
    }
    const std::vector<std::string> all = {"d12", "d20", "d12_disordered", "d20_disordered"};
    figures.add({"flow_imbalance", "1", Bar{1e-6}}, all, [&] {
        double worst = 0;
        for (const std::string& run : all) worst = std::max(worst, results[run].number("imbalance"));
        return worst;
    });
}

}   // namespace

std::vector<VerifyCase> cell_cases() {
    return {{.name = "cells_pipe",
             .title = "Steady flow on cells in a pipe, of relaxed and of disordered particles",
             .is_full = {},
             .measure = {},
             .measure_cells = measure_cells_pipe,
             .figures = cells_pipe_figures,
             .pictures = {}}};
}

}   // namespace patency
