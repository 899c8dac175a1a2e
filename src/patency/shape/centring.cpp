// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/centring.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace patency {

namespace {

constexpr int views = 16;            // around the line: 22 degrees apart
constexpr double view_share = 0.5;   // of the radius, from the ridge: where a gridded distance is smooth
constexpr double spacing_share = 0.4, smoothing_share = 1.2, largest_step_share = 0.3;   // of the radius
constexpr int rounds = 8;   // what a first line is off (about a radius) is gone after five

struct Frame {
    Vec3 u, v;   // unit, across the line
};
Frame frame_across(const Vec3& direction) {
    const Vec3 u = normalized(cross(direction, std::abs(direction.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    return {u, cross(direction, u)};
}

/// The wall's nearest point seen from x.
Vec3 foot(const SignedDistance& distance, const Vec3& x) {
    const DistanceSample s = distance.sample(x);
    return x - s.value * s.gradient;
}

using Feet = std::array<Vec3, views>;

Feet feet_around(const SignedDistance& distance, const Ball& ball, const Frame& frame) {
    Feet feet;
    for (int k = 0; k < views; ++k) {
        const double angle = 2 * std::numbers::pi * k / views;
        feet[std::size_t(k)] = foot(distance, ball.centre + (view_share * ball.radius) * (std::cos(angle) * frame.u +
                                                                                          std::sin(angle) * frame.v));
    }
    return feet;
}

double nearest(const Feet& feet, const Vec3& x) {
    double square = Bounds::infinity;
    for (const Vec3& w : feet) square = std::min(square, dot(w - x, w - x));
    return std::sqrt(square);
}

/// The place in the plane that is farthest from all feet, by a search in ever smaller steps.
Ball farthest_from(const Feet& feet, const Ball& start, const Frame& frame) {
    constexpr double s = 0.7071067811865476;
    constexpr std::array<std::array<double, 2>, 8> ways{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {s, s}, {-s, -s}, {s, -s}, {-s, s}}};
    Ball best{start.centre, nearest(feet, start.centre)};
    const double limit = largest_step_share * start.radius;
    for (double step = 0.5 * limit; step > 1e-4 * start.radius;) {
        Ball next = best;
        for (const auto& way : ways) {
            const Vec3 x = best.centre + step * (way[0] * frame.u + way[1] * frame.v);
            const double r = norm(x - start.centre) > limit ? 0 : nearest(feet, x);
            if (r > next.radius) next = {x, r};
        }
        if (next.radius > best.radius)
            best = next;
        else
            step *= 0.5;
    }
    return best;
}

/// Points spacing_share radii apart along the line, from its first to its last.
std::vector<Ball> respaced(const std::vector<Ball>& line) {
    std::vector<Ball> result{line.front()};
    double needed = spacing_share * line.front().radius, gone = 0;
    for (std::size_t k = 1; k < line.size(); ++k) {
        const double length = norm(line[k].centre - line[k - 1].centre);
        double at = 0;   // on this piece
        while (gone + (length - at) > needed) {
            at += needed - gone;
            const double t = at / length;
            result.push_back(
                {(1 - t) * line[k - 1].centre + t * line[k].centre, (1 - t) * line[k - 1].radius + t * line[k].radius});
            gone = 0, needed = spacing_share * result.back().radius;
        }
        gone += length - at;
    }
    if (result.size() > 1 && gone < 0.5 * needed) result.pop_back();
    result.push_back(line.back());
    return result;
}

std::vector<Ball> smoothed_line(const std::vector<Ball>& line) {
    const std::vector<double> arcs = arcs_of(line);
    std::vector<Ball> result = line;
    for (std::size_t k = 1; k + 1 < line.size(); ++k)
        result[k].centre = smoothed(line, arcs, k, smoothing_share * line[k].radius).place;
    return result;
}

/// Lays the line's first points on the cubic from its first one, along the tangent, to the first beyond the reach.
void lay_start(std::vector<Ball>& line, const Vec3& tangent, double reach) {
    if (reach <= 0 || line.size() < 4) return;
    const std::vector<double> arcs = arcs_of(line);
    std::size_t m = 1;
    while (m < line.size() / 2 && arcs[m] < reach) ++m;
    const Vec3 p = line[0].centre, q = line[m].centre;
    const Vec3 joined = smoothed(line, arcs, m, smoothing_share * line[m].radius).tangent;
    const double length = norm(q - p);
    for (std::size_t k = 0; k < m; ++k) {
        const double t = arcs[k] / arcs[m], s = 1 - t;
        line[k].radius = line[m].radius;
        line[k].centre =
            s * s * (1 + 2 * t) * p + t * t * (1 + 2 * s) * q + (length * t * s) * (s * tangent - t * joined);
    }
}

void lay_ends(std::vector<Ball>& line, const LineEnds& ends) {
    lay_start(line, ends.first_tangent, ends.first_reach);
    std::reverse(line.begin(), line.end());
    lay_start(line, -ends.last_tangent, ends.last_reach);
    std::reverse(line.begin(), line.end());
}

}   // namespace

std::vector<double> arcs_of(const std::vector<Ball>& line) {
    std::vector<double> arcs(line.size());
    for (std::size_t k = 1; k < line.size(); ++k) arcs[k] = arcs[k - 1] + norm(line[k].centre - line[k - 1].centre);
    return arcs;
}

SmoothPlace smoothed(const std::vector<Ball>& line, const std::vector<double>& arcs, std::size_t at, double reach) {
    const std::size_t last = line.size() - 1;
    std::size_t low = at, high = at;
    while (low > 0 && (arcs[at] - arcs[low - 1] < reach || low + 1 > at)) --low;   // two on either side at least,
    while (high < last && (arcs[high + 1] - arcs[at] < reach || high < at + 1)) ++high;   // unless the line ends
    Mat3 normal{};
    Mat3 right{};   // rows: moments of the places
    for (std::size_t k = low; k <= high; ++k) {
        const double t = (arcs[k] - arcs[at]) / reach, a = std::min(std::abs(t), 0.99);
        const double w = (1 - a * a) * (1 - a * a);
        const Vec3 basis{1, t, t * t};
        normal += outer(w * basis, basis);
        right += outer(w * basis, line[k].centre - line[at].centre);
    }
    const Vec3 chord = line[std::min(at + 1, last)].centre - line[at > 0 ? at - 1 : 0].centre;
    if (high - low < 3) return {line[at].centre, normalized(chord)};
    const Mat3 fit = inverse(normal) * right;
    return {line[at].centre + fit.x, normalized(norm(fit.y) > 0 ? fit.y : chord)};
}

double inscribed_radius(const SignedDistance& distance, const Ball& guess, const Vec3& across) {
    const Feet feet = feet_around(distance, guess, frame_across(across));
    Vec3 best = *std::min_element(feet.begin(), feet.end(), [&](const Vec3& a, const Vec3& b) {
        return norm(a - guess.centre) < norm(b - guess.centre);
    });
    for (int k = 0; k < 4; ++k) {   // down the wall to its nearest point
        const Vec3 next = foot(distance, guess.centre + view_share * (best - guess.centre));
        if (!(norm(next - guess.centre) < norm(best - guess.centre))) break;
        best = next;
    }
    return norm(best - guess.centre);
}

std::vector<Ball> centred(const SignedDistance& distance, std::vector<Ball> way, const LineEnds& ends) {
    way = smoothed_line(respaced(way));
    lay_ends(way, ends);
    for (int round = 0; round < rounds; ++round) {
        const std::vector<double> arcs = arcs_of(way);
        std::vector<Ball> moved = way;
        for (std::size_t k = 0; k < way.size(); ++k) {
            if (arcs[k] < ends.first_reach || arcs.back() - arcs[k] < ends.last_reach) continue;
            const Vec3 tangent = smoothed(way, arcs, k, smoothing_share * way[k].radius).tangent;
            const Frame frame = frame_across(tangent);
            const Ball best = farthest_from(feet_around(distance, way[k], frame), way[k], frame);
            moved[k].radius = best.radius;
            if (k > 0 && k + 1 < way.size()) moved[k].centre = best.centre;
        }
        way = respaced(smoothed_line(moved));
        lay_ends(way, ends);
    }
    return way;
}

}   // namespace patency
