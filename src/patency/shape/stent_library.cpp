// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/stent_library.h"

#include <fmt/format.h>

#include "patency/base/errors.h"
#include "patency/base/text.h"

namespace patency {

namespace {

constexpr double mm = 1e-3, um = 1e-6;
using enum StentLayout;
using enum CrownFacing;
using enum ConnectorShape;

constexpr const char* typical = "typical measures of the family, of no one product";

}   // namespace

const std::vector<StentDesign>& stent_library() {
    static const std::vector<StentDesign> table{
        {"paper",
         "2.0 mm x 10 mm, struts of 100 um: six rings of six crowns, three straight connectors per gap",
         "outer diameter 2.0 mm, length 10 mm, opened to 3.3 mm, struts of 80 to 150 um: the reference paper, table V "
         "and "
         "section IV.C; the paper gives no pattern: ours has six rings, which shorten by 7 % when they open, eight "
         "would by 15 %",
         {.layout = rings,
          .rings = 6,
          .crowns = 6,
          .length = 10 * mm,
          .diameter = 2.0 * mm,
          .crimped_diameter = 1.2 * mm,
          .nominal_diameter = 3.3 * mm,
          .strut_width = 100 * um,
          .strut_thickness = 100 * um,
          .crown_radius = 150 * um,
          .gap = 200 * um,
          .connectors = 3,
          .connector_shift = 1,
          .edge_radius = 5 * um,
          .alloy = "316L"}},
        {"open_cell",
         "open cells: rings of six crowns, three short straight connectors per gap, a thin cobalt-chromium wall",
         typical,
         {.layout = rings,
          .rings = 13,
          .crowns = 6,
          .length = 18 * mm,
          .diameter = 1.8 * mm,
          .crimped_diameter = 1.1 * mm,
          .nominal_diameter = 3.0 * mm,
          .strut_width = 90 * um,
          .strut_thickness = 80 * um,
          .crown_radius = 120 * um,
          .gap = 170 * um,
          .connectors = 3,
          .connector_shift = 1,
          .edge_radius = 5 * um,
          .alloy = "L605"}},
        {"open_cell_flex",
         "open cells: rings of eight crowns, two S-shaped connectors per gap that let it bend and shorten",
         typical,
         {.layout = rings,
          .rings = 11,
          .crowns = 8,
          .length = 18 * mm,
          .diameter = 2.0 * mm,
          .crimped_diameter = 1.2 * mm,
          .nominal_diameter = 3.5 * mm,
          .strut_width = 90 * um,
          .strut_thickness = 90 * um,
          .crown_radius = 120 * um,
          .gap = 560 * um,
          .connectors = 2,
          .connector_shape = flex,
          .connector_width = 80 * um,
          .connector_swing = 110 * um,
          .connector_shift = 2,
          .edge_radius = 5 * um,
          .alloy = "PtCr"}},
        {"closed_cell",
         "closed cells: every crown is joined to its neighbour, straight bridges",
         typical,
         {.layout = rings,
          .rings = 9,
          .crowns = 6,
          .length = 15 * mm,
          .diameter = 2.0 * mm,
          .crimped_diameter = 1.3 * mm,
          .nominal_diameter = 3.0 * mm,
          .strut_width = 110 * um,
          .strut_thickness = 100 * um,
          .crown_radius = 130 * um,
          .gap = 120 * um,
          .connectors = 6,
          .edge_radius = 5 * um,
          .alloy = "316L"}},
        {"helical",
         "one wave of crowns wound as a helix, its turns welded tip to tip at two places each",
         typical,
         {.layout = helix,
          .rings = 13,
          .crowns = 8,
          .length = 15 * mm,
          .diameter = 2.0 * mm,
          .crimped_diameter = 1.2 * mm,
          .nominal_diameter = 3.0 * mm,
          .strut_width = 90 * um,
          .strut_thickness = 90 * um,
          .crown_radius = 110 * um,
          .gap = 60 * um,
          .connectors = 2,
          .edge_radius = 5 * um,
          .alloy = "MP35N"}},
        {"two_link",
         "two curved links per gap between rings of eight crowns that are in step, after a commercial cell",
         "the cell of a Terumo Ultimaster Tansei as traced by tristan-rnd (Stent_design_and_construction): four crowns "
         "from "
         "link to link, opened rings 0.97 crown pitches long, links from tip to gap; the other measures are typical",
         {.layout = rings,
          .rings = 12,
          .crowns = 8,
          .length = 18 * mm,
          .diameter = 1.9 * mm,
          .crimped_diameter = 1.15 * mm,
          .nominal_diameter = 3.0 * mm,
          .strut_width = 80 * um,
          .strut_thickness = 80 * um,
          .crown_radius = 90 * um,
          .gap = 230 * um,
          .connectors = 2,
          .connector_shape = flex,
          .facing = staggered,
          .connector_shift = 2,
          .edge_radius = 5 * um,
          .alloy = "L605"}},
    };
    return table;
}

const StentDesign& find_stent(const std::string& name) {
    std::vector<std::string> names;
    for (const StentDesign& design : stent_library()) {
        if (design.name == name) return design;
        names.push_back(design.name);
    }
    const std::string near = nearest_name(name, names);
    throw GeometryError(fmt::format("No stent {}; {}there are {}.", double_quoted(shortened(name)),
                                    near.empty() ? "" : "did you mean " + near + "? ", join(names, ", ", " and ")));
}

}   // namespace patency
