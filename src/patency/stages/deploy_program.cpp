// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_program.h"

#include <algorithm>

#include "patency/bodies/radial_tool.h"
#include "patency/stages/deploy_load.h"

namespace patency {

namespace {

// In ramps.
constexpr double shortest_crimp = 0.1, release = 0.1, entering = 0.2, holding = 0.05, deflating = 1, settling = 1,
                 usual_deflating = 0.2, usual_settling = 0.2;

}   // namespace

std::string_view name_of(DeployPhase phase) {
    switch (phase) {
        case DeployPhase::crimp: return "crimp";
        case DeployPhase::release: return "release";
        case DeployPhase::enter: return "enter";
        case DeployPhase::open: return "open";
        case DeployPhase::hold: return "hold";
        case DeployPhase::deflate: return "deflate";
        case DeployPhase::settle: break;
    }
    return "settle";
}

DeployProgram make_deploy_program(const StentPlace& place, const deck::Deployment& deployment) {
    const double cut = place.pattern.diameter / 2, crimped = place.crimped_diameter / 2, opened = place.diameter / 2,
                 strut = place.pattern.strut_thickness;
    const double folded = crimped - strut,
                 full = opened - strut;   // the balloon that it is crimped onto; its inner face when it is open
    const double ramp = deployment.ramp;
    DeployProgram program;
    double time = 0;
    const auto add = [&](DeployPhase phase, double duration) { program.phases.push_back({phase, time += duration}); };
    const bool is_crimped = crimped < cut * (1 - 1e-9);
    const double way = std::max(shortest_crimp, (cut - crimped) / (opened - crimped)) * ramp;
    if (is_crimped) {
        add(DeployPhase::crimp, way);
        add(DeployPhase::release, release * ramp);
        program.crimper = ramped_radius({0, way, time}, {cut, crimped, 1.2 * cut});
    } else {
        program.crimper = ramped_radius({0}, {2 * opened});
    }
    if (deployment.predilation) {
        if (!is_crimped) add(DeployPhase::release, way);   // while nothing happens to the stent
        const double small = 0.25 * std::min(place.narrowest, *deployment.predilation),
                     wide = *deployment.predilation / 2, from = time;
        add(DeployPhase::enter, entering * ramp);
        program.predilation =
            ramped_radius({0, from, time}, {small, wide, folded});   // and hands the wall over to the folded balloon
    }
    program.open_from = time;
    add(DeployPhase::open, ramp);
    program.open_to = time;
    add(DeployPhase::hold, holding * ramp);
    program.deflate_from = time;
    add(DeployPhase::deflate, deflating * ramp);
    // Slowly at first, where the stent recoils and the balloon hands the wall over to it.
    program.balloon =
        ramped_radius({program.open_from, program.open_to, program.deflate_from, time}, {folded, full, full, folded});
    const double most = full * (1 + RadialLoad::full_lag);
    program.pumped =
        ramped_radius({program.open_from, program.open_to, program.deflate_from, time}, {folded, most, most, folded});
    add(DeployPhase::settle, settling * ramp);
    program.usual_end = program.deflate_from + (usual_deflating + usual_settling) * ramp;
    return program;
}

}   // namespace patency
