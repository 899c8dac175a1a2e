// SPDX-License-Identifier: Apache-2.0
// Centrelines as a VTK PolyData file that VMTK, 3D Slicer and SimVascular read.
#pragma once

#include <filesystem>
#include <string>

#include "patency/shape/lesions.h"

namespace patency {

/// One polyline per outlet, each complete from the inlet on. Point arrays, lengths in mm like the coordinates because that
/// is what these programs expect: MaximumInscribedSphereRadius, Abscissas (from the inlet), BranchId and BifurcationId (-1
/// outside of one), CenterlineSectionArea, CenterlineSectionNormal, CenterlineSectionMinSize and CenterlineSectionMaxSize
/// (widths), CenterlineSectionClosed, CenterlineSectionBifurcation (1 where other branches pass through the section too);
/// and HealthyDiameter. Throws FileError.
void write_centrelines(const std::filesystem::path& path, const BranchedLines& vessel,
                       const std::vector<std::vector<CrossSection>>& sections, const Assessment& assessment,
                       const std::string& space = {});

}   // namespace patency
