// SPDX-License-Identifier: Apache-2.0
// Patterns of stents and their metal: what can be made is one connected piece with the cells, widths and thickness it
// says; what cannot be made is refused with the parameter that is wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/shape/stent_chart.h"
#include "patency/shape/stent_library.h"
#include "patency/shape/surface_check.h"

namespace patency {

void PrintTo(const StentDesign& design, std::ostream* out) { *out << design.name; }

namespace {

constexpr double pi = std::numbers::pi;

class Library : public ::testing::TestWithParam<StentDesign> {
protected:
    const StentPattern pattern_ = GetParam().pattern;
    const StrutCurves curves_ = make_strut_curves(pattern_);
    const StrutMap map_{curves_};
};
INSTANTIATE_TEST_SUITE_P(Stents, Library, ::testing::ValuesIn(stent_library()),
                         [](const auto& p) { return std::string(p.param.name); });

struct Rings : Library {};   // the designs that are no helix
INSTANTIATE_TEST_SUITE_P(Stents, Rings, ::testing::ValuesIn([] {
                             std::vector<StentDesign> rings;
                             for (const StentDesign& design : stent_library())
                                 if (design.pattern.layout == StentLayout::rings) rings.push_back(design);
                             return rings;
                         }()),
                         [](const auto& p) { return std::string(p.param.name); });

TEST_P(Library, IsOneConnectedPieceWithThePatternsCells) {
    const StentMeasures m = measure_stent(curves_);   // throws if there are more pieces or other cells
    EXPECT_EQ(m.cells.size(), std::size_t(curves_.cells));
    // All of the tube: metal, cells and the two ends.
    double cells = 0, edges = 0;
    for (const StentCell& cell : m.cells) {
        cells += cell.area, edges += cell.perimeter;
        EXPECT_GT(cell.area, pi / 4 * cell.inscribed * cell.inscribed);
        EXPECT_GT(cell.perimeter, pi * cell.inscribed);
        EXPECT_GT(cell.inscribed, pattern_.gap * 0.9);
    }
    EXPECT_LT(cells + m.plan_area, curves_.circumference() * curves_.length);
    EXPECT_LT(edges, m.edge_length);
    EXPECT_GT(m.metal_ratio, 0.08);
    EXPECT_LT(m.metal_ratio, 0.40);
    EXPECT_GE(find_alloy(pattern_.alloy).density, 6000);
}

TEST_P(Library, MeshIsClosedAndHasTheMetalsMeasures) {
    StrutCurves sharp = curves_;
    sharp.edge_radius = 0;
    const StentMeasures m = measure_stent(sharp);
    const Surface mesh = make_stent_surface(sharp);
    const std::vector<EdgeUse> uses = edge_uses(mesh);
    for_each_edge(std::span<const EdgeUse>(uses), [](std::span<const EdgeUse> edge) {
        ASSERT_EQ(edge.size(), 2u);
        ASSERT_NE(edge[0].rises, edge[1].rises);
    });
    // Chords of the round tube: (step / radius)^2 / 6.
    EXPECT_NEAR(volume(mesh), m.volume, 1e-3 * m.volume);
    EXPECT_NEAR(area(mesh), m.surface_area, 1e-3 * m.surface_area);
    double low = 1, high = -1, outer = 0, inner = 1;
    for (const Vec3& x : mesh.points) {
        low = std::min(low, x.x), high = std::max(high, x.x);
        outer = std::max(outer, std::hypot(x.y, x.z)), inner = std::min(inner, std::hypot(x.y, x.z));
    }
    const double w = pattern_.strut_width;
    EXPECT_NEAR(high - low, pattern_.length, 0.01 * w);
    EXPECT_NEAR(high + low, 0, 0.01 * w);
    EXPECT_NEAR(2 * outer, pattern_.diameter, 1e-12);
    EXPECT_NEAR(outer - inner, pattern_.strut_thickness, 1e-12);
}

// Where the strut is plain, the metal's edges lie half a width beside its centreline, and its faces half a thickness
// above and below, everywhere. Near a junction the metal may only be more.
TEST_P(Library, StrutsHaveTheirWidthAndThicknessEverywhere) {
    const SignedDistance metal = make_stent_metal(curves_);
    const StentAxis axis;
    const double r = curves_.middle_radius;
    long plain = 0, junction = 0;
    for (const Strut& strut : curves_.struts)
        for (std::size_t k = 1; k < strut.points.size(); ++k)
            for (double t : {0.25, 0.5, 0.75}) {
                const FlatPoint &a = strut.points[k - 1], &b = strut.points[k];
                const double da = b.around - a.around, dl = b.along - a.along, length = std::hypot(da, dl);
                if (length == 0) continue;
                const FlatPoint at{a.around + t * da, a.along + t * dl};
                for (double side : {1.0, -1.0}) {
                    const auto beside = [&](double h) {
                        return axis.place(
                            {r, (at.around - side * h * dl / length) / r, at.along + side * h * da / length});
                    };
                    const double edge = metal.value(beside(strut.half_width));
                    const double middle = map_.value(at);
                    const double far_beside = map_.value({at.around - side * 1.5 * strut.half_width * dl / length,
                                                          at.along + side * 1.5 * strut.half_width * da / length});
                    if (middle > -1.01 * strut.half_width && far_beside > 0.49 * strut.half_width) {
                        ++plain;
                        ASSERT_NEAR(edge, 0, 0.02 * strut.half_width);   // 2 % of the width
                        ASSERT_NEAR(metal.value(beside(1.2 * strut.half_width)), 0.2 * strut.half_width,
                                    0.05 * strut.half_width);
                        ASSERT_NEAR(metal.value(beside(0.8 * strut.half_width)), -0.2 * strut.half_width,
                                    0.02 * strut.half_width);
                    } else {
                        ++junction;
                        ASSERT_LT(edge, 0.02 * strut.half_width);
                    }
                    const double face = r + side * curves_.thickness / 2;
                    ASSERT_NEAR(metal.value(axis.place({face, at.around / r, at.along})), 0, 1e-12);
                }
            }
    EXPECT_GT(plain, 4 * junction);
}

TEST_P(Library, VolumeIsThatOfAFineQuadrature) {
    // Random places in the tube's wall: the metal's share of it.
    const SignedDistance metal = make_stent_metal(curves_);
    const double inner = curves_.middle_radius - curves_.thickness / 2, outer = outer_radius(curves_);
    const double wall = pi * (outer * outer - inner * inner) * curves_.length;
    const std::size_t count = 400'000;   // share 0.2: a random choice would err by 0.3 %
    const StentAxis axis;
    const double inside = sum_of(count, [&](std::size_t k) {
        // The points k (a, b, c) mod 1 of the golden section's kin fill a cube evenly (R3 sequence).
        const auto part = [&](double g) { return std::fmod(0.5 + double(k + 1) * g, 1.0); };
        const double radius = std::sqrt(inner * inner + part(0.8191725133961645) * (outer * outer - inner * inner));
        const Vec3 x =
            axis.place({radius, 2 * pi * part(0.6710436067037893), curves_.length * (part(0.5497004779019703) - 0.5)});
        return metal.value(x) < 0 ? 1.0 : 0.0;
    });
    const double volume = measure_stent(curves_).volume;
    EXPECT_NEAR(wall * inside / double(count), volume, 0.01 * volume);
}

// A turn by the crowns from one connector to the next carries the stent onto itself.
TEST_P(Rings, TurnOntoThemselves) {
    const double turn = curves_.circumference() / pattern_.connectors;
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    for (int k = 0; k < 5000; ++k) {
        const FlatPoint x{unit(engine) * curves_.circumference(), unit(engine) * curves_.length};
        ASSERT_NEAR(map_.value(x), map_.value({x.around + turn, x.along}), 1e-12);
    }
}

// The value never changes faster than one walks around the metal, and its gradient is its slope.
TEST_P(Library, DistanceIsOneNearTheMetal) {
    const SignedDistance metal = make_stent_metal(curves_);
    std::mt19937 engine(2);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    const StentAxis axis;
    const double w = pattern_.strut_width;
    int near = 0;
    for (int k = 0; k < 20000; ++k) {
        const Vec3 x = axis.place(
            {curves_.middle_radius + 3 * w * unit(engine), 2 * pi * unit(engine), pattern_.length * unit(engine)});
        const DistanceSample s = metal.sample(x);
        ASSERT_NEAR(norm(s.gradient), 1, 1e-9);
        if (std::abs(s.value) > w) continue;
        ++near;
        // Walking the value against the gradient ends on the surface; where struts meet, in the metal: from inside the way is
        // a bound, and outside the rounded edge of one strut lies in the other.
        const double left = metal.value(x - s.value * s.gradient);
        ASSERT_LT(left, 0.01 * w);
        ASSERT_TRUE(s.value < 0 || left > -0.01 * w - curves_.edge_radius);
    }
    EXPECT_GT(near, 5000);
}

TEST_P(Library, KeepsItsStrutsWhenItOpens) {
    const StentPattern open = at_diameter(pattern_, pattern_.nominal_diameter);
    EXPECT_LT(open.length, pattern_.length);
    EXPECT_GT(open.length, 0.7 * pattern_.length);
    const StentMeasures cut = measure_stent(curves_), opened = measure_stent(make_strut_curves(open));
    // A ring's centreline keeps its length; connectors that lead aside become longer, and the metal by as much.
    const auto length_of = [](const Strut& strut) {
        double sum = 0;
        for (std::size_t k = 1; k < strut.points.size(); ++k)
            sum += std::hypot(strut.points[k].around - strut.points[k - 1].around,
                              strut.points[k].along - strut.points[k - 1].along);
        return sum;
    };
    const StrutCurves wide = make_strut_curves(open);
    double added = 0;
    for (std::size_t k = 0; k < wide.struts.size(); ++k)
        added += 2 * wide.struts[k].half_width * (length_of(wide.struts[k]) - length_of(curves_.struts[k]));
    EXPECT_NEAR(length_of(wide.struts[0]), length_of(curves_.struts[0]), 2e-3 * length_of(wide.struts[0]));
    EXPECT_NEAR(opened.plan_area, cut.plan_area + added, 0.01 * cut.plan_area);
    EXPECT_LT(opened.metal_ratio, cut.metal_ratio);
    const StentPattern back = at_diameter(open, pattern_.diameter);
    EXPECT_NEAR(back.length, pattern_.length, 1e-9 * pattern_.length);
}

TEST_P(Library, OtherLengthsHaveTheSameRings) {
    const StentPattern same = with_length(pattern_, pattern_.length);
    EXPECT_EQ(same.rings, pattern_.rings);
    EXPECT_NEAR(same.length, pattern_.length, 1e-12);
    const StentPattern longer = with_length(pattern_, 1.4 * pattern_.length),
                       shorter = with_length(pattern_, 0.6 * pattern_.length);
    for (const StentPattern& p : {longer, shorter}) {
        EXPECT_NEAR(ring_amplitude(p), ring_amplitude(pattern_), 1e-12);
        EXPECT_NO_THROW(make_strut_curves(p));
        const double pitch = std::abs(p.length - pattern_.length) / std::abs(p.rings - pattern_.rings);
        EXPECT_LE(std::abs(p.length - (p.rings > pattern_.rings ? 1.4 : 0.6) * pattern_.length), 0.5001 * pitch);
    }
    EXPECT_EQ(with_length(pattern_, 0).rings, 2);
}

TEST(StrutMap, GridChangesNothing) {
    const StrutCurves curves = make_strut_curves(find_stent("two_link").pattern);
    const StrutMap map(curves);
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    for (int k = 0; k < 60; ++k) {
        const FlatPoint x{3 * unit(engine) * curves.circumference(), 1.5 * unit(engine) * curves.length};
        double least = 1;
        for (const Strut& strut : curves.struts)
            for (std::size_t i = 1; i < strut.points.size(); ++i)
                for (int turns = -4; turns <= 4; ++turns) {
                    const FlatPoint &a = strut.points[i - 1], &b = strut.points[i];
                    const double da = b.around - a.around, dl = b.along - a.along;
                    const double xa = x.around + turns * curves.circumference() - a.around, xl = x.along - a.along;
                    const double t = std::clamp((xa * da + xl * dl) / std::max(1e-30, da * da + dl * dl), 0.0, 1.0);
                    least = std::min(least, std::hypot(xa - t * da, xl - t * dl) - strut.half_width);
                }
        ASSERT_NEAR(map.value(x), least, 1e-12);
    }
}

TEST(StentPattern, AmplitudeFillsTheLength) {
    StentPattern p = find_stent("paper").pattern;
    EXPECT_NEAR(p.rings * ring_amplitude(p) + (p.rings - 1) * (p.gap + p.strut_width) + p.strut_width, p.length, 1e-12);
    p.rings = 1, p.connectors = 0;
    EXPECT_NEAR(ring_amplitude(p), p.length - p.strut_width, 1e-12);
}

// A wall without a connector, straight struts parallel to the axis: a closed form for the area.
TEST(StentPattern, AreaOfAPlainRing) {
    StentPattern p = find_stent("paper").pattern;
    p.rings = 1, p.connectors = 0, p.crowns = 4, p.length = 2e-3, p.crimped_diameter = 1.9e-3,
    p.nominal_diameter = 2.1e-3;
    p.crown_radius = pi * (p.diameter - p.strut_thickness) / 16;   // a quarter of the pitch: struts along the axis
    const double straight = ring_amplitude(p) - 2 * p.crown_radius;
    const double centreline = 8 * straight + 8 * pi * p.crown_radius;
    const StentMeasures m = measure_stent(make_strut_curves(p));
    EXPECT_NEAR(m.plan_area, centreline * p.strut_width, 1e-3 * m.plan_area);
    EXPECT_NEAR(m.edge_length, 2 * centreline, 1e-3 * m.edge_length);
    EXPECT_TRUE(m.cells.empty());
}

struct Impossible {
    const char* word;   ///< in the sentence
    void (*spoil)(StentPattern&);
};
void PrintTo(const Impossible& i, std::ostream* out) { *out << i.word; }
class Refused : public ::testing::TestWithParam<Impossible> {};
TEST_P(Refused, NamesTheParameterAndItsLimit) {
    StentPattern p = find_stent("paper").pattern;
    GetParam().spoil(p);
    try {
        measure_stent(make_strut_curves(p));
        FAIL();
    } catch (const GeometryError& e) {
        EXPECT_NE(std::string(e.what()).find(GetParam().word), std::string::npos) << e.what();
    }
}
INSTANTIATE_TEST_SUITE_P(
    Stents, Refused,
    ::testing::Values(
        Impossible{"crown_radius is 0.05 mm, at least 0.06 mm", [](StentPattern& p) { p.crown_radius = 50e-6; }},
        Impossible{"crown_radius is 0.6 mm, at most", [](StentPattern& p) { p.crown_radius = 600e-6; }},
        Impossible{"length is 3 mm, at least", [](StentPattern& p) { p.length = 3e-3; }},
        Impossible{"crimped_diameter", [](StentPattern& p) { p.crimped_diameter = 0.4e-3; }},
        Impossible{"nominal_diameter", [](StentPattern& p) { p.nominal_diameter = 8e-3; }},
        Impossible{"gap", [](StentPattern& p) { p.gap = 0; }},
        Impossible{"connectors is 4, it must divide crowns, 6", [](StentPattern& p) { p.connectors = 4; }},
        Impossible{"connectors is 0", [](StentPattern& p) { p.connectors = 0; }},
        Impossible{"strut_width", [](StentPattern& p) { p.strut_width = std::nan(""); }},
        Impossible{"strut_thickness", [](StentPattern& p) { p.strut_thickness = 0.6e-3; }},
        Impossible{"rings", [](StentPattern& p) { p.rings = 0; }},
        Impossible{"edge_radius", [](StentPattern& p) { p.edge_radius = 60e-6; }},
        Impossible{"connector_swing", [](StentPattern& p) { p.connector_swing = 50e-6; }},
        Impossible{"bend",
                   [](StentPattern& p) { p.connector_shape = ConnectorShape::flex, p.connector_swing = 400e-6; }},
        Impossible{"overlap", [](StentPattern& p) {   // connectors so wide that they meet
                       p.connectors = 6, p.connector_width = 0.996e-3;
                   }}));

TEST(StentLibrary, AnUnknownNameHasASuggestion) {
    try {
        find_stent("open_cel");
        FAIL();
    } catch (const GeometryError& e) {
        EXPECT_NE(std::string(e.what()).find("did you mean open_cell?"), std::string::npos) << e.what();
    }
    EXPECT_THROW(find_alloy("gold"), GeometryError);
}

}   // namespace
}   // namespace patency
