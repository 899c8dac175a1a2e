// SPDX-License-Identifier: Apache-2.0
// The bodies of a deployment, before anything moves: the wall around the stent's place, the stent as it was cut, and the lumen's
// surface, which the wall will carry.
#pragma once

#include <memory>

#include "patency/bodies/vessel_wall.h"
#include "patency/config/case.h"
#include "patency/stages/solid_scene.h"
#include "patency/stages/stent_placement.h"

namespace patency {

struct DeployScene {
    deck::Case config;
    Vessel vessel;
    StentPlace place;
    std::optional<WallField> field;
    double wall_spacing = 0, stent_spacing = 0;   ///< [m]
    double mass_scaling = 1;                      ///< of the stent
    std::unique_ptr<SolidPart> wall,
        stent;           ///< until they are in `solids`; the wall's materials are its layers (WallLayer)
    SolidScene solids;   ///< what moves now
    Surface lumen;       ///< the vessel's surface, fine where the wall carries it
    std::vector<std::uint32_t> carried_points;   ///< of it
    std::unique_ptr<SolidSurface> carrier;       ///< of these points, in their order

    /// The vessel's surface where the wall is now.
    Surface lumen_now(const SolidParticles& wall_particles);
};

/// Throws DeckError, GeometryError, FileError: everything that must be refused is refused here.
std::unique_ptr<DeployScene> build_deployment(const deck::Case& config);

/// What the layers of the wall are made of, in the order of WallLayer, and the stent. Throw as make_solid_material.
std::vector<SolidMaterial> wall_materials(const deck::Wall& wall);
SolidMaterial stent_material(const deck::Stent& stent, const StentPattern& pattern);

/// Of the surface that a network becomes [m]: the wall's spacing.
double network_resolution(const deck::Case& config);
/// Where the deck says nothing: 0.2 mm, or what puts four particles through the thickness [m].
double usual_wall_spacing(double thickness);
/// How much heavier the stent is made, so that it bears as few steps in the ramp as the deck wants: its stable step grows with the root.
double stent_mass_scaling(const deck::Case& config, const StentPlace& place, double spacing);

}   // namespace patency
