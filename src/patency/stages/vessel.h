// SPDX-License-Identifier: Apache-2.0
// What a surface is as a vessel: diagnosed, its openings found, its centrelines, branches, sections and lesions. Makes no
// particles.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "patency/config/case.h"
#include "patency/shape/lesions.h"
#include "patency/shape/network.h"
#include "patency/shape/passage.h"
#include "patency/shape/square_ends.h"
#include "patency/shape/surface_check.h"
#include "patency/shape/surface_openings.h"

namespace patency {

/// A vessel along its centrelines.
struct VesselAlong {
    BranchedLines lines;
    std::vector<std::vector<CrossSection>> sections;   ///< per line and point
    Assessment assessment;
    std::vector<std::optional<SquareCut>> least_cuts{};   ///< per opening, least_square_cut()
};

/// The section at a point of a line, or the disc of the largest sphere where a plane across it cuts another branch or no
/// closed outline [m^2].
double lumen_area(const VesselAlong& along, std::size_t line, std::size_t point);
/// Diameter of the smallest of the largest spheres along all lines [m].
double narrowest_diameter(const VesselAlong& along);

/// What flows along the branches of a vessel that stores nothing, from what flows out of its openings [m^3/s].
std::vector<double> branch_flows(const BranchedLines& lines, const std::vector<Opening>& openings,
                                 std::span<const double> out);
/// When outlets of these diameters [m], one per line, share the flow by Murray's law.
Passage passage_of(const VesselAlong& along, const std::vector<double>& outlet_diameters);

/// Diameters of the largest spheres along a branch, without its bifurcations [m].
struct Widths {
    double least, mean, most;
};
Widths widths_of(const VesselAlong& along, const Branch& branch);

struct Vessel {
    std::size_t triangles_read = 0;
    CheckedSurface checked{};                 ///< its findings say what was repaired and what is refused
    std::vector<SurfaceOpening> openings{};   ///< the inlet first
    std::optional<VesselAlong> along{};       ///< none where something is refused
};

/// Diagnosed, repaired, its openings found; `inlet` (a name or a number, or empty) tells which is the inlet.
Vessel check_vessel(Surface surface, std::string_view inlet = {});
/// The surface of a network, its openings named as the network's; triangles of about `resolution` [m], half its narrowest diameter if 0.
Vessel check_vessel(const Network& network, std::string_view inlet = {}, double resolution = 0);

/// Adds the centrelines and what follows from them; where there are none, why, as one more refused finding. Does nothing
/// where something is refused already, or where it was followed before.
void follow_vessel(Vessel& vessel);

/// Branches that have been followed get the names of the network's tubes, as decks must use them.
void name_as_tubes(Vessel& vessel, const Network& network);

/// How far an opening is from square to the vessel's axis there [rad]; none where its branch is too short to say, or where the vessel was
/// not followed.
std::optional<double> off_square(const Vessel& vessel, std::size_t opening);

/// The ends of these openings are cut square to the centreline so far before them [m]; names and order of the openings stay. Follows
/// the vessel first; it is to be followed again then. Throws UsageError for an opening that there is not, GeometryError
/// for a length that does not take the whole of an oblique end or is longer than the branch, and what cut_end throws.
void cut_ends_back(Vessel& vessel, const std::map<std::string, double>& lengths);

/// The vessel of a deck's surface, ready for use but not followed. Throws GeometryError with all refusals, or a question about the
/// unit if its size is none of a vessel's; FileError.
Vessel open_vessel(const deck::Case& config);

/// The vessel of a deck's surface or network, followed. Throws GeometryError with all refusals; FileError; DeckError for a deck with
/// neither. A network's surface has triangles of `network_resolution` [m] (check_vessel).
Vessel read_vessel(const deck::Case& config, double network_resolution = 0);

}   // namespace patency
