// SPDX-License-Identifier: Apache-2.0
// Decks for the tests: valid ones that together use every key, and a small one to break.
#pragma once

#include <string>
#include <vector>

namespace patency::deck {

/// A valid deck whose lines the tests of mistakes count on.
inline const std::string pipe_deck = R"(version: 1
case: {name: pipe}
geometry:
  shape: {type: tube, diameter: "3 mm", length: "15 mm"}
blood:
  density: "1060 kg/m^3"
  viscosity: "3.5 mPa s"
openings:
  inlet:
    type: velocity
    velocity: "0.1 m/s"
  outlet:
    type: pressure
    pressure: "0 mmHg"
numerics:
  spacing: "0.2 mm"
  duration: "1 s"
)";

/// pipe_deck with the first `part` replaced.
inline std::string pipe_with(const std::string& part, const std::string& replacement) {
    std::string text = pipe_deck;
    return text.replace(text.find(part), part.size(), replacement);
}

inline const std::string solid_deck = R"(version: 1
case: {name: wall}
solids:
  - name: wall
    shape: {type: cylinder, from: [0 mm, 0 mm, 0 mm], to: [0 mm, 0 mm, 5 mm], diameter: 4 mm, inner_diameter: 3 mm}
    material: {law: fibre_artery, density: 1100 kg/m^3, shear: 3 kPa, bulk: 300 kPa, fibre_stiffness: 2 kPa, fibre_growth: 0.8,
               fibre_dispersion: 0.1, fibre_angle: 40 deg}
    holds:
      - {low: [-3 mm, -3 mm, -1 mm], high: [3 mm, 3 mm, 0.1 mm], axes: [false, false, true], displacement: [0 mm, 0 mm, 1 mm], ramp: 1 s}
    pressures: [{face: inner, times: [0 s, 1 s], pressures: [0 mmHg, 100 mmHg]}]
  - name: pin
    shape: {type: sphere, centre: [0 mm, 0 mm, 2 mm], diameter: 1 mm}
    material: {name: 316L}
    spacing: 0.1 mm
    velocity: [1 m/s, 0 m/s, 0 m/s]
contacts:
  - {solid: pin, with: wall, friction: 0.1}
  - {solid: wall, plane: {point: [0 mm, 0 mm, -1 mm], normal: [0, 0, 1]}}
body_force: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
numerics:
  spacing: 0.2 mm
  duration: 1 s
  solid: {viscosity: 0.1, relaxation: adaptive}
)";

inline const std::vector<std::string> valid_decks{
    pipe_deck,
    R"(version: 1
case: {name: everything, mode: periodic, period: "0.8 s"}
geometry:
  surface: lumen.stl
  unit: mm
  space: LPS
  label: 2
  cut_back: {inlet: "2.7 mm", a: "1 cm"}
  extensions: {diameters: 2}
blood: {density: "1.06 g/mL", law: carreau_yasuda, mu_0: "56 cP", mu_inf: "0.0345 P", lambda: "1.902 s", n: 0.22, a: 1.25}
wall:
  motion: deformable
  slip: no_slip
  thickness: "0.8 mm"
  law: coronary_wall
  plaque: fills
  spacing: "0.15 mm"
  layers: {adventitia_share: 0.4, plaque: {name: coronary_wall, young: 2 MPa, poisson: 0.45}, adventitia: {name: coronary_wall}}
deployment: {diameter: 3.3 mm, crimped_diameter: 1.1 mm, predilation: 2 mm, ramp: 3 ms, steps: 30000, slowing: 3, tethering: 5 kPa/mm, region: 0.7}
openings:
  inlet:
    type: flow
    profile: womersley
    ramp: "0.1 s"
    waveform: {fourier: {mean: "60 mL/min", period: "0.8 s", cosines: ["10 mL/min", "0 mL/min"], sines: ["1 mL/s", "3 mm^3/s"]}}
  side:
    type: velocity
    profile: table
    profile_table: {radii: [0, 0.5, 1], speeds: [2, 1.5, 0]}
    waveform: {times: ["0 s", "0.3 s", "0.7 s"], values: ["0.1 m/s", "20 cm/s", "0.1 m/s"], period: "0.8 s"}
  a: {type: pressure, waveform: {file: waves/p.csv}}
  b: {type: resistance, resistance: "100 mmHg s/mL", distal_pressure: "5 mmHg"}
  c: {type: rcr, proximal_resistance: "9 Wood", distal_resistance: "1e5 dyn s/cm^5", compliance: "0.01 mL/mmHg", initial_pressure: "80 mmHg"}
  d: {type: coronary, proximal_resistance: "1e9 Pa s/m^3", distal_resistance: "3 mmHg min/mL", compliance: "1e-6 cm^5/dyn", distal_pressure: "1 kPa", microvascular_resistance: "40 mmHg s/mL", myocardial_compliance: "0.02 mL/mmHg", myocardial_pressure: {times: ["0 s", "0.3 s"], values: ["0 mmHg", "90 mmHg"]}}
aorta: {pressure: "93 mmHg"}
bed: {state: resting, flow: "120 mL/min", murray_exponent: 2.5, venous_pressure: "6 mmHg"}
stent:
  design: open_cell
  alloy: PtCr
  spacing: "20 um"
  placement: {branch: left, arc_length: "14.2 mm", rotation: "30 deg"}
initial: {velocity: parabola, speed: "0.1 m/s", pressure: linear}
numerics:
  scheme: paper
  spacing: "0.1 mm"
  smoothing_ratio: 1.4
  sound_speed_factor: 12
  reference_speed: "0.7 m/s"
  precision: double
  duration: "4 s"
  advection_cfl: 0.2
  acoustic_cfl: 0.5
  threads: 2
  pressure_reference: fixed
  seed: 7
output:
  interval: "10 ms"
  fields: [velocity, pressure, density]
  probes: [{name: throat, point: ["1 mm", "0.2 cm", "-3 um"]}]
  profiles:
    - {name: middle, from: ["0 m", "0 m", "0 m"], to: ["1 mm", "0 m", "0 m"], points: 21, times: ["0.1 s", "0.2 s"]}
  average_from: "3.2 s"
  checkpoint_interval: "0.5 min"
)",
    R"(version: 1
geometry: {shape: {type: channel, gap: "1 mm", length: "8 mm"}}
blood: {density: "1000 kg/m^3", law: newtonian, viscosity: "1 mPa s"}
wall: {velocity: {all: ["1 m/s", "0 m/s", "0 m/s"]}}
body_force: ["9.81 m/s^2", "0 m/s^2", "0 m/s^2"]
openings:
  inlet: {type: velocity, profile: developed_startup, peak_velocity: "0.05 m/s"}
  outlet: {type: pressure, pressure: "-10 kPa"}
numerics: {spacing: "0.04 mm", duration: "1 s", sound_speed: "5 m/s"}
runs:
  - {name: d12, set: {numerics.spacing: "0.08333333333333333 mm"}}
  - name: paper
    set:
      numerics.scheme: paper
      geometry.shape: {type: channel, gap: "2 mm", length: "8 mm"}
      output.fields: [velocity]
)",
    R"(version: 1
geometry: {shape: {type: box, size: ["1 m", "1 m", "0 m"], periodic: [true, true, false], planar: true}}
blood: {density: "1000 kg/m^3", law: power_law, consistency: "0.017 Pa s^n", n: 0.7, min_viscosity: "1 cP", max_viscosity: "1 P"}
initial: {velocity: taylor_green, speed: "1 m/s"}
numerics: {spacing: "2 cm", duration: "2 s"}
)",
    R"({"version": 1,
 "geometry": {"shape": {"type": "nozzle", "axis": [0, 0, 2], "start": ["0 m", "0 m", "-1 cm"],
   "sections": [{"z": "0 mm", "diameter": "12 mm"}, {"z": "22.685 mm", "diameter": "4 mm"}]}},
 "blood": {"density": "1056 kg/m^3", "law": "casson", "yield_stress": "0.05 dyn/cm^2", "plastic_viscosity": "3.5 mPa·s",
   "max_viscosity": "100 mPa*s"},
 "openings": {"inlet": {"type": "flow", "profile": "parabola", "flow": "5.21 cm³/s"},
   "outlet": {"type": "pressure", "pressure": "1 atm"}},
 "numerics": {"spacing": "0.33 mm", "duration": "1 s"}}
)",
    R"(version: 1
geometry:
  shape:
    type: branches
    branches:
      - {name: trunk, from: ["0 mm", "0 mm", "0 mm"], to: ["10 mm", "0 mm", "0 mm"], diameters: ["4 mm", "3.5 mm"]}
      - {name: left, from: ["10 mm", "0 mm", "0 mm"], to: ["17 mm", "7 mm", "0 mm"], diameters: ["3 mm", "2 mm"]}
blood: {density: "1060 kg/m^3", viscosity: "4 mPa s"}
stent: {surface: stents/a.stl, unit: mm, alloy: nitinol}
numerics: {spacing: "0.2 mm", duration: "1 s"}
)",
    R"(version: 1
geometry: {shape: {type: cone, diameters: ["4 mm", "2 mm"], length: "20 mm", axis: [1, 1, 0.5]}}
blood: {density: "1060 kg/m^3", viscosity: "4 mPa s"}
wall: {slip: free_slip}
stent:
  pattern: {layout: rings, rings: 8, crowns: 6, length: "10 mm", diameter: "2 mm", crimped_diameter: "1.2 mm",
    nominal_diameter: "3.3 mm", strut_width: "0.1 mm", strut_thickness: "100 um", crown_radius: "0.15 mm", gap: "0.3 mm",
    connectors: 3, connector_shift: 1, connector_shape: flex, facing: staggered, connector_width: "90 um",
    connector_swing: "50 um", edge_radius: "4 um"}
  placement: {translation: ["1 mm", "2 mm", "3 mm"], direction: [0, 1, 1], rotation: "0.5 rad"}
numerics: {spacing: "0.2 mm", duration: "1 s"}
)",     solid_deck,
    R"(version: 1
geometry:
  network: tree.json
  lesion: {branch: lad, position: "23 mm", length: "1 cm", diameter_stenosis_percent: 39.4, eccentricity: 0.5, side: [0, 0, 1]}
blood: {density: "1060 kg/m^3", viscosity: "4 mPa s"}
numerics: {spacing: "0.2 mm", duration: "1 s"}
)",
};

}   // namespace patency::deck
