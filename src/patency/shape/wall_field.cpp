// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/wall_field.h"

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/shape/wall_thickness.h"

namespace patency {

namespace {

/// The points of all lines by how far they are from a stretch of one of them.
class Part {
public:
    Part(const BranchedLines& lines, const WallSettings& settings) : lines_(lines) {
        for (std::size_t j = 0; j < lines.lines.size(); ++j) {
            has_.emplace_back();
            for (std::size_t k = 0; k < lines.lines[j].points.size(); ++k)
                has_[j].push_back(way_to(j, k, settings) <= settings.reach);
        }
        while (take_bifurcations()) {}
    }

    bool has(std::size_t j, std::size_t k) const { return has_[j][k]; }

private:
    /// Along the tree [m], from the point to the stretch.
    double way_to(std::size_t j, std::size_t k, const WallSettings& s) const {
        const Centreline &own = lines_.lines[s.line], &line = lines_.lines[j];
        const auto to_stretch = [&](double arc) { return std::max({0.0, s.from - arc, arc - s.to}); };
        const double arc = line.points[k].arc;
        if (j == s.line) return to_stretch(arc);
        const std::size_t shared = std::max<std::size_t>(1, shared_points(own, line));
        const double parting = own.points[shared - 1].arc;
        return k < shared ? to_stretch(arc) : to_stretch(parting) + arc - parting;
    }

    /// A bifurcation is cut by no plane, nor is its crotch, where the walls of two branches are one: what comes within a diameter of one has all
    /// of it and a diameter more. Whether something came in.
    bool take_bifurcations() {
        std::vector<char> reached;
        const auto bifurcation = [&](std::size_t j, std::size_t k) { return lines_.bifurcation_ids[j][k]; };
        const auto is_near = [&](std::size_t j, std::size_t k) {
            const auto& points = lines_.lines[j].points;
            for (std::size_t m = 0; m < points.size(); ++m)
                if (has_[j][m] && std::abs(points[m].arc - points[k].arc) <= 2 * points[k].radius) return true;
            return false;
        };
        for (std::size_t j = 0; j < has_.size(); ++j)
            for (std::size_t k = 0; k < has_[j].size(); ++k)
                if (const int b = bifurcation(j, k); b >= 0 && is_near(j, k)) {
                    if (reached.size() <= std::size_t(b)) reached.resize(std::size_t(b) + 1);
                    reached[std::size_t(b)] = 1;
                }
        const auto is_reached = [&](int b) {
            return b >= 0 && std::size_t(b) < reached.size() && reached[std::size_t(b)];
        };
        bool is_new = false;
        for (std::size_t j = 0; j < has_.size(); ++j) {
            const auto& points = lines_.lines[j].points;
            for (std::size_t k = 0; k < points.size(); ++k) {
                if (!is_reached(bifurcation(j, k))) continue;
                for (std::size_t m = 0; m < points.size(); ++m)
                    if (!has_[j][m] && std::abs(points[m].arc - points[k].arc) <= 2 * points[k].radius)
                        has_[j][m] = 1, is_new = true;
            }
        }
        return is_new;
    }

    const BranchedLines& lines_;
    std::vector<std::vector<char>> has_;
};

/// A point of a centreline, as the field needs it.
struct Station {
    Vec3 place;
    double radius, thickness;   // of the healthy lumen, of its wall
    bool is_inside;
    int end;                           // index of an end within two diameters along the line, or -1
    std::vector<std::size_t> next{};   // stations beside it along the lines, to one side
};

/// To the spheres between two that are given, their radii linear between: the round cone around both.
double distance_to_cone(const Vec3& x, const Station& a, const Station& b) {
    const Vec3 axis = b.place - a.place, d = x - a.place;
    const double length = norm(axis), along = dot(d, axis) / length,
                 across = std::sqrt(std::max(0.0, dot(d, d) - along * along));
    const double slope = std::clamp((b.radius - a.radius) / length, -0.99, 0.99);   // sine of half the cone's angle
    const double t = std::clamp((along + across * slope / std::sqrt(1 - slope * slope)) / length, 0.0, 1.0);
    return std::hypot(along - t * length, across) - (1 - t) * a.radius - t * b.radius;
}

}   // namespace

class WallField::Impl {
public:
    Impl(const BranchedLines& lines, const std::vector<std::vector<double>>& healthy,
         const std::vector<Vec3>& opening_normals, SignedDistance lumen, const WallSettings& settings)
        : lumen_(std::move(lumen)) {
        if (settings.thickness && !(*settings.thickness > 0)) throw GeometryError("A wall must have a thickness.");
        const Part part(lines, settings);
        for (std::size_t j = 0; j < lines.lines.size(); ++j) {
            const auto& points = lines.lines[j].points;
            const std::vector<int> end = find_ends(lines, part, healthy, opening_normals, j);
            std::size_t before = none;
            for (std::size_t k = 0; k < points.size(); ++k) {
                if (!part.has(j, k) && end[k] < 0) {   // far outside; what is nearest to an end decides there
                    before = none;
                    continue;
                }
                const double radius = 0.5 * healthy[j][k],
                             thickness = settings.thickness.value_or(coronary_wall_thickness(2 * radius));
                const std::size_t at = add_station({points[k].place, radius, thickness, part.has(j, k), end[k]});
                if (before != none && at > before) stations_[at].next.push_back(before);
                before = at;
                if (!part.has(j, k)) continue;
                thinnest_ = std::min(thinnest_, thickness);
                const Vec3 out =
                    (2 * std::max(radius, points[k].radius) + thickness) * Vec3{1, 1, 1};   // eccentric lumens too
                const Bounds box{points[k].place - out, points[k].place + out};
                bounds_ = is_empty_ ? box : joined(bounds_, box);
                is_empty_ = false;
            }
        }
        if (is_empty_) throw GeometryError("There is no vessel in the part whose wall is wanted.");
        is_filled_ = settings.is_filled;
    }

    WallPlace at(const Vec3& x) const {
        const Station* nearest = nullptr;
        double least = Bounds::infinity;   // to the healthy lumen's spheres
        for (const Station& s : stations_)
            if (const double d = norm(x - s.place) - s.radius; d < least) least = d, nearest = &s;
        double sum = 0, weights = 0, healthy = least;
        for (const Station& s : stations_) {
            const double over = norm(x - s.place) - s.radius - least, share = over / s.thickness;
            if (share < 3) {
                const double w = std::exp(-share * share);
                sum += w * s.thickness, weights += w;
            }
            if (is_filled_ && over < 0.5 * s.radius)
                for (const std::size_t next : s.next)
                    healthy = std::min(healthy, distance_to_cone(x, s, stations_[next]));
        }
        const DistanceSample lumen = lumen_.sample(x);
        WallPlace place{lumen.value, 0, sum / weights, 0, lumen.gradient, {}};
        place.healthy = is_filled_ ? std::min(place.lumen, healthy) : place.lumen;
        const double far = 2 * nearest->radius;
        if (least > far + nearest->thickness) {
            place.region = far;   // beside it: another vessel's
        } else if (nearest->end < 0) {
            place.region = nearest->is_inside ? -far : far;
        } else {
            const VesselEnd& end = ends_[std::size_t(nearest->end)];
            place.region = std::clamp(dot(x - end.centre, end.normal), -far, far);
            place.past_end = end.normal;
        }
        return place;
    }

    const SignedDistance& lumen() const { return lumen_; }
    const std::vector<VesselEnd>& ends() const { return ends_; }
    double thinnest() const { return thinnest_; }
    const Bounds& bounds() const { return bounds_; }

private:
    static constexpr std::size_t none = ~std::size_t(0);

    /// Its index; lines share points, bit for bit.
    std::size_t add_station(Station station) {
        for (std::size_t k = 0; k < stations_.size(); ++k)
            if (stations_[k].place == station.place) return k;
        stations_.push_back(std::move(station));
        return stations_.size() - 1;
    }
    int add_end(const VesselEnd& end) {
        for (std::size_t e = 0; e < ends_.size(); ++e)
            if (ends_[e].centre == end.centre) return int(e);
        ends_.push_back(end);
        return int(ends_.size()) - 1;
    }

    /// Per point of the line the end that is near it, or -1.
    std::vector<int> find_ends(const BranchedLines& lines, const Part& part,
                               const std::vector<std::vector<double>>& healthy, const std::vector<Vec3>& normals,
                               std::size_t j) {
        const auto& points = lines.lines[j].points;
        const std::size_t n = points.size();
        std::vector<int> near(n, -1);
        std::vector<double> way(n, Bounds::infinity);   // to it, along the line
        const auto add = [&](std::size_t k, const Vec3& normal, bool is_opening) {
            const double radius = 0.5 * healthy[j][k];
            const int e = add_end({points[k].place, normal, radius, is_opening});
            for (std::size_t m = 0; m < n; ++m)
                if (const double w = std::abs(points[m].arc - points[k].arc); w < std::min(way[m], 4 * radius))
                    near[m] = e, way[m] = w;
        };
        for (std::size_t k = 0; k + 1 < n; ++k) {
            if (part.has(j, k) && !part.has(j, k + 1)) add(k, points[k].tangent, false);
            if (!part.has(j, k) && part.has(j, k + 1)) add(k + 1, -points[k + 1].tangent, false);
        }
        if (part.has(j, 0)) add(0, normals.at(0), true);
        if (part.has(j, n - 1)) add(n - 1, normals.at(j + 1), true);
        return near;
    }

    SignedDistance lumen_;
    bool is_filled_ = false;
    std::vector<Station> stations_;
    std::vector<VesselEnd> ends_;
    double thinnest_ = Bounds::infinity;
    Bounds bounds_;
    bool is_empty_ = true;
};

WallField::WallField(const BranchedLines& lines, const std::vector<std::vector<double>>& healthy_diameter,
                     const std::vector<Vec3>& opening_normals, SignedDistance lumen, const WallSettings& settings)
    : impl_(std::make_shared<const Impl>(lines, healthy_diameter, opening_normals, std::move(lumen), settings)) {}

WallPlace WallField::at(const Vec3& x) const { return impl_->at(x); }

double WallField::value(const Vec3& x) const {
    const WallPlace p = at(x);
    return std::max({-p.lumen, std::min(p.lumen, p.healthy) - p.thickness, p.region});
}

SignedDistance WallField::wall() const {
    return {[field = *this, step = 1e-3 * thinnest()](const Vec3& x) {
                const WallPlace p = field.at(x);
                const double outer = std::min(p.lumen, p.healthy) - p.thickness;
                if (p.region >= std::max(-p.lumen, outer) && norm(p.past_end) > 0)
                    return DistanceSample{p.region, p.past_end, 0};
                if (-p.lumen >= outer) return DistanceSample{std::max(-p.lumen, p.region), -p.from_lumen, 0};
                if (p.lumen <= p.healthy) return DistanceSample{std::max(outer, p.region), p.from_lumen, 0};
                const auto rise = [&](const Vec3& e) { return field.at(x + step * e).healthy - p.healthy; };
                return DistanceSample{std::max(outer, p.region),
                                      normalized(Vec3{rise({1, 0, 0}), rise({0, 1, 0}), rise({0, 0, 1})}), 0};
            },
            bounds()};
}

const std::vector<VesselEnd>& WallField::ends() const { return impl_->ends(); }
double WallField::thinnest() const { return impl_->thinnest(); }
Bounds WallField::bounds() const { return impl_->bounds(); }
const SignedDistance& WallField::lumen() const { return impl_->lumen(); }

}   // namespace patency
