// SPDX-License-Identifier: Apache-2.0
// A profile at fixed stations from scattered samples in space and time: around every station a parabola is fitted to
// all samples, so that quadratic profiles come out exactly and neighbouring layers do not smear. No smoothing in time
// beyond the mean.
#pragma once

#include <array>
#include <vector>

namespace patency {

class ProfileFit {
public:
    /// Stations at first + k spacing, k < count [m]; samples up to `reach` spacings away count, with a weight that
    /// vanishes there.
    ProfileFit(double first, double spacing, int count, double reach = 2.5);

    void add(double coordinate, double value, double weight);

    const std::vector<double>& stations() const { return stations_; }
    /// The fitted value at each station. @throws GeometryError if a station has too few samples for a parabola.
    std::vector<double> values() const;

private:
    double first_, spacing_, reach_;
    std::vector<double> stations_;
    std::vector<std::array<double, 8>> sums_;   // w t^0..t^4, w f t^0..t^2 with t in spacings from the station
};

/// f = slope s + curve s^2 through f(0) = 0, from samples at distances s > 0 from a wall.
class WallFit {
public:
    void add(double s, double value, double weight);
    /// df/ds at the wall. @throws GeometryError without two different distances.
    double slope() const;

private:
    std::array<double, 5> sums_{};   // w s^2, s^3, s^4, w f s, w f s^2
};

}   // namespace patency
