// SPDX-License-Identifier: Apache-2.0
#include "patency/config/checks.h"

#include <algorithm>
#include <set>

#include "patency/base/text.h"
#include "patency/base/units.h"

namespace patency::deck {

namespace {

constexpr double fewest_across = 4;   // fewer particles across a vessel do not even see its walls

class Checker {
public:
    Checker(const Case& c, const Node& root, Mistakes& mistakes) : case_(c), root_(root), mistakes_(mistakes) {}

    void check() {
        check_geometry();
        check_blood();
        check_openings();
        check_stent();
        check_solids();
        check_initial();
        check_numerics();
        check_output();
        check_runs();
    }

    void check_runs() { check_names("runs", case_.runs); }

private:
    // The sentence belongs to `key`; nothing is said if it, or one of the others the rule reads, is wrong already.
    void expect(bool holds, const std::string& key, const std::string& sentence, std::vector<std::string> others = {}) {
        others.push_back(key);
        const bool is_known =
            std::any_of(others.begin(), others.end(), [&](const auto& k) { return mistakes_.touch(k); });
        if (!holds && !is_known) mistakes_.add(place_of(root_, key), key, sentence);
    }

    template <class Items>
    void check_names(const std::string& path, const Items& items) {
        std::set<std::string> names;
        for (std::size_t i = 0; i < items.size(); ++i) {
            const std::string key = path + "." + std::to_string(i) + ".name",
                              shown = double_quoted(shortened(items[i].name));
            expect(is_plain_name(items[i].name), key,
                   shown + " is no name; names have letters, digits, _ and -, at most 64");
            expect(names.insert(items[i].name).second, key, "a second " + shown + "; names must differ");
        }
    }

    void check_increasing(const std::string& path, const std::vector<double>& values, std::string_view unit) {
        for (std::size_t i = 1; i < values.size(); ++i)
            expect(values[i] > values[i - 1], path + "." + std::to_string(i),
                   "must be greater than the one before, " + format_quantity(values[i - 1], unit));
    }

    void check_geometry() {
        const Geometry& g = case_.geometry;
        const std::string path = "geometry.";
        if (g.unit) {
            const std::vector<std::string> known = unit_names(Dimension::length);
            expect(std::find(known.begin(), known.end(), *g.unit) != known.end(), path + "unit",
                   double_quoted(*g.unit) + " is not one of " + join(known, ", ", " or "));
        }
        if (g.space)
            expect(*g.space == "LPS" || *g.space == "RAS", path + "space",
                   double_quoted(*g.space) + " is not LPS or RAS");
        if (g.surface)
            expect(g.unit.has_value(), path + "surface",
                   "needs geometry.unit: a surface file does not say whether it counts in mm or in m", {path + "unit"});
        if (g.network)
            expect(g.unit.has_value() || g.network->extension() == ".json", path + "network",
                   "needs geometry.unit: only a JSON network says whether it counts in mm or in m", {path + "unit"});
        if (g.inlet)
            expect(g.surface.has_value(), path + "inlet",
                   "can be chosen of a surface only; a network and a shape say it themselves");
        expect(!g.label || g.surface, path + "label", "is one of a label map, which is a surface here");
        expect(g.cut_back.empty() || g.surface, path + "cut_back",
               "can cut a surface only; the ends of a network and of a shape are square to their axes");
        expect(g.branches.empty() || g.surface, path + "branches",
               "can be named of a surface only; a network names its own and a shape has none");
        for (const auto& [name, place] : g.branches)
            expect(is_plain_name(name), path + "branches",
                   double_quoted(shortened(name)) + " is no name; names have letters, digits, _ and -, at most 64");
        if (g.lesion) {
            expect(g.network.has_value(), path + "lesion", "can narrow a network only, not a surface or a shape");
            expect(!g.lesion->side || norm(*g.lesion->side) > 0, path + "lesion.side", "must not be zero");
            expect(g.lesion->position >= 0.5 * g.lesion->length, path + "lesion.position",
                   "is nearer to the start of the branch than half the length, " +
                       format_quantity(0.5 * g.lesion->length, "mm"),
                   {path + "lesion.length"});
        }
        if (g.shape) check_shape(*g.shape, path + "shape.");
    }

    void check_shape(const Shape& s, const std::string& path) {
        if (s.type == ShapeType::box) {
            expect(s.size.x > 0 && s.size.y > 0 && (s.planar || s.size.z > 0), path + "size",
                   "the sides must be greater than zero");
            const bool is_endless = s.periodic[0] && s.periodic[1] && (s.planar || s.periodic[2]);
            expect(!is_endless || case_.openings.empty(), "openings",
                   "a box that is periodic all around has no openings", {path + "periodic"});
        }
        expect(norm(s.axis) > 0, path + "axis", "must not be zero");
        if (s.type == ShapeType::step) {
            expect(s.step_height < s.gap, path + "step_height", "must be less than the gap", {path + "gap"});
            expect(s.step_at < s.length, path + "step_at", "must be less than the length", {path + "length"});
        }
        if (s.type == ShapeType::nozzle) {
            expect(s.sections.size() >= 2, path + "sections", "at least two cross-sections are needed");
            for (std::size_t i = 1; i < s.sections.size(); ++i)
                expect(s.sections[i].z > s.sections[i - 1].z, path + "sections." + std::to_string(i) + ".z",
                       "must be greater than the one before, " + format_quantity(s.sections[i - 1].z, "mm"),
                       {path + "sections." + std::to_string(i - 1)});
        }
        check_names(path + "branches", s.branches);
        for (std::size_t i = 0; i < s.branches.size(); ++i)
            expect(s.branches[i].from != s.branches[i].to, path + "branches." + std::to_string(i) + ".to",
                   "is the same point as `from`");
        check_spacing(s);
    }

    void check_spacing(const Shape& s) {
        double narrowest = 0;
        switch (s.type) {
            case ShapeType::channel: narrowest = s.gap; break;
            case ShapeType::step: narrowest = s.gap - s.step_height; break;
            case ShapeType::tube: narrowest = s.diameter; break;
            case ShapeType::box: narrowest = std::min(s.size.x, s.size.y); break;
            case ShapeType::cone:
                if (!s.diameters.empty()) narrowest = *std::min_element(s.diameters.begin(), s.diameters.end());
                break;
            case ShapeType::nozzle:
                for (const NozzleSection& section : s.sections)
                    narrowest = narrowest == 0 ? section.diameter : std::min(narrowest, section.diameter);
                break;
            case ShapeType::branches:
                for (const Branch& branch : s.branches)
                    for (const double d : branch.diameters) narrowest = narrowest == 0 ? d : std::min(narrowest, d);
                break;
        }
        expect(narrowest >= fewest_across * case_.numerics.spacing * (1 - 1e-12), "numerics.spacing",
               "leaves fewer than 4 particles across the narrowest place, " + format_quantity(narrowest, "mm") +
                   "; at least 12 give a sensible answer",
               {"geometry.shape"});
    }

    void check_numerics() {
        const Numerics& n = case_.numerics;
        expect(!n.convergence || !case_.openings.empty(), "numerics.convergence",
               "watches the openings, and this domain has none; give a duration alone");
        expect(!n.across || case_.scheme() == SchemeName::cells, "numerics.across",
               "is for scheme cells; moving particles need one spacing everywhere, numerics.spacing",
               {"numerics.scheme"});
        expect(!n.across || case_.solids.empty(), "numerics.across", "is for blood; solids need numerics.spacing");
        expect(n.without_rest == WithoutRest::means ||
                   (case_.scheme() == SchemeName::cells && case_.about.mode == Mode::steady),
               "numerics.without_rest", "is for a steady flow of scheme cells", {"numerics.scheme"});
        expect(n.across || !n.smallest_spacing, "numerics.smallest_spacing",
               "means something with numerics.across only");
        expect(n.across || !n.largest_spacing, "numerics.largest_spacing", "means something with numerics.across only");
        if (n.smallest_spacing && n.largest_spacing)
            expect(*n.smallest_spacing <= *n.largest_spacing, "numerics.smallest_spacing",
                   "is more than numerics.largest_spacing, " + format_quantity(*n.largest_spacing, "mm"),
                   {"numerics.largest_spacing"});
        if (case_.geometry.shape)
            expect(!n.across || !case_.geometry.shape->is_planar(), "numerics.across",
                   "follows a vessel in three dimensions, not a planar shape; give numerics.spacing",
                   {"geometry.shape"});
    }

    void check_stent() {
        if (!case_.stent) return;
        const Stent& stent = *case_.stent;
        expect(!stent.surface || stent.unit, "stent.surface",
               "needs stent.unit: a surface file does not say whether it counts in mm or in m");
        if (stent.unit) {
            const std::vector<std::string> known = unit_names(Dimension::length);
            expect(std::find(known.begin(), known.end(), *stent.unit) != known.end(), "stent.unit",
                   double_quoted(*stent.unit) + " is not one of " + join(known, ", ", " or "));
        }
        if (stent.placement)
            expect(norm(stent.placement->direction) > 0, "stent.placement.direction", "must not be zero");
    }

    void check_solids() {
        check_names("solids", case_.solids);
        for (std::size_t i = 0; i < case_.solids.size(); ++i) {
            const SolidDeck& solid = case_.solids[i];
            const std::string path = "solids." + std::to_string(i) + ".";
            check_solid_shape(solid.shape, path + "shape.");
            for (std::size_t k = 0; k < solid.pressures.size(); ++k) {
                const FacePressure& p = solid.pressures[k];
                const std::string key = path + "pressures." + std::to_string(k) + ".";
                expect(p.pressures.size() == p.times.size(), key + "pressures", "there must be one for each of times",
                       {key + "times"});
                check_increasing(key + "times", p.times, "s");
            }
            for (std::size_t k = 0; k < solid.holds.size(); ++k) {
                const Hold& h = solid.holds[k];
                const std::string key = path + "holds." + std::to_string(k) + ".";
                expect(h.low.has_value() == h.high.has_value(), path + "holds." + std::to_string(k),
                       "low and high belong together");
                if (h.low && h.high)
                    expect(h.low->x <= h.high->x && h.low->y <= h.high->y && h.low->z <= h.high->z, key + "high",
                           "is below low", {key + "low"});
            }
        }
        const auto is_known = [&](const std::string& name) {
            return std::any_of(case_.solids.begin(), case_.solids.end(),
                               [&](const SolidDeck& s) { return s.name == name; });
        };
        for (std::size_t i = 0; i < case_.contacts.size(); ++i) {
            const ContactDeck& contact = case_.contacts[i];
            const std::string path = "contacts." + std::to_string(i) + ".";
            expect(is_known(contact.solid), path + "solid",
                   "there is no solid " + double_quoted(shortened(contact.solid)));
            if (contact.with)
                expect(is_known(*contact.with), path + "with",
                       "there is no solid " + double_quoted(shortened(*contact.with)));
            if (contact.plane) expect(norm(contact.plane->normal) > 0, path + "plane.normal", "must not be zero");
            if (contact.tool) {
                const RadialToolDeck& tool = *contact.tool;
                expect(norm(tool.to - tool.from) > 0, path + "tool.to", "is the same point as `from`",
                       {path + "tool.from"});
                expect(tool.diameters.size() == tool.times.size(), path + "tool.diameters",
                       "there must be one for each of times", {path + "tool.times"});
                check_increasing(path + "tool.times", tool.times, "s");
                expect(!case_.numerics.solid.plane_strain, path + "tool",
                       "is not planar; numerics.solid.plane_strain is true");
            }
        }
    }

    void check_solid_shape(const SolidShape& s, const std::string& path) {
        const bool planar = case_.numerics.solid.plane_strain;
        if (s.type == SolidShapeType::box)
            expect(s.to.x > s.from.x && s.to.y > s.from.y && (planar || s.to.z > s.from.z), path + "to",
                   "must lie above `from` on every axis", {path + "from"});
        if (s.type == SolidShapeType::cylinder) {
            expect(planar || norm(s.to - s.from) > 0, path + "to", "is the same point as `from`", {path + "from"});
            expect(s.inner_diameter < s.diameter, path + "inner_diameter", "must be less than the diameter",
                   {path + "diameter"});
        }
        const std::string end = path + (s.low ? "low" : "high");
        expect(s.low.has_value() == s.high.has_value(), end, "low and high go together: the corners of a box");
        expect(!s.low || !s.high || (s.high->x > s.low->x && s.high->y > s.low->y && (planar || s.high->z > s.low->z)),
               path + "high", "must lie above `low` on every axis", {path + "low"});
        if (s.type == SolidShapeType::sphere)
            expect(!planar, path + "type", "is not planar; use a cylinder along z with numerics.solid.plane_strain");
        if (s.type == SolidShapeType::stent) {
            expect(!planar, path + "type", "is not planar; numerics.solid.plane_strain is true");
            expect(case_.stent.has_value(), path + "type", "needs a stent in the deck", {"stent"});
        }
    }

    void check_blood() {
        const Blood& b = case_.blood;
        if (b.law == BloodLaw::carreau_yasuda)
            expect(b.mu_0 >= b.mu_inf, "blood.mu_0", "must not be below mu_inf", {"blood.mu_inf"});
        if (b.law == BloodLaw::power_law)
            expect(b.max_viscosity >= b.min_viscosity, "blood.max_viscosity", "must not be below min_viscosity",
                   {"blood.min_viscosity"});
        if (b.law == BloodLaw::casson)
            expect(b.max_viscosity >= b.plastic_viscosity, "blood.max_viscosity", "must not be below plastic_viscosity",
                   {"blood.plastic_viscosity"});
    }

    void check_openings() {
        bool is_pressure_set = false, takes_beat = false;
        for (const auto& [name, opening] : case_.openings) {
            takes_beat |= opening.has_aortic_pressure() || opening.has_muscle_of_aorta() ||
                          (opening.type == OpeningType::rcr && opening.is_tuned());
            const std::string path = "openings." + name;
            if (opening.type != OpeningType::velocity && opening.type != OpeningType::flow) is_pressure_set = true;
            if (opening.has_aortic_pressure())
                expect(case_.aorta.pressure.has_value(), path,
                       "needs a pressure or a waveform, or aorta.pressure, which it has then",
                       {path + ".pressure", "aorta.pressure"});
            if (name == "inlet" && opening.pressure && case_.aorta.pressure)
                expect(*opening.pressure <= *case_.aorta.pressure * (1 + 1e-9), path + ".pressure",
                       "is more than aorta.pressure, " + format_quantity(*case_.aorta.pressure, "mmHg") +
                           ", which is the mean at this opening and what FFR counts from",
                       {"aorta.pressure"});
            if (opening.is_tuned()) check_tuned(opening, path);
            if (opening.type == OpeningType::rcr || opening.type == OpeningType::coronary)
                check_windkessel(opening, path);
            if (opening.waveform) check_waveform(*opening.waveform, path + ".waveform");
            if (opening.myocardial_pressure)
                check_waveform(*opening.myocardial_pressure, path + ".myocardial_pressure");
            if (opening.profile == VelocityProfile::womersley)
                expect(opening.waveform.has_value(), path + ".profile",
                       "womersley needs a waveform: it is the profile of a pulse", {path});
            if (opening.profile == VelocityProfile::developed_startup)
                expect(!opening.waveform, path + ".profile", "developed_startup needs a constant, not a waveform",
                       {path});
            if (opening.profile_table) check_profile(*opening.profile_table, path + ".profile_table");
        }
        expect(case_.openings.empty() || is_pressure_set, "openings",
               "every opening prescribes a flow; one of them must set the pressure (pressure, resistance, rcr or "
               "coronary)");
        if (takes_beat && case_.about.mode == Mode::periodic) check_beat();
    }

    /// What the aorta's pulse is made of where openings leave theirs to it (physics/open_ends/heartbeat.h).
    void check_beat() {
        constexpr double shortest = 1.0 / 3, longest = 2;   // s
        if (case_.about.period)
            expect(*case_.about.period >= shortest && *case_.about.period <= longest, "case.period",
                   "is no heartbeat's, 0.33 to 2 s, whose pressures openings leave to the aorta; give them their own",
                   {"case"});
        if (case_.aorta.pressure)
            expect(case_.aorta.pulse < *case_.aorta.pressure, "aorta.pulse",
                   "is not less than the mean, " + format_quantity(*case_.aorta.pressure, "mmHg"), {"aorta.pressure"});
    }

    void check_tuned(const Opening& opening, const std::string& path) {
        const std::string what =
            opening.type == OpeningType::resistance ? "a resistance" : "its resistances and compliances";
        expect(case_.aorta.pressure.has_value(), path,
               "needs " + what + ", or aorta.pressure, from which it is tuned to the bed",
               {path + ".resistance", "aorta.pressure"});
    }

    /// All of its numbers, or none: then it is tuned. The muscle's pressure may always be left to the aorta's pulse.
    void check_windkessel(const Opening& o, const std::string& path) {
        const bool is_coronary = o.type == OpeningType::coronary;
        std::vector<std::string> missing;
        if (o.distal_resistance == 0) missing.push_back("distal_resistance");
        if (o.compliance == 0) missing.push_back("compliance");
        if (is_coronary && o.microvascular_resistance == 0) missing.push_back("microvascular_resistance");
        if (is_coronary && o.myocardial_compliance == 0) missing.push_back("myocardial_compliance");
        const bool has_some = o.proximal_resistance > 0 || missing.size() < (is_coronary ? 4u : 2u);
        expect(!has_some || missing.empty(), path,
               "has not all of its numbers: " + join(missing, ", ", " and ") + (missing.size() == 1 ? " is" : " are") +
                   " missing; without any it is tuned to the bed");
        if (o.has_muscle_of_aorta())
            expect(case_.aorta.pressure.has_value(), path,
                   "needs myocardial_pressure, or aorta.pressure, from whose pulse it follows",
                   {path + ".myocardial_pressure", "aorta.pressure"});
    }

    void check_profile(const ProfileTable& table, const std::string& path) {
        expect(table.radii.size() == table.speeds.size() && table.radii.size() >= 2, path + ".speeds",
               "as many as radii are needed, at least two", {path + ".radii"});
        check_increasing(path + ".radii", table.radii, "");
    }

    void check_waveform(const Waveform& waveform, const std::string& path) {
        if (!waveform.times.empty()) {
            expect(waveform.values.size() == waveform.times.size() && waveform.times.size() >= 2, path + ".values",
                   "there are " + std::to_string(waveform.values.size()) + " values at " +
                       std::to_string(waveform.times.size()) + " times; as many are needed, at least two",
                   {path + ".times"});
            check_increasing(path + ".times", waveform.times, "s");
            const std::optional<double> period = waveform.period ? waveform.period : case_.about.period;
            expect(!period || waveform.times.back() <= *period * (1 + 1e-12), path + ".times",
                   "end at " + format_quantity(waveform.times.back(), "s") + ", beyond the period",
                   {path + ".period", "case.period"});
        } else {
            expect(waveform.values.empty(), path + ".values", "stand without times", {path});
        }
        const auto expect_whole = [&](const std::optional<double>& own, const std::string& key) {
            if (!own || !case_.about.period) return;   // means are taken over a period of the case
            const double times = *case_.about.period / *own;
            expect(
                times > 0.5 && std::abs(times - std::round(times)) < 1e-6, key,
                "is not the case's period, " + format_quantity(*case_.about.period, "s") + ", nor a whole part of it",
                {"case.period"});
        };
        expect_whole(waveform.period, path + ".period");
        if (waveform.fourier) expect_whole(waveform.fourier->period, path + ".fourier.period");
        if (waveform.fourier)
            expect(waveform.fourier->cosines.size() == waveform.fourier->sines.size(), path + ".fourier.sines",
                   "there must be as many as cosines", {path + ".fourier"});
    }

    void check_initial() {
        expect(case_.initial_velocity() != InitialVelocity::taylor_green || case_.geometry.shape, "initial.velocity",
               "taylor_green needs a box", {"geometry"});
        const std::string needs_vessel = "estimate needs a surface or a network; shapes have no centrelines";
        expect(case_.initial_velocity() != InitialVelocity::estimate || case_.has_vessel(), "initial.velocity",
               needs_vessel, {"geometry"});
        expect(case_.initial_pressure() != InitialPressure::estimate || case_.has_vessel(), "initial.pressure",
               needs_vessel, {"geometry"});
        const bool can_be_solved = case_.has_vessel() && case_.about.mode == Mode::steady && case_.fits_cells();
        const std::string needs_cells =
            "cells needs a surface or a network, walls at rest and a steady flow; start from the estimate or from rest";
        expect(case_.initial_velocity() != InitialVelocity::cells || can_be_solved, "initial.velocity", needs_cells,
               {"geometry", "case.mode"});
        expect(case_.initial_pressure() != InitialPressure::cells || can_be_solved, "initial.pressure", needs_cells,
               {"geometry", "case.mode"});
        if (case_.initial_pressure() == InitialPressure::linear)
            expect(!case_.openings.empty(), "initial.pressure", "linear needs openings with pressures", {"openings"});
    }

    void check_output() {
        const Output& output = case_.output;
        const double duration = case_.numerics.duration;
        const std::string limit = "is beyond the duration, " + format_quantity(duration, "s");
        const auto expect_within = [&](double time, const std::string& key) {
            expect(time <= duration * (1 + 1e-12), key, limit, {"numerics.duration"});
        };
        if (output.average_from)
            expect(*output.average_from < duration, "output.average_from",
                   "is not before the end, " + format_quantity(duration, "s"), {"numerics.duration"});
        if (output.interval) expect_within(*output.interval, "output.interval");
        check_names("output.probes", output.probes);
        check_names("output.profiles", output.profiles);
        for (std::size_t i = 0; i < output.profiles.size(); ++i) {
            const std::string path = "output.profiles." + std::to_string(i);
            expect(output.profiles[i].from != output.profiles[i].to, path + ".to", "is the same point as `from`");
            check_increasing(path + ".times", output.profiles[i].times, "s");
            for (std::size_t k = 0; k < output.profiles[i].times.size(); ++k)
                expect_within(output.profiles[i].times[k], path + ".times." + std::to_string(k));
        }
        std::set<std::string> fields;
        for (std::size_t i = 0; i < output.fields.size(); ++i)
            expect(fields.insert(output.fields[i]).second, "output.fields." + std::to_string(i),
                   "a second " + double_quoted(output.fields[i]));
    }

    const Case& case_;
    const Node& root_;
    Mistakes& mistakes_;
};

}   // namespace

void check_runs(const Case& c, const Node& root, Mistakes& mistakes) { Checker(c, root, mistakes).check_runs(); }

void check_case(const Case& c, const Node& root, Mistakes& mistakes) { Checker(c, root, mistakes).check(); }

}   // namespace patency::deck
