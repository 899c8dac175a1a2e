// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/stent_part.h"

#include <algorithm>
#include <cmath>

#include "patency/bodies/stent.h"
#include "patency/bodies/stent_skin.h"

namespace patency {

namespace {

/// Elements per particle spacing: three across a strut of four particles give its edges and its middle.
constexpr double spacings_per_element = 4.0 / 3;

/// Of four particles across a strut half are at a face, so F is of second order; hourglass control then has little to pay back. With
/// 0.3 a strut bends as stiffly as it should, with 1 by a tenth too much, and where it flows it bears less than a fiftieth.   THEORY (20.18)
constexpr double stent_hourglass = 0.3;

}   // namespace

std::unique_ptr<SolidPart> make_stent_part(const std::string& name, const StentForm& form, const StentAxis& axis,
                                           const SolidMaterial& material, const SolidNumerics& numerics,
                                           double mass_scaling) {
    SolidNumerics driven = numerics;   // a stent goes where tools and walls take it
    driven.second_order = true;
    driven.hourglass = stent_hourglass;
    driven.across_gaps = false;   // struts pass each other closely, and meet connectors at sharp angles
    driven.mass_scaling = stent_particle_mass_scaling;
    StentParticles metal;
    std::visit([&](const auto& f) { make_stent_particles(f, axis, numerics.spacing, metal); }, form);
    auto part = std::make_unique<SolidPart>();
    part->name = name;
    part->mass_scaling = mass_scaling;
    Solid& solid = part->solid;
    solid.materials = {material};
    solid.materials[0].density *= mass_scaling;
    place_particles(solid, {metal.position.begin(), metal.position.end()}, 0);
    for (std::size_t i = 0; i < metal.size(); ++i) {
        solid.particles.volume[i] = metal.volume[i];
        solid.particles.mass[i] = solid.materials[0].density * metal.volume[i];
    }
    part->body = make_solid_body(solid, driven);
    part->surface = std::make_unique<SolidSurface>(make_stent_skin(form, axis, spacings_per_element * numerics.spacing),
                                                   solid.particles, numerics.kernel().support(), false);
    return part;
}

StentShape measure_stent_shape(const SolidPart& stent, const StentAxis& axis) {
    const SolidSurface& surface = *stent.surface;
    std::vector<double> outer(surface.size(), 0);   // area of the outer face, by vertex
    const SurfaceElements& mesh = surface.mesh();
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
        if (mesh.face[e] == stent_outer)
            for (const std::uint32_t v : mesh.elements[e]) outer[v] = surface.area(v);
    std::vector<StentPoint> at(surface.size());
    double low = INFINITY, high = -INFINITY;
    for (std::size_t v = 0; v < surface.size(); ++v) {
        at[v] = axis.coordinates(surface.position[v]);
        low = std::min(low, at[v].along), high = std::max(high, at[v].along);
    }
    struct Mean {
        double sum = 0, weight = 0;
        void add(double x, double w) { sum += w * x, weight += w; }
        double value() const { return weight > 0 ? sum / weight : 0; }
    } all, ends, middle;
    StentShape shape{.least_diameter = INFINITY, .length = high - low};
    for (std::size_t v = 0; v < surface.size(); ++v) {
        if (outer[v] == 0) continue;
        const double diameter = 2 * at[v].radius, share = (at[v].along - low) / shape.length;
        all.add(diameter, outer[v]);
        if (share < 0.125 || share > 0.875) ends.add(diameter, outer[v]);
        if (share > 0.375 && share < 0.625) middle.add(diameter, outer[v]);
        shape.least_diameter = std::min(shape.least_diameter, diameter),
        shape.largest_diameter = std::max(shape.largest_diameter, diameter);
    }
    shape.outer_diameter = all.value(), shape.end_diameter = ends.value(), shape.middle_diameter = middle.value();
    return shape;
}

}   // namespace patency
