// SPDX-License-Identifier: Apache-2.0
// What a deck says of a solid's material, as density and law; and the table of materials with their sources.
#pragma once

#include <span>
#include <string_view>

#include "patency/bodies/solid.h"
#include "patency/config/solid_deck.h"

namespace patency {

/// A material of the table: the numbers as a deck would give them, and where they are from.
struct TableMaterial {
    std::string_view name, what, source;
    deck::SolidMaterialChoice numbers;
};
std::span<const TableMaterial> material_table();

/// `path` names the material in messages: "solids.0.material". Throws DeckError: an unknown name (with the nearest), numbers
/// missing or too many for the law, no stable solid.
SolidMaterial make_solid_material(const deck::SolidMaterialChoice& choice, const std::string& path);

}   // namespace patency
