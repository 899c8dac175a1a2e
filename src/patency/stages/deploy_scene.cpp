// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_scene.h"

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/bodies/stent.h"
#include "patency/shape/exact_distance.h"
#include "patency/shape/surface_refine.h"
#include "patency/stages/solid_material.h"
#include "patency/stages/stent_part.h"

namespace patency {

namespace {

constexpr double carrying =
    3;   // spacings that the wall's surfaces look for particles: at the edge of a cut a kernel's support has too few

SolidNumerics numerics_of(const deck::Case& config, double spacing) {
    const deck::SolidSettings& s = config.numerics.solid;
    return {.spacing = spacing,
            .smoothing_ratio = s.smoothing_ratio,
            .cfl = s.cfl,
            .hourglass = s.hourglass,
            .viscosity = s.viscosity,
            .precision =
                config.numerics.precision == deck::Precision::mixed ? Precision::mixed : Precision::double_precision};
}

SolidNumerics stent_numerics(const deck::Case& config, double spacing) {
    SolidNumerics n = numerics_of(config, spacing);
    if (!config.stent->surface) n.smoothing_ratio = stent_smoothing_ratio;   // else that of any solid
    return n;
}

WallField field_around(const deck::Case& config, const Vessel& vessel, const StentPlace& place) {
    const VesselAlong& along = vessel.along.value();
    std::vector<Vec3> normals;
    for (const SurfaceOpening& o : vessel.openings) normals.push_back(o.opening.normal);
    return {along.lines,
            along.assessment.healthy_diameter,
            normals,
            make_exact_distance(closed_at(vessel.checked.surface, vessel.checked.ends)),
            {.thickness = config.wall.thickness,
             .is_filled = config.wall.plaque == deck::Plaque::fills,
             .line = place.line,
             .from = place.start_arc(),
             .to = place.end_arc(),
             .reach = config.deployment.region * place.pattern.length}};
}

std::unique_ptr<SolidPart> make_wall_part(const DeployScene& scene) {
    const VesselWall wall =
        make_vessel_wall(*scene.field, scene.wall_spacing, scene.config.wall.layers.adventitia_share);
    auto part = std::make_unique<SolidPart>();
    part->name = "wall";
    Solid& solid = part->solid;
    solid.materials = wall_materials(scene.config.wall);
    solid.constraints.push_back({});   // the ends stay
    place_particles(solid, wall.places, wall.volume);
    SolidParticles& p = solid.particles;
    for (std::size_t i = 0; i < p.size(); ++i) {
        p.material[i] = std::int32_t(wall.layer[i]);
        p.mass[i] = wall.volume * solid.materials[std::size_t(wall.layer[i])].density;
        p.constraint[i] = wall.is_at_end[i] ? 1 : 0;
    }
    const SolidNumerics numerics = numerics_of(scene.config, scene.wall_spacing);
    part->body = make_solid_body(solid, numerics);
    part->surface = std::make_unique<SolidSurface>(wall.surface, solid.particles, carrying * scene.wall_spacing, false);
    return part;
}

void carry_lumen(DeployScene& scene) {
    scene.lumen = scene.vessel.checked.surface;
    const double size = 0.5 * scene.wall_spacing;
    const Bounds box = scene.field->bounds();
    refine_surface(scene.lumen, [&](const Vec3& x) {
        const Vec3 out = {std::max({0.0, box.low.x - x.x, x.x - box.high.x}),
                          std::max({0.0, box.low.y - x.y, x.y - box.high.y}),
                          std::max({0.0, box.low.z - x.z, x.z - box.high.z})};
        const double past = norm(out) > 0 ? norm(out) : std::max(0.0, scene.field->at(x).region);
        return size + 0.5 * past;
    });
    SurfaceElements mesh;
    for (std::uint32_t k = 0; k < scene.lumen.points.size(); ++k) {
        const Vec3& x = scene.lumen.points[k];
        const bool is_in_box = x.x > box.low.x && x.x < box.high.x && x.y > box.low.y && x.y < box.high.y &&
                               x.z > box.low.z && x.z < box.high.z;
        if (!is_in_box || scene.field->at(x).region > -0.5 * scene.wall_spacing) continue;
        scene.carried_points.push_back(k);
        mesh.vertices.push_back(x);
    }
    scene.carrier =
        std::make_unique<SolidSurface>(mesh, scene.wall->body->particles(), carrying * scene.wall_spacing, false);
}

}   // namespace

std::vector<SolidMaterial> wall_materials(const deck::Wall& wall) {
    deck::SolidMaterialChoice usual;
    usual.name = wall.law;
    const auto make = [&](const std::optional<deck::SolidMaterialChoice>& said, const std::string& layer) {
        return said ? make_solid_material(*said, "wall.layers." + layer) : make_solid_material(usual, "wall.law");
    };
    return {make(wall.layers.plaque, "plaque"), make(wall.layers.media, "media"),
            make(wall.layers.adventitia, "adventitia")};
}

SolidMaterial stent_material(const deck::Stent& stent, const StentPattern& pattern) {
    if (stent.material) return make_solid_material(*stent.material, "stent.material");
    deck::SolidMaterialChoice alloy;
    alloy.name = pattern.alloy;
    return make_solid_material(alloy, "stent.alloy");
}

double usual_wall_spacing(double thickness) { return std::min(0.2e-3, thickness / 4); }

double network_resolution(const deck::Case& config) {
    return config.wall.spacing.value_or(usual_wall_spacing(INFINITY));
}

double stent_mass_scaling(const deck::Case& config, const StentPlace& place, double spacing) {
    const deck::Deployment& d = config.deployment;
    if (d.mass_scaling) return *d.mass_scaling;
    const SolidMaterial metal = stent_material(*config.stent, place.pattern);
    const SolidNumerics n = stent_numerics(config, spacing);
    const double wave = n.cfl * n.kernel().h / ((1 + n.viscosity) * metal.moduli().p_wave_speed(metal.density));
    const double step = second_order_share * std::sqrt(stent_particle_mass_scaling) * wave, wanted = d.ramp / d.steps;
    return std::max(1.0, (wanted / step) * (wanted / step));
}

Surface DeployScene::lumen_now(const SolidParticles& wall_particles) {
    carrier->follow(wall_particles);
    Surface now = lumen;
    for (std::size_t k = 0; k < carried_points.size(); ++k) now.points[carried_points[k]] = carrier->position[k];
    return now;
}

std::unique_ptr<DeployScene> build_deployment(const deck::Case& config) {
    auto scene = std::make_unique<DeployScene>();
    scene->config = config;
    scene->solids.config = config;
    scene->vessel = read_vessel(config, network_resolution(config));
    scene->place = place_stent(config, scene->vessel);
    scene->field = field_around(config, scene->vessel, scene->place);
    scene->wall_spacing = config.wall.spacing.value_or(usual_wall_spacing(scene->field->thinnest()));
    scene->stent_spacing = config.stent->spacing.value_or(largest_stent_spacing(scene->place.form));

    const SolidMaterial metal = stent_material(*config.stent, scene->place.pattern);
    const SolidNumerics numerics = stent_numerics(config, scene->stent_spacing);
    scene->mass_scaling = stent_mass_scaling(config, scene->place, scene->stent_spacing);
    scene->stent = make_stent_part("stent", scene->place.form, scene->place.axis, metal, numerics, scene->mass_scaling);
    scene->wall = make_wall_part(*scene);
    carry_lumen(*scene);
    return scene;
}

}   // namespace patency
