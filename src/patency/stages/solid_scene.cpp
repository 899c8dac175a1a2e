// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/solid_scene.h"

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/smooth_rise.h"
#include "patency/base/text.h"
#include "patency/bodies/closest_point.h"
#include "patency/bodies/radial_tool.h"
#include "patency/bodies/solid_shape.h"
#include "patency/bodies/stent.h"
#include "patency/stages/solid_material.h"
#include "patency/stages/stent_of_case.h"
#include "patency/stages/stent_part.h"

namespace patency {

namespace {

SolidFill fill_whole(const deck::SolidShape& s, double spacing, bool planar) {
    switch (s.type) {
        case deck::SolidShapeType::box: return fill_box(s.from, s.to, spacing, planar);
        case deck::SolidShapeType::cylinder:
            return fill_cylinder(s.from, s.to, 0.5 * s.inner_diameter, 0.5 * s.diameter, spacing, planar);
        case deck::SolidShapeType::sphere:
        case deck::SolidShapeType::stent: break;   // a stent is made as one
    }
    return fill_sphere(s.centre, 0.5 * s.diameter, spacing);
}

/// @throws DeckError at `path`.
SolidFill fill_shape(const deck::SolidShape& s, double spacing, bool planar, const std::string& path) {
    SolidFill fill = fill_whole(s, spacing, planar);
    if (s.low) fill = cut_to_box(fill, *s.low, *s.high);
    if (fill.places.empty() || fill.surface.elements.empty())
        throw DeckError(path + ".shape.low: nothing of the solid, or of its surface, lies above it and below `high`");
    return fill;
}

SolidNumerics make_solid_numerics(const deck::Case& config, const deck::SolidDeck& said) {
    const deck::SolidSettings& s = config.numerics.solid;
    SolidNumerics n;
    n.spacing = said.spacing.value_or(config.numerics.spacing);
    n.smoothing_ratio = s.smoothing_ratio;
    n.planar = s.plane_strain;
    n.cfl = s.cfl;
    n.hourglass = s.hourglass;
    n.viscosity = s.viscosity;
    n.precision = config.numerics.precision == deck::Precision::mixed ? Precision::mixed : Precision::double_precision;
    return n;
}

/// The number of a face of the solid. @throws DeckError at `key`.
std::uint16_t face_of(const SurfaceElements& surface, const std::string& name, const std::string& key) {
    const auto found = std::find(surface.faces.begin(), surface.faces.end(), name);
    if (found != surface.faces.end()) return std::uint16_t(found - surface.faces.begin());
    throw DeckError(key + ": there is no face " + double_quoted(shortened(name)) + "; there are " +
                    join(surface.faces, ", ", " and "));
}

double distance_to_face(const Vec3& x, const SurfaceElements& surface, std::uint16_t face, bool planar) {
    double nearest = INFINITY;
    for (std::size_t e = 0; e < surface.elements.size(); ++e) {
        if (surface.face[e] != face) continue;
        const auto& [ia, ib, ic] = surface.elements[e];
        const Vec3 &a = surface.vertices[ia], &b = surface.vertices[ib], &c = surface.vertices[ic];
        const auto w = planar ? closest_on_segment(x, a, b) : closest_on_triangle(x, a, b, c);
        nearest = std::min(nearest, norm(w[0] * a + w[1] * b + w[2] * c - x));
    }
    return nearest;
}

/// Whether a particle lies in the box of a hold, or in the layer at its face: particles there are half a spacing deep.
bool is_held(const Vec3& x, const deck::Hold& h, const SurfaceElements& surface, const std::string& key,
             const SolidNumerics& numerics) {
    if (h.face)
        return distance_to_face(x, surface, face_of(surface, *h.face, key + ".face"), numerics.planar) <
               0.75 * numerics.spacing;
    return x.x >= h.low->x && x.x <= h.high->x && x.y >= h.low->y && x.y <= h.high->y && x.z >= h.low->z &&
           x.z <= h.high->z;
}

void hold_particles(const deck::SolidDeck& said, const std::string& path, const SurfaceElements& surface,
                    const SolidNumerics& numerics, Solid& solid) {
    SolidParticles& p = solid.particles;
    for (std::size_t k = 0; k < said.holds.size(); ++k) {
        const deck::Hold& h = said.holds[k];
        Constraint constraint{.held = h.axes, .displacement = {}};
        if (norm(h.displacement) > 0)
            constraint.displacement = [to = h.displacement, ramp = h.ramp](const Vec3&, double time) {
                return smooth_rise(ramp > 0 ? time / ramp : 1.0) * to;
            };
        solid.constraints.push_back(constraint);
        const std::string key = path + ".holds." + std::to_string(k);
        std::size_t count = 0;
        for (std::size_t i = 0; i < p.size(); ++i)
            if (is_held(p.reference[i], h, surface, key, numerics)) p.constraint[i] = std::int32_t(k + 1), ++count;
        if (count == 0) throw DeckError(key + ": no particle lies there");
    }
}

/// Two families wound around the cylinder's axis, at the angle from around it to along it.
void lay_fibres(const deck::SolidDeck& said, const std::string& path, Solid& solid) {
    if (!std::holds_alternative<FibreArtery>(solid.materials[0].law)) return;
    if (said.shape.type != deck::SolidShapeType::cylinder)
        throw DeckError(path + ".material: fibres need a cylinder, around whose axis they run");
    if (!said.material.fibre_angle) throw DeckError(path + ".material.fibre_angle is missing: fibre_artery needs it");
    const Vec3 way = said.shape.to - said.shape.from, axis = norm(way) > 0 ? normalized(way) : Vec3{0, 0, 1};
    const double c = std::cos(*said.material.fibre_angle), s = std::sin(*said.material.fibre_angle);
    SolidParticles& p = solid.particles;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 from_axis = p.reference[i] - said.shape.from;
        const Vec3 around = normalized(cross(axis, from_axis));
        p.first_fibre[i] = c * around + s * axis;
        p.second_fibre[i] = c * around - s * axis;
    }
}

RadialTool make_radial_tool(const deck::RadialToolDeck& said) {
    const Vec3 way = said.to - said.from;
    std::vector<double> radii;
    for (const double d : said.diameters) radii.push_back(0.5 * d);
    return {.kind = said.type == deck::RadialToolType::balloon ? RadialTool::Kind::balloon : RadialTool::Kind::crimper,
            .axis = StentAxis(motion_along(way, 0.5 * (said.from + said.to))),
            .length = norm(way),
            .radius = ramped_radius(said.times, radii)};
}

/// Linear between, constant outside.
std::function<double(double)> make_pressure(const deck::FacePressure& said) {
    return [times = said.times, values = said.pressures](double t) {
        const auto after = std::size_t(std::upper_bound(times.begin(), times.end(), t) - times.begin());
        if (after == 0) return values.front();
        if (after == times.size()) return values.back();
        const double share = (t - times[after - 1]) / (times[after] - times[after - 1]);
        return values[after - 1] + share * (values[after] - values[after - 1]);
    };
}

std::unique_ptr<SolidPart> make_stent_solid(const deck::Case& config, const deck::SolidDeck& said,
                                            const std::string& path, SolidNumerics numerics) {
    const deck::Stent& stent = *config.stent;
    const MadeStent made = make_stent(stent);
    const StentAxis axis = stent.placement ? make_stent_axis(*stent.placement, made.pattern) : StentAxis();
    numerics.spacing = said.spacing ? *said.spacing : stent.spacing.value_or(largest_stent_spacing(made.form));
    auto part = make_stent_part(said.name, made.form, axis, make_solid_material(said.material, path + ".material"),
                                numerics, said.mass_scaling);
    for (Vec3& v : part->solid.particles.velocity) v = said.velocity;
    return part;
}

std::unique_ptr<SolidPart> make_part(const deck::Case& config, std::size_t index) {
    const deck::SolidDeck& said = config.solids[index];
    const std::string path = "solids." + std::to_string(index);
    const SolidNumerics numerics = make_solid_numerics(config, said);
    if (said.shape.type == deck::SolidShapeType::stent) return make_stent_solid(config, said, path, numerics);
    const SolidFill fill = fill_shape(said.shape, numerics.spacing, numerics.planar, path);
    auto part = std::make_unique<SolidPart>();
    part->name = said.name;
    Solid& solid = part->solid;
    part->mass_scaling = said.mass_scaling;
    solid.materials = {make_solid_material(said.material, path + ".material")};
    solid.materials[0].density *= said.mass_scaling;
    place_particles(solid, fill.places, 0);
    for (std::size_t i = 0; i < solid.particles.size(); ++i) {
        solid.particles.volume[i] = fill.volumes[i];
        solid.particles.mass[i] = solid.materials[0].density * fill.volumes[i];
        solid.particles.velocity[i] = said.velocity;
    }
    hold_particles(said, path, fill.surface, numerics, solid);
    lay_fibres(said, path, solid);
    part->body = make_solid_body(solid, numerics);
    part->surface =
        std::make_unique<SolidSurface>(fill.surface, solid.particles, numerics.kernel().support(), numerics.planar);
    for (std::size_t k = 0; k < said.pressures.size(); ++k)
        part->pressures.push_back(
            {face_of(fill.surface, said.pressures[k].face, path + ".pressures." + std::to_string(k) + ".face"),
             make_pressure(said.pressures[k])});
    return part;
}

}   // namespace

const SolidPart& SolidScene::part(const std::string& name) const {
    for (const auto& p : system.parts)
        if (p->name == name) return *p;
    throw DeckError("there is no solid " + double_quoted(name));
}
SolidPart& SolidScene::part(const std::string& name) { return const_cast<SolidPart&>(std::as_const(*this).part(name)); }

std::size_t SolidScene::particle_count() const {
    std::size_t count = 0;
    for (const auto& p : system.parts) count += p->body->particles().size();
    return count;
}

static std::unique_ptr<Contact> make_contact(SolidScene& scene, const deck::ContactDeck& said, double step) {
    SolidSurface& surface = *scene.part(said.solid).surface;
    const ContactNumerics numerics{.friction = said.friction,
                                   .damping = said.damping,
                                   .step = step,
                                   .hold = scene.system.is_relaxed ? hold_at_rest : Hold{}};
    if (said.plane) return make_plane_contact(surface, said.plane->point, normalized(said.plane->normal), numerics);
    if (said.tool) return make_tool_contact(surface, make_radial_tool(*said.tool), numerics);
    return make_surface_contact(surface, *scene.part(*said.with).surface, numerics);
}

std::unique_ptr<SolidScene> build_solids(const deck::Case& config) {
    if (config.solids.empty()) throw DeckError("solids is missing: this deck has no solids to compute");
    auto scene = std::make_unique<SolidScene>();
    scene->config = config;
    scene->system.gravity = config.body_force;
    scene->system.is_relaxed = config.numerics.solid.relaxation == deck::Relaxation::adaptive;
    for (std::size_t k = 0; k < config.solids.size(); ++k) scene->system.parts.push_back(make_part(config, k));
    const double step = stable_step(scene->system);
    for (const deck::ContactDeck& said : config.contacts)
        scene->system.contacts.push_back(make_contact(*scene, said, step));
    return scene;
}

void step_solids(SolidScene& scene, double until) {
    // A step is chosen every few, for a change of the stable one takes as long as a wave over as many spacings.
    constexpr int steps_between_choices = 8;
    if (scene.steps % steps_between_choices < strides_in_step(scene.system)) scene.dt = choose_strides(scene.system);
    const double left = until - scene.time;
    const double dt = left / std::ceil(left / scene.dt * (1 - 1e-12));
    solid_step(scene.system, scene.time, dt);
    scene.time = dt == left ? until : scene.time + dt;
    scene.steps += strides_in_step(scene.system);
}

}   // namespace patency
