// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/shape/network_field.h"
#include "patency/shape/signed_distance.h"
#include "patency/shape/surface.h"

namespace patency {

namespace {

constexpr double largest_coordinate = 1e3;   // m
constexpr double smallest_radius = 1e-6;     // m: a capillary has three times that

std::vector<std::string> names_of(const Network& network) {
    std::vector<std::string> names;
    for (const Tube& tube : network.tubes) names.push_back(tube.name);
    return names;
}

void expect_tube(const Tube& tube) {
    const auto refuse = [&](const std::string& what) {
        throw GeometryError(fmt::format("Tube '{}' {}", shortened(tube.name), what));
    };
    if (tube.points.size() < 2 || tube.points.size() != tube.radii.size())
        refuse(fmt::format("has {} points and {} radii: it needs two or more of each, as many radii as points.",
                           tube.points.size(), tube.radii.size()));
    for (std::size_t k = 0; k < tube.points.size(); ++k) {
        const Vec3& x = tube.points[k];
        const double largest = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
        if (!std::isfinite(x.x + x.y + x.z) || largest > largest_coordinate)
            refuse(fmt::format(
                "has its point {} at ({:g}, {:g}, {:g}) m, which is no place in a body: check the file and its unit.",
                k + 1, x.x, x.y, x.z));
        if (!(tube.radii[k] > 0) || !std::isfinite(tube.radii[k]))
            refuse(fmt::format("has a radius of {:g} m at its point {}: it must be positive.", tube.radii[k], k + 1));
        if (tube.radii[k] < smallest_radius)
            refuse(
                fmt::format("has a radius of {:g} m at its point {}, which is narrower than any vessel: check the file "
                            "and its unit.",
                            tube.radii[k], k + 1));
        if (k > 0 && x == tube.points[k - 1])
            refuse(fmt::format("has the same place twice, as its points {} and {}: take one out.", k, k + 1));
    }
}

/// The direction out of a tube at one of its ends, over the last radius of length: single points may be noisy.
Vec3 outward_direction(const Tube& tube, bool at_end) {
    const std::size_t n = tube.points.size();
    const auto index = [&](std::size_t k) { return at_end ? n - 1 - k : k; };
    const Vec3& tip = tube.points[index(0)];
    std::size_t k = 1;
    while (k + 1 < n && norm(tube.points[index(k)] - tip) < tube.radii[index(0)]) ++k;
    return normalized(tip - tube.points[index(k)]);
}

}   // namespace

double length_of(const Tube& tube) {
    double length = 0;
    for (std::size_t k = 1; k < tube.points.size(); ++k) length += norm(tube.points[k] - tube.points[k - 1]);
    return length;
}

double narrowest_diameter(const Network& network) {
    double radius = Bounds::infinity;
    for (const Tube& tube : network.tubes)
        for (double r : tube.radii) radius = std::min(radius, r);
    return 2 * radius;
}

double widest_diameter(const Network& network) {
    double radius = 0;
    for (const Tube& tube : network.tubes)
        for (double r : tube.radii) radius = std::max(radius, r);
    return 2 * radius;
}

Passage passage_of(const Network& network) {
    const auto cube = [](double r) { return r * r * r; };
    double outlets = 0;
    for (const Tube& tube : network.tubes) {
        if (tube.start && tube.start->name != "inlet") outlets += cube(tube.radii.front());
        if (tube.end && tube.end->name != "inlet") outlets += cube(tube.radii.back());
    }
    Passage passage{Bounds::infinity, 0};
    for (const Tube& tube : network.tubes) {
        const double healthy = *std::max_element(tube.radii.begin(), tube.radii.end());
        const double share = outlets > 0 ? std::min(1.0, cube(healthy) / outlets) : 1;
        for (std::size_t k = 0; k < tube.points.size(); ++k) {
            const double area = std::numbers::pi * tube.radii[k] * tube.radii[k];
            passage.tightest_area = std::min(passage.tightest_area, area / share);
            if (k == 0) continue;
            const double a = tube.radii[k - 1], b = tube.radii[k];   // linear in between
            passage.drag += share * norm(tube.points[k] - tube.points[k - 1]) * (a * a + a * b + b * b) /
                            (3 * cube(a) * cube(b) * std::numbers::pi * std::numbers::pi);
        }
    }
    return passage;
}

void expect_tubes(const Network& network) {
    if (network.tubes.empty()) throw GeometryError("The network has no tubes.");
    if (!(network.blend >= 0) || !std::isfinite(network.blend))
        throw GeometryError(
            fmt::format("The network's blend width is {:g} m: it must be zero or positive.", network.blend));
    std::set<std::string> names;
    for (const Tube& tube : network.tubes) {
        expect_tube(tube);
        if (!names.insert(tube.name).second)
            throw GeometryError(fmt::format("Two tubes are named '{}': names must differ.", tube.name));
    }
}

void expect_sound(const Network& network) {
    expect_tubes(network);
    std::set<std::string> openings;
    for (const Tube& tube : network.tubes)
        for (const auto* opening : {&tube.start, &tube.end})
            if (*opening && !openings.insert((*opening)->name).second)
                throw GeometryError(fmt::format("Two openings are named '{}': names must differ.", (*opening)->name));
    Groups parts(network.tubes.size());   // of tubes that touch with an end
    for (std::uint32_t k = 0; k < network.tubes.size(); ++k) {
        const TubeField field(network.tubes[k]);
        for (std::uint32_t j = 0; j < network.tubes.size(); ++j)
            if (field.value(network.tubes[j].points.front()) < 0 || field.value(network.tubes[j].points.back()) < 0)
                parts.join(k, j);
    }
    for (std::uint32_t k = 0; k < network.tubes.size(); ++k)
        if (parts.group_of(k) != 0)
            throw GeometryError(fmt::format(
                "Tubes '{}' and '{}' do not hang together: no end of one lies within the other or within tubes "
                "between them. Move the end of one into the other.",
                network.tubes[0].name, network.tubes[k].name));
    if (openings.size() < 2)
        throw GeometryError(fmt::format(
            "The network has {} opening{}; blood must enter and leave, so it needs two or more ends that lie "
            "in no other tube.",
            openings.size(), openings.size() == 1 ? "" : "s"));
}

void open_free_ends(Network& network) {
    struct FreeEnd {
        std::size_t tube;
        bool at_end;
        double radius;
    };
    std::vector<FreeEnd> ends;
    std::vector<TubeField> fields(network.tubes.begin(), network.tubes.end());
    for (std::size_t k = 0; k < network.tubes.size(); ++k)
        for (bool at_end : {false, true}) {
            const Tube& tube = network.tubes[k];
            const Vec3& tip = at_end ? tube.points.back() : tube.points.front();
            bool is_free = true;
            for (std::size_t j = 0; j < fields.size() && is_free; ++j) is_free = j == k || fields[j].value(tip) >= 0;
            if (is_free) ends.push_back({k, at_end, at_end ? tube.radii.back() : tube.radii.front()});
        }
    std::stable_sort(ends.begin(), ends.end(), [](const FreeEnd& a, const FreeEnd& b) { return a.radius > b.radius; });
    for (std::size_t n = 0; n < ends.size(); ++n) {
        Tube& tube = network.tubes[ends[n].tube];
        const bool has_name = !tube.name.starts_with("branch_") && !(tube.start && ends[n].at_end);
        const std::string name = n == 0 ? "inlet" : has_name ? "outlet_" + tube.name : fmt::format("outlet_{}", n);
        (ends[n].at_end ? tube.end : tube.start) = TubeOpening{name, outward_direction(tube, ends[n].at_end)};
    }
}

void open_at(Network& network, const std::string& name, const Vec3& point, const Vec3& normal) {
    struct Crossing {
        std::size_t tube, piece;
        double share, along, beside;
    };
    std::optional<Crossing> nearest;
    for (std::size_t t = 0; t < network.tubes.size(); ++t) {
        const auto& points = network.tubes[t].points;
        for (std::size_t k = 0; k + 1 < points.size(); ++k) {
            const Vec3 piece = points[k + 1] - points[k];
            const double share = std::clamp(dot(point - points[k], piece) / dot(piece, piece), 0.0, 1.0);
            const double beside = norm(points[k] + share * piece - point);
            if (!nearest || beside < nearest->beside) nearest = {t, k, share, dot(normalized(piece), normal), beside};
        }
    }
    constexpr double least_along = 0.95, most_beside = 0.2;   // cosine; of the radius
    if (!nearest || std::abs(nearest->along) < least_along ||
        nearest->beside > most_beside * network.tubes[nearest->tube].radii[nearest->piece])
        throw GeometryError(
            fmt::format("No tube passes through the middle of opening '{}' across its plane.", shortened(name)));
    Tube& tube = network.tubes[nearest->tube];
    const std::size_t k = nearest->piece;
    const double radius = tube.radii[k] + nearest->share * (tube.radii[k + 1] - tube.radii[k]);
    const bool at_end = nearest->along > 0;
    // Kept is what lies behind the plane, down to the point before it; the opening's own point follows.
    const double least_step = 1e-3 * radius;
    std::vector<Vec3> points;
    std::vector<double> radii;
    for (std::size_t n = 0; n < tube.points.size(); ++n) {
        if (at_end ? n > k : n <= k) continue;
        if (norm(tube.points[n] - point) < least_step) continue;
        points.push_back(tube.points[n]);
        radii.push_back(tube.radii[n]);
    }
    points.insert(at_end ? points.end() : points.begin(), point);
    radii.insert(at_end ? radii.end() : radii.begin(), radius);
    tube.points = std::move(points);
    tube.radii = std::move(radii);
    (at_end ? tube.end : tube.start) = TubeOpening{name, normalized(normal)};
}

void add_lesion(Network& network, const Narrowing& lesion) {
    const auto found =
        std::find_if(network.tubes.begin(), network.tubes.end(), [&](const Tube& t) { return t.name == lesion.tube; });
    if (found == network.tubes.end()) {
        const std::string nearest = nearest_name(lesion.tube, names_of(network));
        throw GeometryError(fmt::format(
            "The lesion lies in branch '{}', which the network has not{}; it has {}.", shortened(lesion.tube),
            nearest.empty() ? "" : ", did you mean " + nearest + "?", join(names_of(network), ", ", " and ")));
    }
    Tube& tube = *found;
    const double low = lesion.position - 0.5 * lesion.length, high = lesion.position + 0.5 * lesion.length,
                 length = length_of(tube);
    if (!(low >= 0 && high <= length))
        throw GeometryError(
            fmt::format("The lesion reaches from {:.4g} to {:.4g} mm along branch '{}', which is {:.4g} mm long.",
                        1e3 * low, 1e3 * high, tube.name, 1e3 * length));
    Vec3 plaque{};   // unit, across the centreline at the middle
    if (lesion.eccentricity > 0) {
        double arc = 0;
        std::size_t k = 0;
        while (k + 2 < tube.points.size() && (arc += norm(tube.points[k + 1] - tube.points[k])) < lesion.position) ++k;
        const Vec3 axis = normalized(tube.points[k + 1] - tube.points[k]),
                   side = lesion.side.value_or(motion_along(axis, {}).turn({0, 1, 0}));
        plaque = side - dot(side, axis) * axis;
        if (!(norm(plaque) > 0.1 * norm(side)))
            throw GeometryError(fmt::format(
                "The side of the lesion lies along branch '{}' there: give a direction across it.", tube.name));
        plaque = normalized(plaque);
    }
    constexpr int pieces = 64;   // straight ones follow the cosine to 1e-3 of its depth
    std::vector<Vec3> points;
    std::vector<double> radii;
    const auto add = [&](double arc, const Vec3& x, double radius) {
        const double z = (arc - lesion.position) / (0.5 * lesion.length);
        const double narrowing =
            std::abs(z) < 1 ? radius * lesion.stenosis * 0.5 * (1 + std::cos(std::numbers::pi * z)) : 0;
        points.push_back(x - lesion.eccentricity * narrowing * plaque);
        radii.push_back(radius - narrowing);
    };
    double arc = 0;
    const double step = lesion.length / pieces;
    for (std::size_t k = 0; k + 1 < tube.points.size(); ++k) {
        const Vec3 piece = tube.points[k + 1] - tube.points[k];
        const double size = norm(piece);
        const bool is_within = arc < high && arc + size > low;
        const int parts = is_within ? std::max(1, int(std::ceil(size / step))) : 1;
        for (int p = 0; p < parts; ++p) {
            const double share = double(p) / parts;
            add(arc + share * size, tube.points[k] + share * piece,
                tube.radii[k] + share * (tube.radii[k + 1] - tube.radii[k]));
        }
        arc += size;
    }
    points.push_back(tube.points.back());
    radii.push_back(tube.radii.back());
    tube.points = std::move(points);
    tube.radii = std::move(radii);
}

}   // namespace patency
