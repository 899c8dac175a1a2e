// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/init_deck.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/base/units.h"
#include "patency/physics/open_ends/bed.h"
#include "patency/stages/bed.h"
#include "patency/stages/build.h"
#include "patency/stages/material.h"

namespace patency {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double fewest_across = 4;   // of an opening, or build_frame refuses it

// Common carotid: 415 mL/min (174 people, Radiology 1997; 205: 353) through 6.3 mm (Krejza et al. 2006). Aorta: 0.9 L/min below
// the renal arteries and 2.3 L/min above the coeliac one (Cheng et al. 2003), through about 17 and 23 mm.
constexpr std::array<InletDefault, 4> inlet_defaults{{
    {1.5e-3, deck::BedState::resting, resting_velocity, "a small artery at rest",
     "0.123 m/s, a coronary artery's at rest (J. Korean Soc. Echocardiogr. 2000; 8: 146)"},
    {6e-3, deck::BedState::hyperaemic, hyperaemic_velocity, "a coronary artery at hyperaemia",
     "0.279 m/s (J. Korean Soc. Echocardiogr. 2000; 8: 146)", true},
    {8e-3, deck::BedState::resting, 0.22, "a carotid artery at rest",
     "0.22 m/s: 415 mL/min in the common carotid (Radiology 1997; 205: 353) of 6.3 mm (Krejza et al. 2006)"},
    {1, deck::BedState::resting, 0.08, "the aorta or a leg's artery at rest",
     "0.08 m/s: 0.9 L/min below the renal arteries, 2.3 L/min above the coeliac one (Cheng et al. 2003)"},
}};

/// A number as a person writes it: so many digits in that unit, rounded up if `up`.
double written(double si, const char* unit, int digits, bool up = false) {
    const double value = in_unit(si, unit);
    double rounded = std::stod(fmt::format("{:.{}g}", value, digits));
    if (up && rounded < value) {
        const double last = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
        rounded = std::stod(fmt::format("{:.{}g}", rounded + last, digits));
    }
    const Unit* known = find_unit(unit);
    return parse_quantity(fmt::format("{} {}", format_number(rounded), unit), known->dimension);
}

deck::Case make_boundaries(const Vessel& vessel, const InitSettings& settings, const InletDefault& inlet) {
    deck::Case config;
    config.about.name = settings.name;
    config.geometry = settings.geometry;
    for (const ObliqueEnd& end : settings.oblique_ends)
        if (end.cut_back > 0) config.geometry.cut_back[end.name] = end.cut_back;
    config.blood.density = 1060;
    config.blood.viscosity = parse_quantity("3.5 mPa s", Dimension::viscosity);
    config.aorta.pressure = parse_quantity("93 mmHg", Dimension::pressure);
    for (std::size_t k = 0; k < vessel.openings.size(); ++k) {
        if (const std::string& name = vessel.openings[k].opening.name; !is_plain_name(name))
            throw GeometryError(
                fmt::format("a deck cannot name the opening {}: names have letters, digits, _ and -, at most 64. "
                            "Rename it in the file.",
                            double_quoted(shortened(name))));
        deck::Opening& said = config.openings[vessel.openings[k].opening.name];
        said.type = k == 0 ? deck::OpeningType::pressure : deck::OpeningType::resistance;
        if (k == 0) said.pressure = config.aorta.pressure;
    }
    const double area = vessel.openings.front().opening.area;
    config.bed.state = inlet.state;
    config.bed.venous_pressure = parse_quantity("5 mmHg", Dimension::pressure);
    if (inlet.velocity != hyperaemic_velocity && inlet.velocity != resting_velocity)
        config.bed.flow = written(inlet.velocity * area, "mL/min", 2);
    return config;
}

/// The same vessel as the heart beats: it follows the aorta's pressure, and beds store blood.
void let_pulse(deck::Case& config, double period, const std::string& inlet, bool is_coronary) {
    constexpr int longest =
        10;   // beats; a flow that starts from the beds' own beat repeats at once, and ends with the third
    config.about.mode = deck::Mode::periodic;
    config.about.period = period;
    config.aorta.pulse = parse_quantity("40 mmHg", Dimension::pressure);
    for (auto& [name, said] : config.openings) {
        if (name == inlet)
            said.pressure.reset();
        else
            said.type = is_coronary ? deck::OpeningType::coronary : deck::OpeningType::rcr;
    }
    config.numerics.duration = longest * period;
}

/// What a flow needs along the way from the inlet that needs most.
/// A profile is steady when its slowest viscous mode has fallen to a hundredth, or when blood at half the mean velocity has
/// passed, whichever is sooner; a way is steady when its branches have become so one after another. THEORY.md (15.8)
double settling_of(const Estimate& e, double kinematic_viscosity) {
    constexpr double first_zero = 2.404825557695773;
    std::vector<double> up_to(e.tree.branches.size());
    double most = 0;
    for (std::size_t b = 0; b < up_to.size(); ++b) {   // parents come before children
        const TreeBranch& branch = e.tree.branches[b];
        const double flow = std::abs(e.flow.flow[b]);
        double volume = 0;
        for (std::size_t k = 1; k < branch.arc.size(); ++k) {
            volume += 0.5 * (branch.area[k] + branch.area[k - 1]) * (branch.arc[k] - branch.arc[k - 1]);
        }
        const double length = branch.arc.back() - branch.arc.front();
        const double mean_square = length > 0 ? volume / length / pi : 0;   // radius
        const double viscous = std::log(100.0) * mean_square / (first_zero * first_zero * kinematic_viscosity);
        if (branch.parent >= 0) up_to[b] = up_to[std::size_t(branch.parent)];
        up_to[b] += flow > 0 ? std::min(viscous, 2 * volume / flow) : viscous;
        most = std::max(most, up_to[b]);
    }
    return most;
}

/// A scene at the coarsest spacing that the vessel's openings and what lies around them bear, whatever a budget says.
std::unique_ptr<Scene> coarsest_frame(deck::Case config, const Vessel& vessel) {
    double least = narrowest_diameter(*vessel.along);
    if (config.geometry.surface) {   // its throats may be narrower than what checks ask of an opening
        least = Bounds::infinity;
        for (const SurfaceOpening& o : vessel.openings) least = std::min(least, 2 * o.opening.radius);
    }
    constexpr int tries = 24;   // down to a third
    for (int k = 0;; ++k) {
        config.numerics.spacing = round_spacing(least / fewest_across * std::pow(0.95, k));
        try {
            return build_frame(config, &vessel);
        } catch (const Error&) {   // a continuation that runs into the vessel is shorter at a finer spacing
            if (k == tries) throw;
        }
    }
}

std::vector<Cut> find_cuts(const Vessel& vessel, const deck::Geometry& geometry, double spacing) {
    std::vector<Cut> cuts;
    for (std::size_t k = 1; k < vessel.openings.size(); ++k) {
        if (2 * vessel.openings[k].opening.radius >= fewest_across * spacing) continue;
        const Centreline& line = vessel.along->lines.lines[k - 1];
        std::size_t last = line.points.size() - 1;
        while (last > 0 && 2 * line.points[last].radius < fewest_across * spacing) --last;
        double length = line.length() - line.points[last].arc;
        if (const auto& least = vessel.along->least_cuts[k]) length = std::max(length, least->depth);
        const auto cut = geometry.cut_back.find(vessel.openings[k].opening.name);
        if (cut != geometry.cut_back.end()) length += cut->second;
        cuts.push_back({k, line.points[last].arc, line.length(), written(length, "mm", 3, true)});
    }
    return cuts;
}

std::vector<ShortEnd> find_short_ends(const Vessel& vessel) {
    constexpr double diameters = 1;   // of an opening: so far a disturbance is felt upstream in a laminar flow
    const VesselAlong& along = *vessel.along;
    std::vector<ShortEnd> ends;
    const auto add = [&](std::size_t opening, double length) {
        if (length < diameters * 2 * vessel.openings[opening].opening.radius)
            ends.push_back({opening, std::max(length, 0.0)});
    };
    double first =
        along.lines.branches.size() > 1 ? along.lines.end_arc(along.lines.branches.front()) : Bounds::infinity;
    for (const Lesion& lesion : along.assessment.lesions) first = std::min(first, lesion.start_arc);
    add(0, first);
    for (std::size_t j = 0; j < along.lines.lines.size(); ++j) {
        double last = 0;
        for (const Branch& b : along.lines.branches)
            if (b.lines.size() == 1 && b.lines[0] == j && b.parent >= 0)
                last = std::max(last, along.lines.start_arc(b));
        for (const Lesion& lesion : along.assessment.lesions)
            if (lesion.line == j) last = std::max(last, lesion.end_arc);
        add(j + 1, along.lines.lines[j].length() - last);
    }
    return ends;
}

/// Its nominal diameter is nearest to the healthy one, within a fifth of it; it is the shortest that reaches into healthy vessel on both sides.
std::optional<StentProposal> propose_stent(const VesselAlong& along) {
    if (along.assessment.lesions.empty()) return {};
    const Lesion& lesion = along.assessment.lesions.front();
    const double healthy = lesion.interpolated.diameter;
    const auto misfit = [&](const StentDesign& d) { return std::abs(d.pattern.nominal_diameter - healthy); };
    const auto best =
        std::min_element(stent_library().begin(), stent_library().end(),
                         [&](const StentDesign& a, const StentDesign& b) { return misfit(a) < misfit(b); });
    constexpr double largest_misfit = 0.2, landing = 2e-3;   // landing: m beyond the lesion at each end
    if (misfit(*best) > largest_misfit * healthy) return {};
    const double middle = 0.5 * (lesion.start_arc + lesion.end_arc);
    return StentProposal{0, &*best, with_length(best->pattern, lesion.length() + 2 * landing),
                         std::max(0.0, middle - along.lines.start_arc(along.lines.branches[lesion.branch]))};
}

}   // namespace

double ObliqueEnd::excess() const { return 1 / std::cos(angle) - 1; }

std::vector<ObliqueEnd> square_oblique_ends(Vessel& vessel) {
    constexpr double most_degrees = 15;
    constexpr double beyond_rim = 0.1;   // of the radius: so that no slivers of the old rim are left
    std::vector<ObliqueEnd> ends;
    std::map<std::string, double> lengths;
    for (std::size_t k = 0; k < vessel.openings.size(); ++k) {
        const std::optional<double> angle = off_square(vessel, k);
        if (!angle || *angle <= most_degrees * pi / 180) continue;
        const Opening& o = vessel.openings[k].opening;
        const double length = written(vessel.along->least_cuts[k]->depth + beyond_rim * o.radius, "mm", 2, true);
        ObliqueEnd end{o.name, *angle, length};
        try {   // each by itself: one that cannot be cut keeps no other from it
            Vessel one = vessel;
            cut_ends_back(one, {{o.name, length}});
            if (const std::string refused = refusals(one.checked.findings); !refused.empty())
                throw GeometryError(refused);
            lengths[o.name] = length;
        } catch (const GeometryError& error) {
            end.cut_back = 0, end.why_not = error.what();
        }
        ends.push_back(std::move(end));
    }
    if (lengths.empty()) return ends;
    Vessel cut = vessel;
    cut_ends_back(cut, lengths);
    follow_vessel(cut);
    if (const std::string refused = refusals(cut.checked.findings); refused.empty())
        vessel = std::move(cut);
    else
        for (ObliqueEnd& end : ends)
            if (end.cut_back > 0) end.cut_back = 0, end.why_not = refused;
    return ends;
}

const InletDefault& inlet_default(double diameter) {
    for (const InletDefault& inlet : inlet_defaults)
        if (diameter <= inlet.widest) return inlet;
    return inlet_defaults.back();
}

InitPlan plan_case(const Vessel& vessel, const InitSettings& settings) {
    const VesselAlong& along = *vessel.along;
    const Opening& inlet = vessel.openings.front().opening;
    InitPlan plan{};
    plan.inlet = &inlet_default(2 * inlet.radius);
    plan.budget = settings.budget;
    plan.config = make_boundaries(vessel, settings, *plan.inlet);
    plan.bed_flow = plan.config.bed.flow.value_or(flow_of_bed(plan.config.bed.state, inlet.area));
    plan.estimate = estimate_flow(plan.config, vessel);
    const FluidMaterial blood = make_material(plan.config.blood);
    plan.settling = settling_of(plan.estimate, blood.kinematic_viscosity());

    // Started from the flow on cells it is steady sooner, as a rule, and then ends: this is the longest.
    plan.config.numerics.scheme = deck::SchemeName::sph;
    plan.config.numerics.convergence.emplace();
    plan.config.numerics.duration = written(plan.settling, "s", 2, true);
    const auto scene = coarsest_frame(plan.config, vessel);

    plan.budget_spacing = finest_spacing(*scene, settings.budget, 2 * inlet.radius);
    plan.moving_spacing = std::min(plan.budget_spacing, scene->numerics.spacing);
    plan.price = plan_flow(*scene, settings.budget.threads, plan.moving_spacing);
    plan.fine_spacing = round_spacing(scene->lumen.narrowest / fewest_resolved);
    plan.fine_price = plan_flow(*scene, settings.budget.threads, plan.fine_spacing);
    for (const Branch& branch : along.lines.branches) plan.widths.push_back(widths_of(along, branch));
    if (plan.budget_spacing > plan.moving_spacing)
        plan.cuts = find_cuts(vessel, plan.config.geometry, plan.budget_spacing);
    plan.short_ends = find_short_ends(vessel);
    plan.oblique_ends = settings.oblique_ends;
    plan.stent = propose_stent(along);
    if (plan.stent) {   // what narrows the vessel is plaque
        plan.config.wall.plaque = deck::Plaque::fills;
        plan.config.wall.layers.plaque.emplace().name = "fibrous_plaque";
    }
    plan.with_stent = settings.with_stent;
    if (plan.with_stent && !plan.stent)
        throw GeometryError(along.assessment.lesions.empty()
                                ? "A stent is asked for, and the vessel has no lesion to put it into."
                                : "A stent is asked for, and none of the library (patency stent list) fits the worst "
                                  "lesion's diameter.");
    plan.config.numerics.scheme = deck::SchemeName::cells;
    plan.config.numerics.across = cells_across;
    if (settings.period) let_pulse(plan.config, *settings.period, inlet.name, plan.inlet->is_coronary);
    plan.cells = plan_cells(plan.config, settings.budget.threads, &vessel);
    return plan;
}

}   // namespace patency
