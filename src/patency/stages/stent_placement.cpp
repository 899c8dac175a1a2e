// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/stent_placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/shape/exact_distance.h"
#include "patency/stages/stent_of_case.h"

namespace patency {

namespace {

/// The middle of the stent, along a line.
struct Middle {
    std::size_t line;
    double arc;
};

const Branch& branch_of(const deck::StentPlacement& said, const std::vector<Branch>& branches) {
    std::vector<std::string> names;
    for (const Branch& branch : branches) {
        if (said.branch ? branch.name == *said.branch : branches.size() == 1) return branch;
        names.push_back(branch.name);
    }
    if (!said.branch)
        throw DeckError(
            fmt::format("stent.placement.branch: is missing; the vessel has {}", join(names, ", ", " and ")));
    const std::string near = nearest_name(*said.branch, names);
    throw DeckError(fmt::format("stent.placement.branch: the vessel has no branch {}{}; it has {}",
                                double_quoted(shortened(*said.branch)),
                                near.empty() ? "" : ", did you mean " + near + "?", join(names, ", ", " and ")));
}

Middle middle_at_lesion(const VesselAlong& along) {
    if (along.assessment.lesions.empty())
        throw DeckError(
            "stent.placement: is missing, and the vessel has no lesion of 25 % or more to put the stent in; give "
            "branch and arc_length");
    const Lesion& worst = along.assessment.lesions.front();
    return {worst.line, 0.5 * (worst.start_arc + worst.end_arc)};
}

/// Of all places on all lines the one nearest to x.
Middle nearest_to(const Vec3& x, const VesselAlong& along) {
    Middle best{};
    double nearest = Bounds::infinity;
    for (std::size_t j = 0; j < along.lines.lines.size(); ++j)
        for (const CentrelinePoint& p : along.lines.lines[j].points)
            if (norm(p.place - x) < nearest) nearest = norm(p.place - x), best = {j, p.arc};
    return best;
}

Middle middle_of(const deck::Stent& stent, const VesselAlong& along) {
    if (!stent.placement) return middle_at_lesion(along);
    const deck::StentPlacement& said = *stent.placement;
    if (said.translation) return nearest_to(*said.translation, along);
    const Branch& branch = branch_of(said, along.lines.branches);
    const double length = along.lines.end_arc(branch) - along.lines.start_arc(branch);
    if (*said.arc_length > length)
        throw GeometryError(
            fmt::format("stent.placement.arc_length: {:.4g} mm is past the end of branch {}, which is {:.4g} mm long.",
                        1e3 * *said.arc_length, branch.name, 1e3 * length));
    return {branch.line, along.lines.start_arc(branch) + *said.arc_length};
}

void expect_diameters(const StentPlace& place, const deck::Deployment& deployment) {
    if (!(place.crimped_diameter > 0))
        throw DeckError(
            "deployment.crimped_diameter: is missing; a stent that comes as a surface does not say what it is crimped "
            "to");
    const bool has_pattern =
        std::holds_alternative<StrutCurves>(place.form);   // a surface shows a stent that may be open already
    if (has_pattern && !(place.diameter > place.pattern.diameter))
        throw DeckError(fmt::format(
            "deployment.diameter: {:.4g} mm does not open a stent that was cut at {:.4g} mm; give a larger one",
            1e3 * place.diameter, 1e3 * place.pattern.diameter));
    if (!(place.diameter > place.crimped_diameter))
        throw DeckError(fmt::format("deployment.diameter: {:.4g} mm does not open a stent that is crimped to {:.4g} mm",
                                    1e3 * place.diameter, 1e3 * place.crimped_diameter));
    if (place.crimped_diameter > place.pattern.diameter)
        throw DeckError(
            fmt::format("deployment.crimped_diameter: {:.4g} mm is more than the {:.4g} mm at which the stent was cut: "
                        "crimping makes it smaller",
                        1e3 * place.crimped_diameter, 1e3 * place.pattern.diameter));
    if (!(place.crimped_diameter > 3 * place.pattern.strut_thickness))
        throw DeckError(fmt::format("deployment.crimped_diameter: {:.4g} mm leaves no room inside struts of {:.3g} mm",
                                    1e3 * place.crimped_diameter, 1e3 * place.pattern.strut_thickness));
    if (deployment.predilation && !(*deployment.predilation > place.crimped_diameter))
        throw DeckError(fmt::format(
            "deployment.predilation: a balloon of {:.4g} mm does not make room for the crimped stent of {:.4g} mm",
            1e3 * *deployment.predilation, 1e3 * place.crimped_diameter));
}

/// The ends of a stent are expanded with it: between them and an opening there must be vessel.
void expect_room_before_openings(const StentPlace& place, const Centreline& line, const std::string& inlet) {
    const double margin = place.diameter;
    const auto refuse = [&](const std::string& name, double left) {
        throw GeometryError(fmt::format(
            "The stent of {:.4g} mm with its middle at {:.4g} mm {} opening {}: leave {:.3g} mm of vessel at least. "
            "The vessel along "
            "that way is {:.4g} mm long; move the stent, take a shorter one, or put extensions on the openings.",
            1e3 * place.pattern.length, 1e3 * place.arc,
            left < 0 ? "reaches past" : fmt::format("ends {:.3g} mm from", 1e3 * left), name, 1e3 * margin,
            1e3 * line.length()));
    };
    if (place.start_arc() < margin) refuse(inlet, place.start_arc());
    if (const double left = line.length() - place.end_arc(); left < margin) refuse(line.outlet, left);
}

void expect_inside(const StentPlace& place, const Vessel& vessel) {
    const SignedDistance distance = make_exact_distance(closed_at(vessel.checked.surface, vessel.checked.ends));
    constexpr int places = 16;
    for (int k = 0; k <= places; ++k) {
        const Vec3 x = place.axis.place({0, 0, place.pattern.length * (double(k) / places - 0.5)});
        if (const double out = distance.value(x); out >= 0)
            throw GeometryError(
                fmt::format("The stent lies outside of the vessel: its axis is {:.3g} mm past the wall at ({:.4g}, "
                            "{:.4g}, {:.4g}) mm. Change "
                            "stent.placement.",
                            1e3 * out, 1e3 * x.x, 1e3 * x.y, 1e3 * x.z));
    }
}

/// On its way from the inlet the crimped stent must pass, and where it is opened it must fit, after predilation if asked.
void expect_passage(const StentPlace& place, const Centreline& line, const deck::Deployment& deployment) {
    for (const CentrelinePoint& p : line.points) {
        if (p.arc > place.end_arc()) return;
        if (2 * p.radius > place.crimped_diameter) continue;
        if (p.arc < place.start_arc())
            throw GeometryError(
                fmt::format("The stent, crimped to {:.3g} mm, is too wide to get there: {:.4g} mm from the inlet the "
                            "lumen is {:.3g} mm wide. Crimp it "
                            "further (deployment.crimped_diameter) or take a smaller one.",
                            1e3 * place.crimped_diameter, 1e3 * p.arc, 2e3 * p.radius));
        if (!deployment.predilation)
            throw GeometryError(fmt::format(
                "The lesion is {:.3g} mm wide, too narrow for the stent crimped to {:.3g} mm. Let a balloon open it "
                "before: "
                "deployment.predilation: \"{:.1f} mm\", or crimp the stent further (deployment.crimped_diameter).",
                1e3 * place.narrowest, 1e3 * place.crimped_diameter, 1e3 * predilation_for(place.crimped_diameter)));
    }
}

}   // namespace

double predilation_for(double crimped_diameter) { return 1e-4 * std::ceil(12e3 * crimped_diameter - 1e-6); }

std::vector<Vec3> smoothed_line(const Centreline& line, double radius) {
    std::vector<Vec3> smooth;
    for (std::size_t k = 0; k < line.points.size(); ++k) {
        const double arc = line.points[k].arc, reach = std::min({radius, arc, line.length() - arc});
        Vec3 sum = line.points[k].place;
        double count = 1;
        for (std::size_t m = 1; m <= std::min(k, line.points.size() - 1 - k); ++m) {
            if (arc - line.points[k - m].arc > reach) break;
            sum += line.points[k - m].place + line.points[k + m].place, count += 2;
        }
        smooth.push_back(sum / count);
    }
    return smooth;
}

StentPlace place_stent(const deck::Case& config, const Vessel& vessel) {
    if (!config.stent) throw DeckError("stent: is missing; name one, for instance {design: open_cell}");
    const deck::Stent& stent = *config.stent;
    const VesselAlong& along = vessel.along.value();
    MadeStent made = make_stent(stent);
    if (stent.surface && config.deployment.mode == deck::DeploymentMode::geometric)
        throw DeckError(
            "deployment.mode: geometric opens the struts of a design or a pattern; how those of stent.surface move "
            "only mechanics can say: balloon or radial_load");
    StentPlace place{.pattern = std::move(made.pattern),
                     .form = std::move(made.form),
                     .diameter = 0,
                     .crimped_diameter = 0,
                     .opened_length = 0,
                     .line = 0,
                     .arc = 0,
                     .axis = {},
                     .reference_diameter = 0,
                     .narrowest = Bounds::infinity};
    place.diameter = config.deployment.diameter.value_or(place.pattern.nominal_diameter);
    place.crimped_diameter = config.deployment.crimped_diameter.value_or(place.pattern.crimped_diameter);
    expect_diameters(place, config.deployment);
    place.opened_length = stent.surface ? place.pattern.length : at_diameter(place.pattern, place.diameter).length;

    const Middle middle = middle_of(stent, along);
    const Centreline& line = along.lines.lines[middle.line];
    place.line = middle.line, place.arc = middle.arc;
    expect_room_before_openings(place, line, vessel.openings.front().opening.name);
    if (stent.placement && stent.placement->translation) {
        place.axis = make_stent_axis(*stent.placement, place.pattern);
    } else {
        const std::vector<Vec3> smooth = smoothed_line(line, 0.5 * place.diameter);
        double before = 0;   // the smoothed line is a little shorter
        for (std::size_t k = 1; k < smooth.size() && line.points[k].arc <= middle.arc; ++k)
            before += norm(smooth[k] - smooth[k - 1]);
        place.axis = StentAxis(smooth, before, stent.placement ? stent.placement->rotation : 0, place.pattern.length,
                               0.5 * place.diameter);
    }
    for (const CentrelinePoint& p : line.points)
        if (p.arc >= place.start_arc() && p.arc <= place.end_arc())
            place.narrowest = std::min(place.narrowest, 2 * p.radius);
    const std::vector<double>& healthy = along.assessment.healthy_diameter[middle.line];
    place.reference_diameter =
        0.5 * (value_at(line, healthy, place.start_arc()) + value_at(line, healthy, place.end_arc()));
    expect_inside(place, vessel);
    if (config.deployment.mode == deck::DeploymentMode::geometric) return place;
    if (!stent.surface) at_diameter(place.pattern, place.crimped_diameter);   // its struts must have room
    expect_passage(place, line, config.deployment);
    return place;
}

}   // namespace patency
