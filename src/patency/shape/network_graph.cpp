// SPDX-License-Identifier: Apache-2.0
// Tubes from the points and lines of a file: chains of a graph, and lines that share their way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "patency/base/errors.h"
#include "patency/shape/network.h"
#include "patency/shape/network_field.h"

namespace patency {

namespace {

using Index = std::uint32_t;

/// For every point the first one with the same coordinates.
std::vector<Index> first_equal(const std::vector<Vec3>& points) {
    std::map<std::tuple<double, double, double>, Index> seen;
    std::vector<Index> first;
    for (Index k = 0; k < points.size(); ++k)
        first.push_back(seen.try_emplace({points[k].x, points[k].y, points[k].z}, k).first->second);
    return first;
}

/// How many points at the start of a tube lie on top of one of the fields.
std::size_t shared_points(const Tube& tube, const std::vector<TubeField>& fields) {
    constexpr double tolerance = 0.1;   // of the radius
    std::size_t count = 0;
    const auto is_shared = [&](std::size_t k) {
        for (const TubeField& field : fields)
            if (field.distance_from_axis(tube.points[k]) < tolerance * tube.radii[k]) return true;
        return false;
    };
    while (count < tube.points.size() && is_shared(count)) ++count;
    return count;
}

void reverse(Tube& tube) {
    std::reverse(tube.points.begin(), tube.points.end());
    std::reverse(tube.radii.begin(), tube.radii.end());
}

}   // namespace

Network network_of_graph(const std::vector<Vec3>& points, const std::vector<double>& radii,
                         const std::vector<std::array<std::uint32_t, 2>>& edges) {
    for (const Vec3& x : points)
        if (!std::isfinite(x.x + x.y + x.z))
            throw GeometryError("A point of the network has a coordinate that is no number.");
    const std::vector<Index> first = first_equal(points);
    std::vector<std::vector<Index>> neighbours(points.size());
    for (const auto& edge : edges) {
        const Index a = first[edge[0]], b = first[edge[1]];
        if (a == b || std::find(neighbours[a].begin(), neighbours[a].end(), b) != neighbours[a].end()) continue;
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
    }
    Network network;
    std::map<std::pair<Index, Index>, bool> is_used;   // steps taken, both ways
    for (Index node = 0; node < points.size(); ++node) {
        if (neighbours[node].size() == 2) continue;   // not an end
        for (Index next : neighbours[node]) {
            if (is_used[{node, next}]) continue;
            std::vector<Index> chain{node, next};
            while (neighbours[chain.back()].size() == 2) {
                const auto& on = neighbours[chain.back()];
                chain.push_back(on[0] == chain[chain.size() - 2] ? on[1] : on[0]);
            }
            for (std::size_t k = 1; k < chain.size(); ++k)
                is_used[{chain[k - 1], chain[k]}] = is_used[{chain[k], chain[k - 1]}] = true;
            Tube tube{.name = fmt::format("branch_{}", network.tubes.size() + 1), .points = {}, .radii = {}};
            for (Index k : chain) {
                tube.points.push_back(points[k]);
                tube.radii.push_back(radii[k]);
            }
            if (neighbours[chain.front()].size() > 2) tube.radii.front() = std::min(tube.radii[0], tube.radii[1]);
            if (neighbours[chain.back()].size() > 2)
                tube.radii.back() = std::min(tube.radii.back(), tube.radii[chain.size() - 2]);
            network.tubes.push_back(std::move(tube));
        }
    }
    for (Index node = 0; node < points.size(); ++node)
        if (neighbours[node].size() == 2 && !is_used[{node, neighbours[node][0]}])
            throw GeometryError(fmt::format(
                "The line through point {} is a closed ring without an end: cut it open, or join a branch to it.",
                node + 1));
    return network;
}

void part_shared_tubes(Network& network) {
    std::vector<TubeField> fields;
    std::vector<Tube> kept;
    for (Tube& tube : network.tubes) {
        bool is_new = true;
        for (int end = 0; end < 2 && is_new && !fields.empty(); ++end) {
            const std::size_t shared = shared_points(tube, fields);
            is_new = shared < tube.points.size();
            if (is_new && shared > 1) {   // the last shared point joins it to the other
                tube.points.erase(tube.points.begin(), tube.points.begin() + std::ptrdiff_t(shared) - 1);
                tube.radii.erase(tube.radii.begin(), tube.radii.begin() + std::ptrdiff_t(shared) - 1);
            }
            reverse(tube);   // then the other end; and back
        }
        if (!is_new) continue;
        fields.emplace_back(tube);
        kept.push_back(std::move(tube));
    }
    network.tubes = std::move(kept);
}

}   // namespace patency
