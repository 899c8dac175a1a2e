// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/stent_import.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/shape/surface_check.h"

namespace patency {

namespace {

constexpr double largest_asymmetry = 0.05;   // of moments across the axis; crowns around it leave none
constexpr double facing = 0.9;               // cosine from which on a face looks out or in

struct Moments {
    Vec3 centre;
    Eigen::Matrix3d second;   // about the centre, per area
};

// Of the surface; a triangle's are exact.
Moments moments(const Surface& surface) {
    double sum = 0;
    Vec3 first{};
    Mat3 second{};
    for (const Triangle& t : surface.triangles) {
        const double a = norm(area_vector(surface, t));
        const Vec3 c = centroid(surface, t);
        sum += a;
        first += a * c;
        Mat3 corners = 9.0 * outer(c, c);
        for (std::uint32_t p : t) corners += outer(surface.points[p], surface.points[p]);
        second += (a / 12) * corners;
    }
    const Vec3 centre = first / sum;
    const Mat3 m = (1 / sum) * second + (-1.0) * outer(centre, centre);
    Eigen::Matrix3d matrix;
    matrix << m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z;
    return {centre, matrix};
}

}   // namespace

ImportedStent recognise_stent(Surface read) {
    CheckedSurface checked = check_surface(std::move(read));
    if (const std::string why = refusals(checked.findings); !why.empty())
        throw GeometryError("The surface cannot be used as a stent:\n" + why);
    Surface surface = std::move(checked.surface);
    if (!checked.ends.empty() || !(checked.volume > 0))
        throw GeometryError("The surface is open: a stent's metal must be closed.");

    const Moments m = moments(surface);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m.second);
    const Eigen::Vector3d& value = solver.eigenvalues();
    const auto asymmetry_about = [&](int k) {
        const double a = value[(k + 1) % 3], b = value[(k + 2) % 3];
        return std::abs(a - b) / (a + b);
    };
    const int axis = asymmetry_about(0) < asymmetry_about(2) ? 0 : 2;   // the middle one cannot stand out
    const double asymmetry = asymmetry_about(axis);
    if (!(asymmetry < largest_asymmetry))
        throw GeometryError(
            fmt::format("The surface has no axis as a stent has: across the most likely one its moments differ by "
                        "{:.0f} %, at most {:.0f} % are allowed.",
                        100 * asymmetry, 100 * largest_asymmetry));
    const Eigen::Vector3d along = solver.eigenvectors().col(axis);
    Vec3 direction{along[0], along[1], along[2]};
    if (direction.x + direction.y + direction.z < 0) direction = -direction;

    RigidMotion placement = motion_along(direction, m.centre);
    double low = Bounds::infinity, high = -Bounds::infinity, radius = 0;
    for (Vec3& x : surface.points) {
        x = placement.place_back(x);
        low = std::min(low, x.x), high = std::max(high, x.x), radius = std::max(radius, std::hypot(x.y, x.z));
    }
    const Vec3 middle{0.5 * (low + high), 0, 0};
    for (Vec3& x : surface.points) x = x - middle;
    placement.origin = placement.place(middle);
    if (2 * radius < 0.5e-3 || 2 * radius > 50e-3)
        throw GeometryError(fmt::format("The stent would be {:.3g} mm wide. Is the unit right?", 2e3 * radius));

    double face[2] = {0, 0}, sum[2] = {0, 0};   // looking in, looking out
    for (const Triangle& t : surface.triangles) {
        const Vec3 a = area_vector(surface, t), c = centroid(surface, t);
        const double size = norm(a), across = std::hypot(c.y, c.z);
        if (!(size > 0) || !(across > 0)) continue;
        const double cosine = (a.y * c.y + a.z * c.z) / (size * across);
        if (std::abs(cosine) < facing) continue;
        for (std::uint32_t p : t) sum[cosine > 0] += size / 3 * std::hypot(surface.points[p].y, surface.points[p].z);
        face[cosine > 0] += size;
    }
    const double thickness = face[0] > 0 && face[1] > 0 ? sum[1] / face[1] - sum[0] / face[0] : 0;
    if (!(thickness > 0)) throw GeometryError("The surface has no inner and outer face: a stent is a cut tube.");
    const double a = area(surface);
    return {std::move(surface), placement, 2 * radius, high - low, thickness, checked.volume, a, asymmetry};
}

}   // namespace patency
