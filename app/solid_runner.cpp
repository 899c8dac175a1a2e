// SPDX-License-Identifier: Apache-2.0
#include "solid_runner.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "stage_runner.h"
#include "patency/io/hash.h"
#include "patency/stages/run_solids.h"
#include "patency/stages/solid_scene.h"

namespace patency::app {

namespace {

volatile std::sig_atomic_t caught_signal = 0;
void note_signal(int signal) {
    caught_signal = signal;
    std::signal(signal, SIG_DFL);   // a second one ends the program at once
}

}   // namespace

ExitCode run_solid_stage(const deck::Case& config, const OutputFolder& folder, std::string_view heading, bool fresh) {
    const bool goes_on = !fresh && folder.has_checkpoint("solid");
    if (!goes_on) folder.clear();
    const Log log = make_run_log(folder, goes_on);
    log(LogLevel::info, heading);
    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
    const auto print = [](std::string_view text) {
        fmt::print(stderr, "{}", text);
        std::fflush(stderr);
    };
    Progress progress = isatty(STDERR_FILENO) ? Progress(print, {.style = ProgressStyle::terminal, .interval = 0.2, .width = 0, .clock = {}}) : Progress(print);
    try {
        if (run_solids(config, {.folder = folder, .binary_hash = hex_text(hash_file("/proc/self/exe")), .interrupted = [] { return caught_signal != 0; }, .log = log, .progress = &progress})) return ExitCode::ok;
    } catch (const Error& error) {
        log(LogLevel::error, error.what());
        throw;
    }
    return caught_signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
}

void print_solid_plan(const deck::Case& config) {
    const auto scene = build_solids(config);
    for (const auto& part : scene->system.parts) {
        const ElasticModuli m = part->solid.materials[0].moduli();
        fmt::print("  {:<20} {} particles; E {:.4g} Pa, nu {:.4g}, G {:.4g} Pa, K {:.4g} Pa\n", part->name, part->body->particles().size(), m.young(),
                   m.poisson(), m.shear, m.bulk);
    }
    const double dt = stable_step(scene->system);
    fmt::print("  steps                {:.3g} s; about {:.3g} in all\n", dt, config.numerics.duration / dt);
}

}   // namespace patency::app
