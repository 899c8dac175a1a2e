// SPDX-License-Identifier: Apache-2.0
// Vessels for the tests of stages.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "patency/config/deck.h"
#include "patency/stages/build.h"

namespace patency {

/// The bifurcation that comes with the program, coarse: the least that its lesion allows.
inline deck::Case bifurcation(deck::Settings more = {}) {
    deck::Settings settings{"numerics.scheme=sph", "numerics.across=null", "numerics.spacing=0.48 mm",
                            "numerics.convergence.tolerance_percent=0.5",
                            "initial={velocity: estimate, pressure: estimate}"};
    settings.insert(settings.end(), more.begin(), more.end());
    return deck::read_case(std::filesystem::path(PATENCY_SOURCE_DIR) / "cases/coronary_bifurcation.yaml", settings);
}

/// It, built.
inline const Scene& scene() {
    static const auto made = build_scene(bifurcation());
    return *made;
}

/// One narrowed vessel, small and quick; its network lies in the folder.
inline deck::Case narrowed_tube(const std::filesystem::path& folder, const std::string& numerics) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "tube.json") << R"({"unit": "mm", "blend_width_k": 0.1,
  "tubes": [{"name": "tube", "points": [[-2, 0, 0, 1.5], [3, 0, 0, 1.5], [9, 0, 0, 1.5], [14, 0, 0, 1.5]]}],
  "ends": {"inlet": {"point": [0, 0, 0], "outward_normal": [-1, 0, 0], "radius": 1.5},
           "outlet": {"point": [12, 0, 0], "outward_normal": [1, 0, 0], "radius": 1.5}}})";
    std::ofstream(folder / "tube.yaml") << fmt::format(
        R"(version: 1
case: {{name: tube}}
geometry: {{network: tube.json, lesion: {{branch: tube, position: "6 mm", length: "4 mm", diameter_stenosis_percent: 40}}}}
blood: {{density: "1060 kg/m^3", viscosity: "3.5 mPa s"}}
openings:
  inlet: {{type: flow, flow: "60 mL/min", profile: parabola}}
  outlet: {{type: rcr, proximal_resistance: "1e8 Pa s/m^3", distal_resistance: "9e8 Pa s/m^3", compliance: "1e-10 m^3/Pa"}}
numerics: {{spacing: "0.4 mm", {}{}}}
)",
        numerics.find("scheme") == std::string::npos ? "scheme: sph, " : "", numerics);
    return deck::read_case(folder / "tube.yaml");
}

}   // namespace patency
