// SPDX-License-Identifier: Apache-2.0
// Contact of surfaces: the push is the slope of its energy, equal and opposite, without stand-off; parts of one body.
#include "patency/bodies/contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "patency/bodies/closest_point.h"
#include "patency/bodies/solid_shape.h"
#include "patency/physics/solid/contact.h"
#include "tests/bodies/surface_load.h"

using namespace patency;

namespace {

struct Body {
    Solid solid;
    std::unique_ptr<SolidSurface> surface;

    Body(const SolidFill& fill, double spacing, bool planar) {
        solid.materials = {{1000, NeoHookean{1, 1}}};
        place_particles(solid, fill.places, 0);
        for (std::size_t i = 0; i < solid.particles.size(); ++i) {
            solid.particles.volume[i] = fill.volumes[i];
            solid.particles.mass[i] = 1000 * fill.volumes[i];
        }
        surface = std::make_unique<SolidSurface>(fill.surface, solid.particles, 2.3 * spacing, planar);
    }
    void move(const Vec3& by) {
        for (Vec3& x : solid.particles.position) x += by;
        surface->follow(solid.particles);
    }
    Vec3 load() { return load_by(*surface, solid.particles); }
    Vec3 torque() const {
        Vec3 sum{};
        for (std::size_t i = 0; i < solid.particles.size(); ++i)
            sum += cross(solid.particles.position[i], solid.particles.load[i]);
        return sum;
    }
};

constexpr double spacing = 1e-3, step = 1e-5;

class Contacts : public ::testing::TestWithParam<bool> {
protected:
    // A round body pushed into a block of a finer spacing, off its middle.
    bool planar = GetParam();
    Body block{fill_box({-5e-3, -4e-3, -4e-3}, {5e-3, 0, 4e-3}, 0.7 * spacing, planar), 0.7 * spacing, planar};
    Body ball{planar ? fill_cylinder({0.4e-3, 4e-3, 0}, {0, 0, 0}, 0, 4e-3, spacing, true)
                     : fill_sphere({0.4e-3, 4e-3, 0.3e-3}, 4e-3, spacing),
              spacing, planar};
};
INSTANTIATE_TEST_SUITE_P(Surface, Contacts, ::testing::Values(true, false));

}   // namespace

TEST_P(Contacts, PushIsEqualAndOppositeAndTheSlopeOfItsEnergy) {
    const auto contact =
        make_surface_contact(*block.surface, *ball.surface, {.friction = 0, .damping = 0, .step = step});
    EXPECT_EQ(contact->report().touching, 0u) << "before anything was looked at";
    block.move({}), ball.move({0.1e-3, -0.3e-3, 0.05e-3});
    contact->add_forces(0, 0);
    const Vec3 on_block = block.load(), on_ball = ball.load();
    const ContactReport report = contact->report();
    EXPECT_GT(report.touching, 1u);
    EXPECT_GT(on_ball.y, 0) << "pushed out of the block";
    EXPECT_LT(norm(on_block + on_ball), 1e-14 * norm(on_ball));
    EXPECT_LT(norm(block.torque() + ball.torque()), 1e-13 * norm(on_ball) * 5e-3);
    EXPECT_LT(norm(report.force - on_block), 1e-13 * norm(on_ball));
    EXPECT_NEAR(report.deepest, 0.3e-3, 0.2e-3);
    const auto energy_at = [&](double y) {
        block.move({}), ball.move({0, y, 0});
        contact->add_forces(0, 0);
        return contact->report().energy;
    };
    const double d = 1e-9, up = energy_at(d), down = energy_at(-2 * d);
    EXPECT_NEAR(-(up - down) / (2 * d), on_ball.y, 1e-5 * on_ball.y);
}

// A push that lasts comes to ten times its spring's, and keeps on until the vertex would pull; then nothing of it is left.
TEST_P(Contacts, WhatLastsIsHeldButNeverPulls) {
    const ContactNumerics numerics{.friction = 0, .damping = 0, .step = step, .hold = hold_at_rest};
    const auto contact = make_surface_contact(*block.surface, *ball.surface, numerics);
    const auto push_at = [&](double y, int steps) {
        Vec3 on_block{}, on_ball{};
        for (int k = 0; k < steps; ++k) {
            block.move({}), ball.move({0, k == 0 ? y : 0, 0});
            contact->add_forces(0, step);
        }
        on_block = block.load(), on_ball = ball.load();
        EXPECT_LT(norm(on_block + on_ball), 1e-13 * norm(on_ball) + 1e-18);
        return on_ball.y;
    };
    const double first = push_at(-0.2e-3, 1), last = push_at(0, 4000);
    const auto plain = make_surface_contact(*block.surface, *ball.surface, {.friction = 0, .damping = 0, .step = step});
    block.move({}), ball.move({});
    plain->add_forces(0, step);
    const double spring = ball.load().y;
    double slowest = 1, fastest = 0;   // by how heavy that is which is pushed: m* over its lightest vertex
    for (const auto& [own, other] : {std::pair{&*block.surface, &*ball.surface}, {&*ball.surface, &*block.surface}}) {
        double lightest = INFINITY;
        for (std::size_t v = 0; v < other->size(); ++v) lightest = std::min(lightest, other->mass(v));
        for (std::size_t v = 0; v < own->size(); ++v) {
            const double share = 1 / (1 + lightest / own->mass(v));
            slowest = std::min(slowest, share), fastest = std::max(fastest, share);
        }
    }
    const double grown = (first / spring - 1) / (hold_at_rest.ratio / hold_at_rest.steps);
    EXPECT_GE(grown, slowest * (1 - 1e-9));
    EXPECT_LE(grown, fastest * (1 + 1e-9));
    EXPECT_NEAR(last / spring, 1 + hold_at_rest.ratio, 1e-6);
    const auto before = contact->state();
    const double a_little_out = push_at(0.25e-3, 1);   // farther than it was in
    EXPECT_GT(a_little_out, 2 * spring);
    EXPECT_LT(a_little_out, last);
    EXPECT_GT(contact->report().touching, 0u);
    EXPECT_EQ(push_at(2.5e-3, 1), 0);
    EXPECT_EQ(contact->report().touching, 0u);
    EXPECT_EQ(push_at(-2.5e-3, 1), 0) << "let go is let go";
    contact->restore(before);
    EXPECT_NEAR(push_at(0, 1), a_little_out, 1e-9 * a_little_out) << "a checkpoint holds what is held";
}

TEST_P(Contacts, NothingStandsOff) {
    const auto contact =
        make_surface_contact(*block.surface, *ball.surface, {.friction = 0.3, .damping = 0, .step = step});
    block.move({}), ball.move({0, 1e-6, 0});
    contact->add_forces(0, 0);
    EXPECT_EQ(contact->report().touching, 0u);
}

TEST_P(Contacts, FrictionOpposesSlidingAndMomentumIsKept) {
    const auto contact =
        make_surface_contact(*block.surface, *ball.surface, {.friction = 0.3, .damping = 0, .step = step});
    block.move({}), ball.move({0, -0.2e-3, 0});
    for (Vec3& v : ball.solid.particles.velocity) v = {3, 0, 0};
    ball.move({}), block.move({});
    contact->add_forces(0, 1e-3);   // far beyond the bound
    const Vec3 on_block = block.load(), on_ball = ball.load();
    EXPECT_LT(on_ball.x, 0);
    EXPECT_LT(norm(on_block + on_ball), 1e-14 * norm(on_ball));
    EXPECT_GT(contact->report().friction_loss, 0);
    // Normals are tilted over the round face: the sum of frictions is a little less than mu times that of pushes.
    EXPECT_NEAR(-on_ball.x / on_ball.y, 0.3, 0.06);
}

namespace {

/// An element of the top of the block from (-5, -4, -4) to (5, 0, 4) mm whose first side lies on the edge x = 5 mm, y = 0.
std::size_t split_at_edge(SurfaceElements& mesh) {
    const auto on_edge = [&](std::uint32_t v) {
        const Vec3& x = mesh.vertices[v];
        return std::abs(x.x - 5e-3) < 1e-9 && std::abs(x.y) < 1e-9 && std::abs(x.z) < 3e-3;
    };
    const auto is_top = [&](std::uint32_t v) { return std::abs(mesh.vertices[v].y) < 1e-9; };
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
        auto& [a, b, c] = mesh.elements[e];
        for (int turn = 0; turn < 2 && !(on_edge(a) && on_edge(b)); ++turn) mesh.elements[e] = {b, c, a};
        if (on_edge(a) && on_edge(b) && is_top(c) && !on_edge(c)) return e;
    }
    throw std::runtime_error("no element at the edge");
}

}   // namespace

// A sliver along a block's edge that has turned over faces into it, and most of all elements there: what hovers over the edge is still outside.
TEST(SurfaceContact, AThinElementTellsNoSide) {
    SolidFill fill = fill_box({-5e-3, -4e-3, -4e-3}, {5e-3, 0, 4e-3}, spacing, false);
    auto& [vertices, elements, face, faces] = fill.surface;
    const std::size_t split = split_at_edge(fill.surface);
    const auto [a, b, c] = elements[split];
    const double side = norm(vertices[b] - vertices[a]);
    const Vec3 middle = 0.5 * (vertices[a] + vertices[b]), diagonal = Vec3{1, 1, 0} / std::sqrt(2.0);
    const auto m = std::uint32_t(vertices.size());
    vertices.push_back(middle + 0.01 * side * Vec3{1, -1, 0});
    elements[split] = {a, m, c};
    elements.push_back({m, b, c}), face.push_back(face[split]);
    elements.push_back({a, b, m}), face.push_back(face[split]);
    Body block(fill, spacing, false), ball(fill_sphere({0, 4e-3, 0}, 4e-3, spacing), spacing, false);
    block.move({}), ball.move({});
    const auto& places = ball.surface->position;
    const Vec3 nearest = *std::min_element(places.begin(), places.end(),
                                           [](const Vec3& p, const Vec3& q) { return p.x + p.y < q.x + q.y; });
    block.move({}), ball.move(middle + 0.1 * spacing * diagonal - nearest);
    const auto contact =
        make_surface_contact(*ball.surface, *block.surface, {.friction = 0, .damping = 0, .step = step});
    contact->add_forces(0, 0);
    EXPECT_EQ(contact->report().touching, 0u);
    block.move({}), ball.move(-0.2 * spacing * diagonal);
    contact->add_forces(0, 0);
    EXPECT_GT(contact->report().touching, 0u);
    EXPECT_LT(contact->report().deepest, 0.3 * spacing);
}

/// A block whose top has a strip of two thin elements along its edge, from the side's corners a, b to p, q.
struct StrippedBlock {
    SolidFill fill = fill_box({-5e-3, -4e-3, -4e-3}, {5e-3, 0, 4e-3}, spacing, false);
    std::uint32_t a, b, p, q;
    Vec3 middle, in;   // of a and b; from there to the top element's far corner

    StrippedBlock() {
        auto& [vertices, elements, face, faces] = fill.surface;
        const std::size_t split = split_at_edge(fill.surface);
        const std::uint32_t c = elements[split][2];
        a = elements[split][0], b = elements[split][1], p = std::uint32_t(vertices.size()), q = p + 1;
        middle = 0.5 * (vertices[a] + vertices[b]), in = vertices[c] - middle;
        vertices.push_back(vertices[a] + 0.03 * (vertices[c] - vertices[a]));
        vertices.push_back(vertices[b] + 0.03 * (vertices[c] - vertices[b]));
        elements[split] = {p, q, c};
        elements.push_back({a, b, q}), face.push_back(face[split]);
        elements.push_back({a, q, p}), face.push_back(face[split]);
    }
};

Vec3 lowest_of(const SolidSurface& surface) {
    const auto& places = surface.position;
    return *std::min_element(places.begin(), places.end(), [](const Vec3& u, const Vec3& v) { return u.y < v.y; });
}

// Over a strip of thin elements along an edge, a trifle behind the plane of the side that meets it there: outside too.
TEST(SurfaceContact, WhatHoversOverAThinStripIsOutside) {
    const StrippedBlock strip;
    const Vec3 &middle = strip.middle, &in = strip.in;
    Body block(strip.fill, spacing, false), ball(fill_sphere({0, 4e-3, 0}, 4e-3, spacing), spacing, false);
    block.move({}), ball.move({});
    block.move({}), ball.move(middle + 0.01 * in + Vec3{0, 0.1 * spacing, 0} - lowest_of(*ball.surface));
    const auto contact =
        make_surface_contact(*ball.surface, *block.surface, {.friction = 0, .damping = 0, .step = step});
    contact->add_forces(0, 0);
    EXPECT_EQ(contact->report().touching, 0u);
}

// Over the strip and farther from the plane of the side than from the top: the side is as near but for the strip's width, and tells nothing.
TEST(SurfaceContact, WhatHoversOverAThinStripIsNotBehindTheSide) {
    const StrippedBlock strip;
    Body block(strip.fill, spacing, false), ball(fill_sphere({0, 4e-3, 0}, 4e-3, spacing), spacing, false);
    block.move({}), ball.move({});
    ball.move(strip.middle + 0.02 * strip.in + Vec3{0, 0.005 * spacing, 0} - lowest_of(*ball.surface));
    const auto contact =
        make_surface_contact(*ball.surface, *block.surface, {.friction = 0, .damping = 0, .step = step});
    contact->add_forces(0, 0);
    EXPECT_EQ(contact->report().touching, 0u);
    ball.move(Vec3{0, -0.01 * spacing, 0});
    contact->add_forces(0, 0);
    EXPECT_GT(contact->report().touching, 0u);
}

// The strip has turned over, and the top hangs over the side: what stands before its edge, a trifle below its plane, is before the side, which
// the strip keeps apart from the edge.
TEST(SurfaceContact, WhatStandsBeforeAStripThatTurnedOverIsOutside) {
    const StrippedBlock strip;
    Body block(strip.fill, spacing, false), ball(fill_sphere({0, 4e-3, 0}, 4e-3, spacing), spacing, false);
    block.move({}), ball.move({});
    const auto& places = ball.surface->position;
    const Vec3 first =
        *std::min_element(places.begin(), places.end(), [](const Vec3& u, const Vec3& v) { return u.x < v.x; });
    auto& corners = block.surface->position;
    for (const std::uint32_t v : {strip.a, strip.b}) corners[v] += 0.06 * strip.in - Vec3{0, 0.02 * spacing, 0};
    const Vec3 edge = 0.5 * (corners[strip.p] + corners[strip.q]);
    ball.move(edge + spacing * Vec3{0.1, -0.01, 0} - first);
    const auto contact =
        make_surface_contact(*ball.surface, *block.surface, {.friction = 0, .damping = 0, .step = step});
    contact->add_forces(0, 0);
    EXPECT_EQ(contact->report().touching, 0u);
    ball.move(spacing * Vec3{-0.2, -0.1, 0});
    contact->add_forces(0, 0);
    EXPECT_GT(contact->report().touching, 0u);
    EXPECT_LT(contact->report().deepest, 0.3 * spacing);
}

// Blocks of one lattice: every vertex that is in lies as near to several elements of a plane. A search from where the block came from finds
// them in another order than one from where it is, as after a restart.
TEST(SurfaceContact, TheOrderOfASearchChoosesNoElement) {
    Body below(fill_box({-5e-3, -4e-3, -4e-3}, {5e-3, 0, 4e-3}, spacing, false), spacing, false),
        above(fill_box({-3e-3, 0, -2e-3}, {3e-3, 4e-3, 2e-3}, spacing, false), spacing, false);
    const Vec3 aside = spacing * Vec3{0.3, 0.4, 0.2};
    below.move({}), above.move(aside);
    const auto contact = [&] {
        return make_surface_contact(*above.surface, *below.surface, {.friction = 0, .damping = 0, .step = step});
    };
    const auto came = contact();
    came->add_forces(0, 0);
    EXPECT_EQ(came->report().touching, 0u);
    above.move(-aside - Vec3{0, 0.1 * spacing, 0});
    came->add_forces(0, 0);
    const auto restarted = contact();
    restarted->add_forces(0, 0);
    EXPECT_GT(restarted->report().touching, 20u);
    EXPECT_EQ(came->state(), restarted->state());
}

TEST(PlaneContact, PushesOutWhatIsBehind) {
    Body block(fill_box({0, 0, 0}, {5e-3, 4e-3, 0}, spacing, true), spacing, true);
    const auto contact =
        make_plane_contact(*block.surface, {0, 0.1e-3, 0}, {0, 1, 0}, {.friction = 0, .damping = 0, .step = step});
    block.move({});
    contact->add_forces(0, 0);
    double expected = 0;
    for (std::size_t v = 0; v < block.surface->size(); ++v)
        if (block.surface->position[v].y < 0.05e-3) expected += 0.1 * block.surface->mass(v) / (step * step) * 0.1e-3;
    const Vec3 load = block.load();
    EXPECT_NEAR(load.y, expected, 1e-10 * expected);
    EXPECT_EQ(load.x, 0);
    EXPECT_EQ(contact->report().touching, 6u);
}

TEST(SelfContact, BothSidesOfARingMeetButItsOwnThicknessDoesNotCount) {
    Body ring(fill_cylinder({}, {}, 6e-3, 9e-3, spacing, true), spacing, true);
    const auto contact =
        make_surface_contact(*ring.surface, *ring.surface, {.friction = 0, .damping = 0, .step = step});
    ring.move({});
    contact->add_forces(0, 0);
    EXPECT_EQ(contact->report().touching, 0u);
    // Squeezed in the middle until its inner sides cross.
    for (std::size_t i = 0; i < ring.solid.particles.size(); ++i) {
        Vec3& x = ring.solid.particles.position[i];
        x.y -= (x.y > 0 ? 1 : -1) * 6.5e-3 * std::exp(-x.x * x.x / 16e-6);
    }
    ring.move({});
    contact->add_forces(0, 0);
    ASSERT_GT(contact->report().touching, 0u);
    EXPECT_LT(norm(ring.load()), 1e-14 * double(contact->pushes().size()) * norm(contact->pushes()[0].force));
}

TEST(ClosestPoint, IsNearerThanAnyOtherOfTheTriangle) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto point = [&] {
        const double a = any(random), b = any(random), c = any(random);
        return Vec3{a, b, c};
    };
    for (int k = 0; k < 200; ++k) {
        const Vec3 a = point(), b = point(), c = point(), x = 2.0 * point();
        const auto w = closest_on_triangle(x, a, b, c);
        EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12);
        EXPECT_TRUE(w[0] >= -1e-12 && w[1] >= -1e-12 && w[2] >= -1e-12);
        const double distance = norm(w[0] * a + w[1] * b + w[2] * c - x);
        for (int i = 0; i <= 20; ++i)
            for (int j = 0; i + j <= 20; ++j)
                EXPECT_LE(distance, norm(i / 20.0 * a + j / 20.0 * b + (20 - i - j) / 20.0 * c - x) + 1e-12);
    }
}
