// SPDX-License-Identifier: Apache-2.0
#include "patency/report/view.h"

#include <algorithm>
#include <array>

#include "patency/base/symmetric_eigen.h"

namespace patency {

namespace {

/// Turned so that its largest component is positive: then the same vessel is not seen upside down for a rounding error.
Vec3 positive(const Vec3& v) {
    const Vec3 a{std::abs(v.x), std::abs(v.y), std::abs(v.z)};
    const double largest = a.x >= a.y && a.x >= a.z ? v.x : a.y >= a.z ? v.y : v.z;
    return largest < 0 ? -v : v;
}

}   // namespace

View broad_view(std::span<const Vec3> points) {
    if (points.size() < 3) return {};
    Vec3 mean{};
    for (const Vec3& x : points) mean += x / double(points.size());
    Mat3 spread{};
    for (const Vec3& x : points) spread = spread + outer(x - mean, x - mean);
    const SymmetricEigen e = symmetric_eigen(spread);
    std::array<std::pair<double, Vec3>, 3> axes = {
        {{e.values.x, e.vectors.x}, {e.values.y, e.vectors.y}, {e.values.z, e.vectors.z}}};
    std::sort(axes.begin(), axes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    const Vec3 right = positive(axes[0].second), up = positive(axes[1].second);
    return {right, up, cross(right, up)};
}

}   // namespace patency
