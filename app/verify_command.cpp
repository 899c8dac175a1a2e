// SPDX-License-Identifier: Apache-2.0
// `patency verify`: cases with known answers, their figures against bars.
#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "command_line.h"
#include "commands.h"
#include "interruption.h"
#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"
#include "patency/io/hash.h"
#include "patency/io/progress.h"
#include "patency/verify/runner.h"
#include "side_by_side.h"

namespace patency::app {

namespace {

namespace fs = std::filesystem;

/// The folder of the decks: the one asked for, else beside where we stand, else in the source tree.
fs::path find_decks(const std::string& wanted) {
    if (!wanted.empty()) return wanted;
    if (fs::exists("cases/verify")) return "cases/verify";
    std::error_code error;
    const fs::path installed =
        fs::read_symlink("/proc/self/exe", error).parent_path() / PATENCY_DATA / "cases" / "verify";
    return fs::exists(installed) ? installed : fs::path(PATENCY_SOURCE_DIR) / "cases" / "verify";
}

/// A line per run; on its way it is rewritten on a terminal, and repeated every minute elsewhere.
class Screen {
public:
    void show(const VerifyProgress& p) {
        const auto now = std::chrono::steady_clock::now();
        const bool is_terminal = isatty(STDERR_FILENO);
        const std::string name = p.case_name + " " + p.run_name;
        if (name != name_) name_ = name, start_ = last_ = now;
        if (p.done) {
            const std::string how = !p.done->failure.empty() ? "FAILED: " + p.done->failure
                                    : p.is_reused            ? "done before"
                                                             : fmt::format("{} steps, {:.1f} s ({:.1f} CPU s)",
                                                                           p.done->acoustic_steps, p.done->wall_s, p.done->cpu_s);
            fmt::print(stderr, "{}{:<42} {:>9} particles  {}\n", is_terminal ? "\r\033[K" : "", name, p.done->particles,
                       how);
        } else if (now - last_ > (is_terminal ? std::chrono::milliseconds(300) : std::chrono::milliseconds(60000))) {
            const double spent = std::chrono::duration<double>(now - start_).count();
            const std::string left = p.share > 0 ? "  left " + duration_text(spent * (1 - p.share) / p.share) : "";
            fmt::print(stderr, "{}{:<42} {:>5.1f} %{}{}", is_terminal ? "\r\033[K" : "", name, 100 * p.share, left,
                       is_terminal ? "" : "\n");
            std::fflush(stderr);
            last_ = now;
        }
    }

private:
    std::string name_;
    std::chrono::steady_clock::time_point start_{}, last_{};
};

void print_report(const CaseReport& report) {
    fmt::print("{} ({}, {} particles)\n", report.name, word_of(report.level), report.particles);
    for (const Figure& f : report.figures) {
        const std::string bar =
            f.bar ? fmt::format("{} {:g} {}", word_of(f.bar->sense), f.bar->limit, f.passes() ? "" : "MISSED") : "";
        fmt::print("  {:<48} {:>12} {:<8} {}\n", f.key, f.value ? fmt::format("{:.5g}", *f.value) : "none", f.unit,
                   bar);
        if (!f.value) fmt::print("    {}\n", f.reason);
    }
}

struct Options {
    std::vector<std::string> names, settings;
    std::string level = "quick", out = "verification", decks, reference, report, run;
    int threads = 0, jobs = 0;
    bool is_listing = false, fresh = false;
};

/// The cases one after the other, in this process.
ExitCode run_in_turn(const VerifyRequest& request) {
    const Interruption interruption;
    Screen screen;
    VerifyRequest watched = request;
    watched.report = [&](const VerifyProgress& p) { screen.show(p); };
    watched.interrupted = [&] { return interruption.is_wanted(); };
    bool all_pass = true;
    try {
        for (const CaseReport& report : run_verification(watched)) {
            print_report(report);
            all_pass = all_pass && report.passes();
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::interrupted) throw;
        throw Error(interruption.exit_code(), error.what());
    }
    return all_pass ? ExitCode::ok : ExitCode::bar_missed;
}

/// One case, as a command of its own whose text goes beside its runs.
Job job_of(const VerifyRequest& request, const std::string& name, int threads) {
    Job job{{"verify", name, "--level", word_of(request.level), "-o", request.out.string(), "--threads",
             fmt::format("{}", threads), "--decks", request.decks.string(), "--reference", request.reference.string()},
            request.out / "runs" / (name + ".txt")};
    for (const std::string& setting : request.settings) job.arguments.insert(job.arguments.end(), {"--set", setting});
    if (request.fresh) job.arguments.emplace_back("--fresh");
    return job;
}

/// Several cases at once, a process each: most are too small to keep more than one core busy. What a case said is shown when it ends.
ExitCode run_together(const VerifyRequest& request, int at_once, int threads) {
    std::vector<std::string> names = names_of_verification(request);
    std::ranges::reverse(
        names);   // the registry ends with the dearest, which would have the machine for themselves at the end
    std::error_code error;
    fs::create_directories(request.out / "runs", error);
    if (error) throw FileError(file_error_sentence("make", request.out / "runs", error.value()));
    std::vector<Job> jobs;
    for (const std::string& name : names) jobs.push_back(job_of(request, name, threads));
    const Interruption interruption;
    std::size_t ended = 0;
    ExitCode worst = ExitCode::ok;
    run_side_by_side(jobs, at_once, interruption,
                     {.begun =
                          [&](std::size_t job) {
                              fmt::print(stderr, "{} begins; {} tells how far it is\n", names[job],
                                         jobs[job].output.string());
                          },
                      .ended =
                          [&](std::size_t job, int exit_code) {
                              const auto code = ExitCode(exit_code);
                              if (worst == ExitCode::ok || (worst == ExitCode::bar_missed && code != ExitCode::ok))
                                  worst = code;
                              fmt::print("{}", read_file(jobs[job].output));
                              std::fflush(stdout);
                              fmt::print(stderr, "{} of {}: {} has ended\n", ++ended, names.size(), names[job]);
                          }});
    if (interruption.is_wanted())
        throw Error(interruption.exit_code(), "the verification was interrupted; the same command goes on with it");
    return worst;
}

ExitCode run(const Options& o) {
    if (o.is_listing) {
        for (const VerifyCase& c : verification_cases())
            fmt::print("{:<22} {:<6} {}\n", c.name, word_of(c.level), c.title);
        return ExitCode::ok;
    }
    if (!o.report.empty()) {
        write_verification_report(o.out, o.report, o.run);
        return ExitCode::ok;
    }
    if (o.threads > 0) omp_set_num_threads(o.threads);
    const fs::path decks = find_decks(o.decks);
    const VerifyRequest request{
        .names = o.names,
        .level = o.level == "full" ? Level::full : Level::quick,
        .out = o.out,
        .decks = decks,
        .reference = o.reference.empty() ? decks / "../../../shared/data/reference" : fs::path(o.reference),
        .program = hex_text(hash_file("/proc/self/exe")),
        .settings = o.settings,
        .fresh = o.fresh};
    const int cases = int(names_of_verification(request).size()), threads = omp_get_max_threads();
    const int at_once = std::clamp(o.jobs > 0 ? o.jobs : threads, 1, cases);
    return at_once == 1 ? run_in_turn(request) : run_together(request, at_once, std::max(1, threads / at_once));
}

}   // namespace

void add_verify_command(const Command& program, ExitCode& exit_code) {
    const Command command =
        program.add_command("verify", "Run cases with known answers and hold their figures against bars");
    const auto o = std::make_shared<Options>();
    command.add_option("names", o->names, "Cases; all of the level if none is named");
    command.add_option("--level", o->level, "quick: eight minutes on two cores; full: everything")
        .one_of({"quick", "full"})
        .with_default();
    command
        .add_option("-o,--out", o->out, "Folder of the results; runs that are done are kept there and not done again")
        .with_default();
    command.add_option("--threads", o->threads, "Threads of all cases together; all cores if not given")
        .between(1, 1024);
    command.add_option("--jobs", o->jobs, "Cases at once; as many as threads if not given").between(1, 1024);
    command.add_option("--set", o->settings, "KEY=VALUE over every deck").repeated();
    command.add_option("--decks", o->decks, "Folder of the decks (cases/verify)");
    command.add_option("--reference", o->reference, "Folder of stored results of other programs");
    command.add_option("--report", o->report,
                       "Write the document of the results in the folder and of those written before, and run nothing");
    command.add_option(
        "--run", o->run,
        "With --report: OUT of patency run on the reference paper's bifurcation, to stand beside its table VI");
    command.add_flag("--fresh", o->fresh, "Do all runs again");
    command.add_flag("--list", o->is_listing, "List the cases");
    command.when_given([o, &exit_code] { exit_code = run(*o); });
}

}   // namespace patency::app
