// SPDX-License-Identifier: Apache-2.0
// What touches what in the phases of a deployment by contact.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "patency/bodies/radial_tool.h"
#include "patency/stages/deploy_account.h"
#include "patency/stages/deploy_load.h"
#include "patency/stages/deploy_pace.h"
#include "patency/stages/deploy_program.h"
#include "patency/stages/deploy_scene.h"

namespace patency {

/// Puts bodies and contacts into the scene's system as the phases begin, and knows what those did that are over. Tools go by the
/// program's time, at its pace. All that is given must outlive it.
class DeployContacts {
public:
    DeployContacts(DeployScene& scene, const DeployProgram& program, const DeployPace& pace);

    /// Whatever touches in a phase, for this time step [s]; none: for the stable one, which is returned.
    double begin(DeployPhase phase, std::optional<double> known_step);

    SolidPart& stent() const { return *stent_; }
    SolidPart& wall() const { return *wall_; }
    bool has_wall() const { return scene_.wall == nullptr; }   ///< it has been put into the system

    /// Of whatever works on the stent in the phase that began last: radius [m] and pressure [Pa], at a time of the program [s].
    double tool_radius(double time) const;
    double tool_pressure(double time) const;

    /// Balloon or load have pressed on stent or wall since this was asked last; at a time of the program [s].
    bool have_pressed(double time);

    RadialLoad* load() const { return load_.get(); }   ///< null if a tool opens the stent
    const Contact* stent_on_wall() const { return stent_on_wall_; }

    /// Of the contacts that are and were; stored of those that are.
    ContactAccount account() const;
    /// All that is known of the past, to be kept and put back when the same phases have begun.
    std::vector<double*> numbers();

private:
    Contact* add(std::unique_ptr<Contact> contact);
    Contact* add_tool(SolidSurface& surface, RadialTool::Kind kind, const std::function<double(double)>& radius);
    void drop_last(Contact*& tool);
    void meet();
    void open();

    DeployScene& scene_;
    const DeployProgram& program_;
    const DeployPace& pace_;
    SolidPart *stent_, *wall_;   // wherever they are
    Contact *crimper_ = nullptr, *predilator_ = nullptr, *stent_on_wall_ = nullptr, *balloon_ = nullptr,
            *balloon_on_wall_ = nullptr;
    std::shared_ptr<RadialLoad> load_;
    DeployPhase phase_ = DeployPhase::crimp;
    double pressed_ = 0;    // the balloon's work when that was asked [J]
    double step_ = 0;       // that the contacts of this phase are as stiff for [s]
    ContactAccount past_;   // of contacts that are over
};

}   // namespace patency
