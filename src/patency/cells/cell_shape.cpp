// SPDX-License-Identifier: Apache-2.0
#include "patency/cells/cell_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"

namespace patency::cell_shapes {

namespace {

constexpr double first_half = 3;      // of the cube that a cell is cut from, in spacings: no even cell reaches so far
constexpr double first_reach = 2.2;   // of the search for neighbours, in spacings; grows until it is enough
constexpr double beside_wall = 1.5;   // nearer points are cut by the wall before anything else bounds them there
constexpr double clearance = 1e-3;    // a plane leaves at least this between itself and the point, in spacings
// How far a corner may reach out of the lumen before another plane cuts it off, in spacings. The tangent plane of a tube
// of radius R lets corners out by about 1/4R: smooth walls need one plane from four spacings of radius on.
constexpr double outside_allowed = 0.1;
constexpr int most_walls = 8;        // planes of one cell
constexpr double too_close = 1e-6;   // points, in spacings

}   // namespace

NearestWall find_wall(const Lumen& lumen, const Vec3& x, double scale) {
    const SignedDistance& distance = lumen.exact ? *lumen.exact : lumen.distance;
    const DistanceSample at = distance.sample(x);
    if (!std::isfinite(at.value)) return {Bounds::infinity, {}, x};
    Vec3 place = x - at.value * at.gradient, normal = at.gradient;
    // Where the distance is a bound only (unions), the place is short of the wall: go on to it.
    for (int step = 0; step < 8 && !lumen.exact; ++step) {
        const DistanceSample there = distance.sample(place);
        if (std::abs(there.value) < 1e-6 * scale) break;
        place += -there.value * there.gradient;
        normal = there.gradient;
    }
    const Vec3 way = place - x;
    const double length = norm(way);
    if (length > 1e-6 * scale) normal = (at.value < 0 ? 1 : -1) / length * way;
    return {at.value < 0 ? length : -length, normal, place};
}

void CellMaker::clip(const Plane& plane) {
    if (shape_.clip(plane.normal, plane.offset, -2 - int(planes_.size()))) planes_.push_back(plane);
}

void CellMaker::clip_by_openings() {
    const Lumen& lumen = cloud_.lumen;
    for (std::size_t k = 0; k < lumen.openings.size(); ++k) {
        const Opening& opening = lumen.openings[k];
        const auto [s, radial] = opening_coordinates(opening, centre_);
        if (s < -first_half * unit_ || s > unit_ || norm(radial) > opening.reach + unit_) continue;
        clip({opening.normal, std::max(-s / unit_, clearance), opening_label - int(k)});
    }
    if (lumen.planar)
        for (const double side : {-1.0, 1.0}) clip({{0, 0, side}, cloud_.half_depth / unit_, symmetry_label});
}

void CellMaker::clip_by_neighbours(std::uint32_t i) {
    double done = 0;
    for (double reach = first_reach; done < 4 * shape_.square_radius(); reach *= 1.5) {
        // What lies beyond the cube's corner cuts nothing.
        if (done > 4 * 3 * first_half * first_half) break;
        found_.clear();
        near_.clear();
        cloud_.tree.find(centre_, reach * unit_, found_);
        for (const std::uint32_t j : found_) {
            const Vec3 e = (cloud_.point[j] - centre_) / unit_;
            const double square = dot(e, e);
            if (j != i && square >= done) near_.push_back({square, j});
        }
        std::sort(near_.begin(), near_.end());
        for (const auto& [square, j] : near_) {
            if (square > 4 * shape_.square_radius()) break;
            const double r = std::sqrt(square);
            if (r < too_close) {
                const Vec3 x = 1e3 * centre_;
                throw GeometryError(
                    fmt::format("Two particles lie at the same place, ({:.4f}, {:.4f}, {:.4f}) mm.", x.x, x.y, x.z));
            }
            shape_.clip((cloud_.point[j] - centre_) / (r * unit_), 0.5 * r, int(j));
        }
        done = reach * reach;
    }
}

/// The plane of the wall at a corner that reaches out of the lumen; none (a length of 0) where it would cut the point itself off.
CellMaker::Plane CellMaker::wall_at(const Vec3& corner) const {
    const NearestWall wall = find_wall(cloud_.lumen, centre_ + unit_ * corner, unit_);
    const Vec3 place = (wall.place - centre_) / unit_;
    const Plane plane{wall.normal, dot(wall.normal, place), wall_label};
    // Round an edge of the wall that juts out the plane there may have the point itself behind it: then one across the
    // way from the point to the wall.
    constexpr double behind = 0.1;
    if (plane.offset >= behind) return plane;
    const double length = norm(place);
    return length > clearance ? Plane{place / length, length, wall_label} : Plane{};
}

/// Adds the plane of the wall at the corner that reaches out farthest, or else at the next one. Returns whether something was cut off.
bool CellMaker::clip_outermost_corner() {
    std::vector<std::pair<double, Vec3>> outside;
    for (const Vec3& corner : shape_.corners()) {
        const double out = cloud_.lumen.distance.value(centre_ + unit_ * corner) / unit_;
        if (out > outside_allowed) outside.push_back({out, corner});
    }
    std::stable_sort(outside.begin(), outside.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    const std::size_t before = planes_.size();
    for (const auto& [out, corner] : outside) {
        if (const Plane plane = wall_at(corner); plane.offset > 0) clip(plane);
        if (planes_.size() > before) return true;
    }
    return false;
}

void CellMaker::clip_by_walls(const NearestWall& wall) {
    if (!(wall.distance / unit_ < std::sqrt(shape_.square_radius()))) return;
    if (wall.distance > beside_wall * unit_) clip({wall.normal, wall.distance / unit_, wall_label});
    for (int k = 1; k < most_walls; ++k)
        if (!clip_outermost_corner()) return;
}

double CellMaker::make(std::uint32_t i, const NearestWall& wall, std::vector<CellSide>& sides) {
    centre_ = cloud_.point[i];
    unit_ = cloud_.spacing[i];
    planes_.clear();
    shape_.reset(first_half, box_label);
    clip_by_openings();
    if (wall.distance <= beside_wall * unit_)
        clip({wall.normal, std::max(wall.distance / unit_, clearance), wall_label});
    clip_by_neighbours(i);
    clip_by_walls(wall);
    for (std::size_t f = 0; f < shape_.face_count(); ++f) {
        const PolyhedronFace face = shape_.face(f);
        if (face.label == box_label) {
            const Vec3 x = 1e3 * centre_;
            throw GeometryError(
                fmt::format("The particles leave a hole of more than {:.3g} mm at ({:.3f}, {:.3f}, {:.3f}) mm.",
                            1e3 * first_half * unit_, x.x, x.y, x.z));
        }
        const double area = unit_ * unit_ * norm(face.area);
        const Vec3 centroid = centre_ + unit_ * face.centroid;
        if (face.label >= 0)
            sides.push_back({face.label, area, centroid, {}, 0});
        else {
            const Plane& plane = planes_[std::size_t(-face.label - 2)];
            sides.push_back({plane.label, area, centroid, plane.normal, unit_ * plane.offset});
        }
    }
    return unit_ * unit_ * unit_ * shape_.volume().volume;
}

}   // namespace patency::cell_shapes
