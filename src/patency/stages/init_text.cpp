// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/init_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/base/units.h"
#include "patency/physics/open_ends/bed.h"
#include "patency/stages/stent_placement.h"

namespace patency {

namespace {

double mm(double length) { return 1e3 * length; }
double mL_per_min(double flow) { return in_unit(flow, "mL/min"); }

std::string quantity(double si, std::string_view unit) { return double_quoted(format_quantity(si, unit)); }

/// As a key or a word in a comment: one line, whatever it is.
std::string shown_name(const std::string& name) {
    const bool is_ours =
        is_plain_name(name) && (name.starts_with("inlet") || name.starts_with("outlet") || name.starts_with("branch"));
    return is_ours ? name : double_quoted(name);
}

std::string readable_time(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

std::string price(const FlowPlan& p, double spacing) {
    return fmt::format(
        "spacing {}: {:.2g} particles of blood and {:.2g} of wall, {:.2g} acoustic steps of {:.2g} s, {:.0f} MB, about "
        "{} on {} thread{} if the flow settles soon, {} at the longest",
        format_quantity(spacing, "mm"), p.fluid_particles, p.wall_particles, p.acoustic_steps, p.acoustic_step,
        p.memory / 1e6, readable_time(p.seconds), p.threads, p.threads == 1 ? "" : "s",
        readable_time(p.longest_seconds));
}

/// How well something of that diameter is seen by moving particles.
std::string verdict(double across) {
    return across < 4 ? "not resolved: numbers there mean nothing" : across < fewest_resolved ? "under-resolved" : "";
}

class Lines {
public:
    template <class... Args>
    void add(fmt::format_string<Args...> format, Args&&... args) {
        lines_.push_back(fmt::format(format, std::forward<Args>(args)...));
        while (!lines_.back().empty() && lines_.back().back() == ' ') lines_.back().pop_back();
    }
    std::vector<std::string> take() { return std::move(lines_); }

private:
    std::vector<std::string> lines_;
};

void describe_openings(Lines& out, const Vessel& vessel, const InitPlan& plan) {
    out.add("Openings, and what patency estimate expects there (flow out of the vessel):");
    out.add("  {:<16} {:>11} {:>10} {:>11} {:>13} {:>7}", "name", "diameter mm", "area mm^2", "flow mL/min",
            "pressure mmHg", "moving");
    for (std::size_t k = 0; k < vessel.openings.size(); ++k) {
        const Opening& o = vessel.openings[k].opening;
        const double across = plan.across(2 * o.radius);
        out.add("  {:<16} {:>11.3f} {:>10.4g} {:>11.1f} {:>13.1f} {:>7.1f}  {}", shown_name(o.name), mm(2 * o.radius),
                1e6 * o.area, mL_per_min(plan.estimate.opening_flows[k]),
                in_unit(plan.estimate.opening_pressures[k], "mmHg"), across, verdict(across));
    }
}

void describe_branches(Lines& out, const Vessel& vessel, const InitPlan& plan) {
    const VesselAlong& along = *vessel.along;
    out.add("Branches, diameters of the largest spheres that fit, moving particles across:");
    out.add("  {:<16} {:<16} {:>8} {:>8} {:>11} {:>8} {:>7} {:>7}", "name", "after", "from mm", "to mm", "narrowest",
            "mean", "across", "mean");
    for (std::size_t b = 0; b < along.lines.branches.size(); ++b) {
        const Branch& branch = along.lines.branches[b];
        const Widths& w = plan.widths[b];
        out.add("  {:<16} {:<16} {:>8.2f} {:>8.2f} {:>8.3f} mm {:>5.3f} mm {:>7.1f} {:>7.1f}  {}",
                shown_name(branch.name),
                branch.parent < 0 ? "inlet" : shown_name(along.lines.branches[std::size_t(branch.parent)].name),
                mm(along.lines.start_arc(branch)), mm(along.lines.end_arc(branch)), mm(w.least), mm(w.mean),
                plan.across(w.least), plan.across(w.mean), verdict(plan.across(w.least)));
    }
}

void describe_lesions(Lines& out, const Vessel& vessel, const InitPlan& plan) {
    const VesselAlong& along = *vessel.along;
    out.add("Lesions: {}", along.assessment.lesions.empty() ? "none" : "");
    for (std::size_t k = 0; k < along.assessment.lesions.size(); ++k) {
        const Lesion& l = along.assessment.lesions[k];
        out.add(
            "  L{} in {} at {:.2f} mm from the inlet, {:.2f} mm long: {:.1f} % of the diameter, {:.1f} % of the area",
            k + 1, shown_name(along.lines.branches[l.branch].name), mm(l.throat_arc), mm(l.length()),
            100 * l.diameter_stenosis, 100 * l.area_stenosis);
        const double across = plan.across(l.minimum_diameter);
        out.add("     minimum lumen diameter {:.3f} mm, healthy {:.3f} mm; {:.1f} moving particles across  {}",
                mm(l.minimum_diameter), mm(l.interpolated.diameter), across, verdict(across));
        const EstimatedLesion& e = plan.estimate.lesions[k];
        if (e.ffr)
            out.add("     patency estimate: {:.1f} mL/min, {:.1f} mmHg lost, FFR {:.2f}", mL_per_min(e.flow),
                    in_unit(e.drop, "mmHg"), *e.ffr);
    }
}

/// A surface's end is cut by a key of the deck; that of a network where the network is made.
std::string how_to_cut(const InitPlan& plan, const std::string& name, double length) {
    if (plan.config.geometry.network) return ".";
    return fmt::format(": geometry.cut_back: {{{}: {}}}.", shown_name(name), quantity(length, "mm"));
}

void describe_oblique_ends(Lines& out, const InitPlan& plan) {
    for (const ObliqueEnd& end : plan.oblique_ends) {
        const double degrees = in_unit(end.angle, "deg");
        if (end.cut_back > 0)
            out.add("{} was {:.0f} degrees off square, its section {:.1f} % larger than the vessel: cut back by {}.",
                    shown_name(end.name), degrees, 100 * end.excess(), format_quantity(end.cut_back, "mm"));
        else
            out.add("{} is {:.0f} degrees off square, its section {:.1f} % larger than the vessel, and stays so: {}",
                    shown_name(end.name), degrees, 100 * end.excess(), end.why_not);
    }
}

void describe_price(Lines& out, const Vessel& vessel, const InitPlan& plan) {
    const double spacing = plan.moving_spacing;
    const CellPlan& cells = plan.cells;
    out.add(
        "Price: about {:.2g} cells, {:.2g} to {:.2g} mm apart, {:.0f} in each local diameter; {:.0f} MB, about {} on "
        "{} thread{}",
        cells.cells, mm(cells.finest), mm(cells.coarsest), cells_across, cells.memory / 1e6,
        readable_time(cells.seconds), cells.threads, cells.threads == 1 ? "" : "s");
    out.add("Moving particles instead, for a budget of {}{}:", readable_time(plan.budget.seconds),
            plan.config.about.mode == deck::Mode::periodic ? ", of the mean flow" : "");
    out.add("  {}", price(plan.price, spacing));
    if (!plan.is_within_budget())
        out.add(
            "  That is more than the budget: a coarser spacing would leave fewer than 4 particles across an opening.");
    if (plan.fine_spacing < spacing) out.add("  nothing under-resolved: {}", price(plan.fine_price, plan.fine_spacing));
    if (plan.config.about.mode == deck::Mode::steady) {
        out.add(
            "  Steady after {} s at the latest: along the slowest way, in each branch, the sooner of viscosity's "
            "slowest "
            "mode at 1 % and",
            format_number(plan.config.numerics.duration));
        out.add(
            "  twice the time that blood needs to pass. From the estimate it gets there sooner, and the run ends "
            "then.");
    }
    for (const Cut& cut : plan.cuts)
        out.add(
            "  The budget's {} would need {} cut back from {:.1f} to {:.1f} mm along its line, where it is 4 particles "
            "wide{}",
            format_quantity(plan.budget_spacing, "mm"), shown_name(vessel.openings[cut.opening].opening.name),
            mm(cut.end_arc), mm(cut.arc), how_to_cut(plan, vessel.openings[cut.opening].opening.name, cut.cut_back));
    for (const ShortEnd& end : plan.short_ends)
        out.add("  {} ends {:.1f} mm beside a bifurcation or a lesion, less than its diameter: extensions would help.",
                shown_name(vessel.openings[end.opening].opening.name), mm(end.length));
}

/// key: value, with its comment in a column of its own.
std::string commented(const std::string& line, const std::string& comment) {
    return fmt::format("{:<44} # {}\n", line, comment);
}

std::string path_text(const std::filesystem::path& path, const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::path relative = std::filesystem::proximate(path, folder, error);
    const std::string text = (error || relative.empty() ? path : relative).generic_string();
    if (!is_utf8_text(text)) throw UsageError("the file's path is no UTF-8 text, so a deck cannot name it; rename it");
    return double_quoted(text);
}

std::string geometry_text(const InitPlan& plan, const std::filesystem::path& folder) {
    const deck::Geometry& g = plan.config.geometry;
    std::string text = "geometry:\n";
    text += g.network ? commented("  network: " + path_text(*g.network, folder),
                                  "centrelines and radii; the path is relative to this deck")
                      : commented("  surface: " + path_text(*g.surface, folder),
                                  "the lumen; the path is relative to this deck");
    if (g.unit) text += commented("  unit: " + *g.unit, "of the file's coordinates");
    if (g.label)
        text += commented(fmt::format("  label: {}", *g.label), "of the label map: the one that is the vessel");
    if (g.space) text += commented("  space: " + *g.space, "axes of the file's coordinates");
    if (g.inlet)
        text += commented("  inlet: " + double_quoted(*g.inlet), "which opening is the inlet; the largest if absent");
    if (!g.cut_back.empty())
        text += commented("  cut_back:",
                          "ends cut square to the centreline, so far before them: an oblique section is too large");
    for (const ObliqueEnd& end : plan.oblique_ends)
        if (end.cut_back > 0)
            text += commented("    " + shown_name(end.name) + ": " + quantity(end.cut_back, "mm"),
                              fmt::format("it is {:.0f} degrees off square, so {:.1f} % too large",
                                          in_unit(end.angle, "deg"), 100 * end.excess()));
    if (g.surface) text += commented("  # extensions: {diameters: 2}", "straight pieces on all openings");
    return text;
}

std::string openings_text(const Vessel& vessel, const InitPlan& plan) {
    std::vector<double> diameters;
    for (std::size_t k = 1; k < vessel.openings.size(); ++k) diameters.push_back(2 * vessel.openings[k].opening.radius);
    const std::vector<double> shares = murray_shares(diameters, plan.config.bed.murray_exponent);
    std::string text = commented("openings:", "named as patency inspect does; flows are positive into the vessel");
    for (std::size_t k = 0; k < vessel.openings.size(); ++k) {
        const Opening& o = vessel.openings[k].opening;
        const std::string name = "  " + shown_name(o.name) + ":",
                          size = fmt::format("{:.3f} mm, {:.4g} mm^2", mm(2 * o.radius), 1e6 * o.area);
        if (k == 0) {
            const deck::Opening& said = plan.config.openings.at(o.name);
            text += commented(name, size);
            text += commented("    type: pressure",
                              "the aortic pressure; the beds then decide the flow, so a lesion lowers it");
            if (said.pressure)
                text += commented("    pressure: " + quantity(*said.pressure, "mmHg"), "mean; as aorta.pressure");
            continue;
        }
        const double resistance = *plan.estimate.outlets[k].resistance;
        text += commented(fmt::format("{} {{type: {}}}", name, word_of(plan.config.openings.at(o.name).type)),
                          fmt::format("{}: {:.1f} %, {:.1f} mL/min, {:.3g} mmHg min/mL", size, 100 * shares[k - 1],
                                      mL_per_min(plan.bed_flow * shares[k - 1]), in_unit(resistance, "mmHg min/mL")));
    }
    return text +
           "  # An outlet without numbers is tuned: its share of the bed's flow is as its diameter^3 (Murray 1926), "
           "its "
           "resistance\n"
           "  # the pressure from the aorta to the veins over that. Types resistance, rcr and coronary take numbers, "
           "if you "
           "know better.\n";
}

std::string bed_text(const InitPlan& plan) {
    const deck::Bed& bed = plan.config.bed;
    std::string text = commented("bed:", "the small vessels behind the outlets");
    text += commented(fmt::format("  state: {}", word_of(bed.state)),
                      fmt::format("{}; hyperaemic or resting", plan.inlet->what));
    const std::string flow = fmt::format("of all outlets together: {}", plan.inlet->source);
    text += bed.flow ? commented("  flow: " + quantity(*bed.flow, "mL/min"), flow)
                     : commented("  # flow: " + fmt::format("\"{:.3g} mL/min\"", mL_per_min(plan.bed_flow)), flow);
    text += commented("  murray_exponent: " + format_number(bed.murray_exponent),
                      "3: Murray 1926; 2.33: coronary trees (Huo & Kassab 2012)");
    return text + commented("  venous_pressure: " + quantity(bed.venous_pressure, "mmHg"), "behind the bed");
}

/// With a stent the wall of a deployment: what narrows the vessel is plaque, which gives way.
std::string wall_text(const InitPlan& plan) {
    if (plan.config.wall.plaque == deck::Plaque::none)
        return commented("wall: {motion: rigid}", "the wall stands still");
    return commented("wall:", "of the blood rigid; deformable where a stent is opened by contact") +
           commented("  motion: rigid", "the wall stands still") +
           commented("  plaque: fills", "of a stent by contact: between the lumen and the healthy one") +
           commented("  layers: {plaque: {name: " + *plan.config.wall.layers.plaque->name + "}}",
                     "gives way where it is stretched and stays; calcified_plaque: stiff");
}

std::string stent_text(const Vessel& vessel, const InitPlan& plan) {
    const VesselAlong& along = *vessel.along;
    if (!plan.stent)
        return along.assessment.lesions.empty()
                   ? ""
                   : "# No stent of the library (patency stent list) fits the worst lesion's diameter.\n";
    const StentProposal& s = *plan.stent;
    const Lesion& lesion = along.assessment.lesions[s.lesion];
    std::string text = fmt::format(
        "# A stent for L{}: {} opens to {:.2f} mm (healthy lumen {:.2f} mm), {:.1f} mm long (lesion {:.1f} mm).\n",
        s.lesion + 1, s.design->name, mm(s.design->pattern.nominal_diameter), mm(lesion.interpolated.diameter),
        mm(s.pattern.length), mm(lesion.length()));
    const std::string in = plan.with_stent ? "" : "# ";
    text += in + "stent:\n";
    text += commented(in + "  design: " + s.design->name, "of the library: patency stent list");
    text += commented(fmt::format("{}  length: \"{:.1f} mm\"", in, mm(s.pattern.length)),
                      fmt::format("{} rings; with 2 mm of healthy vessel at both ends", s.pattern.rings));
    text += commented(fmt::format("{}  placement: {{branch: {}, arc_length: \"{:.2f} mm\"}}", in,
                                  shown_name(along.lines.branches[lesion.branch].name), mm(s.arc)),
                      "its middle on the lesion's");
    text += in + "deployment:\n";
    text += commented(in + "  mode: geometric",
                      "a quick change of shape; balloon: by contact, with plastic struts, in hours");
    const double crimped = s.design->pattern.crimped_diameter;
    if (lesion.minimum_diameter < crimped)
        text +=
            commented(fmt::format("#   predilation: \"{:.1f} mm\"", mm(predilation_for(crimped))),
                      fmt::format("by contact, a balloon before: the crimped stent, {:.2f} mm, does not pass {:.2f} mm",
                                  mm(crimped), mm(lesion.minimum_diameter)));
    return text;
}

}   // namespace

std::vector<std::string> describe_plan(const Vessel& vessel, const InitPlan& plan) {
    Lines out;
    out.add("Vessel: {} outlet{}, {:.5g} mm^3, taken for {}.", vessel.openings.size() - 1,
            vessel.openings.size() == 2 ? "" : "s", 1e9 * vessel.checked.volume, plan.inlet->what);
    describe_openings(out, vessel, plan);
    describe_oblique_ends(out, plan);
    describe_branches(out, vessel, plan);
    describe_lesions(out, vessel, plan);
    describe_price(out, vessel, plan);
    return out.take();
}

std::string deck_text(const Vessel& vessel, const InitPlan& plan, const std::filesystem::path& folder) {
    const deck::Case& c = plan.config;
    std::string text =
        "# Blood flow in a vessel, with what is usual where nothing is known; written by patency init. Change what you "
        "know better,\n"
        "# then: patency check, patency estimate, patency flow. patency schema explains every key.\n#\n";
    for (const std::string& line : describe_plan(vessel, plan)) text += line.empty() ? "#\n" : "# " + line + "\n";
    text += "\n" + commented("version: 1", "of the deck's language");
    text += "case:\n" + commented("  name: " + double_quoted(c.about.name), "in reports");
    const bool is_periodic = c.about.mode == deck::Mode::periodic;
    text += is_periodic ? commented("  mode: periodic", "as the heart beats") +
                              commented("  period: " + quantity(*c.about.period, "s"),
                                        fmt::format("{:.0f} beats a minute", 60 / *c.about.period))
                        : commented("  mode: steady", "steady, or periodic with a period (patency init --heart-rate)");
    text += geometry_text(plan, folder);
    text += commented("blood:", "at 37 C, a haematocrit of 45 %, the shear rates of arteries");
    text += commented("  density: " + quantity(c.blood.density, "kg/m^3"), "mass per volume");
    text += commented("  viscosity: " + quantity(c.blood.viscosity, "mPa s"),
                      "Newtonian; laws that thin with shear: carreau_yasuda, casson");
    text += wall_text(plan);
    text += openings_text(vessel, plan);
    text += "aorta:\n" +
            commented("  pressure: " + quantity(*c.aorta.pressure, "mmHg"),
                      is_periodic ? "mean; the reference of FFR" : "mean, of 120 over 80; the reference of FFR");
    if (is_periodic) text += commented("  pulse: " + quantity(c.aorta.pulse, "mmHg"), "systolic less diastolic");
    text += bed_text(plan) + stent_text(vessel, plan);
    text +=
        "numerics:\n" +
        commented("  scheme: cells", fmt::format("a {} flow on the cells of still particles; sph: moving ones, hours",
                                                 word_of(c.about.mode))) +
        commented(fmt::format("  across: {}", format_number(*c.numerics.across)), "cells in each local diameter") +
        commented("  # spacing: " + quantity(plan.moving_spacing, "mm"),
                  fmt::format("of sph, instead of across: {:.1f} in the narrowest place", plan.price.across_narrowest));
    text += commented("  duration: " + quantity(c.numerics.duration, "s"),
                      is_periodic ? "at the longest" : "of sph, simulated, at the longest");
    text += commented(fmt::format("  convergence: {{tolerance_percent: {}}}",
                                  format_number(c.numerics.convergence->tolerance_percent)),
                      is_periodic ? "ends when flows and pressures at the openings repeat from beat to beat"
                                  : "of sph: ends when flows and pressures at the openings have stopped moving");
    text += "output:\n" + commented("  fields: [velocity, pressure]", "of the particles in the frames");
    return text + commented("  # interval: " + quantity(c.numerics.duration / 20, "s"),
                            "frames for ParaView; the last state only if absent");
}

}   // namespace patency
