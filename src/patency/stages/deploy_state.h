// SPDX-License-Identifier: Apache-2.0
// A deployment at one moment, as numbers and as pictures: reads the bodies, changes nothing.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "patency/analysis/stent_metrics.h"
#include "patency/io/vtp.h"
#include "patency/stages/deploy_account.h"
#include "patency/stages/deploy_results.h"
#include "patency/stages/deploy_scene.h"

namespace patency {

/// The outer faces of the stent as it is.
OuterFaces outer_faces_of(const SolidPart& stent);

/// Energies of a body [J], and of them what the ratio is of.
struct BodyEnergy {
    double kinetic = 0, internal = 0, plastic = 0;
    double ratio() const { return internal > 0 ? kinetic / internal : 0; }
};
BodyEnergy energy_of(SolidPart& part);

/// The stent's skin: plastic strain, von Mises stress, displacement, the gap to the lumen given.
PolyData stent_picture(SolidPart& stent, const SignedDistance* lumen);
/// The wall's faces: von Mises stress, displacement, layer.
PolyData wall_picture(SolidPart& wall);

/// Where the work of the tools is: of each body, of its contacts, and what is missing if tools did all of it.
nlohmann::ordered_json energies_json(SolidSystem& system, const ContactAccount& contacts, bool is_all_by_tools);

/// Percentiles of the wall's von Mises stress along the stent, layer by layer; of the stent's plastic strain and stress; of the pressure on
/// its outer face where the wall presses on it, over patches as wide as the wall's particles see [m].
nlohmann::ordered_json stresses_json(SolidPart& stent, SolidPart& wall, const StentAxis& axis, double length,
                                     const std::vector<Contact::Push>& pushes, double patch);

}   // namespace patency
