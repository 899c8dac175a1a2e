// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/relax.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "patency/base/aligned.h"
#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/bodies/lattice_face.h"
#include "patency/pairs/sum_over_neighbours.h"

namespace patency {

using namespace relaxation;

namespace {

constexpr double skin = 0.3;              // rows hold neighbours this much farther than the support, in spacings
constexpr double farthest = 0.1;          // that a point goes in one step
constexpr double plane_clearance = 0.1;   // least distance to an opening's plane, in spacings
// A distance is linear around the place where it was asked: over so many spacings it errs by 0.0003 of one at a wall whose
// radius is four. A point asks every twentieth step or so.
constexpr double linear_within = 0.05;
constexpr int none = -1;

/// -sum_j grad W_ij and sum_j W_ij without their factors.
struct Push {
    static constexpr int own_extras = 0, extras = 0, sums = 4;
    template <class P>
    void operator()(const Pair<P>& pair, const Sample<P, 0>&, const Sample<P, 0>&, std::array<P, 4>& sum) const {
        const P slope = pair.t * pair.t * pair.t;
        sum[0] = fma(slope, pair.d.x, sum[0]);
        sum[1] = fma(slope, pair.d.y, sum[1]);
        sum[2] = fma(slope, pair.d.z, sum[2]);
        sum[3] = fma(slope * pair.t, fma(pair.t, P(-4), P(5)), sum[3]);
    }
};

class Relaxation {
public:
    Relaxation(std::span<Vec3> fluid, std::span<Vec3> wall, const Lumen& lumen, const RelaxSettings& settings)
        : lumen_(lumen),
          settings_(settings),
          face_(lumen.planar),
          factor_(kernel_factor(lumen.planar)),
          full_(lattice_density(lumen.planar)),
          outer_(settings.wall_thickness / settings.spacing),
          fluid_count_(fluid.size()),
          count_(fluid.size() + wall.size()),
          x_(count_),
          motion_(count_),
          push_(count_),
          density_(count_),
          fluid_(count_),
          opening_(count_),
          zone_(count_, Zone::lumen),
          seen_(count_) {
        std::vector<Vec3> given(fluid.begin(), fluid.end());
        given.insert(given.end(), wall.begin(), wall.end());
        for (Vec3& x : given) x *= 1 / settings.spacing;
        const auto order = sorter_.find_order(frame_around(given), 1, given);
        given_as_.assign(order.begin(), order.end());
        for_each_index(count_, [&](std::size_t i) {
            x_[i] = given[given_as_[i]];
            fluid_[i] = given_as_[i] < fluid_count_;
        });
    }

    RelaxQuality run() {
        double move = 0, mean_motion = Bounds::infinity;
        make_rows();
        find_zones();
        for_each_index(count_, [&](std::size_t i) { see(i); });
        for (int step = 0; step < settings_.steps && mean_motion > settings_.tolerance; ++step) {
            compute_push();
            move = advance();
            const double squares = sum_of(count_, [&](std::size_t i) { return dot(motion_[i], motion_[i]); });
            mean_motion = std::sqrt(squares / double(count_));
            if (2 * moved_since_rows() >= skin)
                make_rows();
            else
                place_records();
        }
        if (settings_.steps > 0) {
            settle();
            place_records();
        }
        compute_push();
        return quality(move);
    }

    void write(std::span<Vec3> fluid, std::span<Vec3> wall) const {
        for_each_index(count_, [&](std::size_t i) {
            const std::size_t k = given_as_[i];
            (k < fluid_count_ ? fluid[k] : wall[k - fluid_count_]) = position(i);
        });
    }

private:
    enum class Zone : char { lumen, past_opening, filler };   // behind the opening; up to the fluid's end; farther

    // A place in the sums: a point, or its image behind the face of a periodic axis.
    struct Place {
        std::uint32_t of;
        bool is_image = false;
        Vec3 shift{};
    };

    // What the distance said, where it was asked; in spacings.
    struct Seen {
        Vec3 at;
        double depth;
        Vec3 gradient;
        double good_for;   // so far from there nobody need ask again
    };

    Vec3 position(std::size_t i) const { return settings_.spacing * x_[i]; }

    Frame frame_around(std::span<const Vec3> places) const {
        Vec3 low = places[0], high = low;
        for (const Vec3& x : places) {
            low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
            high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
        }
        return {low - Vec3{1, 1, 1}, high + Vec3{1, 1, 1}, support + skin};
    }

    double moved_since_rows() const {
        return std::sqrt(largest_of(count_, [&](std::size_t i) {
            const Vec3 e = x_[i] - x_at_rows_[i];
            return dot(e, e);
        }));
    }

    // The points and their images, in no order.
    std::vector<Place> points_and_images() const {
        std::vector<Place> places(count_);
        for (std::size_t i = 0; i < count_; ++i) places[i].of = std::uint32_t(i);
        const double reach = support + skin;
        for (int axis = 0; axis < 3; ++axis) {
            const auto component = [axis](const Vec3& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
            const double period = component(lumen_.period) / settings_.spacing;
            if (period <= 0) continue;
            const double low = component(lumen_.bounds.low) / settings_.spacing;
            const Vec3 shift{axis == 0 ? period : 0, axis == 1 ? period : 0, axis == 2 ? period : 0};
            // Images of earlier axes have images too: edges and corners.
            const std::size_t before = places.size();
            for (std::size_t k = 0; k < before; ++k) {
                const Place source = places[k];
                const double at = component(x_[source.of] + source.shift) - low;
                if (at < reach) places.push_back({source.of, true, source.shift + shift});
                if (at > period - reach) places.push_back({source.of, true, source.shift - shift});
            }
        }
        return places;
    }

    void make_rows() {
        wrap();
        const std::vector<Place> unsorted = points_and_images();
        std::vector<Vec3> at(unsorted.size()), sorted(unsorted.size());
        for_each_index(at.size(), [&](std::size_t k) { at[k] = x_[unsorted[k].of] + unsorted[k].shift; });
        const Frame frame = frame_around(at);
        const auto order = sorter_.find_order(frame, 1, at);
        places_.resize(unsorted.size());
        for_each_index(at.size(), [&](std::size_t k) {
            places_[k] = unsorted[order[k]];
            sorted[k] = at[order[k]];
        });
        cells_.index(frame, 1, sorted);
        rows_.find_other(frame, cells_, cells_, support + skin, native_lanes<double>);
        records_.reset(places_.size() + 1);
        place_records();
        find_openings();
        x_at_rows_ = x_;
    }

    void place_records() {
        for_each_index(places_.size(), [&](std::size_t k) {
            const Vec3 x = x_[places_[k].of] + places_[k].shift;
            records_[k] = {x.x, x.y, x.z, 0};
        });
        records_[places_.size()] = {1e9, 1e9, 1e9, 0};   // pads rows: out of everybody's support
    }

    // The opening whose plane or continuation a point is at, or none.
    void find_openings() {
        const double beside = settings_.wall_thickness + settings_.spacing, before = -2 * settings_.spacing;
        for_each_index(count_, [&](std::size_t i) {
            opening_[i] = none;
            for (std::size_t k = 0; k < lumen_.openings.size(); ++k) {
                const Opening& opening = lumen_.openings[k];
                const auto [s, radial] = opening_coordinates(opening, position(i));
                if (s > before && s < settings_.wall_end[k] + settings_.spacing &&
                    norm(radial) < opening.reach + beside)
                    opening_[i] = int(k);
            }
        });
    }

    double height_over(int opening, std::size_t i) const {   // in spacings, positive outside
        return opening_coordinates(lumen_.openings[std::size_t(opening)], position(i)).s / settings_.spacing;
    }

    // Points that left a periodic box come back on its other side.
    void wrap() {
        if (dot(lumen_.period, lumen_.period) == 0) return;
        const Vec3 low = (1 / settings_.spacing) * lumen_.bounds.low, period = (1 / settings_.spacing) * lumen_.period;
        const auto back = [](double& x, double& seen, double from, double length) {
            if (!(length > 0)) return;
            const double turns = length * std::floor((x - from) / length);
            x -= turns, seen -= turns;
        };
        for (std::size_t i = 0; i < count_; ++i) {
            Vec3 &x = x_[i], &at = seen_[i].at;
            back(x.x, at.x, low.x, period.x), back(x.y, at.y, low.y, period.y), back(x.z, at.z, low.z, period.z);
        }
    }

    // Asks for the distance where the point is.
    void see(std::size_t i) {
        const DistanceSample s = lumen_.distance.sample(position(i));
        const double depth = s.value / settings_.spacing;
        // The wall holds a point back, and the outer face pushes it, only from so near.
        const double to_wall = fluid_[i] ? -settings_.clearance - depth : depth - settings_.clearance;
        const double to_face = outer_ - support - depth;
        seen_[i] = {x_[i], depth, s.gradient, std::max(linear_within, std::min(to_wall, to_face))};
    }

    // The distance now, asked again if the point is too far from where it was.
    double depth(std::size_t i) {
        const Vec3 e = x_[i] - seen_[i].at;
        if (dot(e, e) <= seen_[i].good_for * seen_[i].good_for) return seen_[i].depth + dot(e, seen_[i].gradient);
        see(i);
        return seen_[i].depth;
    }

    // push = -sum_j V grad W_ij, which is zero where the points are even.
    void compute_push() {
        const Records<double, 0> records{records_.data()};
        const double slope = factor_ * 5 / (smoothing * smoothing);
        sum_over_neighbours<double>(rows_, PairScale{1, support}, records, records, Push{},
                                    [&](std::uint32_t k, const std::array<double, 4>& sum) {
                                        if (places_[k].is_image) return;
                                        const std::size_t i = places_[k].of;
                                        push_[i] = slope * Vec3{sum[0], sum[1], sum[2]};
                                        double density = factor_ * sum[3];
                                        add_faces(i, push_[i], density);
                                        density_[i] = density / full_;
                                    });
    }

    // The lattice behind the wall's outer face and behind the flat ends past the openings. Each face brings a whole half
    // space, so what lies behind two is taken off once.
    void add_faces(std::size_t i, Vec3& push, double& density) {
        double from_end = support;
        Vec3 end_normal{};
        if (opening_[i] != none) {
            const std::size_t k = std::size_t(opening_[i]);
            from_end = settings_.wall_end[k] / settings_.spacing - height_over(opening_[i], i);
            end_normal = lumen_.openings[k].normal;
            push += -face_.push(from_end) * end_normal;
            density += face_.density(from_end);
        }
        const double from_face = outer_ - depth(i);
        if (from_face >= support) return;
        const Vec3& gradient = seen_[i].gradient;
        push += -face_.push(from_face) * gradient;
        density += face_.density(from_face);
        if (from_end >= support) return;
        const BehindBothFaces twice = behind_both_faces(from_face, gradient, from_end, end_normal, lumen_.planar);
        push -= twice.push;
        density -= twice.density;
    }

    // Accelerated descent (heavy ball). The stiffest mode of an even set has k^2 W(k) of about 0.6 / spacing^2, so that
    // pace stays below its limit 2 (1 + memory) / 0.6; memory makes the soft, short modes fade in tens of steps.
    double advance() {
        constexpr double pace = 0.6, memory = 0.85;
        const auto move = [&](std::size_t i) {
            motion_[i] = memory * motion_[i] + pace * push_[i];
            const double length = norm(motion_[i]);
            if (length > farthest) motion_[i] *= farthest / length;
            const Vec3 before = x_[i];
            x_[i] += motion_[i];
            keep_between_planes(i);
            keep_on_side(i);
            return norm(x_[i] - before);
        };
        return largest_of(count_, move);
    }

    // Whether the point had to be put back.
    bool keep_on_side(std::size_t i) {
        const double now = depth(i), clearance = settings_.clearance;
        const double excess = fluid_[i] ? std::max(0.0, now + clearance) : std::min(0.0, now - clearance);
        if (excess == 0) return false;
        const Vec3& gradient = seen_[i].gradient;
        x_[i] += -excess * gradient;
        motion_[i] += -dot(motion_[i], gradient) * gradient;   // it slides on
        return true;
    }

    // The last word has the distance itself. In a corner, leaving one wall may lead to the other: a few rounds.
    void settle() {
        for_each_index(count_, [&](std::size_t i) {
            const double from_wall = fluid_[i] ? -depth(i) : depth(i);
            if (from_wall > settings_.clearance + 2 * linear_within) return;
            for (int round = 0; round < 8; ++round) {
                see(i);
                if (!keep_on_side(i)) return;
            }
        });
    }

    // Nobody goes through the plane of an opening or of the fluid's end past it, so that as many points stay on each
    // side as the volume there needs.
    void keep_between_planes(std::size_t i) {
        if (opening_[i] == none) return;
        const std::size_t k = std::size_t(opening_[i]);
        const double height = height_over(opening_[i], i), end = settings_.fluid_end[k] / settings_.spacing;
        const double low =
            zone_[i] == Zone::lumen ? -1e9 : (zone_[i] == Zone::past_opening ? 0 : end) + plane_clearance;
        const double high = zone_[i] == Zone::filler ? 1e9 : (zone_[i] == Zone::lumen ? 0 : end) - plane_clearance;
        const double back = std::clamp(height, low, high) - height;
        if (back == 0) return;
        const Vec3& normal = lumen_.openings[k].normal;
        x_[i] += back * normal;
        motion_[i] += -dot(motion_[i], normal) * normal;
    }

    void find_zones() {
        for (std::size_t i = 0; i < count_; ++i) {
            if (opening_[i] == none) continue;
            const double height = height_over(opening_[i], i);
            const double end = settings_.fluid_end[std::size_t(opening_[i])] / settings_.spacing;
            zone_[i] = height <= 0 ? Zone::lumen : height <= end ? Zone::past_opening : Zone::filler;
        }
    }

    RelaxQuality quality(double move) const {
        RelaxQuality q{0, 0, 0, 0, move};
        if (fluid_count_ == 0) return q;
        const double n = double(fluid_count_);
        const auto square = [](double e) { return e * e; };
        q.mean_density = sum_of(count_, [&](std::size_t i) { return fluid_[i] ? density_[i] : 0; }) / n;
        q.density_spread = std::sqrt(
            sum_of(count_, [&](std::size_t i) { return fluid_[i] ? square(density_[i] - q.mean_density) : 0; }) / n);
        q.residual =
            std::sqrt(sum_of(count_, [&](std::size_t i) { return fluid_[i] ? dot(push_[i], push_[i]) : 0; }) / n);
        q.largest_density_error =
            largest_of(count_, [&](std::size_t i) { return fluid_[i] ? std::abs(density_[i] - 1) : 0; });
        return q;
    }

    const Lumen& lumen_;
    const RelaxSettings settings_;
    const LatticeBehindFace face_;
    const double factor_, full_, outer_;
    const std::size_t fluid_count_, count_;
    // Of the points, in the order of the cells where they began; lengths in spacings.
    std::vector<Vec3> x_, motion_, push_;
    std::vector<double> density_;
    std::vector<char> fluid_;
    std::vector<int> opening_;
    std::vector<Zone> zone_;   // kept for good
    std::vector<Seen> seen_;
    std::vector<std::uint32_t> given_as_;
    std::vector<Vec3> x_at_rows_;
    // Of the points and their images, in the order of the cells where they were when the rows were made.
    std::vector<Place> places_;
    AlignedVector<Quad<double>> records_;   // one more, far away
    Cells sorter_, cells_;
    Neighbours rows_;
};

}   // namespace

RelaxQuality relax_points(std::span<Vec3> fluid, std::span<Vec3> wall, const Lumen& lumen,
                          const RelaxSettings& settings) {
    if (!(settings.spacing > 0)) throw GeometryError("Relaxation needs a positive particle spacing.");
    if (settings.fluid_end.size() != lumen.openings.size() || settings.wall_end.size() != lumen.openings.size())
        throw GeometryError("Relaxation needs to know where the points end past every opening.");
    if (fluid.empty() && wall.empty()) return {};
    Relaxation relaxation(fluid, wall, lumen, settings);
    const RelaxQuality quality = relaxation.run();
    relaxation.write(fluid, wall);
    return quality;
}

FittedPoints make_relaxed_points(const Lumen& lumen, double spacing, const PointsExtent& extent,
                                 RelaxQuality* quality) {
    lumen.distance.value(lumen.bounds.low);   // one that is made when asked is made now, by all threads
    FittedPoints points = make_fitted_points(lumen, spacing, extent);
    const double root = lumen.planar ? std::sqrt(points.volume) : std::cbrt(points.volume);
    const std::size_t count = points.fluid.size();
    std::vector<Vec3> inside = points.fluid;
    inside.insert(inside.end(), points.filler.begin(), points.filler.end());
    const RelaxQuality reached = relax_points(inside, points.wall, lumen,
                                              {.spacing = root,
                                               .wall_thickness = extent.wall_thickness,
                                               .fluid_end = points.fluid_end,
                                               .wall_end = points.wall_end,
                                               .steps = lattice_fits(lumen) ? 0 : RelaxSettings{}.steps});
    points.fluid.assign(inside.begin(), inside.begin() + std::ptrdiff_t(count));
    points.filler.assign(inside.begin() + std::ptrdiff_t(count), inside.end());
    if (quality) *quality = reached;
    return points;
}

}   // namespace patency
