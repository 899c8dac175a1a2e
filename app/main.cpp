// SPDX-License-Identifier: Apache-2.0
// Arguments in, exit code out. Commands stand in files of their own (commands.h).
#include <fmt/format.h>
#include <omp.h>
#include <sched.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <vector>

#include "command_line.h"
#include "commands.h"
#include "exit_codes.h"

namespace {

int run(int argc, char** argv) {
    using namespace patency;
    ExitCode exit_code = ExitCode::ok;
    CLI::App program("Blood flow in a coronary artery by particle methods. Not a medical device.", "patency");
    program.require_subcommand(1);
    program.set_version_flag("--version", std::string("patency " PATENCY_VERSION));
    const app::Command commands(&program);
    app::add_check_command(commands, exit_code);
    app::add_inspect_command(commands, exit_code);
    app::add_init_command(commands, exit_code);
    app::add_stent_command(commands, exit_code);
    app::add_estimate_command(commands, exit_code);
    app::add_flow_command(commands, exit_code);
    app::add_deploy_command(commands, exit_code);
    app::add_solid_command(commands, exit_code);
    app::add_run_command(commands, exit_code);
    app::add_sweep_command(commands, exit_code);
    app::add_report_command(commands, exit_code);
    app::add_verify_command(commands, exit_code);
    app::add_bench_command(commands, exit_code);
    app::add_schema_command(commands, exit_code);
    app::add_version_command(commands, exit_code);
    app::add_man_command(program, exit_code);
    app::add_completion_command(program, exit_code);
    std::string codes = "Exit codes:";
    for (const app::ExitMeaning& exit : app::exit_meanings())
        codes += fmt::format("\n  {:<10}{}", exit.code, exit.meaning);
    program.footer(codes);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = program.exit(error);   // prints help or what is wrong
        return code == 0 ? 0 : int(ExitCode::usage);
    }
    return int(exit_code);
}

/// Where OMP_PROC_BIND or OMP_PLACES is set, libgomp has bound this thread to its own core by now, and a program that it starts would
/// know no other: it gets all the cores of all places back.
void leave_own_place() {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    for (int place = 0; place < omp_get_num_places(); ++place) {
        std::vector<int> ids(std::size_t(omp_get_place_num_procs(place)));
        omp_get_place_proc_ids(place, ids.data());
        for (const int id : ids) CPU_SET(std::size_t(id), &cores);
    }
    if (CPU_COUNT(&cores) > 0) ::sched_setaffinity(0, sizeof cores, &cores);
}

/// OpenMP's threads spin for milliseconds while they wait, which on a shared machine takes the time of those that work; but to
/// sleep and wake takes longer than the short loops of coarse levels. These spin some ten microseconds, then sleep. libgomp reads
/// its choices before main, so the program starts itself again with them, unless the user has made one.
void let_threads_sleep(char** argv) {
    if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
    ::setenv("GOMP_SPINCOUNT", "1000", 1);
    leave_own_place();
    ::execv("/proc/self/exe", argv);   // returns only if it fails: then they spin
}

}   // namespace

int main(int argc, char** argv) {
    let_threads_sleep(argv);
    try {
        return run(argc, argv);
    } catch (const patency::Error& error) {
        std::fprintf(stderr, "patency: %s\n", error.what());
        return int(error.code());
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr,
                     "patency: not enough memory; use a larger numerics.spacing (patency check says what is needed)\n");
        return int(patency::ExitCode::geometry);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "patency: %s\n", error.what());
        return 1;
    }
}
