// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/profile_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"

namespace patency {

ProfileFit::ProfileFit(double first, double spacing, int count, double reach)
    : first_(first), spacing_(spacing), reach_(reach), sums_(std::size_t(count)) {
    for (int k = 0; k < count; ++k) stations_.push_back(first + k * spacing);
}

void ProfileFit::add(double coordinate, double value, double weight) {
    const double place = (coordinate - first_) / spacing_;
    const int begin = std::max(0, int(std::ceil(place - reach_)));
    const int end = std::min(int(stations_.size()) - 1, int(std::floor(place + reach_)));
    for (int k = begin; k <= end; ++k) {
        const double t = place - k, q = t / reach_, w = weight * (1 - q * q) * (1 - q * q);
        auto& s = sums_[std::size_t(k)];
        double power = w;
        for (std::size_t m = 0; m < 5; ++m) {
            s[m] += power;
            if (m < 3) s[5 + m] += power * value;
            power *= t;
        }
    }
}

std::vector<double> ProfileFit::values() const {
    std::vector<double> values;
    for (std::size_t k = 0; k < stations_.size(); ++k) {
        const auto& s = sums_[k];
        // Cramer's rule for the constant of the parabola; the determinant is s0^3 times a function of the scatter.
        const double a = s[2] * s[4] - s[3] * s[3], b = s[1] * s[4] - s[2] * s[3], c = s[1] * s[3] - s[2] * s[2];
        const double det = s[0] * a - s[1] * b + s[2] * c;
        if (!(det > 1e-9 * s[0] * s[0] * s[0]))
            throw GeometryError(fmt::format("too few particles around {:.4g} m to fit a profile there", stations_[k]));
        values.push_back((s[5] * a - s[6] * b + s[7] * c) / det);
    }
    return values;
}

void WallFit::add(double s, double value, double weight) {
    sums_[0] += weight * s * s;
    sums_[1] += weight * s * s * s;
    sums_[2] += weight * s * s * s * s;
    sums_[3] += weight * s * value;
    sums_[4] += weight * s * s * value;
}

double WallFit::slope() const {
    const auto& [s2, s3, s4, f1, f2] = sums_;
    const double det = s2 * s4 - s3 * s3;
    if (!(det > 1e-9 * s2 * s4)) throw GeometryError("too few particles near the wall to fit a slope there");
    return (f1 * s4 - f2 * s3) / det;
}

}   // namespace patency
