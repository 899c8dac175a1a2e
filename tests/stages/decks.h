// SPDX-License-Identifier: Apache-2.0
// Small cases for the tests of stages: seconds of computing, closed forms known.
#pragma once

#include <string>

#include <fmt/format.h>

namespace patency {

/// Planar Poiseuille flow, Re 50: gap 1 mm, length 4 mm, peak 0.165 m/s, mean 2/3 of it, pressure drop 4.62 Pa.
struct ChannelDeck {
    int across = 12;
    std::string inlet = "{type: velocity, profile: parabola, peak_velocity: \"0.165 m/s\"}";
    std::string outlet = "{type: pressure, pressure: \"0 Pa\"}";
    std::string initial = "{velocity: parabola, speed: \"0.11 m/s\", pressure: linear}";
    std::string duration = "10 ms";
    std::string more = "";       // whole lines of the deck
    std::string numerics = "";   // further keys

    std::string text() const {
        return fmt::format(R"(version: 1
case: {{name: channel}}
geometry: {{shape: {{type: channel, gap: "1 mm", length: "4 mm"}}}}
blood: {{density: "1000 kg/m^3", viscosity: "3.5 mPa s"}}
openings:
  inlet: {}
  outlet: {}
initial: {}
numerics: {{spacing: "{:.17g} mm", duration: "{}"{}}}
{})",
                           inlet, outlet, initial, 1.0 / across, duration, numerics.empty() ? "" : ", " + numerics,
                           more);
    }
};

/// A plug of 0.2 m/s into a tube of 2 mm, against no pressure.
struct PlugDeck {
    std::string length, spacing, duration;   // with units

    std::string text() const {
        return fmt::format(R"(version: 1
case: {{name: entrance}}
geometry: {{shape: {{type: tube, diameter: "2 mm", length: "{}"}}}}
blood: {{density: "1060 kg/m^3", viscosity: "3.5 mPa s"}}
openings:
  inlet: {{type: velocity, profile: plug, velocity: "0.2 m/s"}}
  outlet: {{type: pressure, pressure: "0 Pa"}}
initial: {{velocity: plug, speed: "0.2 m/s"}}
numerics: {{spacing: "{}", duration: "{}"}}
)",
                           length, spacing, duration);
    }
};

}   // namespace patency
