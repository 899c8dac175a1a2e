// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/branches.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/base/text.h"

namespace patency {

namespace {

constexpr double shortest_share = 1;   // of its radius: a shorter piece between bifurcations is part of them

using Points = std::vector<CentrelinePoint>;

bool is_in_tube(const Vec3& x, const Points& tube) {
    return std::any_of(tube.begin(), tube.end(), [&](const CentrelinePoint& p) {
        const Vec3 d = x - p.place;
        return dot(d, d) < p.radius * p.radius;
    });
}

/// The first point of the line after which it never is in the other's tube.
std::size_t leaving_point(const Points& line, const Points& other, std::size_t shared) {
    std::vector<char> is_inside(line.size());
    for_each_index(line.size() - shared,
                   [&](std::size_t k) { is_inside[shared + k] = is_in_tube(line[shared + k].place, other); });
    std::size_t k = line.size();
    while (k > shared && !is_inside[k - 1]) --k;
    return k;
}

/// Per line and point: whether it is in a bifurcation.
using Marks = std::vector<std::vector<char>>;

Marks mark_bifurcations(const std::vector<Centreline>& lines) {
    Marks marks;
    for (const Centreline& line : lines) marks.emplace_back(line.points.size(), 0);
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t j = 0; j < lines.size(); ++j) {
            if (i == j) continue;
            const Points& line = lines[i].points;
            const std::size_t shared = std::max<std::size_t>(shared_points(lines[i], lines[j]), 1);
            const CentrelinePoint& parting = line[shared - 1];
            std::size_t begin = shared;
            while (begin > 0 && line[begin - 1].arc >= parting.arc - parting.radius) --begin;
            const std::size_t end = leaving_point(line, lines[j].points, shared);
            std::fill(marks[i].begin() + std::ptrdiff_t(begin), marks[i].begin() + std::ptrdiff_t(end), 1);
        }
    return marks;
}

/// Pieces between bifurcations that are shorter than the vessel is wide are no branches.
void mark_short_pieces(const Points& line, std::vector<char>& marks) {
    for (std::size_t begin = 0, end; begin < line.size(); begin = end) {
        for (end = begin; end < line.size() && marks[end] == marks[begin];) ++end;
        const bool is_between = begin > 0 && end < line.size();
        if (!marks[begin] && is_between && line[end - 1].arc - line[begin].arc < shortest_share * line[begin].radius)
            std::fill(marks.begin() + std::ptrdiff_t(begin), marks.begin() + std::ptrdiff_t(end), 1);
    }
}

double distance_to(const NamedCurve& curve, const Vec3& x) {
    double nearest = curve.points.empty() ? Bounds::infinity : norm(x - curve.points[0]);
    for (std::size_t k = 1; k < curve.points.size(); ++k) {
        const Vec3 a = curve.points[k - 1], d = curve.points[k] - a;
        const double t = dot(d, d) > 0 ? std::clamp(dot(x - a, d) / dot(d, d), 0.0, 1.0) : 0;
        nearest = std::min(nearest, norm(x - a - t * d));
    }
    return nearest;
}

}   // namespace

BranchedLines find_branches(std::vector<Centreline> lines) {
    BranchedLines vessel{std::move(lines), {}, {}, {}};
    Marks marks = mark_bifurcations(vessel.lines);
    std::map<std::pair<std::size_t, std::size_t>, int>
        branch_at;   // by the line that has its first point, and the point
    for (std::size_t j = 0; j < vessel.lines.size(); ++j) {
        const Points& line = vessel.lines[j].points;
        mark_short_pieces(line, marks[j]);
        std::vector<int>& branch_ids = vessel.branch_ids.emplace_back(line.size(), -1);
        std::vector<int>& bifurcation_ids = vessel.bifurcation_ids.emplace_back(line.size(), -1);
        int parent = -1;
        for (std::size_t begin = 0, end; begin < line.size(); begin = end) {
            for (end = begin; end < line.size() && marks[j][end] == marks[j][begin];) ++end;
            if (marks[j][begin]) {
                std::fill(bifurcation_ids.begin() + std::ptrdiff_t(begin),
                          bifurcation_ids.begin() + std::ptrdiff_t(end), std::max(parent, 0));
                continue;
            }
            std::size_t owner = 0;   // the first line that has this point
            while (owner < j && shared_points(vessel.lines[owner], vessel.lines[j]) <= begin) ++owner;
            const auto [found, is_new] = branch_at.try_emplace({owner, begin}, int(vessel.branches.size()));
            if (is_new)
                vessel.branches.push_back(
                    {fmt::format("branch_{}", vessel.branches.size() + 1), j, begin, end - 1, parent, {}});
            vessel.branches[std::size_t(found->second)].lines.push_back(j);
            parent = found->second;
            std::fill(branch_ids.begin() + std::ptrdiff_t(begin), branch_ids.begin() + std::ptrdiff_t(end), parent);
        }
    }
    return vessel;
}

void name_branches(BranchedLines& vessel, std::span<const NamedCurve> curves) {
    std::map<std::string, int> uses;
    for (Branch& branch : vessel.branches) {
        const double count = double(branch.last - branch.first + 1);
        double radius = 0;
        for (std::size_t k = branch.first; k <= branch.last; ++k) radius += vessel.point(branch, k).radius / count;
        double best = 0.5 * radius;
        std::string name;
        for (const NamedCurve& curve : curves) {
            double mean = 0;
            for (std::size_t k = branch.first; k <= branch.last; ++k)
                mean += distance_to(curve, vessel.point(branch, k).place) / count;
            if (mean < best) best = mean, name = curve.name;
        }
        if (name.empty()) continue;
        const int use = ++uses[name];
        branch.name = use == 1 ? name : fmt::format("{}_{}", name, use);
    }
}

std::optional<std::size_t> branch_around(const BranchedLines& vessel, const Vec3& point) {
    std::optional<std::size_t> found;
    double least = 1;
    for (std::size_t b = 0; b < vessel.branches.size(); ++b) {
        const Branch& branch = vessel.branches[b];
        for (std::size_t k = branch.first; k <= branch.last; ++k) {
            const CentrelinePoint& p = vessel.point(branch, k);
            if (const double depth = norm(p.place - point) / p.radius; depth < least) least = depth, found = b;
        }
    }
    return found;
}

void name_branches(BranchedLines& vessel, const std::map<std::string, Vec3>& points) {
    std::map<std::size_t, std::string> names;
    for (const auto& [name, point] : points) {
        const auto branch = branch_around(vessel, point);
        if (!branch) throw UsageError(fmt::format("the point of '{}' lies in no branch", shortened(name)));
        const auto [there, is_new] = names.try_emplace(*branch, name);
        if (!is_new)
            throw UsageError(fmt::format("the points of '{}' and '{}' lie in the same branch", shortened(there->second),
                                         shortened(name)));
    }
    for (const auto& [branch, name] : names) vessel.branches[branch].name = name;
    std::set<std::string> known;
    for (const Branch& branch : vessel.branches)
        if (!known.insert(branch.name).second)
            throw UsageError(fmt::format("two branches would be '{}'", shortened(branch.name)));
}

Vec3 normal_of(const BranchedLines& vessel) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3d> points;
    for (const Centreline& line : vessel.lines)
        for (const CentrelinePoint& p : line.points) sum += points.emplace_back(p.place.x, p.place.y, p.place.z);
    const Eigen::Vector3d mean = sum / double(points.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : points) spread += (p - mean) * (p - mean).transpose();
    const Eigen::Vector3d n =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);   // of the least spread
    return {n.x(), n.y(), n.z()};
}

}   // namespace patency
