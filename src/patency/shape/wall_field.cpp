// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/wall_field.h"

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/shape/distance_shapes.h"
#include "patency/shape/wall_thickness.h"

namespace patency {

namespace {

/// The points of all lines by how far they are from a stretch of one of them.
class Part {
public:
    Part(const BranchedLines& lines, const WallSettings& settings) : lines_(lines) {
        for (std::size_t j = 0; j < lines.lines.size(); ++j) {
            has_.emplace_back();
            for (std::size_t k = 0; k < lines.lines[j].points.size(); ++k) has_[j].push_back(way_to(j, k, settings) <= settings.reach);
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

    /// A bifurcation is cut by no plane: what reaches into one has all of it and a radius more. Whether something came in.
    bool take_bifurcations() {
        std::vector<char> reached;
        const auto bifurcation = [&](std::size_t j, std::size_t k) { return lines_.bifurcation_ids[j][k]; };
        for (std::size_t j = 0; j < has_.size(); ++j)
            for (std::size_t k = 0; k < has_[j].size(); ++k)
                if (const int b = bifurcation(j, k); b >= 0 && has_[j][k]) {
                    if (reached.size() <= std::size_t(b)) reached.resize(std::size_t(b) + 1);
                    reached[std::size_t(b)] = 1;
                }
        const auto is_reached = [&](int b) { return b >= 0 && std::size_t(b) < reached.size() && reached[std::size_t(b)]; };
        bool is_new = false;
        for (std::size_t j = 0; j < has_.size(); ++j) {
            const auto& points = lines_.lines[j].points;
            for (std::size_t k = 0; k < points.size(); ++k) {
                if (!is_reached(bifurcation(j, k))) continue;
                for (std::size_t m = 0; m < points.size(); ++m)
                    if (!has_[j][m] && std::abs(points[m].arc - points[k].arc) <= points[k].radius) has_[j][m] = 1, is_new = true;
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
    int end;                    // index of an end within two diameters along the line, or -1
};

}   // namespace

class WallField::Impl {
public:
    Impl(const BranchedLines& lines, const std::vector<std::vector<double>>& healthy, const std::vector<Vec3>& opening_normals, SignedDistance lumen,
         const WallSettings& settings)
        : lumen_(std::move(lumen)) {
        if (settings.thickness && !(*settings.thickness > 0)) throw GeometryError("A wall must have a thickness.");
        const Part part(lines, settings);
        std::vector<RoundCone> cones;
        for (std::size_t j = 0; j < lines.lines.size(); ++j) {
            const auto& points = lines.lines[j].points;
            const std::vector<int> end = find_ends(lines, part, healthy, opening_normals, j);
            for (std::size_t k = 0; k < points.size(); ++k) {
                const double radius = 0.5 * healthy[j][k];
                if (!part.has(j, k) && end[k] < 0) continue;   // far outside; what is nearest to an end decides there
                const double thickness = settings.thickness.value_or(coronary_wall_thickness(2 * radius));
                const bool is_known = std::any_of(stations_.begin(), stations_.end(), [&](const Station& s) { return s.place == points[k].place; });
                if (!is_known) stations_.push_back({points[k].place, radius, thickness, part.has(j, k), end[k]});
                if (k > 0 && settings.is_filled && !is_known)
                    cones.push_back({points[k - 1].place, points[k].place, 0.5 * healthy[j][k - 1], radius});
                if (part.has(j, k)) {
                    thinnest_ = std::min(thinnest_, thickness);
                    const double out = 2 * std::max(radius, points[k].radius) + thickness;   // eccentric lumens too
                    bounds_ = is_empty_ ? Bounds{points[k].place - out * Vec3{1, 1, 1}, points[k].place + out * Vec3{1, 1, 1}}
                                        : joined(bounds_, {points[k].place - out * Vec3{1, 1, 1}, points[k].place + out * Vec3{1, 1, 1}});
                    is_empty_ = false;
                }
            }
        }
        if (is_empty_) throw GeometryError("There is no vessel in the part whose wall is wanted.");
        if (!cones.empty()) healthy_ = union_of_round_cones(std::move(cones));
    }

    WallPlace at(const Vec3& x) const {
        // Distances to the healthy lumen's spheres; the thickness is a mean over those near the least.
        const Station* nearest = nullptr;
        double least = Bounds::infinity;
        for (const Station& s : stations_)
            if (const double d = norm(x - s.place) - s.radius; d < least) least = d, nearest = &s;
        double sum = 0, weights = 0;
        for (const Station& s : stations_) {
            const double over = (norm(x - s.place) - s.radius - least) / s.thickness;
            if (over > 4) continue;
            const double w = std::exp(-over * over);
            sum += w * s.thickness, weights += w;
        }
        WallPlace place{lumen_.value(x), 0, sum / weights, 0};
        place.healthy = healthy_ ? std::min(place.lumen, healthy_->value(x)) : place.lumen;
        const double far = 2 * nearest->radius;
        if (nearest->end < 0) {
            place.region = nearest->is_inside ? -far : far;
        } else {
            const VesselEnd& end = ends_[std::size_t(nearest->end)];
            place.region = std::clamp(dot(x - end.centre, end.normal), -far, far);
        }
        return place;
    }

    const SignedDistance& lumen() const { return lumen_; }
    const std::vector<VesselEnd>& ends() const { return ends_; }
    double thinnest() const { return thinnest_; }
    const Bounds& bounds() const { return bounds_; }

private:
    int add_end(const VesselEnd& end) {
        for (std::size_t e = 0; e < ends_.size(); ++e)
            if (ends_[e].centre == end.centre) return int(e);
        ends_.push_back(end);
        return int(ends_.size()) - 1;
    }

    /// Per point of the line the end that is near it, or -1.
    std::vector<int> find_ends(const BranchedLines& lines, const Part& part, const std::vector<std::vector<double>>& healthy, const std::vector<Vec3>& normals,
                               std::size_t j) {
        const auto& points = lines.lines[j].points;
        const std::size_t n = points.size();
        std::vector<int> near(n, -1);
        const auto add = [&](std::size_t k, const Vec3& normal, bool is_opening) {
            const double radius = 0.5 * healthy[j][k];
            const int e = add_end({points[k].place, normal, radius, is_opening});
            for (std::size_t m = 0; m < n; ++m)
                if (std::abs(points[m].arc - points[k].arc) < 4 * radius) near[m] = e;
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
    std::optional<SignedDistance> healthy_;
    std::vector<Station> stations_;
    std::vector<VesselEnd> ends_;
    double thinnest_ = Bounds::infinity;
    Bounds bounds_;
    bool is_empty_ = true;
};

WallField::WallField(const BranchedLines& lines, const std::vector<std::vector<double>>& healthy_diameter, const std::vector<Vec3>& opening_normals,
                     SignedDistance lumen, const WallSettings& settings)
    : impl_(std::make_shared<const Impl>(lines, healthy_diameter, opening_normals, std::move(lumen), settings)) {}

WallPlace WallField::at(const Vec3& x) const { return impl_->at(x); }

double WallField::value(const Vec3& x) const {
    const WallPlace p = at(x);
    return std::max({-p.lumen, std::min(p.lumen, p.healthy) - p.thickness, p.region});
}

SignedDistance WallField::wall() const {
    const double step = 1e-3 * thinnest();
    return {[field = *this, step](const Vec3& x) {
                DistanceSample sample{field.value(x), {}, 0};
                Vec3 slope{};
                const auto along = [&](const Vec3& e) { return (field.value(x + step * e) - field.value(x - step * e)) / (2 * step); };
                slope = {along({1, 0, 0}), along({0, 1, 0}), along({0, 0, 1})};
                sample.gradient = norm(slope) > 0 ? normalized(slope) : Vec3{1, 0, 0};
                return sample;
            },
            bounds()};
}

const std::vector<VesselEnd>& WallField::ends() const { return impl_->ends(); }
double WallField::thinnest() const { return impl_->thinnest(); }
Bounds WallField::bounds() const { return impl_->bounds(); }
const SignedDistance& WallField::lumen() const { return impl_->lumen(); }

}   // namespace patency
