// SPDX-License-Identifier: Apache-2.0
// What can be said of a stent from the places of its struts and of the lumen around it: diameters, how it recoils and shortens, how well
// it sits, what it covers. Numbers in, numbers out; knows nothing of mechanics.                             THEORY (24.4), (24.5)
#pragma once

#include <span>
#include <vector>

#include "patency/shape/signed_distance.h"
#include "patency/shape/stent_axis.h"

namespace patency {

/// The largest kinetic over internal energy of what is driven slowly enough to be taken for at rest.
inline constexpr double most_kinetic_to_internal = 0.05;
/// A stent that was let go is at rest: its diameter changes by less in a tenth of the time that opened it.
inline constexpr double most_drift_percent = 0.05;
/// A stent is opened: it is that much of the wanted diameter wide, or more.
inline constexpr double least_opened = 0.98;

/// A piece of a stent's length.
struct StentSlice {
    double along;                           ///< its middle, from the stent's middle [m]
    double mean_diameter;                   ///< over all directions [m]
    double least_diameter, most_diameter;   ///< twice the least and the largest radius [m]
    double area;                            ///< within the struts' outer faces [m^2]
};

/// A stent's outer measures.
struct StentProfile {
    std::vector<StentSlice> slices;
    double length;                                         ///< over all [m]
    double least_diameter, mean_diameter, most_diameter;   ///< of the slices' mean diameters [m]
    double least_area;                                     ///< of the slices [m^2]
    double end_diameter;                                   ///< mean of the slices in the last tenths of both ends [m]
    double middle_diameter;                                ///< mean of those in the middle fifth [m]
};

/// Of places on the outer faces of struts, as many slices as asked for. In a slice radii between struts are interpolated over the angle.
/// Throws GeometryError for fewer than three places in a slice.
StentProfile measure_stent_profile(std::span<const StentPoint> outer, int slices);

/// Shares, not percent.
double recoil(double inflated_diameter, double deflated_diameter);
double foreshortening(double length_before, double length_after);
double dogboning(const StentProfile& shape);   ///< (ends - middle) / ends

/// How far a straight line goes until it meets the wall [m]; `most` if it goes farther. The lumen's distance, negative inside.
double reach_to_wall(const SignedDistance& lumen, const Vec3& from, const Vec3& unit_direction, double most);

struct ApposedRule {
    double largest_gap = 1e-4;   ///< between a strut's outer face and the wall [m]: more is malapposed
    double ostium_reach = 2;     ///< over the radius of the stent there: a wall farther out is that of a side branch
};

/// How the struts sit in the lumen, per place.
struct StrutFit {
    std::vector<double> gap;            ///< to the nearest wall [m]; negative: beyond it
    std::vector<char> is_over_ostium;   ///< looks into a side branch
    double malapposed = 0;              ///< share of the outer area that is not over an ostium
    double largest_gap = 0;             ///< [m], not over an ostium
    double over_ostia = 0;              ///< outer area of struts over ostia [m^2]
};
/// `places` on the outer faces [m] with the area of each [m^2].
StrutFit measure_fit(std::span<const Vec3> places, std::span<const double> areas, const StentAxis& axis,
                     const SignedDistance& lumen, const ApposedRule& rule = {});

/// The opening of a side branch that the stent lies in front of.
struct JailedOstium {
    Vec3 centre;   ///< on the stent's outer face [m]
    double area;   ///< of that face in front of it [m^2]
};
/// By rays from the axis on a grid of the stent's outer face; smaller ones than a hundredth of the stent's cross-section do not count.
std::vector<JailedOstium> find_jailed_ostia(const StentProfile& shape, const StentAxis& axis,
                                            const SignedDistance& lumen, const ApposedRule& rule = {});

/// A force that presses somewhere on a face [N].
struct PressedPlace {
    Vec3 place;
    double force;
};
/// The pressure around each place of a face that has these areas [m^2]: all force within `reach` [m] of it over all area there. Forces come
/// as far apart as the vertices of what presses, farther than the places, and say nothing of less than that.
std::vector<double> pressures_on(std::span<const Vec3> places, std::span<const double> areas,
                                 std::span<const PressedPlace> presses, double reach);

/// The value below which this share of the weight lies; 0 of nothing.
double weighted_percentile(std::span<const double> values, std::span<const double> weights, double share);

}   // namespace patency
