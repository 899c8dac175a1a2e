// SPDX-License-Identifier: Apache-2.0
// patency check: all mistakes of a deck at once, then what the flow will be and cost. Runs nothing.
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.h"
#include "deck_options.h"
#include "solid_runner.h"
#include "patency/stages/build.h"
#include "patency/stages/cell_plan.h"
#include "patency/stages/deploy_plan.h"
#include "patency/stages/plan.h"

namespace patency::app {

namespace {

std::string readable_time(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

void print_resolution(double across, double memory, double seconds, int threads) {
    fmt::print("  memory               about {:.0f} MB\n", memory / 1e6);
    fmt::print("  expected time        about {} on {} threads\n", readable_time(seconds), threads);
    if (across < 12) fmt::print("  note: at least 12 particles across the narrowest place give a sensible answer\n");
}

void print_cell_plan(const std::string& path, const CellPlan& plan) {
    fmt::print("{}: the deck is right\n", path);
    fmt::print("  scheme               cells: a steady flow through a rigid lumen, on particles that stand still\n");
    fmt::print("  spacing              {:.3g} to {:.3g} mm\n", 1e3 * plan.finest, 1e3 * plan.coarsest);
    fmt::print("  cells                about {:.3g}; {:.1f} across the narrowest place\n", plan.cells, plan.across_narrowest);
    print_resolution(plan.across_narrowest, plan.memory, plan.seconds, plan.threads);
}

void print_deploy_plan(const deck::Case& config, int threads) {
    const DeployPlan plan = plan_deploy(config, threads);
    const StentPlace& place = plan.place;
    fmt::print("  stent                {:.4g} x {:.4g} mm, opened to {:.4g} mm, along {:.4g} to {:.4g} mm from the inlet\n", 1e3 * place.pattern.diameter,
               1e3 * place.pattern.length, 1e3 * place.diameter, 1e3 * place.start_arc(), 1e3 * place.end_arc());
    fmt::print("  lumen there          {:.3g} mm at its narrowest, {:.3g} mm where healthy\n", 1e3 * place.narrowest, 1e3 * place.reference_diameter);
    if (config.deployment.mode == deck::DeploymentMode::geometric) return fmt::print("  deployment           without mechanics, seconds\n");
    fmt::print("  deployment           about {:.3g} particles of stent, {:.3g} of wall; {:.3g} steps, the stent's mass times {:.3g}; about {} on {} threads\n",
               plan.stent_particles, plan.wall_particles, plan.steps, plan.mass_scaling, readable_time(plan.seconds), threads);
}

void check(const DeckOptions& options) {
    const deck::Case config = options.read();
    if (!config.solids.empty()) {
        options.apply_threads(config);
        fmt::print("{}: the deck is right\n", options.path);
        return print_solid_plan(config);
    }
    const auto deployment = [&] {
        if (config.stent) print_deploy_plan(config, options.apply_threads(config));
    };
    if (config.scheme() == deck::SchemeName::cells) {
        print_cell_plan(options.path, plan_cells(config, options.apply_threads(config)));
        return deployment();
    }
    const auto scene = build_frame(config);
    const FlowPlan plan = plan_flow(*scene, options.apply_threads(config));
    fmt::print("{}: the deck is right\n", options.path);
    fmt::print("  Reynolds number      {:.3g} (mean speed, narrowest width)\n", plan.reynolds);
    fmt::print("  largest speed        {:.3g} m/s\n", plan.speed);
    fmt::print("  sound speed          {:.3g} m/s\n", plan.sound_speed);
    fmt::print("  steps                {:.3g} s advection, {:.3g} s acoustic, {:.3g} acoustic steps in all\n", plan.advection_step,
               plan.acoustic_step, plan.acoustic_steps);
    fmt::print("  particles            about {:.3g} of blood, {:.3g} of wall; {:.1f} across the narrowest place\n", plan.fluid_particles,
               plan.wall_particles, plan.across_narrowest);
    print_resolution(plan.across_narrowest, plan.memory, plan.seconds, plan.threads);
    deployment();
}

}  // namespace

void add_check_command(CLI::App& program, ExitCode&) {
    CLI::App* command = program.add_subcommand("check", "report all mistakes of a deck, and what it will cost; runs nothing");
    const auto options = std::make_shared<DeckOptions>();
    options->add_to(*command);
    command->callback([options] { check(*options); });
}

}  // namespace patency::app
