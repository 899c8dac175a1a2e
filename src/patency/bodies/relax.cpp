// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/relax.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "patency/base/errors.h"
#include "patency/bodies/lattice_face.h"

namespace patency {

using namespace relaxation;

namespace {

constexpr double skin = 0.3;        // rows hold neighbours this much farther than the support, in spacings
constexpr double farthest = 0.1;    // that a point goes in one step
constexpr double plane_clearance = 0.1;   // least distance to an opening's plane, in spacings
constexpr int none = -1;
constexpr int lanes = 8;            // partial sums of a row: fixed, so that every vector width gives the same bits

class Relaxation {
public:
    Relaxation(std::span<Vec3> fluid, std::span<Vec3> wall, const Lumen& lumen, const RelaxSettings& settings)
        : lumen_(lumen),
          settings_(settings),
          face_(lumen.planar),
          factor_(kernel_factor(lumen.planar)),
          full_(lattice_density(lumen.planar)),
          fluid_count_(fluid.size()),
          count_(fluid.size() + wall.size()),
          x_(count_),
          motion_(count_),
          push_(count_),
          density_(count_),
          opening_(count_),
          zone_(count_, Zone::lumen),
          known_depth_(count_, 1e9) {
        for (std::size_t i = 0; i < count_; ++i)
            x_[i] = (1 / settings.spacing) * (i < fluid_count_ ? fluid[i] : wall[i - fluid_count_]);
    }

    RelaxQuality run() {
        double move = 0;
        make_rows();
        find_zones();
        for (int step = 0; step < settings_.steps; ++step) {
            compute_push();
            move = advance();
            if (2 * moved_since_rows() >= skin)
                make_rows();
            else
                place_ghosts();
        }
        compute_push();
        return quality(move);
    }

    double moved_since_rows() const {
        double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest)
        for (std::size_t i = 0; i < count_; ++i) {
            const Vec3 e = x_[i] - x_at_rows_[i];
            largest = std::max(largest, dot(e, e));
        }
        return std::sqrt(largest);
    }

    Vec3 position(std::size_t i) const { return settings_.spacing * x_[i]; }

private:
    bool is_fluid(std::size_t i) const { return i < fluid_count_; }

    enum class Zone : char { lumen, past_opening, filler };   // behind the opening; up to the fluid's end; farther

    // The points' images behind the faces of periodic axes: which point, moved by how much.
    struct Ghost {
        std::uint32_t of;
        Vec3 shift;
    };

    // The rows of chunk_size points, one after the other: row i is neighbours[start[i]] to neighbours[start[i + 1]].
    static constexpr std::size_t chunk_size = 512;
    struct Chunk {
        std::vector<std::uint32_t> start, neighbours;
    };

    void make_ghosts() {
        ghosts_.clear();
        const double dp = settings_.spacing, reach = support + skin;
        for (int axis = 0; axis < 3; ++axis) {
            const auto component = [axis](const Vec3& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
            const double period = component(lumen_.period) / dp;
            if (period <= 0) continue;
            const double low = component(lumen_.bounds.low) / dp;
            const Vec3 shift{axis == 0 ? period : 0, axis == 1 ? period : 0, axis == 2 ? period : 0};
            // Ghosts of earlier axes have images too: edges and corners.
            const std::size_t before = ghosts_.size();
            for (std::size_t k = 0; k < count_ + before; ++k) {
                const Ghost source = k < count_ ? Ghost{std::uint32_t(k), {}} : ghosts_[k - count_];
                const double at = component(x_[source.of] + source.shift) - low;
                if (at < reach) ghosts_.push_back({source.of, source.shift + shift});
                if (at > period - reach) ghosts_.push_back({source.of, source.shift - shift});
            }
        }
    }

    void place_ghosts() {
        const std::size_t all = count_ + ghosts_.size() + 1;
        px_.resize(all), py_.resize(all), pz_.resize(all);
        const auto put = [&](std::size_t k, const Vec3& x) { px_[k] = x.x, py_[k] = x.y, pz_[k] = x.z; };
        for (std::size_t k = 0; k < count_; ++k) put(k, x_[k]);
        for (std::size_t k = 0; k < ghosts_.size(); ++k) put(count_ + k, x_[ghosts_[k].of] + ghosts_[k].shift);
        put(all - 1, {1e9, 1e9, 1e9});   // pads rows: out of everybody's support
    }

    // Neighbours within support and skin, found by cells of that size; rows padded to whole groups of lanes.
    void make_rows() {
        wrap();
        make_ghosts();
        place_ghosts();
        const std::size_t all = count_ + ghosts_.size();
        const double reach = support + skin;
        Vec3 low{px_[0], py_[0], pz_[0]}, high = low;
        for (std::size_t k = 0; k < all; ++k) {
            low = {std::min(low.x, px_[k]), std::min(low.y, py_[k]), std::min(low.z, pz_[k])};
            high = {std::max(high.x, px_[k]), std::max(high.y, py_[k]), std::max(high.z, pz_[k])};
        }
        const long nx = long((high.x - low.x) / reach) + 3, ny = long((high.y - low.y) / reach) + 3;
        const long nz = long((high.z - low.z) / reach) + 3;   // one empty layer around
        std::vector<std::uint32_t> cell(all), start(std::size_t(nx * ny * nz) + 1, 0), inside(all);
        for (std::size_t k = 0; k < all; ++k) {
            const long i = 1 + long((px_[k] - low.x) / reach), j = 1 + long((py_[k] - low.y) / reach);
            cell[k] = std::uint32_t(i + nx * (j + ny * (1 + long((pz_[k] - low.z) / reach))));
            ++start[cell[k] + 1];
        }
        std::partial_sum(start.begin(), start.end(), start.begin());
        std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
        for (std::size_t k = 0; k < all; ++k) inside[next[cell[k]]++] = std::uint32_t(k);

        std::vector<Vec3> sorted(all);   // in cell order, so that a search reads along memory
        for (std::size_t k = 0; k < all; ++k) sorted[k] = {px_[inside[k]], py_[inside[k]], pz_[inside[k]]};

        chunks_.resize((count_ + chunk_size - 1) / chunk_size);
#pragma omp parallel for schedule(dynamic)
        for (std::size_t c = 0; c < chunks_.size(); ++c) {
            std::vector<std::uint32_t>& neighbours = chunks_[c].neighbours;
            neighbours.clear();
            chunks_[c].start.assign(1, 0);
            for (std::size_t i = c * chunk_size; i < std::min(count_, (c + 1) * chunk_size); ++i) {
                const Vec3 x{px_[i], py_[i], pz_[i]};
                for (long dz = -1; dz <= 1; ++dz)
                    for (long dy = -1; dy <= 1; ++dy) {
                        const long middle = long(cell[i]) + nx * (dy + ny * dz);
                        for (std::uint32_t k = start[middle - 1]; k < start[middle + 2]; ++k) {
                            const Vec3 e = x - sorted[k];
                            if (dot(e, e) < reach * reach && inside[k] != i) neighbours.push_back(inside[k]);
                        }
                    }
                neighbours.resize((neighbours.size() + lanes - 1) / lanes * lanes, std::uint32_t(all));
                chunks_[c].start.push_back(std::uint32_t(neighbours.size()));
            }
        }
        find_openings();
        x_at_rows_ = x_;
    }

    // The opening whose plane or continuation a point is at, or none.
    void find_openings() {
        const double beside = settings_.wall_thickness + settings_.spacing, before = -2 * settings_.spacing;
#pragma omp parallel for schedule(static)
        for (std::size_t i = 0; i < count_; ++i) {
            opening_[i] = none;
            for (std::size_t k = 0; k < lumen_.openings.size(); ++k) {
                const Opening& opening = lumen_.openings[k];
                const auto [s, radial] = opening_coordinates(opening, position(i));
                if (s > before && s < settings_.wall_end[k] + settings_.spacing && norm(radial) < opening.reach + beside)
                    opening_[i] = int(k);
            }
        }
    }

    double height_over(int opening, std::size_t i) const {   // in spacings, positive outside
        return opening_coordinates(lumen_.openings[std::size_t(opening)], position(i)).s / settings_.spacing;
    }

    // Points that left a periodic box come back on its other side.
    void wrap() {
        const Vec3 low = (1 / settings_.spacing) * lumen_.bounds.low, period = (1 / settings_.spacing) * lumen_.period;
        const auto back = [](double& x, double from, double length) {
            if (length > 0) x -= length * std::floor((x - from) / length);
        };
        for (Vec3& x : x_) back(x.x, low.x, period.x), back(x.y, low.y, period.y), back(x.z, low.z, period.z);
    }

    // push = -sum_j V grad W_ij, which is zero where the points are even.
    void compute_push() {
#pragma omp parallel for schedule(static)
        for (std::size_t i = 0; i < count_; ++i) {
            const Chunk& chunk = chunks_[i / chunk_size];
            const std::uint32_t* neighbour = chunk.neighbours.data();
            const std::size_t first = chunk.start[i % chunk_size], end = chunk.start[i % chunk_size + 1];
            double sx[lanes] = {}, sy[lanes] = {}, sz[lanes] = {}, sw[lanes] = {};
            const double xi = px_[i], yi = py_[i], zi = pz_[i];
            for (std::size_t k = first; k < end; k += lanes)
                for (int l = 0; l < lanes; ++l) {
                    const std::uint32_t j = neighbour[k + l];
                    const double dx = xi - px_[j], dy = yi - py_[j], dz = zi - pz_[j];
                    const double r = std::sqrt(dx * dx + dy * dy + dz * dz);
                    const double u = 1 - r * (1 / support), t = u > 0 ? u : 0;
                    const double slope = t * t * t;
                    sx[l] += slope * dx;
                    sy[l] += slope * dy;
                    sz[l] += slope * dz;
                    sw[l] += slope * t * (r * (2 / smoothing) + 1);
                }
            Vec3 push{};
            double density = 1;   // the point's own kernel
            for (int l = 0; l < lanes; ++l) {
                push += Vec3{sx[l], sy[l], sz[l]};
                density += sw[l];
            }
            push *= factor_ * 5 / (smoothing * smoothing);
            density *= factor_;
            add_faces(i, push, density);
            push_[i] = push;
            density_[i] = density / full_;
        }
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
        const double outer = settings_.wall_thickness / settings_.spacing;
        if (known_depth_[i] < outer - support) return;   // a bound: no face near
        const DistanceSample s = lumen_.distance.sample(position(i));
        known_depth_[i] = s.value / settings_.spacing;
        const double from_face = outer - known_depth_[i];
        push += -face_.push(from_face) * s.gradient;
        density += face_.density(from_face);
        if (from_face >= support || from_end >= support) return;
        for (double u = std::max(0.0, from_face) + 0.5; u < support; u += 1)
            for (double v = std::max(0.0, from_end) + 0.5; v < support; v += 1)
                for (int w = lumen_.planar ? 0 : -2; w <= (lumen_.planar ? 0 : 2); ++w) {
                    const double r = std::sqrt(u * u + v * v + w * w), slope = factor_ * shape_of_slope(r);
                    push += slope * (u * s.gradient + v * end_normal);
                    density -= factor_ * shape_of_kernel(r);
                }
    }

    // Accelerated descent (heavy ball). The stiffest mode of an even set has k^2 W(k) of about 0.6 / spacing^2, so that
    // pace stays below its limit 2 (1 + memory) / 0.6; memory makes the soft, short modes fade in tens of steps.
    double advance() {
        constexpr double pace = 0.6, memory = 0.85;
        double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest)
        for (std::size_t i = 0; i < count_; ++i) {
            motion_[i] = memory * motion_[i] + pace * push_[i];
            const double length = norm(motion_[i]);
            if (length > farthest) motion_[i] *= farthest / length;
            const Vec3 before = x_[i];
            x_[i] += motion_[i];
            known_depth_[i] += std::min(length, farthest);   // may have come nearer to the outer face by that much
            keep_on_side(i);
            const double moved = norm(x_[i] - before);
            largest = std::max(largest, moved);
        }
        return largest;
    }

    void keep_on_side(std::size_t i) {
        const double clearance = settings_.clearance;
        keep_between_planes(i);
        if (is_fluid(i) && known_depth_[i] < -clearance) return;
        // In a corner, leaving one wall may lead to the other: a few rounds.
        for (int round = 0; round < 4; ++round) {
            const DistanceSample s = lumen_.distance.sample(position(i));
            const double depth = s.value / settings_.spacing;
            const double excess = is_fluid(i) ? std::max(0.0, depth + clearance) : std::min(0.0, depth - clearance);
            known_depth_[i] = depth;
            if (excess == 0) return;
            x_[i] += -excess * s.gradient;
            known_depth_[i] -= excess;
            motion_[i] += -dot(motion_[i], s.gradient) * s.gradient;   // it slides on
        }
    }

    // Nobody goes through the plane of an opening or of the fluid's end past it, so that as many points stay on each
    // side as the volume there needs.
    void keep_between_planes(std::size_t i) {
        if (opening_[i] == none) return;
        const std::size_t k = std::size_t(opening_[i]);
        const double height = height_over(opening_[i], i), end = settings_.fluid_end[k] / settings_.spacing;
        const double low = zone_[i] == Zone::lumen ? -1e9 : (zone_[i] == Zone::past_opening ? 0 : end) + plane_clearance;
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
        double squares = 0, pushes = 0;
        for (std::size_t i = 0; i < fluid_count_; ++i) q.mean_density += density_[i] / double(fluid_count_);
        for (std::size_t i = 0; i < fluid_count_; ++i) {
            squares += (density_[i] - q.mean_density) * (density_[i] - q.mean_density);
            pushes += dot(push_[i], push_[i]);
            q.largest_density_error = std::max(q.largest_density_error, std::abs(density_[i] - 1));
        }
        q.density_spread = std::sqrt(squares / double(fluid_count_));
        q.residual = std::sqrt(pushes / double(fluid_count_));
        return q;
    }

    const Lumen& lumen_;
    const RelaxSettings settings_;
    const LatticeBehindFace face_;
    const double factor_, full_;
    const std::size_t fluid_count_, count_;
    std::vector<Vec3> x_, motion_, push_;           // in spacings
    std::vector<double> density_;
    std::vector<int> opening_;
    std::vector<Zone> zone_;                        // kept for good
    std::vector<double> known_depth_;               // no point is deeper outside than this, in spacings
    std::vector<Ghost> ghosts_;
    std::vector<double> px_, py_, pz_;              // points, ghosts, one far away
    std::vector<Chunk> chunks_;
    std::vector<Vec3> x_at_rows_;
};

}  // namespace

RelaxQuality relax_points(std::span<Vec3> fluid, std::span<Vec3> wall, const Lumen& lumen,
                          const RelaxSettings& settings) {
    if (!(settings.spacing > 0)) throw GeometryError("Relaxation needs a positive particle spacing.");
    if (settings.fluid_end.size() != lumen.openings.size() || settings.wall_end.size() != lumen.openings.size())
        throw GeometryError("Relaxation needs to know where the points end past every opening.");
    if (fluid.empty() && wall.empty()) return {};
    Relaxation relaxation(fluid, wall, lumen, settings);
    const RelaxQuality quality = relaxation.run();
    for (std::size_t i = 0; i < fluid.size(); ++i) fluid[i] = relaxation.position(i);
    for (std::size_t i = 0; i < wall.size(); ++i) wall[i] = relaxation.position(fluid.size() + i);
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

}  // namespace patency
