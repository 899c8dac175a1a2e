// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/network_field.h"

#include <algorithm>
#include <cmath>

namespace patency {

namespace {

constexpr double largest_jump = 1.5;   // the radius, and so the field, may jump where two pieces are equally near

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
        Run run{.first = first, .centre = centre, .reach = reach, .start = {}, .piece = {}, .square = {}};
        for (int n = 0; n < run_length; ++n) {
            const std::size_t k = std::min(first + std::size_t(n), last - 1);
            const Vec3 &start = points_[k], piece = points_[k + 1] - start;
            run.start.x.v[n] = start.x, run.start.y.v[n] = start.y, run.start.z.v[n] = start.z;
            run.piece.x.v[n] = piece.x, run.piece.y.v[n] = piece.y, run.piece.z.v[n] = piece.z;
            run.square.v[n] = dot(piece, piece);
        }
        runs_.push_back(run);
    }
}

TubeField::Nearest TubeField::nearest(const Vec3& x) const {
    Nearest best{Bounds::infinity, radii_[0]};
    const auto look_at = [&](const Run& run) {
        using P = Run::P;
        const Vec<P> d = Vec<P>{P(x.x), P(x.y), P(x.z)} - run.start;
        const P share = min(max(dot(d, run.piece) / run.square, P(0)), P(1));
        const Vec<P> beside = d - share * run.piece;
        const P squared = dot(beside, beside);
        for (int n = 0; n < run_length; ++n)
            if (squared[n] < best.squared_distance) {
                const std::size_t k = std::min(run.first + std::size_t(n), points_.size() - 2);
                best = {squared[n], radii_[k] + share[n] * (radii_[k + 1] - radii_[k])};
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
    double nearest_yet = std::sqrt(best.squared_distance);   // a root per run would take longer than all else
    for (const Run& run : runs_) {
        const Vec3 d = x - run.centre;
        const double bound = nearest_yet + run.reach;
        if (&run == start || !(dot(d, d) < bound * bound)) continue;
        look_at(run);
        nearest_yet = std::sqrt(best.squared_distance);
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
