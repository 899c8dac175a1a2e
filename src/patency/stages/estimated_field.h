// SPDX-License-Identifier: Apache-2.0
// The estimate of a case as a velocity and a pressure at any place of its lumen: what the particles start from.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "patency/stages/estimate.h"

namespace patency {

/// The flow of the branch that a place lies in, with the profile of the station beside it over the distance to the wall, along
/// the centreline; and that station's pressure. Continuous along a branch, not across a bifurcation.              THEORY.md (15.5)
class EstimatedField {
public:
    /// Of a vessel that was followed and its estimate; keeps neither.
    EstimatedField(const Vessel& vessel, const Estimate& estimate);

    struct Value {
        Vec3 velocity;            ///< [m/s]
        double pressure;          ///< [Pa], the deck's datum
        Vec3 pressure_gradient;   ///< [Pa/m]
    };
    /// At a place [m] that is `depth` [m] away from the wall.
    Value at(const Vec3& place, double depth) const;

    /// The branch that a place lies in.
    std::size_t branch_at(const Vec3& place) const { return stations_[nearest(place)].branch; }
    /// What places carry along every branch [m^3/s], each of which stands for `volume` [m^3] at its velocity [m/s]: the mean over the
    /// branch's length between its bifurcations and ends. 0 of a branch too short to tell.
    std::vector<double> carried(std::span<const Vec3> places, std::span<const Vec3> velocities, double volume) const;

    double largest_speed() const { return largest_speed_; }        ///< on an axis [m/s]
    double pressure_range() const { return highest_ - lowest_; }   ///< [Pa]

private:
    struct Station {
        std::size_t branch;
        Vec3 place, tangent;
        double radius;          // of the largest sphere [m]
        double mean_velocity;   // [m/s]
        TreeProfile profile;
        double pressure, slope;   // [Pa], along the tangent [Pa/m]
        double reach;             // what it stands for of a tube; 0 at its ends and in bifurcations [m]
    };
    std::size_t nearest(const Vec3& place) const;
    std::array<long, 3> box_of(const Vec3& place) const;
    template <class Visit>
    void for_each_near(const Vec3& place, Visit visit) const;

    std::vector<Station> stations_;
    // Stations by cubic boxes as wide as the widest vessel.
    Vec3 low_{};
    double box_ = 0;
    std::array<long, 3> boxes_{};
    std::vector<std::vector<std::uint32_t>> inside_;
    double largest_speed_ = 0, lowest_ = 0, highest_ = 0;
};

}   // namespace patency
