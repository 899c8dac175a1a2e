// SPDX-License-Identifier: Apache-2.0
// patency estimate: flow split, pressures and FFR of a vessel as a tree of tubes, in a second. A table on the terminal; with
// -o summary.json and pullback.csv.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "deck_options.h"
#include "patency/base/units.h"
#include "patency/io/csv.h"
#include "patency/io/output_folder.h"
#include "patency/io/summary.h"
#include "patency/stages/estimate_results.h"
#include "stage_runner.h"

namespace patency::app {

namespace {

struct EstimateOptions {
    DeckOptions deck;
    std::string out;
    bool vary = false;
};

std::string shown_band(const Band* band, std::string_view unit, int digits) {
    if (!band) return "";
    const auto shown = [&](double si) { return unit.empty() ? si : in_unit(si, unit); };
    return fmt::format("  ({:.{}f} to {:.{}f})", shown(band->low), digits, shown(band->high), digits);
}
double mL_per_min(double flow) { return in_unit(flow, "mL/min"); }
double mmHg(double pressure) { return in_unit(pressure, "mmHg"); }

void print(const Vessel& vessel, const Estimate& e, const std::optional<EstimateBand>& band) {
    fmt::print("Openings (flow out of the vessel):\n    {:<16} {:>11} {:>11} {:>14}\n", "name", "diameter mm",
               "flow mL/min", "pressure mmHg");
    for (std::size_t k = 0; k < vessel.openings.size(); ++k) {
        const Opening& o = vessel.openings[k].opening;
        fmt::print("    {:<16} {:>11.3f} {:>11.2f} {:>14.3f}{}\n", o.name, 2e3 * o.radius,
                   mL_per_min(e.opening_flows[k]), mmHg(e.opening_pressures[k]),
                   shown_band(band ? &band->opening_flows[k] : nullptr, "mL/min", 1));
    }
    fmt::print("Branches:\n    {:<20} {:>11} {:>10} {:>12} {:>8}\n", "name", "flow mL/min", "drop mmHg", "end mmHg",
               "FFR");
    for (std::size_t b = 0; b < e.tree.branches.size(); ++b) {
        const auto& p = e.flow.pressure[b];
        const auto ffr = e.ffr(b, p.size() - 1);
        fmt::print("    {:<20} {:>11.2f} {:>10.3f} {:>12.3f} {:>8}\n", e.tree.branches[b].name,
                   mL_per_min(e.flow.flow[b]), mmHg(p.front() - p.back()), mmHg(p.back()),
                   ffr ? fmt::format("{:.3f}", *ffr) : "-");
    }
    fmt::print("Lesions: {}\n", e.lesions.empty() ? "none" : "");
    for (std::size_t k = 0; k < e.lesions.size(); ++k) {
        const EstimatedLesion& l = e.lesions[k];
        const Lesion& lesion = vessel.along->assessment.lesions[l.number];
        fmt::print("  L{} in {} at {:.2f} mm: {:.1f} % of the diameter, {:.2f} mL/min, drop {:.3f} mmHg\n",
                   l.number + 1, vessel.along->lines.branches[lesion.branch].name, 1e3 * lesion.throat_arc,
                   100 * lesion.diameter_stenosis, mL_per_min(l.flow), mmHg(l.drop));
        if (l.ffr)
            fmt::print("     FFR {:.3f}{} at {:.1f} mm\n", *l.ffr,
                       shown_band(band ? &band->lesion_ffr[k] : nullptr, "", 3), 1e3 * l.read_arc);
    }
    if (!e.aortic_pressure) fmt::print("No FFR: the deck gives no aortic pressure (aorta.pressure).\n");
}

void write(const EstimateOptions& o, const deck::Case& config, const Vessel& vessel, const Estimate& e,
           const std::optional<EstimateBand>& band) {
    const OutputFolder folder(o.out);
    expect_no_results(folder, "");
    folder.clear();
    write_summary(folder.file("summary.json"), estimate_summary(config, vessel, e, band));
    const Pullback p = estimate_pullback(vessel, e);
    CsvWriter csv(folder.file("pullback.csv"), p.columns);
    for (const auto& row : p.rows) csv.write_row(row);
}

void estimate(const EstimateOptions& o) {
    const deck::Case config = o.deck.read();
    o.deck.apply_threads(config);
    const Vessel vessel = read_vessel(config);
    const Estimate e = estimate_flow(config, vessel);
    const std::optional<EstimateBand> band = o.vary ? std::optional(estimate_band(config, vessel)) : std::nullopt;
    print(vessel, e, band);
    if (!o.out.empty()) write(o, config, vessel, e, band);
}

}   // namespace

void add_estimate_command(const Command& program, ExitCode&) {
    const Command command =
        program.add_command("estimate", "flows, pressures and FFR of a vessel as a tree of tubes, in a second");
    const auto options = std::make_shared<EstimateOptions>();
    options->deck.add_to(command);
    command.add_option("-o,--out", options->out, "Folder of the results");
    command.add_flag("--vary", options->vary,
                     "Bands for a tenth more or less flow, a tenth of a millimetre of diameter, another split");
    command.when_given([options] { estimate(*options); });
}

}   // namespace patency::app
