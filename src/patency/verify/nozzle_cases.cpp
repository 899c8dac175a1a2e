// SPDX-License-Identifier: Apache-2.0
// The FDA's benchmark nozzle at throat Reynolds number 500 against five laboratories' particle image velocimetry
// (Hariharan et al. 2011; Stewart et al. 2012; data doi 10.17917/C78G69, public domain).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "patency/verify/sampling_of_scene.h"

namespace patency {

namespace {

constexpr double expansion =
    0.0926851;   // m from the start of the deck's nozzle to z = 0, see cases/verify/fda_nozzle.yaml

struct Station {
    double z;                 // m, 0 at the sudden expansion
    double low, high, mean;   // axial velocity on the axis over the laboratories [m/s]
};
// SE_exp_0500: the sets 243, 297, 468, 763 and 999.
constexpr std::array<Station, 15> centreline = {{{-0.0880, 0.0831, 0.0928, 0.0871},
                                                 {-0.0640, 0.0850, 0.0893, 0.0878},
                                                 {-0.0480, 0.1890, 0.2364, 0.1995},
                                                 {-0.0420, 0.3774, 0.3807, 0.3786},
                                                 {-0.0200, 0.6582, 0.7149, 0.6804},
                                                 {-0.0080, 0.7015, 0.7679, 0.7333},
                                                 {0.0000, 0.7093, 0.7534, 0.7280},
                                                 {0.0080, 0.6930, 0.7398, 0.7257},
                                                 {0.0160, 0.6710, 0.7211, 0.7032},
                                                 {0.0240, 0.6514, 0.6773, 0.6671},
                                                 {0.0320, 0.6277, 0.6541, 0.6378},
                                                 {0.0400, 0.6102, 0.6373, 0.6246},
                                                 {0.0480, 0.5987, 0.6288, 0.6146},
                                                 {0.0600, 0.4441, 0.5870, 0.5367},
                                                 {0.0800, 0.4168, 0.5134, 0.4591}}};
constexpr double first_judged = -0.02, last_judged = 0.048;   // m

struct PressureStation {
    double z, low, high;   // m; pressure above that at z = 0, over the sets 243, 468, 763 [Pa]
};
constexpr std::array<PressureStation, 5> wall_pressure = {{{-0.06299, 484.3, 550.7},
                                                           {-0.04001, 234.0, 261.8},
                                                           {-0.01999, 110.1, 130.9},
                                                           {0.00800, 82.6, 157.1},
                                                           {0.03200, 130.9, 145.0}}};

void measure_nozzle(Scene& scene, const RunContext& context, RunData& data) {
    const StraightAxis axis = axis_of(scene);
    const double until = scene.config.numerics.duration, dp = scene.numerics.spacing;
    run_until(scene, context, 0.8 * until);
    std::array<TimeMean, centreline.size()> speeds;
    std::array<TimeMean, wall_pressure.size() + 1> pressures;   // the last is at z = 0
    run_until(scene, context, until, [&](const Scene& now, double dt) {
        for (std::size_t i = 0; i < now.fluid.size(); ++i) {
            const double z = axis.axial(now.fluid.position[i]) - expansion, r = axis.radial(now.fluid.position[i]);
            for (std::size_t k = 0; k < centreline.size(); ++k)   // within a spacing the jet's profile is flat to 3 %
                if (r < 0.75 * dp && std::abs(z - centreline[k].z) < dp)
                    speeds[k].add(dot(now.fluid.velocity[i], axis.direction), dt);
            for (std::size_t k = 0; k <= wall_pressure.size(); ++k) {
                const double place = k < wall_pressure.size() ? wall_pressure[k].z : 0;
                if (std::abs(z - place) < dp && axis.radius_at(place + expansion - 1e-6) - r < 1.5 * dp &&
                    r < axis.radius_at(place + expansion - 1e-6))
                    pressures[k].add(now.fluid.pressure[i], dt);
            }
        }
    });
    for (const TimeMean& mean : speeds) data.lists["centreline"].push_back(mean.value());
    for (const TimeMean& mean : pressures) data.lists["pressure"].push_back(mean.value());
}

void nozzle_figures(const Results& results, FigureList& figures) {
    figures.add({"centreline_worst_percent", "percent", Bar{5.0}}, {"throat12"}, [&] {
        double worst = 0;
        for (std::size_t k = 0; k < centreline.size(); ++k) {
            const Station& s = centreline[k];
            if (s.z < first_judged || s.z > last_judged) continue;
            const double u = results["throat12"].list("centreline")[k];
            worst = std::max(worst, 100 * std::max({0.0, s.low - u, u - s.high}) / s.mean);
        }
        return worst;
    });
    for (std::size_t k = 0; k < wall_pressure.size(); ++k) {
        const PressureStation& s = wall_pressure[k];
        figures.add({fmt::format("wall_pressure_pa_z{:+.0f}mm", 1e3 * s.z), "Pa", {}}, {"throat12"}, [&] {
            return results["throat12"].list("pressure")[k] - results["throat12"].list("pressure").back();
        });
        figures.add({fmt::format("laboratories_lowest_pa_z{:+.0f}mm", 1e3 * s.z), "Pa", {}}, {"throat12"},
                    [&] { return s.low; });
        figures.add({fmt::format("laboratories_highest_pa_z{:+.0f}mm", 1e3 * s.z), "Pa", {}}, {"throat12"},
                    [&] { return s.high; });
    }
}

std::vector<Picture> nozzle_pictures(const Results& results) {
    if (!results.has("throat12")) return {};
    Curve low{"laboratories, lowest", {}, {}, false}, high{"laboratories, highest", {}, {}, false},
        ours{"patency", {}, {}, true};
    for (std::size_t k = 0; k < centreline.size(); ++k) {
        for (Curve* c : {&low, &high, &ours}) c->x.push_back(1e3 * centreline[k].z);
        low.y.push_back(centreline[k].low), high.y.push_back(centreline[k].high);
        ours.y.push_back(results["throat12"].list("centreline")[k]);
    }
    return {{"fda_nozzle", "Velocity on the axis", format_plot({"z [mm]", "u [m/s]", {low, high, ours}})}};
}

}   // namespace

std::vector<VerifyCase> nozzle_cases() {
    return {{.name = "fda_nozzle",
             .title = "The FDA's nozzle, throat Reynolds number 500",
             .level = Level::full,
             .is_full = {},
             .measure = measure_nozzle,
             .figures = nozzle_figures,
             .pictures = nozzle_pictures}};
}

}   // namespace patency
