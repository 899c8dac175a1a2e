// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/stent_of_case.h"

#include <fmt/format.h>

#include <cmath>

#include "patency/base/errors.h"
#include "patency/io/surface_file.h"
#include "patency/shape/stent_library.h"

namespace patency {

namespace {

void expect_length_of_a_design(const deck::Stent& stent) {
    if (stent.length && !stent.design)
        throw DeckError("stent.length: is that of a design of the library; a pattern or a surface has its own");
}

/// What the library says of a name that it lacks is a mistake at the deck's key.
template <class Find>
void expect_found(const char* key, const std::optional<std::string>& name, const Find& find) {
    try {
        if (name) find(*name);
    } catch (const GeometryError& unknown) {
        throw DeckError(fmt::format("{}: {}", key, unknown.what()));
    }
}

}   // namespace

void expect_known_names(const deck::Stent& stent) {
    expect_length_of_a_design(stent);
    expect_found("stent.design", stent.design, find_stent);
    expect_found("stent.alloy", stent.alloy, find_alloy);
}

StentPattern make_stent_pattern(const deck::Stent& stent) {
    expect_known_names(stent);
    StentPattern pattern;
    if (stent.design) {
        pattern = find_stent(*stent.design).pattern;
        if (stent.length) pattern = with_length(pattern, *stent.length);
    } else if (stent.pattern) {
        const deck::StentPattern& p = *stent.pattern;
        pattern = {.layout = p.layout == deck::StentLayout::helix ? StentLayout::helix : StentLayout::rings,
                   .rings = p.rings,
                   .crowns = p.crowns,
                   .length = p.length,
                   .diameter = p.diameter,
                   .crimped_diameter = p.crimped_diameter,
                   .nominal_diameter = p.nominal_diameter,
                   .strut_width = p.strut_width,
                   .strut_thickness = p.strut_thickness,
                   .crown_radius = p.crown_radius,
                   .gap = p.gap,
                   .connectors = p.connectors,
                   .connector_shape = p.connector_shape == deck::ConnectorShape::flex ? ConnectorShape::flex
                                                                                      : ConnectorShape::straight,
                   .facing = p.facing == deck::CrownFacing::staggered ? CrownFacing::staggered : CrownFacing::aligned,
                   .connector_width = p.connector_width.value_or(0),
                   .connector_swing = p.connector_swing,
                   .connector_shift = p.connector_shift,
                   .edge_radius = p.edge_radius,
                   .alloy = "316L"};
    } else {
        throw DeckError("stent: it is a surface and has no pattern");
    }
    if (stent.alloy) pattern.alloy = *stent.alloy;
    return pattern;
}

std::string alloy_of(const deck::Stent& stent) {
    if (!stent.surface) return make_stent_pattern(stent).alloy;
    expect_known_names(stent);
    return stent.alloy.value_or("316L");
}

MadeStent make_stent(const deck::Stent& stent) {
    if (!stent.surface) {
        StentPattern pattern = make_stent_pattern(stent);
        StentForm form = make_strut_curves(pattern);
        return {std::move(pattern), std::move(form)};
    }
    const std::string alloy = alloy_of(stent);   // before the file is looked for
    ImportedStent metal = recognise_stent(read_surface(*stent.surface, stent.unit.value_or("")));
    StentPattern measured;
    measured.length = metal.length;
    measured.diameter = measured.nominal_diameter = metal.diameter;
    measured.strut_thickness = metal.strut_thickness, measured.strut_width = least_strut(metal);
    measured.alloy = alloy;
    return {std::move(measured), std::move(metal)};
}

StentAxis make_stent_axis(const deck::StentPlacement& placement, const StentPattern& pattern,
                          std::span<const Vec3> line) {
    if (placement.translation) {
        const double c = std::cos(placement.rotation), s = std::sin(placement.rotation);
        const RigidMotion turned{{{1, 0, 0}, {0, c, -s}, {0, s, c}}, {}};
        return StentAxis(motion_along(placement.direction, *placement.translation).after(turned));
    }
    if (!placement.arc_length || line.empty())
        throw DeckError("stent.placement: the centreline is not known; give a translation");
    return StentAxis(line, *placement.arc_length, placement.rotation, pattern.length, pattern.diameter / 2);
}

}   // namespace patency
