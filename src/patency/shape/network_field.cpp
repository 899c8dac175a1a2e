// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/network_field.h"

#include <algorithm>
#include <cmath>

namespace patency {

namespace {

constexpr std::size_t run_length = 8;   // pieces; a compromise between spheres and pieces to look at
constexpr double largest_jump = 1.5;    // the radius, and so the field, may jump where two pieces are equally near

}   // namespace

TubeField::TubeField(const Tube& tube)
    : points_(tube.points), radii_(tube.radii), bounds_{tube.points[0], tube.points[0]} {
    for (std::size_t k = 0; k < points_.size(); ++k) {
        largest_radius_ = std::max(largest_radius_, radii_[k]);
        bounds_ = joined(bounds_, grown({points_[k], points_[k]}, radii_[k]));
        if (k > 0)
            steepest_ = std::max(steepest_, largest_jump * std::hypot(1, (radii_[k] - radii_[k - 1]) /
                                                                             norm(points_[k] - points_[k - 1])));
    }
    for (std::size_t first = 0; first + 1 < points_.size(); first += run_length) {
        const std::size_t last = std::min(first + run_length, points_.size() - 1);
        const Vec3 centre = 0.5 * (points_[first] + points_[last]);
        double reach = 0;
        for (std::size_t k = first; k <= last; ++k) reach = std::max(reach, norm(points_[k] - centre));
        runs_.push_back({first, last, centre, reach});
    }
}

TubeField::Nearest TubeField::nearest(const Vec3& x) const {
    Nearest best{Bounds::infinity, radii_[0]};
    const auto look_at = [&](const Run& run) {
        for (std::size_t k = run.first; k < run.last; ++k) {
            const Vec3 piece = points_[k + 1] - points_[k], d = x - points_[k];
            const double share = std::clamp(dot(d, piece) / dot(piece, piece), 0.0, 1.0);
            const Vec3 beside = d - share * piece;
            const double squared = dot(beside, beside);
            if (squared < best.squared_distance) best = {squared, radii_[k] + share * (radii_[k + 1] - radii_[k])};
        }
    };
    // First the run whose centre is nearest, then those that may hold something nearer.
    const Run* start = &runs_[0];
    double least = Bounds::infinity;
    for (const Run& run : runs_) {
        const Vec3 d = x - run.centre;
        if (dot(d, d) < least) least = dot(d, d), start = &run;
    }
    look_at(*start);
    for (const Run& run : runs_) {
        const Vec3 d = x - run.centre;
        const double bound = std::sqrt(best.squared_distance) + run.reach;
        if (&run != start && dot(d, d) < bound * bound) look_at(run);
    }
    return best;
}

double TubeField::value(const Vec3& x, double ceiling) const {
    const Vec3 middle{std::clamp(x.x, bounds_.low.x, bounds_.high.x), std::clamp(x.y, bounds_.low.y, bounds_.high.y),
                      std::clamp(x.z, bounds_.low.z, bounds_.high.z)};
    const double outside = norm(x - middle);   // if it is not 0, no point of the tube is nearer
    if (outside > 0 && outside > ceiling) return outside;
    const Nearest found = nearest(x);
    return std::sqrt(found.squared_distance) - found.radius;
}

double TubeField::distance_from_axis(const Vec3& x) const { return std::sqrt(nearest(x).squared_distance); }

NetworkField::NetworkField(const Network& network)
    : tubes_(network.tubes.begin(), network.tubes.end()), blend_(network.blend), bounds_(tubes_.at(0).bounds()) {
    for (const TubeField& tube : tubes_) {
        steepest_ = std::max(steepest_, tube.steepest());
        bounds_ = joined(bounds_, tube.bounds());
    }
    bounds_ = grown(bounds_, blend_);
}

double NetworkField::value(const Vec3& x) const {
    double a = tubes_[0].value(x);
    for (std::size_t k = 1; k < tubes_.size(); ++k) {
        const double b = tubes_[k].value(x, a + blend_);
        if (b >= a + blend_) continue;
        const double h = blend_ > 0 ? std::clamp(0.5 + 0.5 * (a - b) / blend_, 0.0, 1.0) : 1;
        a = a * (1 - h) + b * h - blend_ * h * (1 - h);
    }
    return a;
}

}   // namespace patency
