// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/distance_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"

namespace patency {

namespace {

constexpr double infinity = Bounds::infinity;

// The distance to a polyline in the (axial, radial) half-plane, or in a plane: value and slopes there.
struct PlaneSample {
    double value, axial_slope, radial_slope, curvature;
};

struct Segment {
    double a, r;        // start
    double ua, ur;      // unit direction; outside lies to its left
    double length;      // may be infinite
    double first = 0;   // where it begins: minus infinity for the first ray, else 0
};

// Nearest point of all segments. Inside is told by the caller, as is the scale below which a distance is zero.
PlaneSample nearest(const std::vector<Segment>& segments, double a, double r, bool inside, double zero) {
    double best = infinity, best_da = 0, best_dr = 0;
    const Segment* segment = nullptr;
    bool corner = false;
    for (const Segment& s : segments) {
        const double along = (a - s.a) * s.ua + (r - s.r) * s.ur;
        const double t = std::clamp(along, s.first, s.length);
        double da, dr;
        if (t == along) {   // the foot of the perpendicular: use the normal, which has no cancellation
            const double d = (r - s.r) * s.ua - (a - s.a) * s.ur;
            da = -s.ur * d;
            dr = s.ua * d;
        } else {
            da = a - (s.a + t * s.ua);
            dr = r - (s.r + t * s.ur);
        }
        const double square = da * da + dr * dr;
        if (square < best) {
            best = square;
            best_da = da;
            best_dr = dr;
            segment = &s;
            corner = t != along;
        }
    }
    const double distance = std::sqrt(best), sign = inside ? -1 : 1;
    if (!corner || distance <= zero) return {sign * distance, -segment->ur, segment->ua, 0};
    return {sign * distance, sign * best_da / distance, sign * best_dr / distance, sign / distance};
}

void check_outline(const std::vector<AxialRadius>& outline) {
    if (outline.empty()) throw GeometryError("A body of revolution needs at least one point of its outline.");
    for (std::size_t k = 0; k < outline.size(); ++k) {
        if (!std::isfinite(outline[k].axial) || !(outline[k].radius >= 0) || !std::isfinite(outline[k].radius))
            throw GeometryError(
                fmt::format("Point {} of the outline is at {} m with radius {} m: both must be finite "
                            "and the radius not negative.",
                            k + 1, outline[k].axial, outline[k].radius));
        if (k > 0 && outline[k].axial < outline[k - 1].axial)
            throw GeometryError(
                fmt::format("The outline goes back at point {} (from {} m to {} m): order the points "
                            "along the axis.",
                            k + 1, outline[k - 1].axial, outline[k].axial));
    }
}

// The radius of the outline at a; beyond the ends the first and the last.
double radius_at(const std::vector<AxialRadius>& outline, double a) {
    if (a <= outline.front().axial) return outline.front().radius;
    const auto next = std::upper_bound(outline.begin(), outline.end(), a,
                                       [](double value, const AxialRadius& p) { return value < p.axial; });
    if (next == outline.end()) return outline.back().radius;
    const AxialRadius &p = *(next - 1), &q = *next;
    return p.radius + (q.radius - p.radius) * (a - p.axial) / (q.axial - p.axial);
}

// A round cone as the spheres at start + t axis, 0 <= t <= length, of radius - sine t.
struct SphereRow {
    Vec3 start, axis, aside;   // aside: any unit vector across the axis
    double length, radius;
    double sine, cosine;   // of the angle between the axis and the wall
};

SphereRow make_sphere_row(const RoundCone& p) {
    const double length = norm(p.end - p.start);
    if (length <= std::abs(p.start_radius - p.end_radius)) {   // one end's sphere holds the other's
        const bool start_holds = p.start_radius >= p.end_radius;
        return {start_holds ? p.start : p.end, {1, 0, 0}, {0, 1, 0}, 0, std::max(p.start_radius, p.end_radius), 0, 1};
    }
    const Vec3 axis = (p.end - p.start) / length;
    const Vec3 aside = normalized(cross(axis, std::abs(axis.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const double sine = (p.start_radius - p.end_radius) / length;
    return {p.start, axis, aside, length, p.start_radius, sine, std::sqrt(1 - sine * sine)};
}

DistanceSample sample_of(const SphereRow& row, const Vec3& x) {
    const Vec3 from_start = x - row.start;
    const double from_axis = norm(cross(row.axis, from_start));
    // The nearest sphere: d/dt (|x - c(t)| - r(t)) = 0.
    const double best = dot(from_start, row.axis) - row.sine / row.cosine * from_axis;
    const double t = std::clamp(best, 0.0, row.length);
    const Vec3 from_centre = from_start - t * row.axis;
    const double reach = norm(from_centre);
    const double value = reach - (row.radius - row.sine * t);
    if (reach == 0) return {value, row.aside, infinity};
    return {value, from_centre / reach, t == best ? row.cosine / from_axis : 2 / reach};
}

}   // namespace

SignedDistance everywhere() {
    return {[](const Vec3&) { return DistanceSample{-infinity, {}, 0}; }, Bounds{}};
}

SignedDistance half_space(const Vec3& point, const Vec3& normal) {
    const Vec3 n = normalized(normal);
    return {[point, n](const Vec3& x) { return DistanceSample{dot(x - point, n), n, 0}; }, Bounds{}};
}

SignedDistance box_between(const Vec3& low, const Vec3& high, std::array<bool, 3> walled) {
    const Vec3 centre = 0.5 * (low + high), half = 0.5 * (high - low);
    Bounds bounds;
    if (walled[0]) bounds.low.x = low.x, bounds.high.x = high.x;
    if (walled[1]) bounds.low.y = low.y, bounds.high.y = high.y;
    if (walled[2]) bounds.low.z = low.z, bounds.high.z = high.z;
    if (!walled[0] && !walled[1] && !walled[2]) return everywhere();
    return {[=](const Vec3& x) {
                const double offset[3] = {x.x - centre.x, x.y - centre.y, x.z - centre.z};
                const double size[3] = {half.x, half.y, half.z};
                double beyond[3];   // distance past the nearer of the two walls of an axis
                double square = 0, deepest = -infinity;
                int outside = 0, nearest_axis = 0;
                for (int k = 0; k < 3; ++k) {
                    beyond[k] = walled[k] ? std::abs(offset[k]) - size[k] : -infinity;
                    if (beyond[k] > deepest) deepest = beyond[k], nearest_axis = k;
                    if (beyond[k] > 0) square += beyond[k] * beyond[k], ++outside;
                }
                double g[3] = {0, 0, 0};
                if (outside <= 1) {   // a face is nearest
                    g[nearest_axis] = offset[nearest_axis] < 0 ? -1 : 1;
                    return DistanceSample{deepest, {g[0], g[1], g[2]}, 0};
                }
                const double distance = std::sqrt(square);   // an edge or a corner is nearest
                for (int k = 0; k < 3; ++k)
                    if (beyond[k] > 0) g[k] = std::copysign(beyond[k] / distance, offset[k]);
                return DistanceSample{distance, {g[0], g[1], g[2]}, (outside - 1) / distance};
            },
            bounds};
}

SignedDistance gap_between_plates(double gap) { return box_between({}, {0, gap, 0}, {false, true, false}); }

SignedDistance stepped_gap(double gap, double height, double at) {
    const std::vector<Segment> segments = {{0, gap, 1, 0, infinity, -infinity},   // above
                                           {at, height, -1, 0, infinity},         // below, ahead of the step
                                           {at, 0, 0, 1, height},                 // the step
                                           {at, 0, -1, 0, 0, -infinity}};         // below, behind it
    const Bounds bounds{{-infinity, 0, -infinity}, {infinity, gap, infinity}};
    return {[=](const Vec3& x) {
                const PlaneSample s =
                    nearest(segments, x.x, x.y, x.y < gap && x.y > (x.x < at ? height : 0), 1e-14 * gap);
                return DistanceSample{s.value, {s.axial_slope, s.radial_slope, 0}, s.curvature};
            },
            bounds};
}

SignedDistance body_of_revolution(std::vector<AxialRadius> outline, TubeEnds ends) {
    check_outline(outline);
    std::vector<Segment> segments;
    const auto join = [&](const AxialRadius& p, const AxialRadius& q) {
        const double da = q.axial - p.axial, dr = q.radius - p.radius, length = std::hypot(da, dr);
        if (length > 0) segments.push_back({p.axial, p.radius, da / length, dr / length, length});
    };
    const AxialRadius first = outline.front(), last = outline.back();
    if (ends == TubeEnds::open)
        segments.push_back({first.axial, first.radius, 1, 0, 0, -infinity});
    else
        join({first.axial, 0}, first);
    for (std::size_t k = 1; k < outline.size(); ++k) join(outline[k - 1], outline[k]);
    if (ends == TubeEnds::open)
        segments.push_back({last.axial, last.radius, 1, 0, infinity});
    else
        join(last, {last.axial, 0});

    double largest = 0;
    for (const AxialRadius& p : outline) largest = std::max(largest, p.radius);
    const double zero = 1e-14 * largest;
    const bool open = ends == TubeEnds::open;
    const Bounds bounds{{open ? -infinity : first.axial, -largest, -largest},
                        {open ? infinity : last.axial, largest, largest}};
    return {[outline = std::move(outline), segments = std::move(segments), first, last, open, zero](const Vec3& x) {
                const double r = std::hypot(x.y, x.z);
                const bool between = open || (x.x > first.axial && x.x < last.axial);
                const PlaneSample s = nearest(segments, x.x, r, between && r < radius_at(outline, x.x), zero);
                // On the axis every radial direction is as good as another.
                const Vec3 radial = r > 0 ? Vec3{0, x.y / r, x.z / r} : Vec3{0, 1, 0};
                return DistanceSample{s.value, s.axial_slope * Vec3{1, 0, 0} + s.radial_slope * radial,
                                      s.curvature + (s.radial_slope == 0 ? 0 : s.radial_slope / r)};
            },
            bounds};
}

SignedDistance round_tube(double radius) { return body_of_revolution({{0, radius}}, TubeEnds::open); }

SignedDistance union_of_round_cones(const std::vector<RoundCone>& pieces) {
    if (pieces.empty()) throw GeometryError("A vessel network needs at least one piece.");
    Bounds bounds{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    std::vector<SphereRow> rows;
    for (const RoundCone& p : pieces) {
        if (!(p.start_radius > 0) || !(p.end_radius > 0))
            throw GeometryError(fmt::format("A vessel piece has radii {} m and {} m: both must be positive.",
                                            p.start_radius, p.end_radius));
        bounds = joined(bounds, grown({p.start, p.start}, p.start_radius));
        bounds = joined(bounds, grown({p.end, p.end}, p.end_radius));
        rows.push_back(make_sphere_row(p));
    }
    return {[rows = std::move(rows)](const Vec3& x) {
                DistanceSample best = sample_of(rows.front(), x);
                for (std::size_t k = 1; k < rows.size(); ++k) {
                    const DistanceSample s = sample_of(rows[k], x);
                    if (s.value < best.value) best = s;
                }
                return best;
            },
            bounds};
}

}   // namespace patency
