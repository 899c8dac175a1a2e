// SPDX-License-Identifier: Apache-2.0
// The keys of the wall and of how a stent is implanted in it.
#include "patency/config/schema_rows.h"

namespace patency::deck {

template <>
const Table& table_of<WallLayers>() {
    static const Table table = make_table<WallLayers>(
        "What the wall is made of, from the lumen outwards.",
        {
            row(&WallLayers::plaque,
                {.key = "plaque", .help = "between the lumen and the healthy one; as wall.law says if absent"}),
            row(&WallLayers::media, {.key = "media", .help = "the inner layer; as wall.law says if absent"}),
            row(&WallLayers::adventitia, {.key = "adventitia", .help = "the outer layer; as wall.law says if absent"}),
            row(&WallLayers::adventitia_share, {.key = "adventitia_share",
                                                .help = "how much of the thickness is adventitia",
                                                .range = between(0, 0.9)}),
        });
    return table;
}

template <>
const Table& table_of<Wall>() {
    static const Table table = make_table<Wall>(
        "The vessel wall.",
        {
            row(&Wall::motion, {.key = "motion", .help = "rigid, loaded by the flow (one_way), or moving with it"}),
            row(&Wall::slip, {.key = "slip", .help = "whether blood sticks to the wall"}),
            row(&Wall::velocity, {.key = "velocity",
                                  .help = "velocities of walls that slide, by the wall's name or all",
                                  .unit = "m/s",
                                  .range = between(-largest_speed, largest_speed)}),
            row(&Wall::thickness, {.key = "thickness",
                                   .help = "the thickness of the wall; by the healthy lumen's diameter if absent",
                                   .unit = "mm",
                                   .range = above_up_to(0, largest_length),
                                   .example = "0.8 mm",
                                   .need = where("motion", {"one_way", "deformable"})}),
            row(&Wall::law,
                {.key = "law", .help = "the material of the wall, of the program's table", .example = "coronary_wall"}),
            row(&Wall::plaque,
                {.key = "plaque",
                 .help = "fills: tissue from the lumen to the healthy one; none: the wall follows the lumen"}),
            row(&Wall::layers, {.key = "layers", .help = "materials layer by layer"}),
            row(&Wall::spacing, {.key = "spacing",
                                 .help = "between the wall's particles; 0.2 mm or a quarter of its thickness if absent",
                                 .unit = "mm",
                                 .range = above_up_to(0, largest_length),
                                 .example = "0.15 mm"}),
        });
    return table;
}

template <>
const Table& table_of<Deployment>() {
    const Condition by_contact = where("mode", {"balloon", "radial_load"});
    const Range diameters = above_up_to(0, 0.1);
    static const Table table = make_table<Deployment>(
        "How the stent is implanted; its diameters are outer ones.",
        {
            row(&Deployment::mode, {.key = "mode",
                                    .help = "a balloon, a load on the struts until the diameter is reached, or a quick "
                                            "change of shape without mechanics"}),
            row(&Deployment::diameter, {.key = "diameter",
                                        .help = "what the stent is opened to; its nominal one if absent",
                                        .unit = "mm",
                                        .range = diameters,
                                        .example = "3.3 mm"}),
            row(&Deployment::crimped_diameter, {.key = "crimped_diameter",
                                                .help = "what it is crimped to first; the design's if absent",
                                                .unit = "mm",
                                                .range = diameters,
                                                .example = "1.1 mm",
                                                .only = by_contact}),
            row(&Deployment::predilation,
                {.key = "predilation",
                 .help = "the diameter of a balloon that opens the lumen before the stent enters",
                 .unit = "mm",
                 .range = diameters,
                 .example = "2 mm",
                 .only = by_contact}),
            row(&Deployment::friction, {.key = "friction",
                                        .help = "Coulomb's coefficient between stent and wall",
                                        .range = between(0, 10),
                                        .only = by_contact}),
            row(&Deployment::balloon_friction, {.key = "balloon_friction",
                                                .help = "Coulomb's coefficient between tools and stent",
                                                .range = between(0, 10),
                                                .only = by_contact}),
            row(&Deployment::load, {.key = "load",
                                    .help = "the most that the pressure on the struts may become",
                                    .unit = "Pa",
                                    .range = above_up_to(0, 1e12),
                                    .only = where("mode", {"radial_load"})}),
            row(&Deployment::ramp, {.key = "ramp",
                                    .help = "the time in which the stent is opened",
                                    .unit = "ms",
                                    .range = above_up_to(0, 10),
                                    .only = by_contact}),
            row(&Deployment::steps, {.key = "steps",
                                     .help = "of the stent in that time; its mass is scaled so that it bears them",
                                     .range = between(100, 100000000),
                                     .only = by_contact}),
            row(&Deployment::slowing,
                {.key = "slowing",
                 .help = "at the most so many times slower where the stent or the wall moves too fast",
                 .range = between(1, 100),
                 .only = by_contact}),
            row(&Deployment::mass_scaling, {.key = "mass_scaling",
                                            .help = "the stent's density over its alloy's, instead of steps",
                                            .range = between(1, 1e12),
                                            .example = "100",
                                            .only = by_contact}),
            row(&Deployment::region, {.key = "region",
                                      .help = "how far the wall goes on past the stent's ends, in lengths of it",
                                      .range = above_up_to(0, 1000),
                                      .only = by_contact}),
            row(&Deployment::tethering, {.key = "tethering",
                                         .help = "stiffness, per area, of what surrounds the wall",
                                         .unit = "Pa/m",
                                         .range = between(0, 1e12),
                                         .only = by_contact}),
            row(&Deployment::shoulder, {.key = "shoulder",
                                        .help = "from the stent's end to the vessel as it was, in diameters",
                                        .range = above_up_to(0, 20),
                                        .only = where("mode", {"geometric"})}),
            row(&Deployment::frames, {.key = "frames",
                                      .help = "pictures of the deployment",
                                      .range = between(1, 10000),
                                      .only = by_contact}),
        });
    return table;
}

}   // namespace patency::deck
