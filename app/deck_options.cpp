// SPDX-License-Identifier: Apache-2.0
#include "deck_options.h"

#include <fmt/format.h>
#include <omp.h>

#include "command_line.h"
#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/stages/opening_names.h"
#include "patency/stages/stent_of_case.h"

namespace patency::app {

namespace {

/// Names that the schema does not know, before anything is built.
const deck::Case& with_known_names(const deck::Case& config) {
    if (config.stent) expect_known_names(*config.stent);
    return config;
}

}   // namespace

void DeckOptions::add_to(const Command& command) {
    command.add_option("case", path, "the deck (YAML)").required();
    command.add_option("--set", settings, "change a key of the deck: key=value; may be repeated").repeated();
    command.add_option("--run", run, "which of the deck's runs");
    command.add_option("--threads", threads, "how many threads; the deck's or one per core if absent").between(1, 1024);
}

deck::Case DeckOptions::read() const {
    const std::vector<deck::NamedCase> runs = deck::read_runs(path, settings, find_opening_names);
    if (run.empty() && runs.size() == 1) return with_known_names(runs.front().resolved);
    std::vector<std::string> names;
    for (const deck::NamedCase& named : runs) {
        if (named.name == run) return with_known_names(named.resolved);
        names.push_back(named.name);
    }
    throw UsageError(
        run.empty() ? fmt::format("the deck has several runs; choose one with --run: {}", join(names, ", ", " or "))
                    : fmt::format("the deck has no run '{}'; it has {}", run, join(names, ", ", " and ")));
}

int DeckOptions::apply_threads(const deck::Case& config) const {
    const int wanted = threads > 0 ? threads : config.numerics.threads;
    if (wanted > 0) omp_set_num_threads(wanted);
    return omp_get_max_threads();
}

std::string DeckOptions::title(const deck::Case& config) const {
    return fmt::format("{} on {}", path, thread_text(apply_threads(config)));
}

std::string thread_text(int threads) { return fmt::format("{} {}", threads, threads == 1 ? "thread" : "threads"); }

}   // namespace patency::app
