// SPDX-License-Identifier: Apache-2.0
// What patency init decides for a vessel: who brings the blood and who takes it, how long it takes to settle, which spacing
// a budget pays for, and what that means. How it is written down is init_text.h's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "patency/config/case.h"
#include "patency/shape/stent_library.h"
#include "patency/stages/cell_plan.h"
#include "patency/stages/estimate.h"
#include "patency/stages/plan.h"
#include "patency/stages/vessel.h"

namespace patency {

/// An opening that lies so obliquely that its section is more than a few per cent larger than the vessel's.
struct ObliqueEnd {
    std::string name;
    double angle;            ///< off square [rad]
    double cut_back;         ///< what makes it square, geometry.cut_back [m]; 0 where nothing does
    std::string why_not{};   ///< then: a sentence

    double excess() const;   ///< area over that across the vessel, less one
};

/// Cuts ends that are more than 15 degrees off square: an oblique section is 1/cos larger than the vessel there, 3.5 % at 15
/// degrees. The vessel is followed as it is then. Returns those ends, cut or not.
std::vector<ObliqueEnd> square_oblique_ends(Vessel& vessel);

struct InitSettings {
    deck::Geometry geometry;   ///< the surface or network, paths absolute
    std::string name;          ///< of the case
    Budget budget;
    bool with_stent = false;                  ///< the proposed stent is in the deck, not a comment there
    std::vector<ObliqueEnd> oblique_ends{};   ///< of square_oblique_ends()
    std::optional<double> period{};           ///< of the heart [s]; a steady flow if absent
};

/// What brings blood to a vessel of this width, if nobody says.
struct InletDefault {
    double widest;   ///< for inlets up to this diameter [m]
    deck::BedState state;
    double velocity;            ///< mean over the inlet's section [m/s]
    const char* what;           ///< "a coronary artery at hyperaemia"
    const char* source;         ///< where the velocity comes from
    bool is_coronary = false;   ///< the heart squeezes the bed behind it
};
const InletDefault& inlet_default(double diameter);

/// An outlet that is too narrow for the spacing that the budget alone allows: from where on its line it would have to be cut.
struct Cut {
    std::size_t opening;
    double arc, end_arc;   ///< from the inlet [m]
    double cut_back;       ///< geometry.cut_back that does it, with what is cut already [m]
};

/// An opening so near to a bifurcation or a lesion that what is prescribed there disturbs it.
struct ShortEnd {
    std::size_t opening;
    double length;   ///< of undisturbed vessel [m]
};

/// A design of the library for a lesion.
struct StentProposal {
    std::size_t lesion;   ///< in Assessment::lesions
    const StentDesign* design;
    StentPattern pattern;   ///< of the design, as long as it takes
    double arc;             ///< of the lesion's middle, from its branch's start [m]
};

struct InitPlan {
    deck::Case config;   ///< the deck
    const InletDefault* inlet;
    Estimate estimate;   ///< of the deck
    double bed_flow;     ///< what the bed takes without a loss in the vessel [m^3/s]
    double settling;     ///< until a flow from rest is steady [s]
    Budget budget;
    CellPlan cells;   ///< what the deck costs
    double
        moving_spacing;   ///< instead, of moving particles: what the budget pays for, but no coarser than the openings bear [m]
    double budget_spacing;   ///< of moving particles, that the budget alone allows [m]
    FlowPlan price;          ///< of moving particles
    double fine_spacing;     ///< at which nothing is under-resolved [m]
    FlowPlan fine_price;
    std::vector<Widths> widths;   ///< as the vessel's branches
    std::vector<Cut> cuts;
    std::vector<ShortEnd> short_ends;
    std::vector<ObliqueEnd> oblique_ends;
    std::optional<StentProposal> stent;   ///< for the worst lesion; none where no design fits
    bool with_stent;                      ///< it is in the deck, not a comment there

    double across(double diameter) const { return diameter / moving_spacing; }   ///< moving particles
    bool is_within_budget() const { return price.longest_seconds <= budget.seconds && price.memory <= budget.memory; }
};

/// Of the deck that is written: within some per cent of the limit, in a minute (docs/VERIFICATION.md).
inline constexpr double cells_across = 12;

/// Fewer particles across are marked as under-resolved.
inline constexpr double fewest_resolved = 8;

/// Decides everything for a vessel that was followed: a steady flow on cells that follow it, and what moving particles would
/// cost. Throws GeometryError if no flow can be set up in it, or a stent is wanted and there is no lesion that one of the library fits.
InitPlan plan_case(const Vessel& vessel, const InitSettings& settings);

}   // namespace patency
