// SPDX-License-Identifier: Apache-2.0
// The kernel of relaxation on a lattice of unit spacing, and what a lattice behind a flat face adds to a point before
// it. Private to relax.cpp and graded_points.cpp; everything is in units of the spacing, so a point's volume is 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/vec.h"

namespace patency::relaxation {

constexpr double smoothing = 1.3;   // h over spacing, as the fluid's
constexpr double support = 2 * smoothing;

// Wendland C2 without its factor: w = t^4 (2q + 1), -w'/r = 5 t^3 / h^2, with q = r/h, t = 1 - q/2.
inline double kernel_factor(bool planar) {
    constexpr double h = smoothing, pi = std::numbers::pi;
    return planar ? 7 / (4 * pi * h * h) : 21 / (16 * pi * h * h * h);
}
inline double shape_of_kernel(double r) {
    const double t = std::max(0.0, 1 - r / support);
    return t * t * t * t * (2 * r / smoothing + 1);
}
inline double shape_of_slope(double r) {   // -w'/r
    const double t = std::max(0.0, 1 - r / support);
    return 5 / (smoothing * smoothing) * t * t * t;
}

// What half a lattice behind a flat face adds to a point at distance a before it: the lattice goes on behind the
// face as it ends before it, aligned with the point.
class LatticeBehindFace {
public:
    explicit LatticeBehindFace(bool planar) {
        for (int k = 0; k <= count; ++k) {
            const double a = support * k / count;
            for (double z = a + 0.5; z < support; z += 1)
                for (int i = -3; i <= 3; ++i)
                    for (int j = planar ? 0 : -3; j <= (planar ? 0 : 3); ++j) {
                        const double r = std::sqrt(z * z + i * i + j * j);
                        push_[k] += kernel_factor(planar) * shape_of_slope(r) * z;
                        density_[k] += kernel_factor(planar) * shape_of_kernel(r);
                    }
        }
    }
    double push(double a) const { return read(push_, a); }   // away from the face
    double density(double a) const { return read(density_, a); }

private:
    // 1040 intervals put the lattice's distances (k + 1/2) on nodes, so that a lattice stays exactly.
    static constexpr int count = 1040;
    static double read(const double* table, double a) {
        const double place = std::clamp(a / support, 0.0, 1.0) * count;
        const int k = std::min(int(place + 1e-9), count - 1);
        return table[k] + (place - k) * (table[k + 1] - table[k]);
    }
    double push_[count + 1] = {}, density_[count + 1] = {};
};

// What the lattices behind two faces across each other add twice: the point is at a before the one and at b before the other,
// whose normals point out.
struct BehindBothFaces {
    Vec3 push{};
    double density = 0;
};
inline BehindBothFaces behind_both_faces(double a, const Vec3& out_of_a, double b, const Vec3& out_of_b, bool planar) {
    BehindBothFaces both;
    const double factor = kernel_factor(planar);
    for (double u = std::max(0.0, a) + 0.5; u < support; u += 1)
        for (double v = std::max(0.0, b) + 0.5; v < support; v += 1)
            for (int w = planar ? 0 : -2; w <= (planar ? 0 : 2); ++w) {
                const double r = std::sqrt(u * u + v * v + w * w);
                both.push += -factor * shape_of_slope(r) * (u * out_of_a + v * out_of_b);
                both.density += factor * shape_of_kernel(r);
            }
    return both;
}

inline double lattice_density(bool planar) {
    double sum = 0;
    for (int i = -3; i <= 3; ++i)
        for (int j = -3; j <= 3; ++j)
            for (int k = planar ? 0 : -3; k <= (planar ? 0 : 3); ++k)
                sum += kernel_factor(planar) * shape_of_kernel(std::sqrt(double(i * i + j * j + k * k)));
    return sum;
}

}   // namespace patency::relaxation
