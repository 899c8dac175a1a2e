// SPDX-License-Identifier: Apache-2.0
// Metal that a balloon opens: a thin ring with a closed form, a ring of crowns, a whole stent; what springs back.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/shape/stent_axis.h"
#include "patency/stages/stent_part.h"
#include "patency/verify/solid_runs.h"
#include "patency/verify/verify_case.h"

namespace patency {

namespace {

const deck::RadialToolDeck& balloon_of(const deck::Case& config) { return *config.contacts[0].tool; }

/// What the tool gave less where it went, over what it gave.
double energy_imbalance(SolidScene& scene) {
    double given = 0, found = 0;
    for (auto& part : scene.system.parts) {
        const SolidEnergy e = part->body->energy();
        found += e.kinetic + e.internal() + e.lost();
    }
    for (const auto& contact : scene.system.contacts) {
        const ContactReport r = contact->report();
        given += r.work, found += r.energy + r.friction_loss + r.damping_loss;
    }
    return std::abs(given - found) / given;
}

// A thin ring.

/// Mean of the hoop's logarithmic strain over the metal, of a ring around x.
double hoop_strain(const SolidParticles& p) {
    double sum = 0, volume = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 &x = p.position[i], &X = p.reference[i];
        sum += p.volume[i] * std::log(std::hypot(x.y, x.z) / std::hypot(X.y, X.z));
        volume += p.volume[i];
    }
    return sum / volume;
}

/// Opened, held, let go. Uniaxial in the hoop: tau = y + H a, e = tau/E + a; the balloon bears 2 pi tau A / e^e.  THEORY (22.9)
void measure_plastic_ring(const deck::Case& config, const std::string&, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    SolidPart& ring = *scene->system.parts[0];
    const auto& metal = std::get<J2Plastic>(ring.solid.materials[0].law);
    const auto& shape = config.solids[0].shape;
    const double E = metal.elastic.young(), y = metal.hardening.yield, H = metal.hardening.slope;
    const double section = 0.5 * (shape.diameter - shape.inner_diameter) * norm(shape.to - shape.from);
    const auto& times = balloon_of(config).times;   // opens, holds, goes
    double strain = 0, force = 0, rest = 0, ratio = 0;
    std::int64_t samples = 0;
    const double held_from = 0.5 * (times[1] + times[2]);   // means over vibrations
    run_to(*scene, times[1], interrupted, [&] {
        if (scene->steps % 100 != 0 || scene->time < 0.1 * times[1]) return;
        const SolidEnergy e = ring.body->energy();
        ratio = std::max(ratio, e.kinetic / e.internal());
    });
    run_to(*scene, held_from, interrupted, [] {});
    run_to(*scene, times[2], interrupted, [&] {
        strain += hoop_strain(ring.body->particles()), force += scene->system.contacts[0]->report().normal_force,
            ++samples;
    });
    strain /= double(samples), force /= double(samples);
    const double flowed = (strain - y / E) / (1 + H / E), stress = y + H * flowed;
    run_to(*scene, config.numerics.duration, interrupted, [&] {
        if (scene->time > 0.5 * (times[3] + config.numerics.duration))
            rest += hoop_strain(ring.body->particles());
        else
            samples = 0;
        ++samples;
    });
    rest /= double(samples - 1);
    note_size(*scene, data);
    data.lists["springback_error"] = {100 * std::abs((strain - rest) / (stress / E) - 1)};
    data.lists["force_error"] = {100 *
                                 std::abs(force / (2 * std::numbers::pi * stress * section * std::exp(-strain)) - 1)};
    double volume = 0;
    for (const double v : ring.body->particles().volume) volume += v;
    data.lists["work_error"] = {100 *
                                std::abs(ring.body->energy().plastic / (volume * metal.hardening.work(flowed)) - 1)};
    data.lists["strain"] = {strain};
    data.lists["ratio"] = {100 * ratio};
    data.lists["imbalance"] = {100 * energy_imbalance(*scene)};
    data.lists["touching"] = {double(scene->system.contacts[0]->report().touching)};
}

void plastic_ring_figures(const Results& results, FigureList& figures) {
    const auto add = [&](const char* key, const char* unit, std::optional<Bar> bar, const char* list) {
        figures.add({key, unit, bar}, {"ring"}, [&results, list] { return results["ring"].number(list); });
    };
    add("springback_error_percent", "percent", Bar{4}, "springback_error");
    add("balloon_force_error_percent", "percent", Bar{4}, "force_error");
    add("plastic_work_error_percent", "percent", Bar{4}, "work_error");
    add("kinetic_to_internal_percent", "percent", Bar{5}, "ratio");
    add("energy_imbalance_percent", "percent", Bar{1}, "imbalance");
    add("hoop_strain", "1", {}, "strain");
    add("vertices_in_contact_after", "1", Bar{0}, "touching");
}

// Stents.

/// The ring of crowns by CalculiX 2.20, 672 bricks of 20 nodes along a strut: tests/validation/crown_ring.
constexpr double ring_recoil_percent = 1.043, ring_foreshortening_percent = 18.30, ring_plastic_work = 5.326e-4;   // J

/// Opened by the balloon and let go; its shape with the balloon at its largest and at rest in the end.
void measure_stent(const deck::Case& config, const std::string&, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    SolidPart& stent = *scene->system.parts[0];
    const auto& balloon = balloon_of(config);
    const Vec3 way = balloon.to - balloon.from;
    const StentAxis axis(motion_along(way, 0.5 * (balloon.from + balloon.to)));
    const auto shape = [&] {
        stent.surface->follow(stent.body->particles());
        return measure_stent_shape(stent, axis);
    };
    const double full = balloon.times[1], gone = balloon.times.back(), end = config.numerics.duration;
    const StentShape before = shape();
    double ratio = 0, pressure = 0;
    std::vector<double> time, diameter, kinetic, internal, pressures;
    constexpr double samples = 200;   // of the first ramp
    double next = 0;
    const auto look = [&] {
        if (scene->time < next) return;
        next += full / samples;
        const SolidEnergy e = stent.body->energy();
        const ContactReport r = scene->system.contacts[0]->report();
        time.push_back(scene->time), kinetic.push_back(e.kinetic), internal.push_back(e.internal()),
            pressures.push_back(r.pressure);
        diameter.push_back(shape().outer_diameter);
        if (scene->time > 0.1 * full && scene->time <= full) ratio = std::max(ratio, e.kinetic / e.internal());
        pressure = std::max(pressure, r.pressure);
    };
    run_to(*scene, full, interrupted, look);
    const StentShape open = shape();
    const SolidEnergy energy = stent.body->energy();
    const double steps_of_ramp = double(scene->steps), depth = scene->system.contacts[0]->report().deepest;
    run_to(*scene, gone, interrupted, look);
    scene->system.is_relaxed = true;   // to where it would come to rest
    run_to(*scene, 0.5 * (gone + end), interrupted, look);
    double rest = 0, length = 0, ends = 0, middle = 0;
    std::int64_t count = 0;
    run_to(*scene, end, interrupted, [&] {
        look();
        if (scene->steps % 50 != 0) return;
        const StentShape now = shape();
        rest += now.outer_diameter, length += now.length, ends += now.end_diameter, middle += now.middle_diameter,
            ++count;
    });
    rest /= double(count), length /= double(count), ends /= double(count), middle /= double(count);
    double strain = 0;
    for (const double a : stent.body->particles().plastic_strain) strain = std::max(strain, a);
    note_size(*scene, data);
    const auto put = [&](const char* name, double value) { data.lists[name] = {value}; };
    put("open", 1e3 * open.outer_diameter), put("rest", 1e3 * rest);
    put("recoil", 100 * (1 - rest / open.outer_diameter));
    put("foreshortening", 100 * (1 - length / before.length));
    put("dogboning", 100 * (open.end_diameter / open.middle_diameter - 1));
    put("ratio", 100 * ratio), put("plastic_work", energy.plastic + energy.yielded),
        put("unresolved", 100 * energy.yielded / (energy.plastic + energy.yielded)),
        put("hourglass", 100 * energy.hourglass / energy.internal());
    put("plastic_strain", strain), put("pressure", pressure),
        put("depth", 100 * depth / stent.body->numerics().spacing);
    put("steps", steps_of_ramp), put("imbalance", 100 * energy_imbalance(*scene)),
        put("mass_scaling", stent.mass_scaling);
    data.lists["time"] = time, data.lists["diameter"] = diameter, data.lists["kinetic"] = kinetic,
    data.lists["internal"] = internal;
    data.lists["pressure_of_time"] = pressures;
}

void add_stent_figures(const Results& results, FigureList& figures, const std::string& run, const std::string& tail,
                       bool has_bars, std::optional<Bar> foreshortening = {}) {
    const auto add = [&](const char* key, const char* unit, std::optional<Bar> bar, const char* list) {
        figures.add({key + tail, unit, has_bars ? bar : std::nullopt}, {run},
                    [&results, run, list] { return results[run].number(list); });
    };
    add("open_diameter_mm", "mm", {}, "open");
    add("recoil_percent", "percent", Bar{8}, "recoil");
    add("foreshortening_percent", "percent", foreshortening, "foreshortening");
    add("kinetic_to_internal_percent", "percent", Bar{5}, "ratio");
    add("ramp_steps", "1", Bar{least_steps_of_ramp, Sense::at_least}, "steps");
    add("energy_imbalance_percent", "percent", Bar{1}, "imbalance");
    add("depth_over_spacing_percent", "percent", Bar{10}, "depth");
    add("plastic_work_j", "J", {}, "plastic_work");
    add("unresolved_plastic_work_percent", "percent", {}, "unresolved");
    add("hourglass_share_percent", "percent", {}, "hourglass");
    add("largest_plastic_strain", "1", {}, "plastic_strain");
    add("largest_balloon_pressure_pa", "Pa", {}, "pressure");
    add("dogboning_percent", "percent", {}, "dogboning");
    add("mass_scaling", "1", {}, "mass_scaling");
}

/// Sum of a bar's both sides: what must not be below either.
void add_least(const Results& results, FigureList& figures, const std::string& run, double recoil) {
    figures.add({"recoil_at_least_percent", "percent", Bar{recoil, Sense::at_least}}, {run},
                [&results, run] { return results[run].number("recoil"); });
    figures.add({"foreshortening_at_least_percent", "percent", Bar{0, Sense::at_least}}, {run},
                [&results, run] { return results[run].number("foreshortening"); });
}

void stent_ring_figures(const Results& results, FigureList& figures) {
    add_stent_figures(results, figures, "ring", "", true);
    add_least(results, figures, "ring", 0.5);
    const auto add_error = [&](const char* key, double bar, const char* list, double reference) {
        figures.add({key, "percent", Bar{bar}}, {"ring"}, [&results, list, reference] {
            return 100 * std::abs(results["ring"].number(list) / reference - 1);
        });
    };
    add_error("recoil_error_percent", 10, "recoil", ring_recoil_percent);
    add_error("plastic_work_error_percent", 5, "plastic_work", ring_plastic_work);
    figures.add({"foreshortening_difference_points", "percent", {}},
                {"ring"},   // one row of crowns shortens by more than a stent
                [&] { return std::abs(results["ring"].number("foreshortening") - ring_foreshortening_percent); });
    figures.add({"recoil_change_of_ramp_points", "percent", Bar{0.5}}, {"ring", "slow"},
                [&] { return std::abs(results["ring"].number("recoil") - results["slow"].number("recoil")); });
    add_stent_figures(results, figures, "slow", "_slow", false);
    figures.add({"recoil_change_of_spacing_points", "percent", Bar{1}}, {"ring", "fine"},
                [&] { return std::abs(results["ring"].number("recoil") - results["fine"].number("recoil")); });
    add_stent_figures(results, figures, "fine", "_fine", false);
}

void stent_free_figures(const Results& results, FigureList& figures) {
    add_stent_figures(results, figures, "free", "", true, Bar{12});
    add_least(results, figures, "free", 1);
}

}   // namespace

std::vector<VerifyCase> stent_cases() {
    const auto stent = [](const char* name, const char* title, auto measure, auto figures) {
        return VerifyCase{.name = name,
                          .title = title,
                          .level = Level::full,
                          .is_full = {},
                          .measure = {},
                          .measure_solids = measure,
                          .figures = figures,
                          .pictures = {}};
    };
    return {stent("plastic_ring", "A thin ring of metal that a balloon opens, and what springs back",
                  measure_plastic_ring, plastic_ring_figures),
            stent("stent_ring", "A ring of crowns, opened to 3.3 mm and let go", measure_stent, stent_ring_figures),
            stent("stent_free", "The open-cell stent, opened freely to 3.3 mm and let go", measure_stent,
                  stent_free_figures)};
}

}   // namespace patency
