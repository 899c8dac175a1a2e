// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/stent_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "patency/base/errors.h"
#include "patency/base/text.h"

namespace patency {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double chord_error = 1.0 / 2000;   // of the width, between an arc and its chord
constexpr double least_crown_radius = 0.6;   // strut widths; at 0.5 the inside of a crown is a cusp
constexpr double least_clearance = 0.25;     // strut widths between tips that are not joined
constexpr int connector_pieces = 64;

FlatPoint operator+(const FlatPoint& a, const FlatPoint& b) { return {a.around + b.around, a.along + b.along}; }
FlatPoint operator-(const FlatPoint& a, const FlatPoint& b) { return {a.around - b.around, a.along - b.along}; }
FlatPoint operator*(double s, const FlatPoint& a) { return {s * a.around, s * a.along}; }
FlatPoint left_of(const FlatPoint& a) { return {-a.along, a.around}; }
double length_of(const FlatPoint& a) { return std::hypot(a.around, a.along); }
double angle_of(const FlatPoint& a) { return std::atan2(a.along, a.around); }

void expect(bool holds, const std::string& sentence) {
    if (!holds) throw GeometryError("The stent cannot be made: " + sentence + ".");
}
std::string mm(double length) { return fmt::format("{:.4g} mm", 1e3 * length); }

double circumference_of(const StentPattern& p, double diameter) { return pi * (diameter - p.strut_thickness); }
double crowns_per_turn(const StentPattern& p) { return p.crowns + (p.layout == StentLayout::helix ? 0.5 : 0.0); }
double pitch_at(const StentPattern& p, double diameter) { return circumference_of(p, diameter) / crowns_per_turn(p); }
double gap_between_centrelines(const StentPattern& p) { return p.gap + p.strut_width; }

// The half crowns of a helix: it starts at a peak and ends in a valley, so that both ends lie at a neighbour's tip.
int last_half_crown(const StentPattern& p) {
    const int all = p.rings * (2 * p.crowns + 1);
    return all % 2 == 1 ? all : all - 1;
}

// Axial pitches from the lowest ring (valley) to the highest (peak).
double axial_pitches(const StentPattern& p) {
    if (p.layout == StentLayout::rings) return p.rings - 1;
    return (last_half_crown(p) - 2) / (2.0 * p.crowns + 1);
}

// The least amplitude at which circles of the crown radius on both sides can be joined by a strut.
double least_amplitude(double half_pitch, double radius) {
    return 2 * radius + std::sqrt(std::max(0.0, 4 * radius * radius - half_pitch * half_pitch));
}

// The length of the centreline from a peak to the next valley: THEORY (16.1).
double path_length(double half_pitch, double amplitude, double radius) {
    const double rise = amplitude - 2 * radius;
    const double strut = std::sqrt(std::max(0.0, half_pitch * half_pitch + rise * rise - 4 * radius * radius));
    const double slope = std::atan2(rise * strut + 2 * radius * half_pitch, strut * half_pitch - 2 * radius * rise);
    return strut + 2 * radius * slope;
}

void expect_sizes(const StentPattern& p) {
    const auto positive = [](const char* name, double value) {
        expect(value > 0 && std::isfinite(value), fmt::format("{} is {}, it must be positive", name, mm(value)));
    };
    positive("length", p.length);
    positive("diameter", p.diameter);
    positive("crimped_diameter", p.crimped_diameter);
    positive("nominal_diameter", p.nominal_diameter);
    positive("strut_width", p.strut_width);
    positive("strut_thickness", p.strut_thickness);
    positive("crown_radius", p.crown_radius);
    for (double value : {p.gap, p.connector_width, p.connector_swing, p.edge_radius})
        expect(value >= 0 && std::isfinite(value),
               "gap, connector_width, connector_swing and edge_radius must be zero or positive");
    expect(p.rings >= 1 && p.rings <= 200, fmt::format("rings is {}, it must be 1 to 200", p.rings));
    expect(p.crowns >= 2 && p.crowns <= 60, fmt::format("crowns is {}, it must be 2 to 60", p.crowns));
    expect(p.layout == StentLayout::rings || p.rings >= 2, "rings is 1, a helix needs at least 2 turns");
    expect(p.strut_thickness < p.diameter / 4,
           fmt::format("strut_thickness is {}, at most a quarter of the diameter, {}", mm(p.strut_thickness),
                       mm(p.diameter / 4)));
    const double width = p.connector_width > 0 ? std::min(p.strut_width, p.connector_width) : p.strut_width;
    const double edge_limit = 0.4 * std::min(p.strut_thickness, width);
    expect(p.edge_radius <= edge_limit,
           fmt::format("edge_radius is {}, at most {} for these struts", mm(p.edge_radius), mm(edge_limit)));
}

void expect_crowns(const StentPattern& p) {
    const double pitch = pitch_at(p, p.diameter), most = (pitch - p.strut_width) / 2;
    const double least = least_crown_radius * p.strut_width;
    expect(p.crown_radius >= least,
           fmt::format("crown_radius is {}, at least {} (0.6 strut_width)", mm(p.crown_radius), mm(least)));
    expect(p.crown_radius <= most,
           fmt::format("crown_radius is {}, at most {}: {} crowns of strut_width {} around diameter {} would overlap",
                       mm(p.crown_radius), mm(most), p.crowns, mm(p.strut_width), mm(p.diameter)));
    const double most_width = pitch_at(p, p.crimped_diameter) / 2;
    expect(p.strut_width <= most_width,
           fmt::format("crimped_diameter is {}: struts would overlap there; strut_width can be at most {}",
                       mm(p.crimped_diameter), mm(most_width)));
    const double amplitude = ring_amplitude(p), needed = least_amplitude(pitch / 2, p.crown_radius);
    const double q = axial_pitches(p);
    expect(amplitude >= needed,
           fmt::format("length is {}, at least {} for {} rings with this gap and crown_radius", mm(p.length),
                       mm((1 + q) * needed + q * gap_between_centrelines(p) + p.strut_width), p.rings));
    const double reach = 2 * crowns_per_turn(p) * path_length(pitch / 2, amplitude, p.crown_radius);
    const double widest = reach / pi + p.strut_thickness;
    expect(p.nominal_diameter <= widest, fmt::format("nominal_diameter is {}, but the struts are straight at {}",
                                                     mm(p.nominal_diameter), mm(widest)));
}

void expect_connectors(const StentPattern& p) {
    if (p.rings > 1) {
        expect(p.connectors >= 1 && p.connectors <= p.crowns,
               fmt::format("connectors is {}, it must be 1 to crowns, {}", p.connectors, p.crowns));
        const double least = least_clearance * p.strut_width;
        expect(p.gap >= least, fmt::format("gap is {}, at least {} (0.25 strut_width)", mm(p.gap), mm(least)));
    }
    expect(p.layout == StentLayout::helix || p.connectors == 0 || p.crowns % p.connectors == 0,
           fmt::format("connectors is {}, it must divide crowns, {}", p.connectors, p.crowns));
    expect(p.layout == StentLayout::rings || p.facing == CrownFacing::aligned,
           "facing is staggered, but the crowns of a helix are aligned");
    expect(p.connector_swing == 0 || p.connector_shape == ConnectorShape::flex,
           "connector_swing is given, but the connectors are straight");
    expect(std::abs(p.connector_shift) <= p.crowns, "connector_shift is more than all crowns");
}

// The wave through circles of one radius, over the first, under the second, and so on: arcs and the tangents that cross
// between them. Starts and ends at the tips of the first and the last circle.
std::vector<FlatPoint> weave(const std::vector<FlatPoint>& centres, double radius, double width) {
    const double step = 2 * std::acos(1 - std::min(1.0, chord_error * width / radius));
    std::vector<FlatPoint> points;
    FlatPoint arriving{1, 0};
    for (std::size_t k = 0; k < centres.size(); ++k) {
        const double side = k % 2 == 0 ? 1 : -1;   // over (clockwise) or under
        FlatPoint leaving{1, 0};
        if (k + 1 < centres.size()) {
            const FlatPoint e = centres[k + 1] - centres[k];
            const double square = e.around * e.around + e.along * e.along;
            const double strut = std::sqrt(std::max(0.0, square - 4 * radius * radius));
            leaving = (1 / square) * (strut * e - (2 * radius * side) * left_of(e));
        }
        double sweep = side * (angle_of(arriving) - angle_of(leaving));
        if (sweep < -1e-9) sweep += 2 * pi;
        const double start = angle_of(side * left_of(arriving));
        // Tips are corners, so that all arcs are divided alike: the first and the last are halves.
        const int halves = k == 0 || k + 1 == centres.size() ? 1 : 2;
        const int pieces = halves * std::max(1, int(std::ceil(sweep / halves / step - 1e-6)));
        for (int i = 0; i <= pieces; ++i) {
            const double angle = start - side * sweep * i / pieces;
            points.push_back(centres[k] + radius * FlatPoint{std::cos(angle), std::sin(angle)});
        }
        arriving = leaving;
    }
    return points;
}

// From tip to tip: `aside` more around, `rise` more along. THEORY (16.3).
Strut make_connector(const StentPattern& p, const FlatPoint& from, double aside, double rise) {
    const double width = p.connector_width > 0 ? p.connector_width : p.strut_width;
    const double largest = 3 * std::sqrt(3.0) / 8;   // of the swing's shape
    Strut strut{{}, width / 2};
    for (int i = 0; i <= connector_pieces; ++i) {
        const double t = double(i) / connector_pieces, sine = std::sin(2 * pi * t);
        const double way = p.connector_shape == ConnectorShape::straight ? t : t - sine / (2 * pi);
        const double swing = p.connector_swing / largest * sine * std::pow(std::sin(pi * t), 2);
        strut.points.push_back(from + FlatPoint{aside * way + swing, rise * t});
        if (aside == 0 && p.connector_swing == 0) return strut.points.push_back(from + FlatPoint{0, rise}), strut;
    }
    // Narrower bends than half the width would fold the strut's edge.
    double tightest = 1e9;
    for (std::size_t i = 1; i + 1 < strut.points.size(); ++i) {
        const FlatPoint a = strut.points[i] - strut.points[i - 1], b = strut.points[i + 1] - strut.points[i];
        const double turn = std::abs(a.around * b.along - a.along * b.around) / (length_of(a) * length_of(b));
        if (turn > 1e-9) tightest = std::min(tightest, length_of(a) / turn);
    }
    expect(tightest >= least_crown_radius * width,
           fmt::format("the connectors bend to a radius of {}, at least {} (0.6 of their width): reduce "
                       "connector_swing or widen the gap",
                       mm(tightest), mm(least_crown_radius * width)));
    return strut;
}

void add_rings(const StentPattern& p, StrutCurves& curves) {
    const double pitch = pitch_at(p, p.diameter), amplitude = ring_amplitude(p), rise = gap_between_centrelines(p);
    const double level = amplitude / 2 - p.crown_radius;
    const auto phase = [&](int ring) { return p.facing == CrownFacing::aligned && ring % 2 == 1 ? pitch / 2 : 0.0; };
    for (int ring = 0; ring < p.rings; ++ring) {
        const double middle = -p.length / 2 + p.strut_width / 2 + amplitude / 2 + ring * (amplitude + rise);
        std::vector<FlatPoint> centres;
        for (int k = 0; k <= 2 * p.crowns; ++k)
            centres.push_back({phase(ring) + k * pitch / 2, middle + (k % 2 == 0 ? level : -level)});
        curves.struts.push_back({weave(centres, p.crown_radius, p.strut_width), p.strut_width / 2});
        if (ring + 1 == p.rings) break;
        const double aside = p.facing == CrownFacing::aligned ? 0 : ring % 2 == 0 ? pitch / 2 : -pitch / 2;
        for (int c = 0; c < p.connectors; ++c) {
            const int crown = ring * p.connector_shift + c * (p.crowns / p.connectors);
            curves.struts.push_back(
                make_connector(p, {phase(ring) + crown * pitch, middle + amplitude / 2}, aside, rise));
        }
    }
    curves.cells = (p.rings - 1) * p.connectors;
}

void add_helix(const StentPattern& p, StrutCurves& curves) {
    const double circumference = curves.circumference(), pitch = pitch_at(p, p.diameter);
    const double amplitude = ring_amplitude(p), rise = gap_between_centrelines(p);
    const double level = amplitude / 2 - p.crown_radius;
    const int last = last_half_crown(p), turn = 2 * p.crowns + 1;
    const auto height = [&](int k) { return (amplitude + rise) * (k * pitch / 2) / circumference; };
    const double start = -p.length / 2 + p.strut_width / 2 + amplitude / 2 - height(1);   // the first valley is lowest
    std::vector<FlatPoint> centres;
    for (int k = 0; k <= last; ++k)
        centres.push_back({k * pitch / 2, start + height(k) + (k % 2 == 0 ? level : -level)});
    curves.struts.push_back({weave(centres, p.crown_radius, p.strut_width), p.strut_width / 2});
    const int peaks = (last - turn) / 2 + 1;   // that have a valley above them
    const int count = std::clamp(p.connectors * (p.rings - 1) + 1, 2, peaks);
    for (int c = 0; c < count; ++c) {
        const int k = 2 * int(std::lround(double(c) * (peaks - 1) / (count - 1)));
        curves.struts.push_back(make_connector(p, {k * pitch / 2, start + height(k) + amplitude / 2}, 0, rise));
    }
    curves.cells = count - 1;
}

}   // namespace

double StrutCurves::circumference() const { return 2 * pi * middle_radius; }

double ring_amplitude(const StentPattern& p) {
    const double q = axial_pitches(p);
    return (p.length - p.strut_width - q * gap_between_centrelines(p)) / (1 + q);
}

StentPattern with_length(const StentPattern& pattern, double length) {
    const double amplitude = ring_amplitude(pattern), gap = gap_between_centrelines(pattern);
    const auto with_rings = [&](int rings) {
        StentPattern p = pattern;
        p.rings = rings;
        const double pitches = axial_pitches(p);
        p.length = (1 + pitches) * amplitude + pitches * gap + p.strut_width;
        return p;
    };
    StentPattern best = with_rings(2);
    for (int rings = 3; best.length < length; ++rings) {
        const StentPattern longer = with_rings(rings);
        if (longer.length - length > length - best.length) break;
        best = longer;
    }
    return best;
}

StrutCurves make_strut_curves(const StentPattern& p) {
    expect_sizes(p);
    expect_connectors(p);
    expect_crowns(p);
    StrutCurves curves{(p.diameter - p.strut_thickness) / 2, p.strut_thickness, p.edge_radius, p.length, 0, {}};
    p.layout == StentLayout::rings ? add_rings(p, curves) : add_helix(p, curves);
    return curves;
}

StentPattern at_diameter(const StentPattern& p, double diameter) {
    const double r = p.crown_radius, half = pitch_at(p, diameter) / 2;
    const double path = path_length(pitch_at(p, p.diameter) / 2, ring_amplitude(p), r);
    double low = least_amplitude(half, r), high = low + path;
    expect(2 * half >= 2 * r + p.strut_width && path_length(half, low, r) <= path,
           fmt::format("the struts do not allow a diameter of {}", mm(diameter)));
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (path_length(half, middle, r) < path ? low : high) = middle;
    }
    StentPattern opened = p;
    const double q = axial_pitches(p);
    opened.diameter = diameter;
    opened.length = (1 + q) * low + q * gap_between_centrelines(p) + p.strut_width;
    return opened;
}

const std::vector<Alloy>& alloys() {
    static const std::vector<Alloy> table{
        {"L605", 9130, "cobalt-chromium, ASTM F90"},
        {"MP35N", 8430, "cobalt-nickel, ASTM F562"},
        {"316L", 7990, "stainless steel, ASTM F138"},
        {"PtCr", 9900, "platinum-chromium steel"},
        {"nitinol", 6450, "nickel-titanium, superelastic, ASTM F2063"},
    };
    return table;
}

const Alloy& find_alloy(const std::string& name) {
    std::vector<std::string> names;
    for (const Alloy& alloy : alloys()) {
        if (alloy.name == name) return alloy;
        names.push_back(alloy.name);
    }
    throw GeometryError(
        fmt::format("No alloy {}; there are {}.", double_quoted(shortened(name)), join(names, ", ", " and ")));
}

}   // namespace patency
