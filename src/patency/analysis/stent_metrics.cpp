// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/stent_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/shape/surface.h"

namespace patency {

namespace {

constexpr int directions = 72;   // of 5 degrees: a strut of 0.1 mm at 3 mm is one wide
constexpr double pi = std::numbers::pi;

int direction_of(double angle) {
    const int k = int(std::floor((angle / (2 * pi) - std::floor(angle / (2 * pi))) * directions));
    return std::min(k, directions - 1);
}

/// Mean radius by direction; those without a place lie on straight lines over the angle between those with one.
std::array<double, directions> radii_of(const std::vector<StentPoint>& places) {
    std::array<double, directions> sum{}, count{}, radii{};
    for (const StentPoint& p : places)
        sum[std::size_t(direction_of(p.angle))] += p.radius, count[std::size_t(direction_of(p.angle))] += 1;
    const auto next = [&](int from, int step) {
        int k = from;
        while (count[std::size_t((k % directions + directions) % directions)] == 0) k += step;
        return k;
    };
    for (int k = 0; k < directions; ++k) {
        const int a = next(k, -1), b = next(k, 1);
        const auto radius = [&](int at) {
            const auto i = std::size_t((at % directions + directions) % directions);
            return sum[i] / count[i];
        };
        const double part = a == b ? 0 : double(k - a) / (b - a);
        radii[std::size_t(k)] = (1 - part) * radius(a) + part * radius(b);
    }
    return radii;
}

StentSlice measure_slice(double along, const std::vector<StentPoint>& places) {
    const std::array<double, directions> r = radii_of(places);
    StentSlice slice{.along = along,
                     .mean_diameter = 2 * std::accumulate(r.begin(), r.end(), 0.0) / directions,
                     .least_diameter = Bounds::infinity,
                     .most_diameter = 0,
                     .area = 0};
    for (const StentPoint& p : places)
        slice.least_diameter = std::min(slice.least_diameter, 2 * p.radius),
        slice.most_diameter = std::max(slice.most_diameter, 2 * p.radius);
    for (const double radius : r) slice.area += pi / directions * radius * radius;
    return slice;
}

template <class Wanted>
double mean_diameter_where(const std::vector<StentSlice>& slices, Wanted wanted) {
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < slices.size(); ++k)
        if (wanted((double(k) + 0.5) / double(slices.size()))) sum += slices[k].mean_diameter, count += 1;
    return sum / count;
}

double radius_at(const StentProfile& shape, double along) {
    const auto& s = shape.slices;
    for (std::size_t k = 1; k < s.size(); ++k)
        if (along < s[k].along) {
            const double part = std::clamp((along - s[k - 1].along) / (s[k].along - s[k - 1].along), 0.0, 1.0);
            return 0.5 * ((1 - part) * s[k - 1].mean_diameter + part * s[k].mean_diameter);
        }
    return 0.5 * s.back().mean_diameter;
}

}   // namespace

StentProfile measure_stent_profile(std::span<const StentPoint> outer, int slices) {
    const auto [first, last] =
        std::minmax_element(outer.begin(), outer.end(), [](const auto& a, const auto& b) { return a.along < b.along; });
    if (outer.empty() || slices < 1 || !(last->along > first->along))
        throw GeometryError("A stent without a length has no measures.");
    const double low = first->along, length = last->along - low;
    std::vector<std::vector<StentPoint>> places(static_cast<std::size_t>(slices));
    for (const StentPoint& p : outer)
        places[std::min(std::size_t((p.along - low) / length * slices), places.size() - 1)].push_back(p);
    StentProfile shape{.slices = {},
                       .length = length,
                       .least_diameter = Bounds::infinity,
                       .mean_diameter = 0,
                       .most_diameter = 0,
                       .least_area = Bounds::infinity,
                       .end_diameter = 0,
                       .middle_diameter = 0};
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (places[k].size() < 3)
            throw GeometryError("A stent has fewer than three places in a slice of its length; take fewer slices.");
        shape.slices.push_back(measure_slice(low + length * (double(k) + 0.5) / slices, places[k]));
        const StentSlice& s = shape.slices.back();
        shape.least_diameter = std::min(shape.least_diameter, s.mean_diameter),
        shape.most_diameter = std::max(shape.most_diameter, s.mean_diameter);
        shape.mean_diameter += s.mean_diameter / slices, shape.least_area = std::min(shape.least_area, s.area);
    }
    const double end = std::max(0.1, 1.0 / slices), half_middle = std::max(0.1, 0.6 / slices);
    shape.end_diameter = mean_diameter_where(shape.slices, [&](double at) { return at < end || at > 1 - end; });
    shape.middle_diameter =
        mean_diameter_where(shape.slices, [&](double at) { return std::abs(at - 0.5) < half_middle; });
    return shape;
}

double recoil(double inflated_diameter, double deflated_diameter) {
    return (inflated_diameter - deflated_diameter) / inflated_diameter;
}

double foreshortening(double length_before, double length_after) {
    return (length_before - length_after) / length_before;
}

double dogboning(const StentProfile& shape) {
    return (shape.end_diameter - shape.middle_diameter) / shape.end_diameter;
}

double reach_to_wall(const SignedDistance& lumen, const Vec3& from, const Vec3& direction, double most) {
    double way = 0;
    const double near = 1e-4 * most;
    while (way < most) {   // a ball of the distance around the place holds no wall
        const double inside = -lumen.value(from + way * direction);
        if (inside < near) return way + std::max(inside, 0.0);
        way += inside;
    }
    return most;
}

StrutFit measure_fit(std::span<const Vec3> places, std::span<const double> areas, const StentAxis& axis,
                     const SignedDistance& lumen, const ApposedRule& rule) {
    StrutFit fit{.gap = std::vector<double>(places.size()), .is_over_ostium = std::vector<char>(places.size())};
    for_each_index(places.size(), [&](std::size_t i) {
        fit.gap[i] = -lumen.value(places[i]);
        if (fit.gap[i] <= rule.largest_gap) return;
        const StentPoint at = axis.coordinates(places[i]);
        const double most = (rule.ostium_reach - 1) * at.radius;
        fit.is_over_ostium[i] = reach_to_wall(lumen, places[i], axis.outward(at), most) >= most;
    });
    double facing = 0, malapposed = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (fit.is_over_ostium[i]) {
            fit.over_ostia += areas[i];
            continue;
        }
        facing += areas[i];
        if (fit.gap[i] > rule.largest_gap) malapposed += areas[i];
        fit.largest_gap = std::max(fit.largest_gap, fit.gap[i]);
    }
    fit.malapposed = facing > 0 ? malapposed / facing : 0;
    return fit;
}

std::vector<JailedOstium> find_jailed_ostia(const StentProfile& shape, const StentAxis& axis,
                                            const SignedDistance& lumen, const ApposedRule& rule) {
    const double cell = pi * shape.mean_diameter / directions;
    const int rows = std::max(1, int(std::ceil(shape.length / cell)));
    const double low = shape.slices.front().along - 0.5 * shape.length / double(shape.slices.size());
    const auto place_of = [&](int row, int k) {
        const double along = low + shape.length * (row + 0.5) / rows;
        return StentPoint{radius_at(shape, along), 2 * pi * (k + 0.5) / directions, along};
    };
    std::vector<char> is_open(std::size_t(rows * directions), 0);
    for_each_task(is_open.size(), [&](std::size_t i) {
        const StentPoint at = place_of(int(i) / directions, int(i) % directions);
        const double most = rule.ostium_reach * at.radius;
        is_open[i] = reach_to_wall(lumen, axis.place({0, 0, at.along}), axis.outward(at), most) >= most;
    });
    Groups groups(is_open.size());
    const auto join = [&](int a, int b) {
        if (is_open[std::size_t(a)] && is_open[std::size_t(b)]) groups.join(std::uint32_t(a), std::uint32_t(b));
    };
    for (int row = 0; row < rows; ++row)
        for (int k = 0; k < directions; ++k) {
            join(row * directions + k, row * directions + (k + 1) % directions);
            if (row + 1 < rows) join(row * directions + k, (row + 1) * directions + k);
        }
    std::vector<JailedOstium> by_group(is_open.size(), {{}, 0}), ostia;
    for (std::size_t i = 0; i < is_open.size(); ++i) {
        if (!is_open[i]) continue;
        const StentPoint at = place_of(int(i) / directions, int(i) % directions);
        const double area = 2 * pi * at.radius / directions * shape.length / rows * axis.stretch(at);
        JailedOstium& ostium = by_group[groups.group_of(std::uint32_t(i))];
        ostium.centre += area * axis.place(at), ostium.area += area;
    }
    for (JailedOstium& ostium : by_group) {
        if (ostium.area < 0.01 * pi / 4 * shape.mean_diameter * shape.mean_diameter) continue;
        ostium.centre = ostium.centre / ostium.area;
        ostia.push_back(ostium);
    }
    std::sort(ostia.begin(), ostia.end(), [](const auto& a, const auto& b) { return a.area > b.area; });
    return ostia;
}

std::vector<double> pressures_on(std::span<const Vec3> places, std::span<const double> areas,
                                 std::span<const PressedPlace> presses, double reach) {
    Vec3 low{INFINITY, INFINITY, INFINITY}, high = -1.0 * low;
    for (const Vec3& x : places)
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)},
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    const Vec3 size = high - low;
    double Vec3::*const along = size.x >= size.y && size.x >= size.z ? &Vec3::x
                                : size.y >= size.z                   ? &Vec3::y
                                                                     : &Vec3::z;
    // In the order along the longest side, what is within reach lies in one window.
    struct Amount {
        Vec3 place;
        double force, area;
        std::size_t of;   // the place it is of; none: a force's
    };
    constexpr std::size_t none = std::size_t(-1);
    std::vector<Amount> amounts;
    for (std::size_t k = 0; k < places.size(); ++k) amounts.push_back({places[k], 0, areas[k], k});
    for (const PressedPlace& p : presses) amounts.push_back({p.place, p.force, 0, none});
    std::stable_sort(amounts.begin(), amounts.end(),
                     [&](const Amount& a, const Amount& b) { return a.place.*along < b.place.*along; });
    std::vector<double> pressures(places.size());
    auto first = amounts.begin();
    for (const Amount& at : amounts) {
        if (at.of == none) continue;
        while (first->place.*along < at.place.*along - reach) ++first;
        double force = 0, area = 0;
        for (auto a = first; a != amounts.end() && a->place.*along <= at.place.*along + reach; ++a)
            if (norm(a->place - at.place) <= reach) force += a->force, area += a->area;
        if (area > 0) pressures[at.of] = force / area;
    }
    return pressures;
}

double weighted_percentile(std::span<const double> values, std::span<const double> weights, double share) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    const double wanted = share * std::accumulate(weights.begin(), weights.end(), 0.0);
    double below = 0;
    for (const std::size_t i : order)
        if ((below += weights[i]) >= wanted) return values[i];
    return order.empty() ? 0 : values[order.back()];
}

}   // namespace patency
