// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/deploy_contacts.h"

#include <utility>

#include "patency/base/parallel.h"
#include "patency/bodies/stent_skin.h"
#include "patency/bodies/tether.h"

namespace patency {

DeployContacts::DeployContacts(DeployScene& scene, const DeployProgram& program, const DeployPace& pace)
    : scene_(scene), program_(program), pace_(pace), stent_(scene.stent.get()), wall_(scene.wall.get()) {}

double DeployContacts::begin(DeployPhase phase, std::optional<double> known_step) {
    SolidSystem& solids = scene_.solids.system;
    if (scene_.stent) solids.parts.push_back(std::move(scene_.stent));
    const bool needs_wall = phase != DeployPhase::crimp && phase != DeployPhase::release;
    if (scene_.wall && (needs_wall || program_.predilation)) solids.parts.push_back(std::move(scene_.wall));
    // What a tool drives goes slowly enough by itself; damping would take the work that is to be done on metal and wall. What is let go
    // comes to rest.
    solids.is_relaxed = phase == DeployPhase::release || phase == DeployPhase::hold || phase == DeployPhase::settle;
    step_ = known_step ? *known_step : stable_step(solids);
    phase_ = phase;
    if (phase == DeployPhase::crimp) {
        crimper_ = add_tool(*stent_->surface, RadialTool::Kind::crimper, program_.crimper);
        add_tool(*stent_->surface, RadialTool::Kind::balloon, program_.balloon);   // folded: what it is crimped onto
    } else if (needs_wall && !stent_on_wall_) {
        meet();
    }
    if (phase == DeployPhase::enter && !balloon_)   // folded within the stent, which the wall closes on
        balloon_ = add_tool(*stent_->surface, RadialTool::Kind::balloon, program_.balloon);
    if (program_.predilation && !predilator_ && phase <= DeployPhase::enter)
        predilator_ = add_tool(*wall_->surface, RadialTool::Kind::balloon, program_.predilation);
    if (phase == DeployPhase::open) open();
    return step_;
}

/// The crimped stent comes into the vessel.
void DeployContacts::meet() {
    SolidSystem& solids = scene_.solids.system;
    for (const auto& gone : solids.contacts) past_.add(gone->report());
    solids.contacts.clear();
    crimper_ = predilator_ = nullptr;
    const deck::Deployment& d = scene_.config.deployment;
    if (d.tethering > 0) add(make_tether(*wall_->surface, 1, d.tethering));   // the outer face
    stent_on_wall_ = add(make_surface_contact(
        *stent_->surface, *wall_->surface,
        {.friction = d.friction, .damping = damping_when_driven, .step = step_, .hold = hold_when_driven}));
}

void DeployContacts::open() {
    const deck::Deployment& d = scene_.config.deployment;
    drop_last(predilator_);
    if (d.mode == deck::DeploymentMode::balloon) {
        if (!balloon_) balloon_ = add_tool(*stent_->surface, RadialTool::Kind::balloon, program_.balloon);
        balloon_on_wall_ = add_tool(*wall_->surface, RadialTool::Kind::balloon, program_.balloon);
        return;
    }
    drop_last(balloon_);
    const auto face = std::make_shared<InnerFace>(*stent_->surface, scene_.place.axis);
    const SolidParticles& metal = stent_->body->particles();
    const double mass = sum_of(metal.size(), [&](std::size_t i) { return metal.mass[i]; });
    load_ = std::make_shared<RadialLoad>(RadialLoad{.pumped = program_.pumped,
                                                    .radius = [face] { return face->radius(); },
                                                    .speed = [face] { return face->speed(); },
                                                    .most = d.load,
                                                    .mass_by_area = mass / face->area()});
    stent_->pressures.push_back(
        {stent_inner, [&pace = pace_, load = load_](double t) { return load->pressure(pace.program(t)); }});
}

/// A tool that is done, if it is there: the last contact.
void DeployContacts::drop_last(Contact*& tool) {
    if (!tool) return;
    past_.add(tool->report());
    scene_.solids.system.contacts.pop_back();
    tool = nullptr;
}

Contact* DeployContacts::add(std::unique_ptr<Contact> contact) {
    auto& contacts = scene_.solids.system.contacts;
    contacts.push_back(std::move(contact));
    return contacts.back().get();
}

Contact* DeployContacts::add_tool(SolidSurface& surface, RadialTool::Kind kind,
                                  const std::function<double(double)>& radius) {
    return add(make_tool_contact(surface,
                                 {.kind = kind,
                                  .axis = scene_.place.axis,
                                  .length = scene_.place.pattern.length,
                                  .radius = [&pace = pace_, radius](double t) { return radius(pace.program(t)); }},
                                 {.friction = scene_.config.deployment.balloon_friction, .step = step_}));
}

double DeployContacts::tool_radius(double time) const {
    if (phase_ <= DeployPhase::release) return program_.crimper(time);
    if (phase_ == DeployPhase::enter) return program_.predilation(time);
    return balloon_ ? program_.balloon(time) : 0;
}

double DeployContacts::tool_pressure(double time) const {
    if (const Contact* tool = phase_ <= DeployPhase::release ? crimper_ : balloon_) return tool->report().pressure;
    return load_ ? load_->pressure(time) : 0;
}

bool DeployContacts::have_pressed(double time) {
    double work = 0;   // of what recedes: it cannot touch and do none
    for (const Contact* tool : {balloon_, balloon_on_wall_})
        if (tool) work += tool->report().work;
    return std::exchange(pressed_, work) != work || (load_ && load_->pressure(time) > 0);
}

ContactAccount DeployContacts::account() const {
    ContactAccount all = past_;
    all.stored = 0;   // of those that are gone
    for (const auto& c : scene_.solids.system.contacts) all.add(c->report());
    return all;
}

std::vector<double*> DeployContacts::numbers() {
    std::vector<double*> all = past_.numbers();
    all.push_back(&pressed_);
    if (load_)
        for (double* x : load_->numbers()) all.push_back(x);
    return all;
}

}   // namespace patency
