// SPDX-License-Identifier: Apache-2.0
// `patency bench flow|solid`: how fast flow and solids are computed, beside the reference loop, with the answers compared.
#include <fmt/format.h>
#include <omp.h>

#include <memory>

#include "command_line.h"
#include "commands.h"
#include "patency/verify/bench_flow.h"
#include "patency/verify/bench_solid.h"

namespace patency::app {

namespace {

struct Options {
    std::vector<std::string> names;
    int threads = 0;
    double effort = 1;
    bool as_json = false;
};

void print(const BenchResult& r, std::FILE* file) {
    fmt::print(file,
               "{:<20} {:>9} particles {:>2} threads {:>11.4g} {:<30} reference {:>11.4g}  ratio {:>6.3f}  answer off "
               "by {:.1e}\n",
               r.name, r.particles, r.threads, r.value, r.unit, r.reference_value, r.ratio, r.answer_error);
    std::fflush(file);
}

using Bench = std::vector<BenchResult> (*)(const BenchRequest&);

void run(const Options& o, Bench bench) {
    const int threads = o.threads > 0 ? o.threads : omp_get_max_threads();
    const auto results =
        bench({.threads = threads, .names = o.names, .effort = o.effort, .report = [&](const BenchResult& r) {
                   print(r, o.as_json ? stderr : stdout);
               }});
    if (o.as_json) fmt::print("{}", format_bench(results));
}

}   // namespace

void add_bench_command(const Command& program, ExitCode&) {
    const Command bench =
        program.add_command("bench", "measure the speed, with a reference beside it and the answer checked");
    bench.expect_one_of_its_commands();
    const auto add = [&](const char* name, const char* what, const char* names, Bench measure) {
        const Command command = bench.add_command(name, what);
        const auto o = std::make_shared<Options>();
        command.add_option("names", o->names, names);
        command.add_option("--threads", o->threads, "how many threads; one per core if absent").between(1, 1024);
        command.add_option("--effort", o->effort, "how many times more steps, for steadier numbers").positive();
        command.add_flag("--json", o->as_json, "print a JSON array");
        command.when_given([o, measure] { run(*o, measure); });
    };
    add("flow", "pipes with openings and walls",
        "parts of names: pipe_d16, pipe_d32, two_threads, growth, mixed, double; all if absent", run_flow_bench);
    add("solid", "a block of 200,000 particles",
        "parts of names: block_mixed, block_double, metal_mixed; all if absent", run_solid_bench);
}

}   // namespace patency::app
