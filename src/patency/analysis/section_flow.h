// SPDX-License-Identifier: Apache-2.0
// Flow through cross-sections of a vessel: area, flow, mean pressure, mean and peak velocity. Reads particles; moves none.
#pragma once

#include <span>
#include <vector>

#include "patency/analysis/sample.h"
#include "patency/bodies/open_end.h"

namespace patency {

/// A plane across a vessel.
struct SectionPlane {
    Vec3 centre;     ///< inside the lumen [m]
    Vec3 normal;     ///< unit, along the stream
    double radius;   ///< of the largest circle around the centre inside the lumen, about [m]
};

/// The part of a plane that is lumen and joined to the centre, as small squares; those across the wall are cut by it.
struct SectionGrid {
    std::vector<Vec3> place;    ///< middles of the squares' parts in the lumen [m]
    std::vector<double> area;   ///< of their part in the lumen [m^2]
    Vec3 normal;
    double side = 0;             ///< of a square [m]
    bool closed = true;          ///< false: it runs into open space (a side branch cut along), farther than 4 radii
    double total_area() const;   ///< [m^2]
};
/// Squares of `across` to the radius.
SectionGrid make_section_grid(const SectionPlane& plane, const WallHint& wall, int across = 8);
/// Centroid, area and mean square of a grid's squares.
SectionShape shape_of(const SectionGrid& grid);

struct SectionFlow {
    double area;            ///< [m^2]
    double flow;            ///< along the normal [m^3/s]
    double pressure;        ///< mean over the area, above the reference pressure [Pa]
    double mean_velocity;   ///< flow over area [m/s]
    double peak_velocity;   ///< largest component along the normal at a square's middle [m/s]
};
/// What goes through each section now: the flow from the particles themselves in a slab of three quarters of the reach on both sides,
/// which carry it whatever its profile; pressure and peak from samples in the squares. Squares without a particle within reach take
/// no part in the means: if there are only such, flow and pressure are NaN.
std::vector<SectionFlow> flow_through_sections(const FluidParticles& fluid, const Frame& frame,
                                               std::span<const SectionGrid> sections, const LocalLength& reach,
                                               const WallHint& wall);

/// Means over instants and how much they swing. Flow and pressure of a section that saw no blood once stay NaN.
class SectionFlowMeans {
public:
    /// One instant: the sections always in the same order; pressure above `level` [Pa].
    void add(std::span<const SectionFlow> sections, double level);

    std::size_t instants() const { return instants_; }
    std::vector<SectionFlow> mean() const;        ///< pressures with their levels; the area of the last instant
    std::vector<SectionFlow> deviation() const;   ///< standard ones, of area 0

    /// For checkpoints: instants, then per section and number the sum and the sum of squares.
    std::vector<double> state() const;
    void restore(std::span<const double> state);

private:
    std::size_t instants_ = 0;
    std::vector<SectionFlow> sum_, squares_;
};

}   // namespace patency
