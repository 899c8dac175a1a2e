// SPDX-License-Identifier: Apache-2.0
#include "solid_runner.h"

#include <fmt/format.h>

#include "patency/stages/run_solids.h"
#include "patency/stages/solid_scene.h"
#include "stage_runner.h"

namespace patency::app {

ExitCode run_solid_stage(const deck::Case& config, const OutputFolder& folder, std::string_view heading, bool fresh) {
    const bool goes_on = !fresh && folder.has_checkpoint("solid");
    if (!fresh && !goes_on) expect_no_results(folder);
    if (!goes_on) folder.clear();
    const Log log = make_run_log(folder, goes_on);
    log(LogLevel::info, heading);
    const Interruption interruption(folder);
    Progress progress = make_progress();
    try {
        if (run_solids(config, {.folder = folder,
                                .binary_hash = binary_hash(),
                                .interrupted = [&] { return interruption.is_wanted(); },
                                .log = log,
                                .progress = &progress}))
            return ExitCode::ok;
    } catch (const Error& error) {
        log(LogLevel::error, error.what());
        throw;
    }
    return interruption.exit_code();
}

void print_solid_plan(const deck::Case& config) {
    const auto scene = build_solids(config);
    for (const auto& part : scene->system.parts) {
        const ElasticModuli m = part->solid.materials[0].moduli();
        fmt::print("  {:<20} {} particles; E {:.4g} Pa, nu {:.4g}, G {:.4g} Pa, K {:.4g} Pa\n", part->name,
                   part->body->particles().size(), m.young(), m.poisson(), m.shear, m.bulk);
    }
    const double dt = stable_step(scene->system);
    fmt::print("  steps                {:.3g} s; about {:.3g} in all\n", dt, config.numerics.duration / dt);
}

}   // namespace patency::app
