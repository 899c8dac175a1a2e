// SPDX-License-Identifier: Apache-2.0
// Single solids that move, stretch and flow against closed forms: a plate that swings, tubes under pressure, a bar that
// hits a wall.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/verify/solid_closed_forms.h"
#include "patency/verify/solid_runs.h"
#include "patency/verify/verify_case.h"

namespace patency {

namespace {

using std::numbers::pi;

// The plate.

/// Times at which a signal goes through zero, by straight lines between samples.
class Crossings {
public:
    void look(double time, double value) {
        if (is_started_ && (value > 0) != (last_ > 0))
            times.push_back(time - (time - last_time_) * value / (value - last_));
        is_started_ = true, last_ = value, last_time_ = time;
    }
    std::vector<double> times;

private:
    bool is_started_ = false;
    double last_ = 0, last_time_ = 0;
};

void measure_beam(const deck::Case& config, const std::string&, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    SolidPart& plate = *scene->system.parts[0];
    SolidParticles& p = plate.body->particles();
    const Vec3 tip = config.solids[0].shape.to;
    const Cantilever beam{tip.x, 2 * tip.y, plate.solid.materials[0].density, plate.solid.materials[0].moduli()};
    const double omega = cantilever_frequency(beam),
                 speed = 0.01 * omega * beam.height;   // swings by a hundredth of its height
    std::size_t watched = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (p.reference[i].x > 0) p.velocity[i] = {0, speed * cantilever_shape(beam, p.reference[i].x), 0};
        if (norm(p.reference[i] - tip) < norm(p.reference[watched] - tip)) watched = i;
    }
    const double start = plate.body->energy().kinetic;
    Crossings crossings;
    double drift = 0;
    const double periods = config.numerics.duration * omega / (2 * pi);
    run_to(*scene, config.numerics.duration, interrupted, [&] {
        crossings.look(scene->time, p.position[watched].y - p.reference[watched].y);
        if (scene->steps % 100 != 0) return;
        const SolidEnergy e = plate.body->energy();
        drift = std::max(drift, std::abs(e.kinetic + e.elastic + e.hourglass - start) / start);
    });
    note_size(*scene, data);
    const auto& t = crossings.times;
    if (t.size() < 2) return;
    const double computed = pi * double(t.size() - 1) / (t.back() - t.front());
    data.lists["frequency"] = {computed / (2 * pi)};
    data.lists["exact_frequency"] = {omega / (2 * pi)};
    data.lists["drift_percent"] = {100 * drift};
    data.lists["periods"] = {periods};
}

double frequency_error(const RunData& run) {
    return 100 * std::abs(run.number("frequency") / run.number("exact_frequency") - 1);
}

void beam_figures(const Results& results, FigureList& figures) {
    figures.add({"frequency_error_percent", "percent", Bar{3}}, {"n10"},
                [&] { return frequency_error(results["n10"]); });
    figures.add({"energy_drift_percent", "percent", Bar{1}}, {"n10"},
                [&] { return results["n10"].number("drift_percent"); });
    figures.add({"periods", "1", Bar{10, Sense::at_least}}, {"n10"}, [&] { return results["n10"].number("periods"); });
    for (const std::string run : {"n6", "n20"})
        figures.add({"frequency_error_percent_" + run, "percent", {}}, {run},
                    [&] { return frequency_error(results[run]); });
    figures.add({"frequency_error_ratio_n10_n6", "1", Bar{1}}, {"n6", "n10"},
                [&] { return frequency_error(results["n10"]) / frequency_error(results["n6"]); });
    figures.add({"frequency_error_ratio_n20_n10", "1", Bar{1}}, {"n10", "n20"},
                [&] { return frequency_error(results["n20"]) / frequency_error(results["n10"]); });
}

// Tubes in the plane.

struct Tube {
    explicit Tube(const SolidPart& of) : part(of) {
        const auto& shape_faces = of.surface->mesh().faces;
        inner = std::uint16_t(std::find(shape_faces.begin(), shape_faces.end(), "inner") - shape_faces.begin());
    }
    /// Mean distance of the inner face's vertices from the axis [m].
    double radius() const {
        const auto& mesh = part.surface->mesh();
        double sum = 0, count = 0;
        for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
            if (mesh.face[e] != inner) continue;
            const Vec3& x = part.surface->position[mesh.elements[e][0]];
            sum += std::hypot(x.x, x.y), count += 1;
        }
        return sum / count;
    }
    TubeStress stress(std::size_t i) const {
        const Vec3& x = part.body->particles().position[i];
        const Vec3 r = normalized(Vec3{x.x, x.y, 0}), t{-r.y, r.x, 0};
        const Mat3 s = part.body->cauchy(i);
        return {dot(r, s * r), dot(t, s * t)};
    }
    const SolidPart& part;
    std::uint16_t inner = 0;
};

/// At the end of each plateau of the pressure: radius and pressure; at the end of the first, stresses against Lame's.
void measure_thick_tube(const deck::Case& config, const std::string&, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    SolidPart& part = *scene->system.parts[0];
    const Tube tube(part);
    const auto& shape = config.solids[0].shape;
    const auto& load = config.solids[0].pressures[0];
    const double A = 0.5 * shape.inner_diameter, B = 0.5 * shape.diameter;
    const RubberTube exact{A, B, std::get<NeoHookean>(part.solid.materials[0].law)};
    const SolidParticles& p = part.body->particles();
    for (std::size_t k = 2; k < load.times.size(); k += 2) {   // 0, ramp, hold, ramp, hold ..
        run_to(*scene, load.times[k], interrupted, [] {});
        part.body->compute_deformation();
        const double pressure = load.pressures[k], radius = tube_radius(exact, pressure);
        data.lists["error_percent"].push_back(100 * std::abs(tube.radius() - radius) / (radius - A));
        data.lists["stretch"].push_back(radius / A);
        if (k > 2) continue;
        double worst = 0;
        const double largest = lame_stress(A, B, pressure, A).hoop;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const double r = std::hypot(p.reference[i].x, p.reference[i].y);
            const TubeStress wanted = lame_stress(A, B, pressure, r), got = tube.stress(i);
            worst = std::max({worst, std::abs(got.hoop - wanted.hoop), std::abs(got.radial - wanted.radial)});
        }
        data.lists["lame_error_percent"] = {100 * worst / largest};
    }
    note_size(*scene, data);
}

double largest_in(const RunData& run, const std::string& list) {
    const auto& values = run.list(list);
    return *std::max_element(values.begin(), values.end());
}

void thick_tube_figures(const Results& results, FigureList& figures) {
    const auto worst = [&](const std::string& layers, const std::string& list) {
        return std::max(largest_in(results["nu45_" + layers], list), largest_in(results["nu49_" + layers], list));
    };
    for (const auto& [layers, bar] : {std::pair{"4", 3.0}, std::pair{"8", 1.5}})
        figures.add({std::string("curve_error_percent_") + layers, "percent", Bar{bar}},
                    {std::string("nu45_") + layers, std::string("nu49_") + layers},
                    [&, l = std::string(layers)] { return worst(l, "error_percent"); });
    figures.add({"lame_stress_error_percent", "percent", Bar{4}}, {"nu45_8", "nu49_8"},
                [&] { return worst("8", "lame_error_percent"); });
    figures.add({"lame_stress_error_percent_4", "percent", {}}, {"nu45_4", "nu49_4"},
                [&] { return worst("4", "lame_error_percent"); });
    figures.add({"largest_stretch", "1", {}}, {"nu45_8"}, [&] { return largest_in(results["nu45_8"], "stretch"); });
}

/// Loaded to its collapse, or loaded to a pressure and released.
void measure_plastic_tube(const deck::Case& config, const std::string& run, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    SolidPart& part = *scene->system.parts[0];
    const Tube tube(part);
    const auto& shape = config.solids[0].shape;
    const double A = 0.5 * shape.inner_diameter, B = 0.5 * shape.diameter, T = config.numerics.duration;
    const auto& metal = std::get<J2Plastic>(part.solid.materials[0].law);
    const double yield = metal.hardening.yield, collapse = collapse_pressure(A, B, yield);
    double largest = 0;
    if (run.starts_with("collapse")) {
        // The pressure rises evenly until the radius runs away: where it has gone six times as far as when the inner face yields, and ends there.
        const double away = A + 6 * yield / metal.elastic.young() * A;
        part.pressures = {{tube.inner, [&](double time) { return largest > 0 ? 0.0 : 1.2 * collapse * time / T; }}};
        run_to(*scene, T, interrupted, [&] {
            if (largest == 0 && tube.radius() > away) largest = part.pressures[0].pressure(scene->time);
        });
        data.lists["collapse_error_percent"] = {100 * std::abs(largest / collapse - 1)};
        double least = INFINITY;
        for (const double a : part.body->particles().plastic_strain) least = std::min(least, a);
        data.lists["least_plastic_strain"] = {least};
    } else {
        const double loaded = config.solids[0].pressures[0].pressures[1];
        run_to(*scene, T, interrupted, [] {});
        part.body->compute_deformation();
        const SolidParticles& p = part.body->particles();
        double sum = 0, scale = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const double r = std::hypot(p.reference[i].x, p.reference[i].y);
            const double wanted = residual_stress(A, B, yield, loaded, r).hoop, error = tube.stress(i).hoop - wanted;
            sum += p.volume[i] * error * error, scale += p.volume[i] * wanted * wanted;
        }
        data.lists["hoop_error_percent"] = {100 * std::sqrt(sum / scale)};
        data.lists["loaded_over_collapse"] = {loaded / collapse};
    }
    note_size(*scene, data);
}

void plastic_tube_figures(const Results& results, FigureList& figures) {
    figures.add({"collapse_pressure_error_percent", "percent", Bar{4}}, {"collapse"},
                [&] { return results["collapse"].number("collapse_error_percent"); });
    figures.add({"least_plastic_strain", "1", {}}, {"collapse"},
                [&] { return results["collapse"].number("least_plastic_strain"); });
    figures.add({"residual_hoop_error_percent", "percent", Bar{10}}, {"residual"},
                [&] { return results["residual"].number("hoop_error_percent"); });
    figures.add({"loaded_over_collapse", "1", {}}, {"residual"},
                [&] { return results["residual"].number("loaded_over_collapse"); });
}

// The copper bar of Wilkins & Guinan (1973), 227 m/s, linear hardening: the foot's radius of the converged hexahedra of
// Foulk et al. (2021), 7.22 mm (Simo 1992: 7.12 mm), and the length that elements of second order converge to, 21.42 mm.
constexpr double bar_foot_radius = 7.22e-3, bar_length = 21.42e-3;

void measure_taylor_bar(const deck::Case& config, const std::string&, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    SolidPart& bar = *scene->system.parts[0];
    run_to(*scene, config.numerics.duration, interrupted, [] {});
    bar.surface->follow(bar.body->particles());
    double low = INFINITY, high = -INFINITY, radius = 0;
    for (const Vec3& x : bar.surface->position) {
        low = std::min(low, x.z), high = std::max(high, x.z);
        radius = std::max(radius, std::hypot(x.x, x.y));
    }
    double strain = 0;
    for (const double a : bar.body->particles().plastic_strain) strain = std::max(strain, a);
    const SolidEnergy e = bar.body->energy();
    note_size(*scene, data);
    data.lists["length"] = {high - low};
    data.lists["radius"] = {radius};
    data.lists["plastic_strain"] = {strain};
    data.lists["hourglass_share"] = {e.hourglass / e.plastic};
}

void taylor_bar_figures(const Results& results, FigureList& figures) {
    const auto error = [](double value, double wanted) { return 100 * std::abs(value / wanted - 1); };
    for (const std::string run : {"n16", "n8"}) {
        const bool is_fine = run == "n16";
        const std::string tail = is_fine ? "" : "_" + run;
        const std::optional<Bar> bar = is_fine ? std::optional(Bar{5}) : std::nullopt;
        figures.add({"length_error_percent" + tail, "percent", bar}, {run},
                    [&] { return error(results[run].number("length"), bar_length); });
        figures.add({"foot_radius_error_percent" + tail, "percent", bar}, {run},
                    [&] { return error(results[run].number("radius"), bar_foot_radius); });
        figures.add({"largest_plastic_strain" + tail, "1", {}}, {run},
                    [&] { return results[run].number("plastic_strain"); });
        figures.add({"hourglass_over_plastic" + tail, "1", {}}, {run},
                    [&] { return results[run].number("hourglass_share"); });
    }
}

}   // namespace

std::vector<VerifyCase> solid_cases() {
    const auto solid = [](const char* name, const char* title, auto measure, auto figures) {
        return VerifyCase{.name = name,
                          .title = title,
                          .is_full = {},
                          .measure = {},
                          .measure_solids = measure,
                          .figures = figures,
                          .pictures = {}};
    };
    std::vector<VerifyCase> cases = {
        solid("beam", "A clamped plate that swings, against Timoshenko's beam", measure_beam, beam_figures),
        solid("thick_tube", "A neo-Hookean tube under pressure, against the radial equilibrium of the same law",
              measure_thick_tube, thick_tube_figures),
        solid("plastic_tube", "A tube of metal to its collapse, and what stays after unloading", measure_plastic_tube,
              plastic_tube_figures),
        solid("taylor_bar", "A copper bar that hits a rigid wall", measure_taylor_bar, taylor_bar_figures)};
    cases[2].level = Level::full;
    cases[0].is_full = [](const std::string& run) { return run == "n20"; };
    cases[3].is_full = [](const std::string& run) { return run == "n16"; };
    return cases;
}

}   // namespace patency
