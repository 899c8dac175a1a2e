// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/lumen_after.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/surface_file.h"

namespace patency {

namespace {

/// Of the vessel's openings the one that is where this one was.
std::size_t same_opening(const Opening& opening, const Vessel& vessel) {
    const auto away = [&](const SurfaceOpening& o) { return norm(o.opening.centre - opening.centre); };
    const auto found = std::min_element(vessel.openings.begin(), vessel.openings.end(),
                                        [&](const auto& a, const auto& b) { return away(a) < away(b); });
    if (found == vessel.openings.end() || away(*found) > 0.1 * opening.radius)
        throw GeometryError(fmt::format(
            "The lumen after the deployment has lost its opening {}: a stent so near to it cannot be implanted.",
            opening.name));
    return std::size_t(found - vessel.openings.begin());
}

}   // namespace

deck::Case case_after(const deck::Case& config, const Vessel& before, Vessel& vessel,
                      const std::filesystem::path& surface) {
    deck::Case after = config;
    after.geometry = {};
    after.geometry.surface = surface;
    after.geometry.unit = "mm";
    if (!vessel.checked.surface.space.empty()) after.geometry.space = vessel.checked.surface.space;
    after.geometry.extensions = config.geometry.extensions;
    after.stent.reset();
    after.deployment = {};
    if (const std::size_t inlet = same_opening(before.openings.front().opening, vessel); inlet > 0) {
        after.geometry.inlet = vessel.openings[inlet].opening.name;
        choose_inlet(vessel.openings, *after.geometry.inlet);
    }
    for (const SurfaceOpening& o : before.openings) {   // the openings keep the names that they had
        const std::string& found = vessel.openings[same_opening(o.opening, vessel)].opening.name;
        if (found != o.opening.name) after.geometry.names[found] = o.opening.name;
    }
    return after;
}

std::map<std::string, Vec3> keep_branch_names(const BranchedLines& before, BranchedLines& after) {
    std::map<std::string, Vec3> points;
    std::set<std::size_t> named;
    for (const Branch& branch : before.branches) {
        const Vec3 middle = before.point(branch, (branch.first + branch.last) / 2).place;
        if (const auto found = branch_around(after, middle); found && named.insert(*found).second)
            points[branch.name] = middle;
    }
    try {
        BranchedLines renamed = after;
        name_branches(renamed, points);
        after = std::move(renamed);
    } catch (const UsageError&) {   // a branch that is new has a name that an old one had: names would lie
        return {};
    }
    return points;
}

Vessel write_lumen_after(const deck::Case& config, const Vessel& before, const Surface& after,
                         const OutputFolder& folder) {
    const auto path = std::filesystem::absolute(folder.file("lumen_after.vtp"));
    write_surface(path, after);
    write_stl(folder.file("lumen_after.stl"), after, config.geometry.unit.value_or("mm"));
    // As the flow after will read it: of ends that are equally wide rounding in the file tells which is the first.
    Vessel vessel = check_vessel(read_surface(path.string(), "mm"));
    if (const std::string refused = refusals(vessel.checked.findings); !refused.empty())
        throw GeometryError(
            fmt::format("The lumen after the deployment cannot be used; patency inspect {} shows where.\n{}",
                        path.string(), refused));
    deck::Case config_after = case_after(config, before, vessel, path);
    follow_vessel(vessel);
    if (before.along && vessel.along)
        config_after.geometry.branches = keep_branch_names(before.along->lines, vessel.along->lines);
    deck::write_case(config_after, folder.file("case_after.yaml"));
    return vessel;
}

}   // namespace patency
