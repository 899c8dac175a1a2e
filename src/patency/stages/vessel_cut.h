// SPDX-License-Identifier: Apache-2.0
// A cut along a vessel: the surface that its centrelines sweep out sideways, in the plane in which the vessel mostly lies, with the
// means over time of velocity and pressure. Shows the jet of a lesion and what becomes of it.
#pragma once

#include <filesystem>
#include <vector>

#include "patency/stages/scene.h"

namespace patency {

class VesselCut {
public:
    /// Of a scene with a vessel: rows of places from wall to wall, a spacing apart along every branch.
    explicit VesselCut(const Scene& scene);

    void sample(const Scene& scene);   ///< one instant of the means
    /// Triangles with Velocity, Pressure (as the deck counts it) and how much the speed swings. Throws FileError.
    void write(const std::filesystem::path& path) const;

    const std::vector<Vec3>& places() const { return places_; }

    /// For checkpoints: instants, then five sums per place.
    std::vector<double> state() const;
    void restore(const std::vector<double>& state);

private:
    std::vector<Vec3> places_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<Vec3> velocity_;   // sums
    std::vector<double> pressure_, squares_;
    double instants_ = 0;
    std::string space_;
};

}   // namespace patency
