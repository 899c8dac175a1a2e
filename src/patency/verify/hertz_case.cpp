// SPDX-License-Identifier: Apache-2.0
// Hertz' contact: of two cylinders half-width and peak pressure against the load, for spacings and stiffnesses that differ; of a sphere
// on a block the force against the approach.
#include "patency/verify/hertz_case.h"

#include <algorithm>
#include <cmath>

#include "patency/verify/solid_closed_forms.h"
#include "patency/verify/solid_runs.h"

namespace patency {

namespace {

/// Pushes on a surface near the contact: where, how much, on what length.
struct Footprint {
    std::vector<double> place, force, length;   // m, N/m, m

    double load() const {
        double sum = 0;
        for (const double f : force) sum += f;
        return sum;
    }
};

/// Of the vertices of a planar surface, by their place along x; forces along y, as pushes into the surface.
Footprint footprint_of(const SolidSurface& surface, double sign) {
    Footprint print;
    std::vector<std::size_t> order;
    for (std::size_t v = 0; v < surface.size(); ++v) order.push_back(v);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return surface.position[a].x < surface.position[b].x; });
    for (const std::size_t v : order) {
        print.place.push_back(surface.position[v].x);
        print.force.push_back(sign * surface.force[v].y);
        print.length.push_back(surface.area(v));
    }
    return print;
}

struct Ellipse {
    double half_width, peak;   // m, Pa
};

/// The p0 sqrt(1 - (x - m)^2 / b^2), m the footprint's middle, that is nearest to its pressures by squares, weighed by length.
Ellipse fit_ellipse(const Footprint& print) {
    double middle = 0;
    for (std::size_t k = 0; k < print.place.size(); ++k) middle += print.force[k] * print.place[k] / print.load();
    double spread = 0;
    for (std::size_t k = 0; k < print.place.size(); ++k)
        spread += print.force[k] * std::pow(print.place[k] - middle, 2) / print.load();
    const double first = 2 * std::sqrt(spread);   // an ellipse's half-width, from its second moment
    // Of a vertex the mean over its length: what an even pressure gives it.
    const auto shape_at = [&](std::size_t k, double b) {
        const auto area = [b](double x) {
            const double s = std::clamp(x / b, -1.0, 1.0);
            return 0.5 * b * (s * std::sqrt(1 - s * s) + std::asin(s));
        };
        const double x = print.place[k] - middle, half = 0.5 * print.length[k];
        return (area(x + half) - area(x - half)) / (2 * half);
    };
    Ellipse best{first, 0};
    double least = INFINITY;
    for (double b = 0.7 * first; b < 1.4 * first; b += 5e-4 * first) {
        double ff = 0, fp = 0, pp = 0;
        for (std::size_t k = 0; k < print.place.size(); ++k) {
            const double shape = shape_at(k, b), p = print.force[k] / print.length[k];
            ff += print.length[k] * shape * shape, fp += print.length[k] * shape * p, pp += print.length[k] * p * p;
        }
        const double rest = pp - fp * fp / ff;
        if (rest < least) least = rest, best = {b, fp / ff};
    }
    return best;
}

// A sphere on a block.

/// How far the body went down at a place on the axis [m]: a linear fit to the particles nearest to it.
double sinking_at(const SolidBody& body, const Vec3& place, double reach) {
    const SolidParticles& p = body.particles();
    double w = 0, wu = 0, wz = 0, wzz = 0, wzu = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 d = p.reference[i] - place;
        const double r = norm(d) / reach;
        if (r >= 1) continue;
        const double weight = (1 - r * r) * (1 - r * r), u = p.reference[i].z - p.position[i].z;
        w += weight, wu += weight * u, wz += weight * d.z, wzz += weight * d.z * d.z, wzu += weight * d.z * u;
    }
    return (wu * wzz - wzu * wz) / (w * wzz - wz * wz);
}

/// The block's top is at z = 0, where the sphere stands on it at first.
void measure_sphere(SolidScene& scene, const Stop& interrupted, RunData& data) {
    run_to(scene, scene.config.numerics.duration, interrupted, [] {});
    note_size(scene, data);
    const SolidPart &block = scene.part("lower"), &sphere = scene.part("upper");
    const ElasticModuli m = block.solid.materials[0].moduli();
    const double modulus = contact_modulus(m, sphere.solid.materials[0].moduli()),
                 radius = 0.5 * scene.config.solids[1].shape.diameter, spacing = scene.config.numerics.spacing,
                 depth = 4 * spacing;
    double force = 0;
    for (const Vec3& f : block.surface->force) force -= f.z;
    const double approach =
        sinking_at(*sphere.body, {0, 0, depth}, 2 * spacing) - sinking_at(*block.body, {0, 0, -depth}, 2 * spacing);
    const auto exact_approach = [&](double f) {
        return 2 * (hertz_sinking(radius, modulus, f, m.young(), m.poisson(), 0) -
                    hertz_sinking(radius, modulus, f, m.young(), m.poisson(), depth));
    };
    double low = 0.1 * force, high = 10 * force;   // the force that belongs to this approach
    for (int k = 0; k < 60; ++k) (exact_approach(0.5 * (low + high)) < approach ? low : high) = 0.5 * (low + high);
    data.lists["force"] = {force}, data.lists["exact_force"] = {0.5 * (low + high)},
    data.lists["approach"] = {approach};
    data.lists["contact_radius_over_spacing"] = {std::cbrt(0.75 * force * radius / modulus) / spacing};
}

void measure_hertz(const deck::Case& config, const std::string&, const Stop& interrupted, RunData& data) {
    const auto scene = build_solids(config);
    if (!config.numerics.solid.plane_strain) return measure_sphere(*scene, interrupted, data);
    run_to(*scene, config.numerics.duration, interrupted, [] {});
    note_size(*scene, data);
    const SolidPart &lower = scene->part("lower"), &upper = scene->part("upper");
    const auto curvature = [&](std::size_t k) { return 2 / config.solids[k].shape.diameter; };
    const HertzLine line{1 / (curvature(0) + curvature(1)),
                         contact_modulus(lower.solid.materials[0].moduli(), upper.solid.materials[0].moduli())};
    const Footprint below = footprint_of(*lower.surface, -1), above = footprint_of(*upper.surface, 1);
    const double load = below.load();
    const auto put = [&](const std::string& name, double value) { data.lists[name] = {value}; };
    // Where spacings differ the coarser surface's own vertices tell the pressures: the finer one's meet few elements.
    const Ellipse found = fit_ellipse(below);
    put("load", load);
    put("spacing", config.numerics.spacing);
    put("half_width", found.half_width);
    put("peak", found.peak);
    put("exact_half_width", line.half_width(load));
    put("exact_peak", line.peak_pressure(load));
    Vec3 sum{};
    for (const auto* surface : {lower.surface.get(), upper.surface.get()})
        for (const Vec3& f : surface->force) sum += f;
    put("imbalance", norm(sum) / load);
    put("penetration_over_spacing", scene->system.contacts[0]->report().deepest / config.numerics.spacing);
    double kinetic = 0, internal = 0;
    for (const auto& part : scene->system.parts) {
        const SolidEnergy e = part->body->energy();
        kinetic += e.kinetic, internal += e.internal();
    }
    put("kinetic_to_internal", kinetic / internal);
    data.lists["place"] = below.place, data.lists["force"] = below.force, data.lists["length"] = below.length;
    data.lists["place_above"] = above.place, data.lists["force_above"] = above.force,
    data.lists["length_above"] = above.length;
}

const std::vector<std::string> ratios = {"1", "3", "5"}, sphere_runs = {"sphere_1", "sphere_2", "sphere_3"};

void hertz_figures(const Results& results, FigureList& figures) {
    std::vector<std::string> all;
    const auto error_percent = [&results](const std::string& run, const std::string& name) {
        return 100 * std::abs(results[run].number(name) / results[run].number("exact_" + name) - 1);
    };
    for (const std::string twin : {"", "_stiff"})
        for (const std::string& ratio : ratios) {
            const std::string run = "ratio_" + ratio + twin, suffix = "_" + ratio + twin;
            all.push_back(run);
            figures.add({"half_width_error_percent" + suffix, "percent", Bar{4}}, {run},
                        [=] { return error_percent(run, "half_width"); });
            figures.add({"peak_pressure_error_percent" + suffix, "percent", Bar{4}}, {run},
                        [=] { return error_percent(run, "peak"); });
            figures.add({"penetration_over_spacing" + suffix, "1", {}}, {run},
                        [&results, run] { return results[run].number("penetration_over_spacing"); });
        }
    const auto worst = [&results, all](const std::string& name) {
        double most = 0;
        for (const std::string& run : all) most = std::max(most, results[run].number(name));
        return most;
    };
    figures.add({"sphere_curve_error_percent", "percent", Bar{4}}, sphere_runs, [=] {
        double most = 0;
        for (const std::string& run : sphere_runs) most = std::max(most, error_percent(run, "force"));
        return most;
    });
    figures.add({"spacings_in_half_width", "1", Bar{6, Sense::at_least}}, all, [=, &results] {
        double least = INFINITY;
        for (const std::string& run : all)
            least = std::min(least, results[run].number("half_width") / results[run].number("spacing"));
        return least;
    });
    figures.add({"reaction_imbalance", "1", Bar{1e-12}}, all, [=] { return worst("imbalance"); });
    figures.add({"kinetic_to_internal", "1", Bar{1e-3}}, all, [=] { return worst("kinetic_to_internal"); });
}

}   // namespace

VerifyCase hertz_case() {
    return {.name = "hertz",
            .title = "Hertz' contact: cylinders of different spacing and stiffness, and a sphere",
            .is_full = [](const std::string& run) { return run != "ratio_1"; },
            .measure = {},
            .measure_solids = measure_hertz,
            .figures = hertz_figures,
            .pictures = {}};
}

}   // namespace patency
