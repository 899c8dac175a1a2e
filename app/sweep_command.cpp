// SPDX-License-Identifier: Apache-2.0
// patency sweep: a deck with all combinations of some keys' values, each a run in a folder of its own; one table and one page.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "deck_options.h"
#include "patency/base/text.h"
#include "patency/config/sweep.h"
#include "patency/io/atomic_file.h"
#include "patency/io/summary.h"
#include "patency/report/sweep.h"
#include "patency/stages/flow_checkpoint.h"
#include "side_by_side.h"
#include "stage_runner.h"

namespace patency::app {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct SweepOptions {
    DeckOptions deck;
    std::string out, command = "run";
    int jobs = 0;
    bool fresh = false;
};

/// One of the sweep's runs: the deck's options that make it, and what it is made from.
struct Variant {
    SweepRow row;
    DeckOptions deck;
};

/// The sweep's axes: the settings, and the deck's own runs where it has several and none was chosen.
std::vector<deck::SweepAxis> axes_of(const SweepOptions& options) {
    std::vector<deck::SweepAxis> axes;
    for (const std::string& setting : options.deck.settings) axes.push_back(deck::parse_axis(setting));
    if (!options.deck.run.empty()) return axes;
    deck::Settings first;   // names of runs do not depend on values, but the deck must be whole to be read
    for (const deck::SweepAxis& axis : axes) first.push_back(axis.key + "=" + axis.values.front());
    deck::SweepAxis runs{"run", {}};
    for (const deck::NamedCase& named : deck::read_runs(options.deck.path, first)) runs.values.push_back(named.name);
    if (runs.values.size() > 1) axes.push_back(runs);
    return axes;
}

/// All runs, their decks read: a mistake in any of them stops the sweep before it begins. `sweep` gets its keys.
std::vector<Variant> variants_of(const SweepOptions& options, Sweep& sweep) {
    const std::vector<deck::SweepAxis> axes = axes_of(options);
    for (const deck::SweepAxis& axis : axes)
        if (axis.values.size() > 1) sweep.keys.push_back(axis.key);
    std::vector<Variant> variants;
    for (const deck::SweepPoint& point : deck::combine(axes)) {
        Variant variant{.row = {.name = point.name, .values = {}}, .deck = options.deck};
        variant.deck.settings.clear();
        for (std::size_t a = 0; a < axes.size(); ++a) {
            if (axes[a].values.size() > 1) variant.row.values.push_back(point.values[a]);
            if (axes[a].key == "run")
                variant.deck.run = point.values[a];
            else
                variant.deck.settings.push_back(axes[a].key + "=" + point.values[a]);
        }
        const deck::Case config = variant.deck.read();
        sweep.name = config.about.name;
        variant.row.made_from = std::make_shared<const Json>(origin_summary(origin_of(config, binary_hash())));
        variants.push_back(std::move(variant));
    }
    return variants;
}

bool has_ended_well(const SweepRow& row) {
    return row.exit_code == int(ExitCode::ok) || row.exit_code == int(ExitCode::bar_missed);
}

/// Runs that an earlier sweep brought to their end are kept, if they are the same.
void keep_what_is_done(const fs::path& out, Sweep& sweep) {
    if (!is_sweep(out)) return;
    const Sweep before = read_sweep(out);
    if (before.command != sweep.command)
        throw CheckpointError(
            fmt::format("'{}' holds a sweep of patency {}; --fresh begins anew there", out.string(), before.command));
    for (SweepRow& row : sweep.rows)
        for (const SweepRow& old : before.rows)
            if (old.name == row.name && old.made_from && *old.made_from == *row.made_from && has_ended_well(old) &&
                old.summary)
                row = old;
}

/// Why a run failed: its last sentence.
std::string reason_in(const fs::path& output, int exit_code) {
    if (exit_code == int(ExitCode::ok)) return {};
    if (exit_code == int(ExitCode::bar_missed)) return "finished, but a bar or the convergence was missed";
    const std::string said = read_file(output);
    std::string reason = fmt::format("ended with exit code {}", exit_code);
    for (const std::string_view line : split(said, '\n'))
        if (line.starts_with("patency: ")) reason = line.substr(9);
    return reason;
}

Job job_of(const SweepOptions& options, const Variant& variant, int threads) {
    const fs::path folder = fs::path(options.out) / variant.row.name;
    Job job{{options.command, options.deck.path, "-o", folder.string(), "--threads", fmt::format("{}", threads)},
            fs::path(options.out) / (variant.row.name + ".txt")};
    for (const std::string& setting : variant.deck.settings)
        job.arguments.insert(job.arguments.end(), {"--set", setting});
    if (!variant.deck.run.empty()) job.arguments.insert(job.arguments.end(), {"--run", variant.deck.run});
    if (options.fresh && options.command != "estimate")   // which always begins anew
        job.arguments.emplace_back("--fresh");
    return job;
}

ExitCode run(const SweepOptions& options) {
    Sweep sweep{.name = {}, .command = options.command, .keys = {}, .rows = {}};
    const std::vector<Variant> variants = variants_of(options, sweep);
    for (const Variant& variant : variants) sweep.rows.push_back(variant.row);
    const OutputFolder folder(options.out);
    if (options.fresh) folder.clear();
    keep_what_is_done(options.out, sweep);
    const auto record = [&] { write_sweep(options.out, sweep, PATENCY_VERSION); };
    record();

    std::vector<std::size_t> to_run;   // rows
    for (std::size_t k = 0; k < variants.size(); ++k)
        if (!has_ended_well(sweep.rows[k])) to_run.push_back(k);
    const int threads = options.deck.apply_threads(variants.front().deck.read());
    const int at_once = std::clamp(options.jobs > 0 ? options.jobs : threads, 1, std::max(1, int(to_run.size())));
    const Log log = make_run_log(folder, !options.fresh);
    const auto say = [&](const std::string& line) { log(LogLevel::info, line); };
    say(fmt::format("{}: {} runs, {} of them done before; {} at once, {} each", options.deck.path, variants.size(),
                    variants.size() - to_run.size(), at_once, thread_text(std::max(1, threads / at_once))));
    std::vector<Job> jobs;
    for (const std::size_t row : to_run) jobs.push_back(job_of(options, variants[row], std::max(1, threads / at_once)));
    const Interruption interruption(folder);
    std::size_t ended = 0;
    run_side_by_side(jobs, at_once, interruption,
                     {.begun = [&](std::size_t job) { say(fmt::format("{} begins", sweep.rows[to_run[job]].name)); },
                      .ended =
                          [&](std::size_t job, int exit_code) {
                              SweepRow& row = sweep.rows[to_run[job]];
                              row.exit_code = exit_code;
                              row.reason = reason_in(jobs[job].output, exit_code);
                              const fs::path summary = fs::path(options.out) / row.name / "summary.json";
                              if (has_ended_well(row) && fs::exists(summary))
                                  row.summary = std::make_shared<const Json>(read_summary(summary));
                              say(fmt::format("{} of {}: {}: {}", ++ended, to_run.size(), row.name,
                                              row.reason.empty() ? "done" : row.reason));
                              record();
                          }});
    fmt::print("{}", sweep_text(sweep));
    say(fmt::format("the page: {}", folder.file("report.html").string()));
    if (interruption.is_wanted()) return interruption.exit_code();
    const auto has_code = [&](ExitCode code) {
        return std::any_of(sweep.rows.begin(), sweep.rows.end(),
                           [&](const SweepRow& row) { return row.exit_code == int(code); });
    };
    if (has_code(ExitCode::checkpoint)) return ExitCode::checkpoint;
    const bool all_good = std::all_of(sweep.rows.begin(), sweep.rows.end(),
                                      [](const SweepRow& row) { return row.exit_code == int(ExitCode::ok); });
    return all_good ? ExitCode::ok : ExitCode::bar_missed;
}

}   // namespace

void add_sweep_command(const Command& program, ExitCode& exit_code) {
    const Command command = program.add_command(
        "sweep", "a deck with all combinations of some keys' values, several runs at once; one table and one page");
    const auto options = std::make_shared<SweepOptions>();
    options->deck.add_to(command);
    command.describe("--set",
                     "a key of the deck and its values: key=value,value; may be repeated, all combinations are run");
    command.describe("--run", "which of the deck's runs; all of them if absent");
    command.describe("--threads", "how many threads all runs have together; the deck's or one per core if absent");
    command
        .add_option("-o,--out", options->out, "the folder for the results; a sweep that was interrupted there goes on")
        .required();
    command.add_option("--command", options->command, "what each run is")
        .one_of({"run", "flow", "deploy", "estimate", "solid"})
        .with_default();
    command.add_option("--jobs", options->jobs, "how many runs at once; as many as threads if absent").between(1, 1024);
    command.add_flag("--fresh", options->fresh, "do all runs again");
    command.when_given([options, &exit_code] { exit_code = run(*options); });
}

}   // namespace patency::app
