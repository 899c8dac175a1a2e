// SPDX-License-Identifier: Apache-2.0
// Solids that touch: a block on a slope, rings that collide.
#include <algorithm>
#include <cmath>

#include "patency/verify/hertz_case.h"
#include "patency/verify/measures.h"
#include "patency/verify/solid_runs.h"
#include "patency/verify/verify_case.h"

namespace patency {

namespace {

struct Sums {
    Vec3 momentum, turn;   // about the origin
    double energy = 0;
};
Sums sums_of(SolidScene& scene) {
    Sums sums;
    for (auto& part : scene.system.parts) {
        const SolidEnergy e = part->body->energy();
        sums.energy += e.kinetic + e.elastic + e.hourglass;
        const SolidParticles& p = part->body->particles();
        for (std::size_t i = 0; i < p.size(); ++i) {
            sums.momentum += p.mass[i] * p.velocity[i];
            sums.turn += p.mass[i] * cross(p.position[i], p.velocity[i]);
        }
    }
    for (const auto& contact : scene.system.contacts) sums.energy += contact->report().energy;
    return sums;
}

// Two rings.

/// The rings collide and part; every run with the same stiffness of the contact, so that only the time step differs.
void measure_two_rings(const deck::Case& config, const std::string& run, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    const Sums start = sums_of(*scene);
    double scale = 0, turn_scale = 0;   // what the rings have each for itself
    for (const auto& part : scene->system.parts) {
        const SolidParticles& p = part->body->particles();
        for (std::size_t i = 0; i < p.size(); ++i) {
            scale += p.mass[i] * norm(p.velocity[i]);
            turn_scale += p.mass[i] * norm(cross(p.position[i], p.velocity[i]));
        }
    }
    // An even step, a share of the stable one of the rings at rest, kept where they are squeezed.
    const double share = run == "coarse" ? 1.0 : run == "fine" ? 0.25 : 0.5;
    const auto steps = std::int64_t(std::ceil(config.numerics.duration / (share * stable_step(scene->system))));
    const double dt = config.numerics.duration / double(steps);
    double momentum = 0, turn = 0, energy = 0, touching = 0;
    for (std::int64_t k = 0; k < steps && !(interrupted && interrupted()); ++k) {
        solid_step(scene->system, scene->time, dt);
        scene->time += dt, ++scene->steps;
        touching = std::max(touching, double(scene->system.contacts[0]->report().touching));
        if (k % 20 != 0 && k + 1 != steps) continue;
        const Sums now = sums_of(*scene);
        momentum = std::max(momentum, norm(now.momentum - start.momentum) / scale);
        turn = std::max(turn, norm(now.turn - start.turn) / turn_scale);
        if (scene->system.contacts[0]->report().touching == 0)
            energy = std::max(energy, std::abs(now.energy - start.energy) / start.energy);
    }
    note_size(*scene, data);
    data.lists["momentum"] = {momentum};
    data.lists["turn"] = {turn};
    data.lists["energy"] = {energy};
    data.lists["touching"] = {touching};
    data.lists["dt"] = {dt};
}

void two_rings_figures(const Results& results, FigureList& figures) {
    figures.add({"momentum_drift", "1", Bar{1e-10}}, {"middle"}, [&] { return results["middle"].number("momentum"); });
    figures.add({"angular_momentum_drift", "1", Bar{1e-10}}, {"middle"},
                [&] { return results["middle"].number("turn"); });
    figures.add({"energy_growth", "1", Bar{1e-3}}, {"middle"}, [&] { return results["middle"].number("energy"); });
    figures.add({"energy_order", "1", Bar{1.8, Sense::at_least}}, {"coarse", "fine"}, [&] {
        return observed_order(results["coarse"].number("energy"), results["coarse"].number("dt"),
                              results["fine"].number("energy"), results["fine"].number("dt"));
    });
    figures.add({"momentum_drift_mixed", "1", Bar{1e-6}}, {"mixed"},
                [&] { return results["mixed"].number("momentum"); });
    figures.add({"vertices_in_contact", "1", Bar{1, Sense::at_least}}, {"middle"},
                [&] { return results["middle"].number("touching"); });
}

// Three rings.

/// Of the paper's section III.C, mended: the outer ring is held at its outside.
void measure_three_rings(const deck::Case& config, const std::string&, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    const SolidPart& outer = scene->part("outer");
    const Sums start = sums_of(*scene);
    const auto touches = [&](std::size_t contact) { return scene->system.contacts[contact]->report().touching > 0; };
    double first = 0, scale = 0, balance = 0, growth = 0, outer_touched = 0, self_touched = 0;
    for (const auto& part : scene->system.parts)
        for (std::size_t i = 0; i < part->body->particles().size(); ++i)
            scale += part->body->particles().mass[i] * norm(part->body->particles().velocity[i]);
    run_to(*scene, config.numerics.duration, interrupted, [&] {
        if (first == 0 && touches(0)) first = scene->time;
        outer_touched += touches(1), self_touched += touches(2);
        if (scene->steps % 50 != 0) return;
        const Sums now = sums_of(*scene);
        balance = std::max(balance, norm(now.momentum - start.momentum - outer.body->reaction_impulse(0)) / scale);
        growth = std::max(growth, (now.energy - start.energy) / start.energy);
    });
    note_size(*scene, data);
    data.lists["first_touch"] = {first};
    data.lists["balance"] = {balance};
    data.lists["growth"] = {growth};
    data.lists["outer_touched"] = {outer_touched > 0 ? 1.0 : 0.0};
    data.lists["self_touched"] = {self_touched > 0 ? 1.0 : 0.0};
}

void three_rings_figures(const Results& results, FigureList& figures) {
    constexpr double first_touch = 0.014254;   // s: the gap of the circles over the closing speed along their line
    const auto number = [&](const char* name) {
        return [&results, name] { return results["three_rings"].number(name); };
    };
    figures.add({"first_touch_error_percent", "percent", Bar{2}}, {"three_rings"},
                [&] { return 100 * std::abs(results["three_rings"].number("first_touch") / first_touch - 1); });
    figures.add({"momentum_balance", "1", Bar{1e-8}}, {"three_rings"}, number("balance"));
    figures.add({"energy_growth", "1", Bar{1e-3}}, {"three_rings"}, number("growth"));
    figures.add({"medium_touches_outer", "1", Bar{1, Sense::at_least}}, {"three_rings"}, number("outer_touched"));
    figures.add({"medium_touches_itself", "1", Bar{1, Sense::at_least}}, {"three_rings"}, number("self_touched"));
}

// A block on a slope.

/// The plane is level and gravity leans, by the angle whose tangent the deck's body force has.
void measure_incline(const deck::Case& config, const std::string& run, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    const SolidPart& block = *scene->system.parts[0];
    const SolidParticles& p = block.body->particles();
    const Vec3 g = config.body_force;
    const double mu = config.contacts[0].friction, length = config.solids[0].shape.to.x - config.solids[0].shape.from.x;
    const auto centre = [&] {
        double mass = 0, x = 0;
        for (std::size_t i = 0; i < p.size(); ++i) mass += p.mass[i], x += p.mass[i] * p.position[i].x;
        return x / mass;
    };
    // It settles onto the plane in the first half; then it is watched.
    const double end = config.numerics.duration, from = 0.5 * end;
    run_to(*scene, from, interrupted, [] {});
    std::vector<double> t, x;
    run_to(*scene, end, interrupted, [&] {
        if (scene->steps % 20 == 0) t.push_back(scene->time - from), x.push_back(centre());
    });
    note_size(*scene, data);
    if (run == "stick") {
        data.lists["creep_percent"] = {100 * std::abs(x.back() - x.front()) / length};
        return;
    }
    // x = x0 + v t + a t^2 / 2 by least squares: the mean acceleration, vibration apart.
    double s[5] = {}, b[3] = {};
    for (std::size_t k = 0; k < t.size(); ++k) {
        double power = 1;
        for (int n = 0; n < 5; ++n, power *= t[k] / from) {
            s[n] += power;
            if (n < 3) b[n] += power * (x[k] - x[0]);
        }
    }
    const Mat3 M{{s[0], s[1], s[2]}, {s[1], s[2], s[3]}, {s[2], s[3], s[4]}};
    const double measured = 2 * (inverse(M) * Vec3{b[0], b[1], b[2]}).z / (from * from),
                 exact = g.x + mu * g.y;   // g.y < 0
    data.lists["slide_error_percent"] = {100 * std::abs(measured / exact - 1)};
}

void incline_figures(const Results& results, FigureList& figures) {
    figures.add({"slide_error_percent", "percent", Bar{2}}, {"slide"},
                [&] { return results["slide"].number("slide_error_percent"); });
    figures.add({"stick_creep_percent", "percent", Bar{0.1}}, {"stick"},
                [&] { return results["stick"].number("creep_percent"); });
}

}   // namespace

std::vector<VerifyCase> contact_cases() {
    const auto contact = [](const char* name, const char* title, auto measure, auto figures) {
        return VerifyCase{.name = name,
                          .title = title,
                          .is_full = {},
                          .measure = {},
                          .measure_solids = measure,
                          .figures = figures,
                          .pictures = {}};
    };
    std::vector<VerifyCase> cases = {
        contact("incline", "A block on a slope, below and above the angle of friction", measure_incline,
                incline_figures),
        contact("two_rings", "Two elastic rings that collide: what is kept", measure_two_rings, two_rings_figures),
        contact("three_rings", "Three rings, the outermost held: the reference paper's section III.C, mended",
                measure_three_rings, three_rings_figures)};
    cases[2].level = Level::full;
    cases.push_back(hertz_case());
    return cases;
}

}   // namespace patency
