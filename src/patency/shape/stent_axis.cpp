// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/stent_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"

namespace patency {

namespace {

// From one frame to the next without turning around the line, by two reflections (Wang et al. 2008).
Vec3 carried(const Vec3& normal, const Vec3& from, const Vec3& tangent, const Vec3& to, const Vec3& next_tangent) {
    const Vec3 v = to - from;
    const double vv = dot(v, v);
    const Vec3 n = normal - (2 * dot(v, normal) / vv) * v, t = tangent - (2 * dot(v, tangent) / vv) * v;
    const Vec3 w = next_tangent - t;
    const double ww = dot(w, w);
    const Vec3 turned = ww > 0 ? n - (2 * dot(w, n) / ww) * w : n;
    return normalized(turned - dot(turned, next_tangent) * next_tangent);
}

}   // namespace

StentAxis::StentAxis() : StentAxis(RigidMotion{}) {}

StentAxis::StentAxis(const RigidMotion& placement) {
    const Vec3 x = placement.turn({1, 0, 0}), y = placement.turn({0, 1, 0});
    stations_ = {{placement.origin, x, y, 0}, {placement.place({1, 0, 0}), x, y, 1}};
}

StentAxis::StentAxis(std::span<const Vec3> line, double arc_length, double rotation, double length, double radius) {
    for (const Vec3& x : line) {
        if (!std::isfinite(norm(x))) throw GeometryError("The stent's line has a point that is not finite.");
        if (stations_.empty())
            stations_.push_back({x, {}, {}, 0});
        else if (const double step = norm(x - stations_.back().at); step > 0)
            stations_.push_back({x, {}, {}, stations_.back().along + step});
    }
    if (stations_.size() < 2) throw GeometryError("The stent's line needs at least two different points.");
    const double whole = stations_.back().along;
    if (!(arc_length - length / 2 >= 0) || !(arc_length + length / 2 <= whole))
        throw GeometryError(
            fmt::format("A stent of {:.4g} mm with its middle at {:.4g} mm does not lie on the line of {:.4g} mm: "
                        "place it between {:.4g} and {:.4g} mm.",
                        1e3 * length, 1e3 * arc_length, 1e3 * whole, 1e3 * length / 2, 1e3 * (whole - length / 2)));

    const std::size_t n = stations_.size();
    const auto direction = [&](std::size_t k) { return normalized(stations_[k + 1].at - stations_[k].at); };
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3 sum = k == 0 ? direction(0) : k + 1 == n ? direction(n - 2) : direction(k - 1) + direction(k);
        if (!(norm(sum) > 0.1)) throw GeometryError("The stent's line turns back on itself.");
        stations_[k].tangent = normalized(sum);
    }
    const Mat3 first = transpose(motion_along(stations_[0].tangent, {}).rotation);   // rows: tangent, normal, binormal
    stations_[0].normal = std::cos(rotation) * first.y + std::sin(rotation) * first.z;
    for (std::size_t k = 1; k < n; ++k) {
        const Station &a = stations_[k - 1], &b = stations_[k];
        stations_[k].normal = carried(a.normal, a.at, a.tangent, b.at, b.tangent);
    }
    for (Station& s : stations_) s.along -= arc_length;

    const auto is_used = [&](double from, double to) { return to > -length / 2 && from < length / 2; };
    for (std::size_t k = 1; k < n; ++k) {
        const Station &a = stations_[k - 1], &b = stations_[k];
        if (!is_used(a.along, b.along)) continue;
        const double bend = (b.along - a.along) / norm(b.tangent - a.tangent);
        if (!(bend > radius))
            throw GeometryError(fmt::format(
                "At {:.4g} mm the line bends to a radius of {:.3g} mm, less than the stent's {:.3g} mm: its "
                "struts would fold there. Smooth the line or place the stent elsewhere.",
                1e3 * (a.along + arc_length), 1e3 * bend, 1e3 * radius));
        for (std::size_t j = 0; j + 1 < k; ++j)
            if (is_used(stations_[j].along, stations_[j].along) && is_used(b.along, b.along) &&
                b.along - stations_[j].along > std::numbers::pi * radius && norm(b.at - stations_[j].at) < 2 * radius)
                throw GeometryError(
                    fmt::format("The line comes back to itself between {:.4g} and {:.4g} mm: the stent "
                                "would run through itself.",
                                1e3 * (stations_[j].along + arc_length), 1e3 * (b.along + arc_length)));
    }
}

std::size_t StentAxis::piece_at(double along) const {
    const auto next = std::upper_bound(stations_.begin() + 1, stations_.end() - 1, along,
                                       [](double value, const Station& s) { return value < s.along; });
    return std::size_t(next - stations_.begin()) - 1;
}

StentAxis::Frame StentAxis::frame_at(double along) const {
    const std::size_t k = piece_at(along);
    const Station &a = stations_[k], &b = stations_[k + 1];
    const double part = (along - a.along) / (b.along - a.along);
    if (part < 0 || part > 1) {   // straight on
        const Station& end = part < 0 ? a : b;
        return {end.at + (along - end.along) * end.tangent, end.tangent, end.normal, cross(end.tangent, end.normal)};
    }
    const Vec3 tangent = normalized(a.tangent + part * (b.tangent - a.tangent));
    const Vec3 normal = a.normal + part * (b.normal - a.normal);
    const Vec3 across = normalized(normal - dot(normal, tangent) * tangent);
    return {a.at + part * (b.at - a.at), tangent, across, cross(tangent, across)};
}

Vec3 StentAxis::place(const StentPoint& p) const {
    const Frame f = frame_at(p.along);
    return f.at + (p.radius * std::cos(p.angle)) * f.normal + (p.radius * std::sin(p.angle)) * f.binormal;
}

StentAxis::Foot StentAxis::nearest_foot(const Vec3& x, std::size_t begin, std::size_t end) const {
    Foot foot{0, Bounds::infinity};
    const auto take = [&](double at, double distance) {
        if (distance < foot.distance) foot = {at, distance};
    };
    const Station &first = stations_.front(), &last = stations_.back();
    if (const double past = dot(x - first.at, first.tangent); past <= 0)
        take(first.along + past, norm(x - first.at - past * first.tangent));
    if (const double past = dot(x - last.at, last.tangent); past >= 0)
        take(last.along + past, norm(x - last.at - past * last.tangent));
    for (std::size_t k = begin; k < end; ++k) {
        const Station &a = stations_[k], &b = stations_[k + 1];
        const double part = foot_on(k, x);
        if (part >= 0 && part <= 1) take(a.along + part * (b.along - a.along), norm(x - a.at - part * (b.at - a.at)));
    }
    return foot;
}

/// The share of a piece at which x lies in the normal plane: a quadratic equation, as place and tangent are linear there. Below 0 or
/// above 1: before or behind it; not a number: nowhere.
double StentAxis::foot_on(std::size_t piece, const Vec3& x) const {
    const Station &a = stations_[piece], &b = stations_[piece + 1];
    const Vec3 step = b.at - a.at, turn = b.tangent - a.tangent, d = x - a.at;
    const double c0 = dot(d, a.tangent), c1 = dot(d, turn) - dot(step, a.tangent), c2 = -dot(step, turn);
    return c0 < 0 ? -1 : 2 * c0 / (-c1 + std::sqrt(c1 * c1 - 4 * c2 * c0));
}

StentAxis::Sight StentAxis::sight(const Vec3& x, std::size_t& piece) const {
    const std::size_t last = stations_.size() - 2;
    const auto from = [&](double radius, const Vec3& away, const Vec3& tangent, double along) {
        return Sight{radius, along, radius > 0 ? away / radius : Vec3{}, tangent};
    };
    const auto past_end = [&](const Station& end) {
        const double past = dot(x - end.at, end.tangent);
        const Vec3 away = x - end.at - past * end.tangent;
        return from(norm(away), away, end.tangent, end.along + past);
    };
    constexpr int pieces_walked = 4;
    if (piece == unseen) piece = piece_at(coordinates(x).along);
    for (int k = 0; k < 2 * pieces_walked; ++k) {
        if (k == pieces_walked) piece = piece_at(coordinates(x).along);   // it came from far away
        const double part = foot_on(piece, x);
        if (part >= 0 && part <= 1) {
            const Station &a = stations_[piece], &b = stations_[piece + 1];
            const Vec3 away = x - a.at - part * (b.at - a.at);
            return from(norm(away), away, normalized(a.tangent + part * (b.tangent - a.tangent)),
                        a.along + part * (b.along - a.along));
        }
        if (part < 0 && piece == 0) return past_end(stations_.front());
        if (part > 1 && piece == last) return past_end(stations_.back());
        if (part < 0) --piece;
        if (part > 1) ++piece;
    }
    const StentPoint at = coordinates(x);   // at a corner of the line, between two normal planes
    return {at.radius, at.along, outward(at), tangent(at)};
}

StentPoint StentAxis::seen_from(const Vec3& x, double along) const {
    const Frame f = frame_at(along);
    const Vec3 d = x - f.at;
    const double y = dot(d, f.normal), z = dot(d, f.binormal);
    return {std::hypot(y, z), std::atan2(z, y), along};
}

StentPoint StentAxis::coordinates(const Vec3& x) const {
    const Foot foot = nearest_foot(x, 0, stations_.size() - 1);
    return seen_from(x, foot.distance < Bounds::infinity ? foot.along : 0);   // else x is not finite
}

StentPoint StentAxis::coordinates(const Vec3& x, double along) const {
    const std::size_t piece = piece_at(along);
    const Foot foot =
        nearest_foot(x, piece - std::min<std::size_t>(piece, 2), std::min(piece + 3, stations_.size() - 1));
    return foot.distance < Bounds::infinity ? seen_from(x, foot.along) : coordinates(x);
}

Vec3 StentAxis::outward(const StentPoint& p) const {
    const Frame f = frame_at(p.along);
    return std::cos(p.angle) * f.normal + std::sin(p.angle) * f.binormal;
}

Vec3 StentAxis::tangent(const StentPoint& p) const { return frame_at(p.along).tangent; }

double StentAxis::stretch(const StentPoint& p) const {
    const std::size_t k = piece_at(p.along);
    const Station &a = stations_[k], &b = stations_[k + 1];
    const double span = b.along - a.along, part = (p.along - a.along) / span;
    if (part < 0 || part > 1) return 1;
    // d/d(along) of ((x - place) . tangent = 0), per unit tangent.
    const Vec3 tangent = a.tangent + part * (b.tangent - a.tangent);
    const Vec3 off = place(p) - (a.at + part * (b.at - a.at));
    return (dot(b.at - a.at, tangent) - dot(off, b.tangent - a.tangent)) / (span * norm(tangent));
}

}   // namespace patency
