// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/centreline.h"

#include <algorithm>
#include <cmath>

#include "patency/base/parallel.h"
#include "patency/shape/centring.h"

namespace patency {

namespace {

constexpr double spacing_share = 0.5;   // of the smallest radius
constexpr double most_points = 50'000;
constexpr double same_share = 0.1;      // of the radius: lines nearer than this are one
constexpr double tangent_share = 0.5;   // of the radius: the tangent is that of a fit to so much on either side

/// Places every `spacing` along the line, on cubic pieces with its smooth tangents; the last one at its end.
std::vector<Ball> evenly_spaced(const std::vector<Ball>& line, double spacing, const Vec3& first_tangent,
                                const Vec3& last_tangent) {
    std::vector<double> arcs = arcs_of(line);
    std::vector<Vec3> tangents(line.size());
    for (std::size_t k = 0; k < line.size(); ++k) tangents[k] = smoothed(line, arcs, k, line[k].radius).tangent;
    tangents.front() = first_tangent, tangents.back() = last_tangent;
    const auto on_piece = [&](std::size_t k, double t) {   // between k and k + 1
        const double h = arcs[k + 1] - arcs[k], s = 1 - t;
        return Ball{s * s * (1 + 2 * t) * line[k].centre + t * t * (1 + 2 * s) * line[k + 1].centre +
                        (h * t * s) * (s * tangents[k] - t * tangents[k + 1]),
                    s * line[k].radius + t * line[k + 1].radius};
    };
    std::vector<Ball> result{line.front()};
    double gone = 0;   // since the last place; walked in small steps, for the pieces are curved
    constexpr int steps = 16;
    Ball from = line.front();
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
        for (int j = 1; j <= steps; ++j) {
            const Ball to = on_piece(k, double(j) / steps);
            const double length = norm(to.centre - from.centre);
            double at = 0;
            while (gone + (length - at) > spacing) {
                at += spacing - gone, gone = 0;
                const double t = at / length;
                result.push_back({(1 - t) * from.centre + t * to.centre, (1 - t) * from.radius + t * to.radius});
            }
            gone += length - at;
            from = to;
        }
    if (result.size() > 1 && gone < 0.5 * spacing) result.pop_back();
    result.push_back(line.back());
    return result;
}

/// How many points two lines have in common from the inlet on.
std::size_t close_points(const std::vector<Ball>& a, const std::vector<Ball>& b) {
    std::size_t k = 0;
    while (k < a.size() && k < b.size() && norm(a[k].centre - b[k].centre) <= same_share * a[k].radius) ++k;
    return k;
}

/// Lets a line share the points of an earlier one exactly where they are one; what is left at the parting fades over a
/// diameter.
void share(std::vector<std::vector<Ball>>& lines, std::size_t j, double spacing) {
    std::size_t most = 0, with = 0;
    for (std::size_t i = 0; i < j; ++i)
        if (const std::size_t k = close_points(lines[i], lines[j]); k > most) most = k, with = i;
    if (most == 0) return;
    const std::vector<Ball>& a = lines[with];
    std::vector<Ball>& b = lines[j];
    most = std::min(most, b.size() - 1);   // an outlet is its own
    const Vec3 gap = a[most - 1].centre - b[most - 1].centre;
    const double fade = 2 * a[most - 1].radius;
    std::copy(a.begin(), a.begin() + std::ptrdiff_t(most), b.begin());
    for (std::size_t k = most; k + 1 < b.size(); ++k)
        b[k].centre += std::max(0.0, 1 - double(k - most + 1) * spacing / fade) * gap;
}

Centreline finished(const SignedDistance& distance, const std::vector<Ball>& line, const LineEnds& ends,
                    const std::string& outlet) {
    Centreline result{outlet};
    result.points.resize(line.size());
    const std::vector<double> arcs = arcs_of(line);
    for_each_task(line.size(), [&](std::size_t k) {
        const Vec3 tangent = k == 0                 ? ends.first_tangent
                             : k + 1 == line.size() ? ends.last_tangent
                                                    : smoothed(line, arcs, k, tangent_share * line[k].radius).tangent;
        result.points[k] = {line[k].centre, tangent, inscribed_radius(distance, line[k], tangent), arcs[k]};
    });
    return result;
}

/// Behind a cap the radius goes linearly from that at the depth where the wall is seen to that of an ellipse with the
/// opening's area and reach.
void mend_radii(Centreline& line, const Opening& opening, bool is_inlet) {
    const double depth = std::min(1.2 * depth_of_cap(opening), 0.5 * line.length());
    const double radius = point_at(line, is_inlet ? depth : line.length() - depth).radius;
    const double at_cap = opening.radius * opening.radius / opening.reach;
    for (CentrelinePoint& p : line.points) {
        const double t = (is_inlet ? p.arc : line.length() - p.arc) / depth;
        if (t < 1) p.radius = (1 - t) * at_cap + t * radius;
    }
}

}   // namespace

CentrelinePoint point_at(const Centreline& line, double arc) {
    const auto& p = line.points;
    const auto after = std::upper_bound(p.begin(), p.end(), arc, [](double a, const auto& q) { return a < q.arc; });
    if (after == p.begin()) return p.front();
    if (after == p.end()) return p.back();
    const CentrelinePoint &a = *(after - 1), &b = *after;
    const double t = (arc - a.arc) / (b.arc - a.arc);
    return {(1 - t) * a.place + t * b.place, normalized((1 - t) * a.tangent + t * b.tangent),
            (1 - t) * a.radius + t * b.radius, arc};
}

std::size_t shared_points(const Centreline& a, const Centreline& b) {
    std::size_t k = 0;
    while (k < a.points.size() && k < b.points.size() && a.points[k].place == b.points[k].place) ++k;
    return k;
}

std::vector<Centreline> find_centrelines(const SignedDistance& distance, const std::vector<Opening>& openings,
                                         std::size_t inlet) {
    const SignedDistance wall = without_caps(distance, openings);
    std::vector<std::vector<Ball>> lines = find_ways(wall, openings, inlet);
    const auto reach = [&](const Opening& o) { return is_capped(distance, o) ? depth_of_cap(o) : 0; };
    std::vector<LineEnds> ends;
    std::vector<const Opening*> outlets;
    for (std::size_t o = 0; o < openings.size(); ++o) {
        if (o == inlet) continue;
        outlets.push_back(&openings[o]);
        ends.push_back({-openings[inlet].normal, openings[o].normal, reach(openings[inlet]), reach(openings[o])});
    }
    for_each_task(lines.size(), [&](std::size_t j) { lines[j] = centred(wall, std::move(lines[j]), ends[j]); });
    double smallest = Bounds::infinity, length = 0;
    for (const std::vector<Ball>& line : lines) {
        for (const Ball& ball : line) smallest = std::min(smallest, ball.radius);
        length += arcs_of(line).back();
    }
    const double spacing = std::max(spacing_share * smallest, length / most_points);
    std::vector<Centreline> result;
    for (std::size_t j = 0; j < lines.size(); ++j) {
        lines[j] = evenly_spaced(lines[j], spacing, ends[j].first_tangent, ends[j].last_tangent);
        share(lines, j, spacing);
        Centreline& line = result.emplace_back(finished(wall, lines[j], ends[j], outlets[j]->name));
        if (ends[j].first_reach > 0) mend_radii(line, openings[inlet], true);
        if (ends[j].last_reach > 0) mend_radii(line, *outlets[j], false);
    }
    // The fits at the parting see different ways on; up to there the lines are one in all they say.
    for (std::size_t j = 1; j < result.size(); ++j)
        for (std::size_t i = 0; i < j; ++i)
            std::copy_n(result[i].points.begin(), shared_points(result[i], result[j]), result[j].points.begin());
    return result;
}

}   // namespace patency
