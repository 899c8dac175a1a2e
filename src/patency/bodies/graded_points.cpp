// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/graded_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "patency/base/aligned.h"
#include "patency/base/errors.h"
#include "patency/base/pack.h"
#include "patency/base/parallel.h"
#include "patency/bodies/graded_rows.h"
#include "patency/bodies/lattice_face.h"

namespace patency {

using namespace relaxation;

namespace {

constexpr double skin = 0.3;      // rows hold neighbours this much farther than the support, in mean spacings of a pair
constexpr double crowded = 0.5;   // mean spacings between two points that stand for one
constexpr double farthest = 0.1;         // that a point goes in one step, in its spacings
constexpr double linear_within = 0.05;   // of its spacings a point may go before it asks for the distance again
constexpr double wall_reach =
    1.1 * support;   // spacings within which a point sees a wall; those may become larger on its way
constexpr int none = -1;

/// A small cube of the lumen, and how many points it should hold.
struct Share {
    Vec3 middle;
    double side, points;
};

/// Halves cubes until one holds less than four points or so, along a curve that visits neighbours one after the other.
class Division {
public:
    Division(const Lumen& lumen, const SpacingField& field) : lumen_(lumen), field_(field) {}

    /// The middle lies deeper than `least` [m], as is known of the cube that was halved.
    void add(const Vec3& middle, double side, std::vector<Share>& shares, double least = -Bounds::infinity) const {
        constexpr double sides_in_spacings = 1.6;   // 4 points; the next smaller cube holds half of one
        const double reach = std::sqrt(3.0) / 2 * side, depth = least > reach ? least : -lumen_.distance.value(middle);
        if (depth < -reach) return;
        const SpacingSettings& limits = field_.settings();
        const double spacing = field_(middle);
        if (side > sides_in_spacings * std::max(limits.smallest, spacing - limits.growth * reach)) {
            const double q = 0.25 * side;
            for (int k = 0; k < 8; ++k)
                add(middle + Vec3{k & 1 ? q : -q, k & 2 ? q : -q, k & 4 ? q : -q}, 0.5 * side, shares,
                    depth - 0.5 * reach);
            return;
        }
        // What share of a cube lies before a plane depends on how it is turned; on the mean about as the way.
        const auto before = [&](double way) { return std::clamp(0.5 + way / side, 0.0, 1.0); };
        double inside = before(depth);
        for (const Opening& opening : lumen_.openings) {
            const auto [s, radial] = opening_coordinates(opening, middle);
            if (s > -side && norm(radial) < opening.reach + side) inside *= before(-s);
        }
        if (inside > 0) shares.push_back({middle, side, inside * std::pow(side / spacing, 3)});
    }

private:
    const Lumen& lumen_;
    const SpacingField& field_;
};

/// Points for the shares: what one cube has too much or too little goes to the next.
std::vector<Vec3> first_points(const Lumen& lumen, const SpacingField& field) {
    const Vec3 size = lumen.bounds.high - lumen.bounds.low;
    const double side = std::max({size.x, size.y, size.z}) / 16;
    const auto count = [&](double length) { return std::max<std::size_t>(1, std::size_t(std::ceil(length / side))); };
    const std::size_t nx = count(size.x), ny = count(size.y), nz = count(size.z);
    std::vector<std::vector<Share>> found(nx * ny * nz);
    const Division division(lumen, field);
    for_each_task(found.size(), [&](std::size_t n) {
        const std::size_t i = n / (ny * nz), j = n / nz % ny, k = n % nz;
        const Vec3 at{double(i) + 0.5, double(j) + 0.5, double(k) + 0.5};
        division.add(lumen.bounds.low + side * at, side, found[n]);
    });
    // Two, four and eight points of a cube are as far from each other as they can be, also from those of its like.
    constexpr double places[8][3] = {{1, 1, 1},    {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1},
                                     {-1, -1, -1}, {1, 1, -1},  {1, -1, 1},  {-1, 1, 1}};
    std::vector<Vec3> points;
    double owed = 0;
    std::uint32_t dice = 1;
    const auto jitter = [&] {   // points on one place would stay there; -1/2 to 1/2
        dice = dice * 1664525u + 1013904223u;
        return double(dice >> 8) / (1 << 24) - 0.5;
    };
    for (const auto& shares : found)
        for (const Share& share : shares) {
            owed += share.points;
            const int now = std::clamp(int(std::floor(owed + 0.5)), 0, 8);
            owed -= now;
            for (int k = 0; k < now; ++k) {
                const double q = now == 1 ? 0 : 0.25 * share.side, j = 0.1 * share.side;
                const Vec3 e{q * places[k][0], q * places[k][1], q * places[k][2]};
                const double a = jitter(), b = jitter(), c = jitter();
                points.push_back(share.middle + e + j * Vec3{a, b, c});
            }
        }
    return points;
}

class GradedRelaxation {
public:
    GradedRelaxation(const Lumen& lumen, const SpacingField& field, const GradedSettings& settings)
        : lumen_(lumen),
          field_(field),
          settings_(settings),
          x_(first_points(lumen, field)),
          count_(x_.size()),
          spacing_(count_),
          density_(count_),
          motion_(count_),
          push_(count_),
          opening_(count_),
          seen_(count_) {}

    std::size_t count() const { return count_; }

    RelaxQuality run() {
        // The neighbours of those taken out close up; but where a slit presses its points together they would follow each other into it for ever.
        constexpr int steps_after_thinning = 20, rounds = 4;
        find_spacings();
        for_each_index(count_, [&](std::size_t i) {
            opening_[i] = opening_near(i);
            see(i, wall_reach * spacing_[i]);   // no first point lies farther outside
            keep_inside(i);
            settle(i);
        });
        make_rows();
        double move = relax(1, settings_.steps);
        for (int round = 0; thin_out() && round < rounds; ++round)
            move = relax(steps_after_thinning, steps_after_thinning);
        compute_push();
        return quality(move);
    }

    /// The points and their spacings along the vessel: outward from the first opening, neighbour by neighbour.
    GradedPoints ordered() const {
        GradedPoints result;
        for (const std::uint32_t i : order_along_vessel()) {
            result.points.push_back(x_[i]);
            result.spacing.push_back(spacing_[i]);
        }
        return result;
    }

private:
    struct Seen {   // what the distance said, where it was asked [m]
        Vec3 at;
        double depth;
        Vec3 gradient;
        double good_for;
    };

    // Until the points rest, in `least` to `most` steps. Returns the largest move of the last.
    double relax(int least, int most) {
        double move = 0, mean_motion = Bounds::infinity;
        for (int step = 0; step < least || (step < most && mean_motion > settings_.tolerance); ++step) {
            compute_push();
            move = largest_of(count_, [&](std::size_t i) { return advance(i); });
            mean_motion =
                std::sqrt(sum_of(count_, [&](std::size_t i) { return dot(motion_[i], motion_[i]); }) / double(count_));
            if (2 * moved_since_rows() >= skin) make_rows();
        }
        for_each_index(count_, [&](std::size_t i) { settle(i); });
        make_rows();
        return move;
    }

    // Two points that a pocket of the wall has pressed together do not part any more, for the slope of the kernel fades
    // towards its middle: one of them is taken out. Whether there were any.
    bool thin_out() {
        std::vector<char> is_out(count_, 0);
        for (std::uint32_t i = 0; i < count_; ++i)
            for (const std::uint32_t j : rows_.row(i))
                if (j < i && !is_out[j] && norm(x_[i] - x_[j]) < crowded * 0.5 * (spacing_[i] + spacing_[j]))
                    is_out[i] = 1;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            if (is_out[i]) continue;
            x_[kept] = x_[i], seen_[kept] = seen_[i], motion_[kept] = {};
            ++kept;
        }
        if (kept == count_) return false;
        count_ = kept;
        x_.resize(count_), seen_.resize(count_), motion_.resize(count_);
        spacing_.resize(count_), density_.resize(count_), push_.resize(count_), opening_.resize(count_);
        make_rows();
        return true;
    }

    // The field's, by one factor that makes the points fill the lumen.
    void find_spacings() {
        for_each_index(count_, [&](std::size_t i) { spacing_[i] = field_(x_[i]); });
        const double filled = sum_of(count_, [&](std::size_t i) { return std::pow(spacing_[i], 3); });
        const double factor = std::cbrt(lumen_.volume / filled);
        for_each_index(count_, [&](std::size_t i) { spacing_[i] *= factor; });
    }

    double moved_since_rows() const {
        return largest_of(count_, [&](std::size_t i) { return norm(x_[i] - x_at_rows_[i]) / spacing_[i]; });
    }

    void make_rows() {
        find_spacings();
        rows_.find(x_, spacing_, support + skin);
        for_each_index(count_, [&](std::size_t i) { opening_[i] = opening_near(i); });
        x_at_rows_ = x_;
    }

    int opening_near(std::size_t i) const {
        for (std::size_t k = 0; k < lumen_.openings.size(); ++k) {
            const Opening& opening = lumen_.openings[k];
            const auto [s, radial] = opening_coordinates(opening, x_[i]);
            if (s > -(support + skin) * spacing_[i] && s < 2 * opening.reach &&
                norm(radial) < opening.reach + 2 * spacing_[i])
                return int(k);
        }
        return none;
    }

    // The wall nearer than reach [m].
    void see(std::size_t i, double reach) {
        const DistanceSample s = lumen_.distance.sample_within(x_[i], reach);
        // No wall acts on points deeper than the kernel's support.
        const double beyond = -support * spacing_[i] - s.value;
        seen_[i] = {x_[i], s.value, s.gradient, std::max(linear_within * spacing_[i], beyond)};
    }

    // A point that has seen a wall before knows how far that one may be at the most.
    void see(std::size_t i) {
        const double seen = std::abs(seen_[i].depth) + norm(x_[i] - seen_[i].at);
        see(i, std::min(wall_reach, seen / spacing_[i] + 1e-6) * spacing_[i]);
    }

    double depth(std::size_t i) {   // negative inside [m]
        const Vec3 e = x_[i] - seen_[i].at;
        if (dot(e, e) <= seen_[i].good_for * seen_[i].good_for) return seen_[i].depth + dot(e, seen_[i].gradient);
        see(i);
        return seen_[i].depth;
    }

    // -sum_j s_j^3 grad W_ij, with W of the pair's mean spacing. THEORY.md (17.5)
    void compute_push() {
        records_.reset(count_ + 1);
        for_each_index(count_, [&](std::size_t i) { records_[i] = {x_[i].x, x_[i].y, x_[i].z, spacing_[i]}; });
        records_[count_] = {1e9, 1e9, 1e9, field_.settings().smallest};   // pads rows: out of everybody's support
        for_each_index(count_, [&](std::size_t i) {
            using P = Pack<double>;
            constexpr std::size_t lanes = GradedRows::lanes, width = P::lanes;
            static_assert(lanes % width == 0);   // as many partial sums for every vector width: the same bits
            std::array<P, lanes / width> sx, sy, sz, sw;
            for (auto* sums : {&sx, &sy, &sz, &sw}) sums->fill(P(0));
            const P x(x_[i].x), y(x_[i].y), z(x_[i].z), own(spacing_[i]);
            const auto row = rows_.row(i);
            for (std::size_t k = 0; k < row.size(); k += lanes)
                for (std::size_t p = 0; p < sx.size(); ++p) {
                    const auto other = load_quads<double, P::lanes>(records_.data(), &row[k + p * width]);
                    const P dx = x - other.a, dy = y - other.b, dz = z - other.c, per_mean = P(2) / (own + other.d);
                    const P r = sqrt(fma(dx, dx, fma(dy, dy, dz * dz)));
                    const P t = max(P(0), fma(r * per_mean, P(-1 / support), P(1)));
                    const P ratio = other.d * per_mean, slope = ratio * ratio * ratio * (t * t * t),
                            turn = slope * per_mean * per_mean;
                    sx[p] = fma(turn, dx, sx[p]);
                    sy[p] = fma(turn, dy, sy[p]);
                    sz[p] = fma(turn, dz, sz[p]);
                    sw[p] = fma(slope * t, fma(t, P(-4), P(5)), sw[p]);
                }
            const auto sum = [&](const std::array<P, lanes / width>& sums) {
                double total = 0;
                for (std::size_t l = 0; l < lanes; ++l) total += sums[l / width][int(l % width)];
                return total;
            };
            Vec3 push{sum(sx), sum(sy), sum(sz)};
            double density = sum(sw);
            push *= factor_ * 5 / (smoothing * smoothing) * spacing_[i];
            density *= factor_;
            add_faces(i, push, density);
            push_[i] = push;
            density_[i] = density / full_;
        });
    }

    void add_faces(std::size_t i, Vec3& push, double& density) {
        const double per_spacing = 1 / spacing_[i];
        double from_plane = support;
        Vec3 normal{};
        if (opening_[i] != none) {
            const Opening& opening = lumen_.openings[std::size_t(opening_[i])];
            from_plane = -opening_coordinates(opening, x_[i]).s * per_spacing;
            normal = opening.normal;
            push += -face_.push(from_plane) * normal;
            density += face_.density(from_plane);
        }
        const double from_wall = -depth(i) * per_spacing;
        if (from_wall >= support) return;
        const Vec3& gradient = seen_[i].gradient;
        push += -face_.push(from_wall) * gradient;
        density += face_.density(from_wall);
        if (from_plane >= support) return;
        const BehindBothFaces twice = behind_both_faces(from_wall, gradient, from_plane, normal, false);
        push -= twice.push;
        density -= twice.density;
    }

    // Heavy ball, as in relax.cpp, in spacings of each point. Returns its move.
    double advance(std::size_t i) {
        constexpr double pace = 0.6, memory = 0.85;
        motion_[i] = memory * motion_[i] + pace * push_[i];
        const double length = norm(motion_[i]);
        if (length > farthest) motion_[i] *= farthest / length;
        const Vec3 before = x_[i];
        x_[i] += spacing_[i] * motion_[i];
        keep_inside(i);
        return norm(x_[i] - before) / spacing_[i];
    }

    // Whether the point had to be put back from the wall.
    bool keep_inside(std::size_t i) {
        const double clearance = settings_.clearance * spacing_[i];
        const auto put_back = [&](double beyond, const Vec3& out) {
            if (!(beyond > 0)) return false;
            x_[i] += -beyond * out;
            motion_[i] += -dot(motion_[i], out) * out;   // it slides on
            return true;
        };
        if (opening_[i] != none) {
            const Opening& opening = lumen_.openings[std::size_t(opening_[i])];
            put_back(opening_coordinates(opening, x_[i]).s + clearance, opening.normal);
        }
        return put_back(depth(i) + clearance, seen_[i].gradient);
    }

    // The last word has the distance itself. In a corner, leaving one wall may lead to the other: a few rounds.
    void settle(std::size_t i) {
        if (depth(i) < -(settings_.clearance + 2 * linear_within) * spacing_[i]) return;
        for (int round = 0; round < 8; ++round) {
            see(i);
            if (!keep_inside(i)) return;
        }
    }

    std::vector<std::uint32_t> order_along_vessel() const {
        std::vector<std::uint32_t> order;
        std::vector<char> taken(count_, 0);
        const auto take = [&](std::uint32_t i) {
            if (i == count_ || taken[i]) return;
            taken[i] = 1;
            order.push_back(i);
        };
        const auto spread = [&](std::size_t from) {
            for (std::size_t n = from; n < order.size(); ++n)
                for (const std::uint32_t j : rows_.row(order[n]))
                    if (j < count_ && !taken[j] &&
                        norm(x_[j] - x_[order[n]]) < 0.75 * (spacing_[j] + spacing_[order[n]]))
                        take(j);
        };
        if (!lumen_.openings.empty())
            for (std::uint32_t i = 0; i < count_; ++i) {
                const auto [s, radial] = opening_coordinates(lumen_.openings[0], x_[i]);
                if (opening_[i] == 0 && s > -spacing_[i]) take(i);
            }
        spread(0);
        for (std::uint32_t i = 0; i < count_; ++i) {
            const std::size_t from = order.size();
            take(i);
            spread(from);
        }
        return order;
    }

    RelaxQuality quality(double move) const {
        const double n = double(count_);
        const auto square = [](double e) { return e * e; };
        RelaxQuality q{0, 0, 0, 0, move};
        q.mean_density = sum_of(count_, [&](std::size_t i) { return density_[i]; }) / n;
        q.density_spread =
            std::sqrt(sum_of(count_, [&](std::size_t i) { return square(density_[i] - q.mean_density); }) / n);
        q.largest_density_error = largest_of(count_, [&](std::size_t i) { return std::abs(density_[i] - 1); });
        q.residual = std::sqrt(sum_of(count_, [&](std::size_t i) { return dot(push_[i], push_[i]); }) / n);
        return q;
    }

    const Lumen& lumen_;
    const SpacingField& field_;
    const GradedSettings settings_;
    const LatticeBehindFace face_{false};
    const double factor_ = kernel_factor(false), full_ = lattice_density(false);
    std::vector<Vec3> x_;   // [m]
    std::size_t count_;
    std::vector<double> spacing_, density_;
    std::vector<Vec3> motion_, push_;   // in spacings of each point
    std::vector<int> opening_;
    std::vector<Seen> seen_;
    std::vector<Vec3> x_at_rows_;
    AlignedVector<Quad<double>> records_;   // place and spacing; one more, far away
    GradedRows rows_;
};

}   // namespace

GradedPoints make_graded_points(const Lumen& lumen, const SpacingField& field, const GradedSettings& settings,
                                RelaxQuality* quality) {
    if (lumen.planar || dot(lumen.period, lumen.period) > 0)
        throw GeometryError("Points that follow the vessel need a lumen in three dimensions, not a periodic one.");
    if (!(settings.clearance >= 0 && settings.clearance <= 0.5))
        throw GeometryError("The clearance of points must be between 0 and half a spacing.");
    lumen.distance.value(lumen.bounds.low);   // one that is made when asked is made now, by all threads
    GradedRelaxation relaxation(lumen, field, settings);
    constexpr std::size_t fewest = 100;
    if (relaxation.count() < fewest)
        throw GeometryError(
            fmt::format("The lumen holds only {} points at this spacing: take a smaller one.", relaxation.count()));
    const RelaxQuality reached = relaxation.run();
    if (quality) *quality = reached;
    return relaxation.ordered();
}

}   // namespace patency
