// SPDX-License-Identifier: Apache-2.0
// A vessel's steady flow on cells told in the same way as one of moving particles: branches, lesions, FFR, wall shear.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "patency/io/output_folder.h"
#include "patency/stages/cell_scene.h"
#include "patency/stages/scene.h"

namespace patency {

/// The cells as particles that stand where they are, with the wall's patches as feet of its particles: what samples read. No scheme.
/// Of a deck with a vessel.
std::unique_ptr<Scene> scene_of_cells(const CellScene& cells);

/// Adds what vessel_results.h adds to a summary, and writes its files.
void add_vessel_results(nlohmann::ordered_json& summary, const CellScene& cells, const OutputFolder& folder);

}   // namespace patency
