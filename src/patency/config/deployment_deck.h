// SPDX-License-Identifier: Apache-2.0
// What a deck says about the wall as a solid and about how a stent is implanted, in SI: `wall`, `deployment`. Included by case.h,
// read as all of it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "patency/base/vec.h"
#include "patency/config/solid_deck.h"

namespace patency::deck {

enum class WallMotion { rigid, one_way, deformable };
inline std::vector<std::string_view> words(WallMotion) { return {"rigid", "one_way", "deformable"}; }

enum class Slip { no_slip, free_slip };
inline std::vector<std::string_view> words(Slip) { return {"no_slip", "free_slip"}; }

enum class Plaque { none, fills };
inline std::vector<std::string_view> words(Plaque) { return {"none", "fills"}; }

enum class DeploymentMode { balloon, radial_load, geometric };
inline std::vector<std::string_view> words(DeploymentMode) { return {"balloon", "radial_load", "geometric"}; }

/// What the wall is made of, from the lumen outwards; absent: as wall.law says.
struct WallLayers {
    std::optional<SolidMaterialChoice> plaque, media, adventitia;
    double adventitia_share = 0;   ///< of the thickness, outside
    bool operator==(const WallLayers&) const = default;
};

struct Wall {
    WallMotion motion = WallMotion::rigid;
    Slip slip = Slip::no_slip;
    std::map<std::string, Vec3> velocity;   ///< m/s, by the wall's name, or "all"
    std::optional<double> thickness;        ///< m; absent: by the healthy lumen's diameter
    std::string law = "coronary_wall";      ///< a material of the table
    Plaque plaque = Plaque::none;   ///< fills: from the lumen to the healthy one; none: the wall follows the lumen
    WallLayers layers;
    std::optional<double>
        spacing;   ///< m between its particles as a solid; absent: 0.2 mm, or a quarter of the thickness
    bool operator==(const Wall&) const = default;
};

/// How the stent gets where it belongs. Diameters of a stent are outer ones.
struct Deployment {
    DeploymentMode mode = DeploymentMode::balloon;
    std::optional<double> diameter;   ///< m, that the balloon opens the stent to; absent: the design's nominal one
    std::optional<double> crimped_diameter;   ///< m; absent: the design's
    std::optional<double> predilation;        ///< m: the balloon that opens the lumen before; absent: none
    double friction = 0.1;                    ///< between stent and wall
    double balloon_friction = 0.2;            ///< between tools and stent
    double load = 1e7;                        ///< radial_load: Pa on the struts, at the most
    double ramp = 3e-3;                       ///< s in which the balloon opens
    int steps = 15000;                        ///< of the stent, in the ramp
    double slowing = 4;                       ///< where it moves too fast the ramp takes longer, at most so many times
    std::optional<double> mass_scaling;       ///< of the stent's density, instead of steps
    double region = 0.5;                      ///< in lengths of the stent: the wall beyond each of its ends
    double tethering = 0;                     ///< Pa/m of springs on the outside of the wall
    double shoulder = 1;                      ///< geometric: in diameters, from the stent's end to the vessel as it was
    int frames = 40;
    bool operator==(const Deployment&) const = default;
};

}   // namespace patency::deck
