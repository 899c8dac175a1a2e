// SPDX-License-Identifier: Apache-2.0
// patency init: a commented deck for a vessel, ready to check, estimate and run; what it will cost and what it will see.
#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "command_line.h"
#include "commands.h"
#include "patency/base/text.h"
#include "patency/base/units.h"
#include "patency/io/atomic_file.h"
#include "patency/io/network_file.h"
#include "patency/stages/init_text.h"

namespace patency::app {

namespace {

namespace fs = std::filesystem;

struct InitOptions {
    std::string path, unit, space, inlet, name, out = "case.yaml", budget = "1 h";
    std::optional<int> label;
    int threads = 0;
    int heart_rate = 0;
    bool force = false, stent = false;
};

double parse_budget(const std::string& text) {
    try {
        const double seconds = parse_quantity(text, Dimension::time, "1 h");
        if (seconds > 0 && seconds <= 1e9) return seconds;
    } catch (const DeckError& error) {
        throw UsageError(fmt::format("--budget: {}", error.what()));
    }
    throw UsageError("--budget: a time greater than zero is needed, for example \"1 h\"");
}

/// Half of the machine's: others work there too.
double usable_memory() { return 0.5 * double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)); }

/// Without `..` and links, so that the way from one to the other is the right one.
fs::path resolved(const fs::path& path) {
    std::error_code error;
    const fs::path plain = fs::weakly_canonical(fs::absolute(path), error);
    return error ? fs::absolute(path) : plain;
}

void init(const InitOptions& o) {
    InitSettings settings;
    settings.budget = {parse_budget(o.budget), usable_memory(), o.threads > 0 ? o.threads : omp_get_max_threads()};
    if (o.threads > 0) omp_set_num_threads(o.threads);
    const fs::path out = resolved(o.out);
    if (!o.force && fs::exists(fs::symlink_status(out)))
        throw FileError(
            fmt::format("'{}' is there already; choose another name with -o, or --force to replace it", o.out));
    deck::Geometry& g = settings.geometry;
    const bool is_network = holds_network(o.path);
    (is_network ? g.network : g.surface) = resolved(o.path);
    if (!o.unit.empty()) g.unit = o.unit;
    if (!o.space.empty()) g.space = o.space;
    if (!o.inlet.empty()) g.inlet = o.inlet;
    g.label = o.label;
    settings.with_stent = o.stent;
    if (o.heart_rate > 0) settings.period = 60.0 / o.heart_rate;
    settings.name = o.name.empty() ? resolved(o.path).stem().string() : o.name;
    if (!is_utf8_text(settings.name)) throw UsageError("the name of the case is no UTF-8 text; give one with --name");

    if (is_network && g.inlet)
        throw UsageError("--inlet: a network's inlet is its widest end, or the one that its file names so");
    if (is_network && g.label) throw UsageError("--label: a network of tubes has no labels");
    deck::Case config;
    config.geometry = g;
    Vessel vessel = [&] {
        try {
            return read_vessel(config);
        } catch (const DeckError& error) {   // here the deck is the command line
            throw UsageError(error.what());
        }
    }();
    if (!is_network && !g.unit) g.unit = "mm";   // an image knows its own
    if (!is_network) settings.oblique_ends = square_oblique_ends(vessel);
    const InitPlan plan = plan_case(vessel, settings);
    write_file(out, deck_text(vessel, plan, out.parent_path()));
    fmt::print("{}\n", double_quoted(o.path));
    for (const std::string& line : describe_plan(vessel, plan)) fmt::print("{}\n", line);
    fmt::print("Written: {}\n", o.out);
}

}   // namespace

void add_init_command(const Command& program, ExitCode&) {
    const Command command =
        program.add_command("init", "write a commented deck for a vessel, with what is usual where nothing is known");
    const auto o = std::make_shared<InitOptions>();
    command.add_option("vessel", o->path, "a surface, a label map or a network of tubes, as patency inspect reads them")
        .required();
    command.add_option("--unit", o->unit,
                       "of its coordinates, which only images and JSON networks say themselves: m, cm, mm or um");
    command.add_option("--label", o->label, "of a label map with several: which one is the vessel");
    command.add_option("--space", o->space, "its axes, if the file does not say: LPS or RAS");
    command.add_option("--inlet", o->inlet,
                       "the opening that is the inlet, by name or number; the largest if not given");
    command.add_option("--name", o->name, "of the case; the file's if not given");
    command.add_option("--budget", o->budget, "how long the flow may take on this machine").with_default();
    command.add_option("--threads", o->threads, "how many threads; one per core if not given").between(1, 1024);
    command.add_option("-o,--out", o->out, "the deck").with_default();
    command
        .add_option("--heart-rate", o->heart_rate,
                    "beats a minute: a flow that pulses with the aorta's pressure; a steady one if not given")
        .between(30, 180);
    command.add_flag(
        "--stent", o->stent,
        "with the stent that it proposes for the worst lesion, for patency run; a comment in the deck if not given");
    command.add_flag("--force", o->force, "replace a deck that is there");
    command.when_given([o] { init(*o); });
}

}   // namespace patency::app
