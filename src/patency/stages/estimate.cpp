// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/stages/bed.h"
#include "patency/stages/end_law.h"
#include "patency/stages/material.h"

namespace patency {

namespace {

constexpr double pi = std::numbers::pi;
// FFR is read 10 to 20 mm behind a lesion's end (Norgaard et al. 2019): in the middle of that.
constexpr double distance_to_reading = 15e-3;   // m

double changed(double area, double more) {
    const double diameter = std::max(std::sqrt(4 * area / pi) + more, 0.1e-3);
    return pi / 4 * diameter * diameter;
}

/// The vessel as a tree: every branch from where its parent ends, bifurcations belong to what comes after them.
std::vector<TreeBranch> branches_of(const VesselAlong& along, const EstimateChange& change) {
    std::vector<TreeBranch> branches;
    for (std::size_t b = 0; b < along.lines.branches.size(); ++b) {
        const Branch& from = along.lines.branches[b];
        const auto& points = along.lines.lines[from.line].points;
        TreeBranch branch;
        branch.name = from.name, branch.parent = from.parent;
        std::size_t first = from.first;
        if (from.parent >= 0) {
            const Branch& parent = along.lines.branches[std::size_t(from.parent)];
            first = parent.last + 1;   // lines share their points up to there
            const double cosine = dot(along.lines.point(parent, parent.last).tangent, points[from.first].tangent);
            branch.turn = std::acos(std::clamp(cosine, -1.0, 1.0));
        }
        for (std::size_t k = first; k <= from.last; ++k) {
            branch.arc.push_back(points[k].arc);
            branch.area.push_back(changed(lumen_area(along, from.line, k), change.diameter));
        }
        branches.push_back(std::move(branch));
    }
    return branches;
}

/// What holds at an opening, steady. Flows along the stream: out of an outlet, into the inlet.
TreeEnd end_of(const Opening& opening, const deck::Opening& said, const deck::Case& config, bool is_inlet,
               double flow_factor) {
    const EndLaw law = make_end_law(opening, said, config);
    if (law.prescribes_flow()) return TreeFlowRate{(is_inlet ? 1 : -1) * flow_factor * law.signal.waveform.mean()};
    if (!law.outlet) return TreePressure{law.signal.waveform.mean()};
    return TreeResistance{impedance(*law.outlet, 0).real(), said.distal_pressure};
}

void expect_same_openings(const deck::Case& config, const std::vector<SurfaceOpening>& openings) {
    std::string names;
    for (const SurfaceOpening& o : openings) {
        names += (names.empty() ? "" : ", ") + o.opening.name;
        if (!config.openings.contains(o.opening.name))
            throw DeckError(fmt::format("openings.{} is missing: the surface has an opening of {:.2f} mm there",
                                        o.opening.name, 2e3 * o.opening.radius));
    }
    for (const auto& [name, said] : config.openings)
        if (std::none_of(openings.begin(), openings.end(),
                         [&name = name](const SurfaceOpening& o) { return o.opening.name == name; }))
            throw DeckError(fmt::format("openings.{}: the surface has no such opening; it has {}", name, names));
}

std::size_t station_at(const TreeBranch& branch, double arc) {
    const auto at = std::lower_bound(branch.arc.begin(), branch.arc.end(), arc);
    return std::min(std::size_t(at - branch.arc.begin()), branch.arc.size() - 1);
}

/// The branch that a line passes through at an arc.
std::size_t branch_at(const VesselAlong& along, const std::vector<TreeBranch>& tree, std::size_t line, double arc) {
    std::size_t found = 0;
    for (std::size_t b = 0; b < tree.size(); ++b) {
        const auto& lines = along.lines.branches[b].lines;
        if (std::find(lines.begin(), lines.end(), line) != lines.end() && tree[b].arc.front() <= arc) found = b;
    }
    return found;
}

EstimatedLesion read_lesion(const Estimate& e, const VesselAlong& along, std::size_t number) {
    const Lesion& lesion = along.assessment.lesions[number];
    const double read_arc = std::min(lesion.end_arc + distance_to_reading, along.lines.lines[lesion.line].length());
    const auto& tree = e.tree.branches;
    const std::size_t before = branch_at(along, tree, lesion.line, lesion.start_arc),
                      after = branch_at(along, tree, lesion.line, read_arc);
    const std::size_t station = station_at(tree[after], read_arc);
    const double drop =
        e.flow.pressure[before][station_at(tree[before], lesion.start_arc)] - e.flow.pressure[after][station];
    return {number, e.flow.flow[lesion.branch], drop, read_arc, e.ffr(after, station)};
}

}   // namespace

std::optional<double> Estimate::ffr(std::size_t branch, std::size_t station) const {
    if (!aortic_pressure) return std::nullopt;
    return (flow.pressure[branch][station] + level) / *aortic_pressure;
}

Estimate estimate_flow(const deck::Case& given, const Vessel& vessel, const EstimateChange& change) {
    expect_same_openings(given, vessel.openings);
    deck::Case config = given;
    config.bed.murray_exponent += change.exponent;
    std::vector<Opening> openings;
    for (const SurfaceOpening& o : vessel.openings) openings.push_back(o.opening);
    if (!config.bed.flow) config.bed.flow = flow_of_bed(config.bed.state, inlet_area(config, openings));
    *config.bed.flow *= change.flow;
    complete_openings(config, openings);

    Estimate e;
    e.tree.branches = branches_of(*vessel.along, change);
    const FluidMaterial material = make_material(config.blood);
    e.tree.blood.density = material.density;
    e.tree.blood.viscosity_at =
        material.viscosity_at ? material.viscosity_at : [mu = material.viscosity](double) { return mu; };
    const deck::Opening& inlet = config.openings.at(openings[0].name);
    e.tree.inlet = end_of(openings[0], inlet, config, true, change.flow);
    e.tree.inlet_entrance = inlet.profile == deck::VelocityProfile::plug ? 1 : 0;
    e.tree.outlets.assign(e.tree.branches.size(), TreePressure{0});
    std::vector<std::size_t> branch_of_opening(openings.size(), 0);
    for (std::size_t b = 0; b < vessel.along->lines.branches.size(); ++b) {
        const Branch& branch = vessel.along->lines.branches[b];
        const Centreline& line = vessel.along->lines.lines[branch.line];
        if (branch.lines.size() > 1 || branch.last + 1 != line.points.size())
            continue;   // goes on behind a bifurcation
        const auto at =
            std::find_if(openings.begin(), openings.end(), [&](const Opening& o) { return o.name == line.outlet; });
        e.tree.outlets[b] = end_of(*at, config.openings.at(at->name), config, false, change.flow);
        branch_of_opening[std::size_t(at - openings.begin())] = b;
    }
    e.flow = solve_tree(e.tree);

    for (std::size_t k = 0; k < openings.size(); ++k) {
        const std::size_t b = branch_of_opening[k];
        e.opening_flows.push_back(k == 0 ? -e.flow.flow[0] : e.flow.flow[b]);
        e.opening_pressures.push_back(k == 0 ? e.flow.inlet_pressure : e.flow.pressure[b].back());
        e.outlets.push_back(config.openings.at(openings[k].name));
    }
    if (config.aorta.pressure) {
        e.aortic_pressure = *config.aorta.pressure;
        e.level = *config.aorta.pressure - e.flow.inlet_pressure;
    }
    for (std::size_t n = 0; n < vessel.along->assessment.lesions.size(); ++n)
        e.lesions.push_back(read_lesion(e, *vessel.along, n));
    return e;
}

std::vector<Vec3> reading_places(const Estimate& estimate, const VesselAlong& along) {
    std::vector<Vec3> places;
    for (const EstimatedLesion& lesion : estimate.lesions) {
        const auto& points = along.lines.lines[along.assessment.lesions[lesion.number].line].points;
        const auto at = std::lower_bound(points.begin(), points.end(), lesion.read_arc,
                                         [](const CentrelinePoint& p, double arc) { return p.arc < arc; });
        places.push_back(at == points.end() ? points.back().place : at->place);
    }
    return places;
}

std::optional<double> ffr_near(const Estimate& e, const VesselAlong& along, const Vec3& place) {
    std::optional<double> ffr;
    double least = Bounds::infinity;
    for (std::size_t b = 0; b < e.tree.branches.size(); ++b) {
        const std::size_t stations =
            e.tree.branches[b].arc.size();   // the branch's points, and its bifurcation's before them
        const Branch& branch = along.lines.branches[b];
        for (std::size_t k = 0; k < stations; ++k)
            if (const double away = norm(along.lines.point(branch, branch.last + 1 - stations + k).place - place);
                away < least)
                least = away, ffr = e.ffr(b, k);
    }
    return ffr;
}

EstimateBand estimate_band(const deck::Case& config, const Vessel& vessel, std::span<const Vec3> places) {
    EstimateBand band;
    const auto widen = [](std::vector<Band>& bands, std::size_t k, double value) {
        if (bands.size() <= k) bands.push_back({value, value});
        bands[k] = {std::min(bands[k].low, value), std::max(bands[k].high, value)};
    };
    for (double flow : {0.9, 1.0, 1.1})
        for (double diameter : {-0.1e-3, 0.0, 0.1e-3})
            for (double exponent : {-0.5, 0.0, 0.5}) {
                const Estimate e = estimate_flow(config, vessel, {flow, diameter, exponent});
                for (std::size_t k = 0; k < e.lesions.size(); ++k)
                    if (e.lesions[k].ffr) widen(band.lesion_ffr, k, *e.lesions[k].ffr);
                for (std::size_t k = 0; k < places.size(); ++k)
                    if (const auto ffr = ffr_near(e, *vessel.along, places[k])) widen(band.place_ffr, k, *ffr);
                for (std::size_t k = 0; k < e.opening_flows.size(); ++k)
                    widen(band.opening_flows, k, e.opening_flows[k]);
            }
    return band;
}

}   // namespace patency
