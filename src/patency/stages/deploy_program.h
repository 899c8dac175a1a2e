// SPDX-License-Identifier: Apache-2.0
// What happens when in a deployment: the phases, and the radii of the tools over time.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "patency/config/case.h"
#include "patency/stages/stent_placement.h"

namespace patency {

enum class DeployPhase { crimp, release, enter, open, hold, deflate, settle };
std::string_view name_of(DeployPhase phase);

struct DeployProgram {
    struct Entry {
        DeployPhase phase;
        double end;   ///< [s]; it begins where the one before ends
    };
    std::vector<Entry> phases;   ///< those that last
    std::function<double(double time)> crimper, balloon,
        predilation,                     ///< radii [m]; predilation: empty if there is none
        pumped;                          ///< of what a load fills: THEORY (21.17)
    double open_from = 0, open_to = 0;   ///< when the stent is opened [s]
    /// The last two phases end as soon as nothing happens any more, and `end` at the latest [s].
    double end() const { return phases.back().end; }
    double deflate_from = 0, usual_end = 0;
};

/// The balloon's last radius is that of the stent's inner face at the wanted diameter. The crimper moves as fast as the balloon on average.
DeployProgram make_deploy_program(const StentPlace& place, const deck::Deployment& deployment);

}   // namespace patency
