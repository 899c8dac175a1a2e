// SPDX-License-Identifier: Apache-2.0
// `patency bench flow`: how fast the flow is computed, beside the reference loop, with the answers compared.
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <omp.h>

#include <memory>

#include "commands.h"
#include "patency/verify/bench_flow.h"

namespace patency::app {

namespace {

struct Options {
    std::vector<std::string> names;
    int threads = 0;
    double effort = 1;
    bool as_json = false;
};

void print(const BenchResult& r, std::FILE* file) {
    fmt::print(file, "{:<20} {:>9} particles {:>2} threads {:>11.4g} {:<30} reference {:>11.4g}  ratio {:>6.3f}  answer off by {:.1e}\n", r.name,
               r.particles, r.threads, r.value, r.unit, r.reference_value, r.ratio, r.answer_error);
    std::fflush(file);
}

void run(const Options& o) {
    const int threads = o.threads > 0 ? o.threads : omp_get_max_threads();
    const auto results = run_flow_bench({.threads = threads, .names = o.names, .effort = o.effort,
                                         .report = [&](const BenchResult& r) { print(r, o.as_json ? stderr : stdout); }});
    if (o.as_json) fmt::print("{}", format_bench(results));
}

}  // namespace

void add_bench_command(CLI::App& program, ExitCode&) {
    CLI::App* bench = program.add_subcommand("bench", "measure the speed, with a reference beside it and the answer checked");
    bench->require_subcommand(1);
    CLI::App* flow = bench->add_subcommand("flow", "pipes with openings and walls");
    const auto o = std::make_shared<Options>();
    flow->add_option("names", o->names, "parts of names: pipe_d16, pipe_d32, two_threads, growth, mixed, double; all if absent");
    flow->add_option("--threads", o->threads, "how many threads; one per core if absent")->check(CLI::Range(1, 1024));
    flow->add_option("--effort", o->effort, "how many times more steps, for steadier numbers")->check(CLI::PositiveNumber);
    flow->add_flag("--json", o->as_json, "print a JSON array");
    flow->callback([o] { run(*o); });
}

}  // namespace patency::app
