// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_geometric.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "patency/config/deck.h"
#include "patency/io/summary.h"
#include "patency/io/surface_file.h"
#include "patency/shape/exact_distance.h"
#include "patency/shape/lumen_morph.h"
#include "patency/shape/stent_chart.h"
#include "patency/shape/surface_refine.h"
#include "patency/stages/deploy_results.h"
#include "patency/stages/deploy_scene.h"
#include "patency/stages/lumen_after.h"
#include "patency/stages/stopwatch.h"

namespace patency {

namespace {

/// The shoulder that was asked for, or what there is before the nearer opening.
double shoulder_of(const StentPlace& place, const Centreline& line, double diameters) {
    const double past = (place.pattern.length - place.opened_length) / 2;   // the opened stent is shorter
    const double room = std::min(place.start_arc(), line.length() - place.end_arc()) + past;
    return std::min(diameters * place.diameter, 0.9 * room);
}

/// The surface with triangles small enough to be opened smoothly where it will be.
Surface refined_around(Surface surface, const StentPlace& place, const LumenMorph& morph) {
    const double size = 0.1 * place.diameter;   // a thirtieth of the circumference
    refine_surface(surface, [&](const Vec3& x) {
        const StentPoint at = place.axis.coordinates(x);
        const double past =
            std::max({0.0, std::abs(at.along) - morph.length / 2 - morph.shoulder, at.radius - 2 * morph.radius});
        return size + 0.5 * past;
    });
    return surface;
}

}   // namespace

void deploy_geometrically(const deck::Case& config, const DeployStage& stage) {
    const Stopwatch watch;
    const auto say = [&](const std::string& line) { stage.log(LogLevel::info, line); };
    deck::write_case(config, stage.folder.file("case.resolved.yaml"));
    const Vessel before = read_vessel(config, network_resolution(config));
    const StentPlace place = place_stent(config, before);
    const Centreline& line = before.along->lines.lines[place.line];
    const LumenMorph morph{.radius = place.diameter / 2,
                           .length = place.opened_length,
                           .shoulder = shoulder_of(place, line, config.deployment.shoulder)};
    say(
        fmt::format("the stent of {:.4g} mm lies {:.4g} to {:.4g} mm from the inlet towards {}; the lumen there is "
                    "{:.3g} mm at its narrowest, {:.3g} mm where healthy",
                    1e3 * place.pattern.length, 1e3 * place.start_arc(), 1e3 * place.end_arc(), line.outlet,
                    1e3 * place.narrowest, 1e3 * place.reference_diameter));

    Surface surface = refined_around(before.checked.surface, place, morph);
    morph_surface(surface, place.axis, morph);
    Vessel after = write_lumen_after(config, before, surface, stage.folder);
    const LumenGain gain = lumen_gain(place, *before.along, after);

    const StrutCurves opened = make_strut_curves(at_diameter(place.pattern, place.diameter));
    write_surface(stage.folder.file("stent.vtp"), make_stent_surface(opened, place.axis));
    const OuterFaces outer = outer_faces_of(opened, place.axis);
    const StentProfile shape = measure_stent_profile(seen_from(place.axis, outer.places), slices_for(place.pattern));
    const SignedDistance lumen = make_exact_distance(closed_at(after.checked.surface, after.checked.ends));
    const StrutFit fit = measure_fit(outer.places, outer.areas, place.axis, lumen);
    write_stent_table(stage.folder.file("stent.csv"), shape);

    nlohmann::ordered_json deploy = {
        {"mode", "geometric"},
        {"is_mechanical", false},
        {"note", "the lumen took the stent's nominal shape without mechanics: no recoil, no stress, no contact"}};
    deploy.update(deploy_summary(place, shape, fit, find_jailed_ostia(shape, place.axis, lumen), gain));
    deploy["foreshortening_percent"] = 100 * foreshortening(place.pattern.length, shape.length);
    for (const char* key : {"recoil_percent", "penetration_over_spacing", "kinetic_to_internal"}) deploy[key] = nullptr;
    write_summary(stage.folder.file("summary.json"), {{"deploy", deploy}});
    write_timing(stage.folder, {{"deploy", {{"cpu_s", watch.cpu()}, {"wall_s", watch.wall()}}}});
    say(fmt::format(
        "done without mechanics: narrowest {:.3g} mm, before {:.3g} mm; residual stenosis {:.1f} %; {:.1f} s",
        1e3 * gain.narrowest_after, 1e3 * gain.narrowest_before, 100 * gain.residual_stenosis(), watch.wall()));
}

}   // namespace patency
