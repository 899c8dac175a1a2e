// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/vessel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/base/units.h"
#include "patency/io/surface_file.h"
#include "patency/physics/open_ends/bed.h"
#include "patency/shape/exact_distance.h"
#include "patency/shape/network_lumen.h"
#include "patency/stages/lumen_of_case.h"

namespace patency {

Vessel check_vessel(Surface surface, std::string_view inlet) {
    Vessel vessel{.triangles_read = surface.triangles.size(), .checked = check_surface(std::move(surface))};
    vessel.openings = find_openings(vessel.checked);
    for (Finding& finding : find_missing_openings(vessel.openings))
        vessel.checked.findings.push_back(std::move(finding));
    if (!inlet.empty()) choose_inlet(vessel.openings, inlet);
    return vessel;
}

Vessel check_vessel(const Network& network, std::string_view inlet, double resolution) {
    const std::vector<Opening> named = openings_of(network, 0);   // in the order of their face ids, from 2 on
    Vessel vessel =
        check_vessel(make_network_surface(network, resolution > 0 ? resolution : 0.5 * narrowest_diameter(network)));
    for (SurfaceOpening& o : vessel.openings)
        if (o.face_id) o.opening.name = named.at(std::size_t(*o.face_id) - 2).name;
    std::stable_partition(vessel.openings.begin(), vessel.openings.end(),
                          [&](const SurfaceOpening& o) { return o.opening.name == named.front().name; });
    if (!inlet.empty()) choose_inlet(vessel.openings, inlet);
    return vessel;
}

void follow_vessel(Vessel& vessel) {
    CheckedSurface& checked = vessel.checked;
    if (vessel.along || !refusals(checked.findings).empty()) return;
    try {
        std::vector<Opening> openings;
        for (const SurfaceOpening& o : vessel.openings) openings.push_back(o.opening);
        const Surface closed = closed_at(checked.surface, checked.ends);
        VesselAlong along{find_branches(find_centrelines(make_exact_distance(closed), openings)), {}, {}};
        along.sections = cut_sections(closed, along.lines);
        along.assessment = assess_lesions(along.lines, along.sections);
        const SectionCutter cutter(closed);
        for (const AxisEnd& end : find_ends(checked, vessel.openings, along.lines))
            along.least_cuts.push_back(least_square_cut(cutter, end));
        vessel.along = std::move(along);
    } catch (const GeometryError& e) {
        checked.findings.push_back({"no_centreline", Verdict::refused, 1, vessel.openings[0].opening.centre,
                                    diagonal(bounds(checked.surface)), e.what()});
    }
}

std::optional<double> off_square(const Vessel& vessel, std::size_t opening) {
    if (!vessel.along || !vessel.along->least_cuts.at(opening)) return {};
    const AxisEnd end = find_ends(vessel.checked, vessel.openings, vessel.along->lines).at(opening);
    return off_square(end, *vessel.along->least_cuts[opening]);
}

namespace {

/// Up, to what one would write.
double in_hundredths_of_mm(double length) { return std::ceil(1e5 * length) / 100; }

SquareCut cut_of_length(const Vessel& vessel, const SectionCutter& cutter, const AxisEnd& end, std::size_t which,
                        double length) {
    const auto refuse = [&](const std::string& why) {
        throw GeometryError(fmt::format("geometry.cut_back.{}: {:.3g} mm {}", end.name, 1e3 * length, why));
    };
    if (length >= end.room)
        refuse(fmt::format("is more than its branch has, {:.2f} mm from the end to {}", 1e3 * end.room,
                           end.room < end.line->length() ? "the bifurcation" : "the vessel's other end"));
    const auto cut = square_cut_at(cutter, end, length);
    if (!cut)
        refuse(
            fmt::format("leaves too little of its branch, which is {:.2f} mm long, to tell which way it goes; cut less",
                        1e3 * end.room));
    const std::optional<SquareCut>& least = vessel.along->least_cuts.at(which);
    if (!least)
        refuse("cannot make it square: its rim reaches so far back that no plane across its branch leaves it whole");
    if (length < least->depth)
        refuse(fmt::format("leaves a part of its oblique rim, {:.0f} degrees off square: at least {:.2f} mm are needed",
                           in_unit(off_square(end, *least), "deg"), in_hundredths_of_mm(least->depth)));
    return *cut;
}

/// Names, face ids and order of openings that are found anew: each is where one was, or where the cut made one.
void keep_openings(Vessel& vessel, const std::vector<SurfaceOpening>& before) {
    std::vector<SurfaceOpening> found = find_openings(vessel.checked), kept;
    for (const SurfaceOpening& old : before) {
        const auto away = [&](const SurfaceOpening& o) { return norm(o.opening.centre - old.opening.centre); };
        const auto same = std::min_element(found.begin(), found.end(),
                                           [&](const auto& a, const auto& b) { return away(a) < away(b); });
        if (same == found.end() || away(*same) > 0.5 * old.opening.radius)
            throw GeometryError(
                fmt::format("geometry.cut_back: {} is no opening any more once the ends are cut; cut "
                            "it elsewhere",
                            old.opening.name));
        same->opening.name = old.opening.name;
        same->face_id = old.face_id;
        kept.push_back(std::move(*same));
        found.erase(same);
    }
    vessel.openings = std::move(kept);
}

}   // namespace

void cut_ends_back(Vessel& vessel, const std::map<std::string, double>& lengths) {
    std::vector<std::string> names;
    for (const SurfaceOpening& o : vessel.openings) names.push_back(o.opening.name);
    for (const auto& [name, length] : lengths) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        const std::string nearest = nearest_name(name, names);
        throw UsageError(fmt::format("{} is no opening of the surface{}; it has {}", double_quoted(shortened(name)),
                                     nearest.empty() ? "" : ", did you mean " + nearest + "?",
                                     join(names, ", ", " and ")));
    }
    follow_vessel(vessel);
    if (!vessel.along || lengths.empty()) return;   // what is refused is said by whoever asks
    const Surface closed = closed_at(vessel.checked.surface, vessel.checked.ends);
    const SectionCutter cutter(closed);
    const std::vector<AxisEnd> ends = find_ends(vessel.checked, vessel.openings, vessel.along->lines);
    Surface surface = vessel.checked.surface;
    std::vector<SurfaceOpening> openings = vessel.openings;
    std::vector<Finding> findings = vessel.checked.findings;
    for (std::size_t k = 0; k < ends.size(); ++k) {
        const auto asked = lengths.find(ends[k].name);
        if (asked == lengths.end()) continue;
        const SquareCut cut = cut_of_length(vessel, cutter, ends[k], k, asked->second);
        try {
            findings.push_back(cut_end(surface, ends, k, cut));
        } catch (const GeometryError& error) {
            throw GeometryError(fmt::format("geometry.cut_back: {}", error.what()));
        }
        openings[k].opening.centre = cut.point;
    }
    const std::size_t known = findings.size();
    vessel.checked = check_surface(std::move(surface));
    for (Finding& finding : vessel.checked.findings) {   // what was left as harmless is found again
        const auto is_known = [&](const Finding& f) {
            return f.kind == finding.kind && f.verdict == finding.verdict && f.verdict == Verdict::harmless;
        };
        if (std::none_of(findings.begin(), findings.begin() + std::ptrdiff_t(known), is_known))
            findings.push_back(std::move(finding));
    }
    vessel.checked.findings = std::move(findings);
    vessel.along.reset();
    if (refusals(vessel.checked.findings).empty()) keep_openings(vessel, openings);
}

double lumen_area(const VesselAlong& along, std::size_t line, std::size_t point) {
    const CrossSection& s = along.sections[line][point];
    if (s.is_closed && s.holds_place && !s.is_shared && s.area > 0) return s.area;
    const double radius = along.lines.lines[line].points[point].radius;
    return std::numbers::pi * radius * radius;
}

std::vector<double> branch_flows(const BranchedLines& lines, const std::vector<Opening>& openings,
                                 std::span<const double> out) {
    std::vector<double> flows;
    for (const Branch& branch : lines.branches) {
        flows.push_back(0);
        for (std::size_t line : branch.lines)
            for (std::size_t k = 0; k < out.size(); ++k)
                if (openings[k].name == lines.lines[line].outlet) flows.back() += out[k];
    }
    return flows;
}

double narrowest_diameter(const VesselAlong& along) {
    double radius = Bounds::infinity;
    for (const Centreline& line : along.lines.lines)
        for (const CentrelinePoint& point : line.points) radius = std::min(radius, point.radius);
    return 2 * radius;
}

Passage passage_of(const VesselAlong& along, const std::vector<double>& outlet_diameters) {
    const std::vector<Centreline>& lines = along.lines.lines;
    const std::vector<double> shares = murray_shares(outlet_diameters, 3);
    Passage passage{Bounds::infinity, 0};
    for (std::size_t j = 0; j < lines.size(); ++j) {
        std::vector<std::size_t> shared;
        for (const Centreline& other : lines) shared.push_back(shared_points(lines[j], other));
        double drag = 0;
        for (std::size_t k = 0; k < lines[j].points.size(); ++k) {
            double share = 0;
            for (std::size_t i = 0; i < lines.size(); ++i) share += i == j || k < shared[i] ? shares[i] : 0;
            const double area = lumen_area(along, j, k);
            passage.tightest_area = std::min(passage.tightest_area, area / share);
            if (k > 0) drag += share * (lines[j].points[k].arc - lines[j].points[k - 1].arc) / (area * area);
        }
        passage.drag = std::max(passage.drag, drag);
    }
    return passage;
}

Widths widths_of(const VesselAlong& along, const Branch& branch) {
    Widths w{Bounds::infinity, 0, 0};
    for (std::size_t k = branch.first; k <= branch.last; ++k) {
        const double diameter = 2 * along.lines.point(branch, k).radius;
        w.least = std::min(w.least, diameter), w.most = std::max(w.most, diameter);
        w.mean += diameter / double(branch.last - branch.first + 1);
    }
    return w;
}

namespace {

void expect_usable(const Vessel& vessel, const deck::Geometry& geometry) {
    const std::string refused = refusals(vessel.checked.findings);
    if (refused.empty()) return;
    throw GeometryError(fmt::format("geometry: {} cannot be used; patency inspect shows where.\n{}",
                                    (geometry.network ? *geometry.network : *geometry.surface).string(), refused));
}

/// What a key of the geometry asks for and cannot be is a mistake of the deck.
template <class Change>
void as_said_by(const char* key, Change change) {
    try {
        change();
    } catch (const UsageError& error) {
        throw DeckError(fmt::format("geometry.{}: {}", key, error.what()));
    }
}

}   // namespace

void name_as_tubes(Vessel& vessel, const Network& network) {
    if (!vessel.along) return;
    std::vector<NamedCurve> curves;
    for (const Tube& tube : network.tubes) curves.push_back({tube.name, tube.points});
    name_branches(vessel.along->lines, curves);
}

Vessel open_vessel(const deck::Case& config) {
    const deck::Geometry& g = config.geometry;
    Surface surface;
    as_said_by(g.label ? "label" : "surface",
               [&] { surface = read_surface(g.surface.value(), g.unit.value_or(""), g.space.value_or(""), g.label); });
    Vessel vessel = check_vessel(std::move(surface));
    expect_usable(vessel, g);
    if (g.inlet) as_said_by("inlet", [&] { choose_inlet(vessel.openings, *g.inlet); });
    as_said_by("names", [&] { rename_openings(vessel.openings, g.names); });
    expect_vessel_size(vessel.openings.front(), g.unit.value_or("mm"));
    if (!g.cut_back.empty()) {
        as_said_by("cut_back", [&] { cut_ends_back(vessel, g.cut_back); });
        expect_usable(vessel, g);
    }
    return vessel;
}

Vessel read_vessel(const deck::Case& config, double network_resolution) {
    const deck::Geometry& g = config.geometry;
    if (!g.surface && !g.network)
        throw DeckError("geometry: a surface or a network is needed; a shape has no branches to follow");
    if (g.surface) {
        Vessel vessel = open_vessel(config);
        follow_vessel(vessel);
        expect_usable(vessel, g);
        as_said_by("branches", [&] { name_branches(vessel.along->lines, g.branches); });
        return vessel;
    }
    const Network network = read_network_of(config);
    Vessel vessel = check_vessel(network, {}, network_resolution);
    follow_vessel(vessel);
    expect_usable(vessel, g);
    name_as_tubes(vessel, network);
    return vessel;
}

}   // namespace patency
