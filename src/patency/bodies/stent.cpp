// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/stent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "patency/base/errors.h"
#include "patency/bodies/relax.h"
#include "patency/shape/stent_chart.h"
#include "patency/shape/surface_distance.h"

namespace patency {

namespace {

constexpr double support_around = 3;   // spacings: relaxation sees as many points beside the struts

// The unrolled struts as a planar lumen, periodic around: x is around, y along.
Lumen unrolled(const StrutCurves& curves, double area) {
    const auto map = std::make_shared<const StrutMap>(curves);
    const Bounds box{{0, -curves.length / 2, 0}, {curves.circumference(), curves.length / 2, 0}};
    Lumen lumen{.distance = SignedDistance(
                    [map](const Vec3& x) {
                        const StrutSample s = map->sample({x.x, x.y});
                        return DistanceSample{s.value, {s.direction.around, s.direction.along, 0}, 0};
                    },
                    box),
                .openings = {},
                .volume = area,
                .wall_area = 0,
                .planar = true,
                .bounds = box};
    lumen.period.x = lumen.fit.x = curves.circumference();
    return lumen;
}

// Relaxed points in the struts, as many as their area needs.
std::vector<Vec3> points_in_plane(const StrutCurves& curves, double area, double spacing) {
    const Lumen lumen = unrolled(curves, area);
    const Lattice lattice = fitted_lattice(lumen, spacing);
    const double thickness = support_around * spacing;
    Bounds region = grown(lumen.bounds, thickness);
    region.low.x = lumen.bounds.low.x, region.high.x = lumen.bounds.high.x;
    std::vector<double> depths;
    const std::vector<Vec3> near = lattice_points(lattice, region, [&](const Vec3& x) {
        const double depth = lumen.distance.value(x);
        if (depth < thickness) depths.push_back(depth);
        return depth < thickness;
    });
    std::vector<std::size_t> order(near.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return depths[a] < depths[b]; });
    const std::size_t inside = std::min(near.size(), std::size_t(std::llround(area / lattice.cell_volume())));
    std::sort(order.begin(), order.begin() + std::ptrdiff_t(inside));   // neighbours in space are neighbours in memory
    std::sort(order.begin() + std::ptrdiff_t(inside), order.end());
    std::vector<Vec3> metal, around;
    for (std::size_t k = 0; k < order.size(); ++k) (k < inside ? metal : around).push_back(near[order[k]]);
    relax_points(
        metal, around, lumen,
        {.spacing = std::sqrt(lattice.cell_volume()), .wall_thickness = thickness, .fluid_end = {}, .wall_end = {}});
    return metal;
}

void expect_fine(const StentForm& form, double spacing) {
    const double largest = largest_stent_spacing(form);
    if (!(spacing > 0) || spacing > largest * (1 + 1e-9))
        throw GeometryError(fmt::format(
            "A spacing of {:.3g} um does not put {} particles across the stent's struts: at most {:.3g} um.",
            1e6 * spacing, least_across, 1e6 * largest));
}

/// Places a straight stent's particles along the axis; volumes [m^3] are those of the metal there and add up to `volume`.
void bend(const std::vector<StentPoint>& points, const StentAxis& axis, double volume, bool grows_outwards,
          StentParticles& particles) {
    particles.resize(points.size());
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        particles.position[i] = axis.place(points[i]);
        particles.volume[i] = (grows_outwards ? points[i].radius : 1) * axis.stretch(points[i]);
        sum += particles.volume[i];
    }
    for (std::size_t i = 0; i < points.size(); ++i) particles.volume[i] *= volume / sum;
}

}   // namespace

double largest_stent_spacing(const StentForm& form) { return least_strut(form) / least_across; }

void make_stent_particles(const StrutCurves& curves, const StentAxis& axis, double spacing, StentParticles& particles) {
    expect_fine(curves, spacing);
    const StentMeasures measures = measure_stent(curves);
    const std::vector<Vec3> plane = points_in_plane(curves, measures.plan_area, spacing);
    const std::size_t layers = std::size_t(std::max(double(least_across), std::round(curves.thickness / spacing)));
    std::vector<StentPoint> points(plane.size() * layers);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3& flat = plane[i / layers];
        const double over = ((double(i % layers) + 0.5) / double(layers) - 0.5) * curves.thickness;
        points[i] = {curves.middle_radius + over, flat.x / curves.middle_radius, flat.y};
    }
    bend(points, axis, measures.volume, true, particles);   // unrolled, all are as large
}

void make_stent_particles(const ImportedStent& stent, const StentAxis& axis, double spacing,
                          StentParticles& particles) {
    expect_fine(stent, spacing);
    StentParticles straight;
    make_stent_particles(make_surface_distance(stent.surface, spacing), stent.volume, spacing, straight);
    const StentAxis own;
    std::vector<StentPoint> points;
    for (const Vec3& x : straight.position) points.push_back(own.coordinates(x));
    bend(points, axis, stent.volume, false, particles);
}

void make_stent_particles(const SignedDistance& metal, double volume, double spacing, StentParticles& particles) {
    const Lumen lumen{.distance = metal, .openings = {}, .volume = volume, .wall_area = 0, .bounds = metal.bounds()};
    const FittedPoints points = make_relaxed_points(lumen, spacing, {});
    particles.resize(points.fluid.size());
    for (std::size_t i = 0; i < particles.size(); ++i) {
        particles.position[i] = points.fluid[i];
        particles.volume[i] = volume / double(particles.size());
    }
}

}   // namespace patency
