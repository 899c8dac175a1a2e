// SPDX-License-Identifier: Apache-2.0
// patency check: all mistakes of a deck at once, then what the flow will be and cost. Runs nothing.
#include <fmt/format.h>

#include <optional>

#include "command_line.h"
#include "commands.h"
#include "deck_options.h"
#include "patency/stages/build.h"
#include "patency/stages/cell_plan.h"
#include "patency/stages/cell_start.h"
#include "patency/stages/deploy_plan.h"
#include "patency/stages/disk_plan.h"
#include "patency/stages/plan.h"
#include "patency/stages/stopwatch.h"
#include "solid_runner.h"

namespace patency::app {

namespace {

std::string readable_time(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

std::string readable_size(double bytes) {
    return bytes < 995e6 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

/// What a flow costs, alone.
struct FlowCost {
    double across, memory, seconds, disk;
    int threads;
    double longest_seconds = seconds;   ///< if the flow does not settle
};

void print_cost(const FlowCost& cost) {
    fmt::print("  memory, disk         about {}, {}\n", readable_size(cost.memory), readable_size(cost.disk));
    fmt::print("  expected time        about {} on {}", readable_time(cost.seconds), thread_text(cost.threads));
    if (cost.longest_seconds > 1.1 * cost.seconds)
        fmt::print(" if the flow settles soon, {} at the longest", readable_time(cost.longest_seconds));
    fmt::print("\n");
    if (cost.across < 12)
        fmt::print("  note: at least 12 particles across the narrowest place give a sensible answer\n");
}

void print_speed(double reynolds, double speed) {
    constexpr double laminar = 2300;   // of a tube; behind a lesion jets break up at a quarter of it
    fmt::print("  Reynolds number      {:.3g} (mean speed, narrowest width)\n", reynolds);
    fmt::print("  largest speed        {:.3g} m/s\n", speed);
    if (reynolds > laminar)
        fmt::print(
            "  note: blood in a vessel is turbulent from about {:.0f} on, which this program does not compute; are the "
            "units of flows, "
            "pressures and viscosity right?\n",
            laminar);
}

void print_cell_plan(const std::string& path, const CellPlan& plan) {
    fmt::print("{}: the deck is right\n", path);
    fmt::print("  scheme               cells: a {} flow through a rigid lumen, on particles that stand still\n",
               plan.steps > 0 ? "periodic" : "steady");
    print_speed(plan.reynolds, plan.speed);
    if (plan.steps > 0) fmt::print("  steps in time        {:.0f}\n", plan.steps);
    fmt::print("  spacing              {:.3g} to {:.3g} mm\n", 1e3 * plan.finest, 1e3 * plan.coarsest);
    fmt::print("  cells                about {:.3g}; {:.1f} across the narrowest place\n", plan.cells,
               plan.across_narrowest);
}

void print_flow_plan(const std::string& path, const FlowPlan& plan) {
    fmt::print("{}: the deck is right\n", path);
    print_speed(plan.reynolds, plan.speed);
    fmt::print("  sound speed          {:.3g} m/s\n", plan.sound_speed);
    fmt::print("  steps                {:.3g} s advection, {:.3g} s acoustic, about {:.3g} acoustic steps\n",
               plan.advection_step, plan.acoustic_step, plan.acoustic_steps);
    fmt::print("  particles            about {:.3g} of blood, {:.3g} of wall; {:.1f} across the narrowest place\n",
               plan.fluid_particles, plan.wall_particles, plan.across_narrowest);
}

void print_deploy_plan(const deck::Case& config, const DeployPlan& plan, int threads) {
    const StentPlace& place = plan.place;
    fmt::print(
        "  stent                {:.4g} x {:.4g} mm, opened to {:.4g} mm, along {:.4g} to {:.4g} mm from the inlet\n",
        1e3 * place.pattern.diameter, 1e3 * place.pattern.length, 1e3 * place.diameter, 1e3 * place.start_arc(),
        1e3 * place.end_arc());
    fmt::print("  lumen there          {:.3g} mm at its narrowest, {:.3g} mm where healthy\n", 1e3 * place.narrowest,
               1e3 * place.reference_diameter);
    if (config.deployment.mode == deck::DeploymentMode::geometric)
        return fmt::print("  deployment           without mechanics, seconds\n");
    fmt::print(
        "  deployment           about {:.3g} particles of stent, {:.3g} of wall; {:.3g} steps, the stent's mass times "
        "{:.3g}; about {} on {}\n",
        plan.stent_particles, plan.wall_particles, plan.steps, plan.mass_scaling, readable_time(plan.seconds),
        thread_text(threads));
    if (const double slowing = config.deployment.slowing; slowing > 1)
        fmt::print("  pace                 up to {:.3g} times more slowly where stent or wall would move too fast\n",
                   slowing);
}

void check(const DeckOptions& options) {
    const deck::Case config = options.read();
    if (!config.solids.empty()) {
        options.apply_threads(config);
        fmt::print("{}: the deck is right\n", options.path);
        return print_solid_plan(config);
    }
    const int threads = options.apply_threads(config);
    std::optional<Vessel> vessel;
    const Stopwatch reading;
    if (config.has_vessel()) vessel = read_vessel(config);
    const double read_seconds = reading.wall();
    const Vessel* known = vessel ? &*vessel : nullptr;
    std::optional<DeployPlan> deployment;   // before a word is said: a stent that does not fit is a mistake too
    if (config.stent) deployment = plan_deploy(config, threads);
    FlowCost cost{};
    if (config.scheme() == deck::SchemeName::cells) {
        const CellPlan plan = plan_cells(config, threads, known);
        print_cell_plan(options.path, plan);
        cost = {plan.across_narrowest, plan.memory, plan.seconds, flow_disk(config, plan.cells, 0, known), threads};
    } else {
        const FlowPlan plan = plan_flow(*build_frame(config), threads);
        print_flow_plan(options.path, plan);
        cost = {plan.across_narrowest,
                plan.memory,
                plan.seconds,
                flow_disk(config, plan.fluid_particles, plan.wall_particles, known),
                threads,
                plan.longest_seconds};
        if (config.initial_velocity() == deck::InitialVelocity::cells) {
            const double start = plan_cells(case_on_cells(config), threads, known).seconds;
            cost.seconds += start, cost.longest_seconds += start;
        }
    }
    print_cost(cost);
    if (!deployment) return;
    print_deploy_plan(config, *deployment, threads);
    // The flow after takes about what the flow before takes. The vessel is read once more for the stent's place, for the deployment, after
    // it and for each estimate, as long as it was just now.
    fmt::print("  patency run          all stages: about {}, {} on the disk\n",
               readable_time(2 * cost.seconds + deployment->seconds + 5 * read_seconds),
               readable_size(2 * cost.disk + deploy_disk(config, *deployment, *vessel)));
}

}   // namespace

void add_check_command(const Command& program, ExitCode&) {
    const Command command =
        program.add_command("check", "report all mistakes of a deck, and what it will cost; runs nothing");
    const auto options = std::make_shared<DeckOptions>();
    options->add_to(command);
    command.when_given([options] { check(*options); });
}

}   // namespace patency::app
