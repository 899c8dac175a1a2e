// SPDX-License-Identifier: Apache-2.0
// What the scheme must do whatever its numbers: rest stays rest, a uniform motion is not seen, a level of pressure is
// not seen, bits do not depend on threads or on the loop, and what goes wrong is said.
#include "patency/schemes/flow_scheme.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <cstdio>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "patency/base/errors.h"
#include "tests/schemes/small_flows.h"

using namespace patency;
using namespace patency::testing_flows;

namespace {

using Kind = OpenEnd::Kind;

// One thread but where threads are the question: in domains this small they mostly wait for each other.
struct OneThread : testing::Environment {
    void SetUp() override { omp_set_num_threads(1); }
};
const auto* const one_thread = testing::AddGlobalTestEnvironment(new OneThread);

double fastest(const SmallFlow& flow) {
    double v = 0;
    for (const Vec3& u : flow.fluid.velocity) v = std::max(v, norm(u));
    return v;
}

std::vector<std::byte> state_of(const SmallFlow& flow) {
    std::vector<std::byte> state;
    for (const FieldBase* field : flow.fluid.fields())
        if (field->keep() == Keep::state) state.insert(state.end(), field->bytes().begin(), field->bytes().end());
    return state;
}

void run(SmallFlow& flow, Precision precision, int steps) {
    const auto scheme = flow.make(precision);
    double time = 0;
    for (int k = 0; k < steps; ++k) time += scheme->step(time, 1).dt;
}

/// A flow that has everything: a duct with a velocity inlet, a pressure outlet, and a profile that is not steady.
void make_busy_duct(SmallFlow& flow, int along = 12, int across = 8) {
    make_channel(flow, along, across, false, Kind::velocity, Kind::pressure);
    const double gap = across * dp;
    flow.ends[0].velocity = [=](double t) {
        return [=](const Vec3& x) {
            const double y = x.y / gap, z = x.z / gap;
            return Vec3{(0.15 + 2 * t) * 16 * y * (1 - y) * z * (1 - z), 0, 0};
        };
    };
    flow.ends[1].resistance = 1e8;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const Vec3& x = flow.fluid.position[i];
        flow.fluid.velocity[i] = flow.ends[0].velocity(0)(x) + Vec3{0, 0.01 * std::sin(3000 * x.x), 0};
        flow.fluid.pressure[i] = 20 - 1e4 * x.x;
    }
}

struct BothPrecisions : testing::TestWithParam<Precision> {};
INSTANTIATE_TEST_SUITE_P(Flow, BothPrecisions, testing::Values(Precision::mixed, Precision::double_precision),
                         [](const testing::TestParamInfo<Precision>& v) {
                             return v.param == Precision::mixed ? "Mixed" : "Double";
                         });

TEST_P(BothPrecisions, BloodAtRestStaysAtRest) {
    for (const bool planar : {true, false}) {
        SmallFlow flow;
        make_channel(flow, 10, 8, planar, Kind::pressure, Kind::pressure);
        flow.disturb(0.1, 1);   // no arrangement may drive it
        run(flow, GetParam(), 20);
        EXPECT_EQ(fastest(flow), 0) << planar;
        for (const double p : flow.fluid.pressure) ASSERT_EQ(p, 0);
    }
}

TEST_P(BothPrecisions, UniformPressureDrivesNothing) {
    SmallFlow flow;
    make_channel(flow, 10, 8, false, Kind::pressure, Kind::pressure);
    flow.disturb(0.1, 1);
    const double level = 13000;
    for (double& p : flow.fluid.pressure) p = level;
    for (OpenEnd& end : flow.ends) end.pressure = level;
    run(flow, GetParam(), 20);
    // The fitted slope at the ends is round-off: a few units in the last place of the level (2^-53; after rounding to
    // single, 2^-24) over the four spacings of the fit. That accelerates blood for a hundred acoustic steps of h/c.
    const double last = GetParam() == Precision::mixed ? std::exp2(-24) : std::exp2(-53);
    const double time = 100 * 1.3 * dp / flow.blood.sound_speed;
    EXPECT_LE(fastest(flow), 4 * last * level / (4 * dp) / flow.blood.density * time);
    // And the pressure of the buffers is rounded once in each of some 200 acoustic steps.
    for (const double p : flow.fluid.pressure) ASSERT_NEAR(p, level, 200 * last * level);
}

TEST_P(BothPrecisions, ALevelOfPressureIsNotSeen) {
    SmallFlow low, high;
    const double offset = 10000;
    for (SmallFlow* flow : {&low, &high}) {
        const double level = flow == &high ? offset : 0;
        make_channel(*flow, 12, 8, true, Kind::pressure, Kind::pressure);
        for (std::size_t i = 0; i < flow->fluid.size(); ++i)
            flow->fluid.pressure[i] = level + 100 * (1 - flow->fluid.position[i].x / (12 * dp));
        flow->ends[0].pressure = level + 100, flow->ends[1].pressure = level;
        run(*flow, GetParam(), 20);
    }
    ASSERT_EQ(low.fluid.size(), high.fluid.size());
    // A difference of pressures loses the last places of the level, 1e4 Pa times 2^-53 (2^-24): of 100 Pa over 12 spacings
    // this is 1e-13 (7e-5) per spacing. It sums at random over some hundred acoustic steps; 100 for all that.
    const double lost = (GetParam() == Precision::mixed ? std::exp2(-24) : std::exp2(-53)) * offset / (100.0 / 12);
    // Paired by place, not by index: the last places also move particles over the edges of sorting bins, and two of them change
    // their order. Every particle must have its twin.
    for (std::size_t i = 0; i < low.fluid.size(); ++i) {
        std::size_t same = 0;
        for (std::size_t j = 1; j < high.fluid.size(); ++j)
            if (norm(high.fluid.position[j] - low.fluid.position[i]) <
                norm(high.fluid.position[same] - low.fluid.position[i]))
                same = j;
        ASSERT_LE(norm(high.fluid.position[same] - low.fluid.position[i]), 0.01 * dp);
        ASSERT_LE(norm(low.fluid.velocity[i] - high.fluid.velocity[same]) / fastest(low), 100 * lost);
    }
    EXPECT_GT(fastest(low), 0.01);   // 100 Pa have moved it
}

TEST(Flow, UniformMotionIsNotSeen) {
    for (const bool planar : {true, false}) {
        SmallFlow flow;
        make_periodic_block(flow, 12, planar);
        flow.disturb(0.2, 2);
        const Vec3 v{0.13, -0.07, planar ? 0 : 0.05};
        for (Vec3& u : flow.fluid.velocity) u = v;
        run(flow, Precision::mixed, 30);
        for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
            ASSERT_EQ(flow.fluid.velocity[i], v);
            ASSERT_EQ(flow.fluid.pressure[i], 0);
        }
    }
}

TEST_P(BothPrecisions, APlugSlipsThrough) {
    // Between plates that do not hold it back blood goes through both ends as it is, and they count the same.
    SmallFlow flow;
    make_channel(flow, 10, 8, true, Kind::velocity, Kind::pressure);
    flow.numerics.free_slip = true;
    const Vec3 v{0.2, 0, 0};
    flow.ends[0].velocity = [=](double) { return [=](const Vec3&) { return v; }; };
    for (Vec3& u : flow.fluid.velocity) u = v;
    run(flow, GetParam(), 60);
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) ASSERT_LE(norm(flow.fluid.velocity[i] - v), 1e-12);
    EXPECT_NEAR(flow.ends[0].flow, -0.2 * 8 * dp, 1e-16);
    EXPECT_NEAR(flow.ends[1].flow, 0.2 * 8 * dp, 1e-16);
    EXPECT_LT(flow.ends[0].crossed, -40);                                     // layers of eight have come in,
    EXPECT_NEAR(double(flow.ends[0].crossed + flow.ends[1].crossed), 0, 8);   // and as many have gone out
}

// Viscous steps are many and short, so that noise of the shift counts against what the flow carries: blood that drifts out of
// buffers fills the vessel, percent by percent.                                                     THEORY.md (8.11)
TEST_P(BothPrecisions, AVesselHoldsAsManyParticlesAfterThreeTransits) {
    SmallFlow flow;
    const int along = 16, across = 10;
    make_channel(flow, along, across, true, Kind::pressure, Kind::pressure);
    flow.blood.viscosity = 0.056;
    std::fill(flow.fluid.viscosity.begin(), flow.fluid.viscosity.end(), flow.blood.viscosity);
    const double gap = across * dp, length = along * dp, peak = 0.06,
                 slope = 8 * flow.blood.viscosity * peak / (gap * gap);
    flow.numerics.reference_speed = peak;
    flow.ends[0].pressure = slope * length;
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const Vec3& x = flow.fluid.position[i];
        flow.fluid.velocity[i] = {4 * peak * x.y * (gap - x.y) / (gap * gap), 0, 0};
        flow.fluid.pressure[i] = slope * (length - x.x);
    }
    const auto inside = [&] { return double(std::count(flow.fluid.opening.begin(), flow.fluid.opening.end(), 0)); };
    const double begin = inside();
    const auto scheme = flow.make(GetParam());
    double time = 0;
    while (time * peak < 3 * length) time += scheme->step(time, 1).dt;
    EXPECT_LE(double(flow.ends[0].crossed), -1.5 * begin);   // the mean velocity is two thirds of the peak
    EXPECT_NEAR(inside(), begin + across / 2, across / 2) << "what leaves is counted half a spacing beyond the plane";
}

TEST_P(BothPrecisions, BitsDoNotDependOnThreads) {
    const int before = omp_get_max_threads();
    std::vector<std::byte> one;
    for (int threads = 1; threads <= 4; ++threads) {
        omp_set_num_threads(threads);
        SmallFlow flow;
        make_busy_duct(flow, 12, 24);   // 11,000 particles: sorted in parallel, as are the 2,300 of each buffer
        run(flow, GetParam(), 3);
        if (threads == 1)
            one = state_of(flow);
        else
            EXPECT_TRUE(state_of(flow) == one) << threads << " threads";
    }
    omp_set_num_threads(before);
}

TEST_P(BothPrecisions, TheFastLoopIsTheReferenceLoop) {
    SmallFlow fast, slow;
    make_busy_duct(fast), make_busy_duct(slow);
    slow.numerics.loop = LoopKind::reference;
    run(fast, GetParam(), 4), run(slow, GetParam(), 4);
    EXPECT_TRUE(state_of(fast) == state_of(slow));
    EXPECT_EQ(fast.ends[1].flow, slow.ends[1].flow);
}

TEST_P(BothPrecisions, MirroredBloodFlowsInTheMirror) {
    SmallFlow flow, mirrored;
    make_busy_duct(flow), make_busy_duct(mirrored);
    const double gap = 8 * dp;
    for (std::size_t i = 0; i < mirrored.fluid.size(); ++i) {
        mirrored.fluid.position[i].y = gap - mirrored.fluid.position[i].y;
        mirrored.fluid.velocity[i].y *= -1;
    }
    run(flow, GetParam(), 3), run(mirrored, GetParam(), 3);
    ASSERT_EQ(flow.fluid.size(), mirrored.fluid.size());
    // The sums come in another order: single precision keeps 6 digits of each, double 15; some hundred acoustic steps.
    const double allowed = (GetParam() == Precision::mixed ? 1e-6 : 1e-15) * 300 * fastest(flow);
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const Vec3 x{flow.fluid.position[i].x, gap - flow.fluid.position[i].y, flow.fluid.position[i].z};
        std::size_t j = 0;
        for (std::size_t k = 0; k < mirrored.fluid.size(); ++k)
            if (norm(mirrored.fluid.position[k] - x) < norm(mirrored.fluid.position[j] - x)) j = k;
        const Vec3 v = flow.fluid.velocity[i], u = mirrored.fluid.velocity[j];
        ASSERT_LE(norm(Vec3{v.x - u.x, v.y + u.y, v.z - u.z}), allowed);
    }
}

TEST_P(BothPrecisions, NoiseIsQuietedUpToTheLayerAtTheWall) {   // THEORY.md (4.9)
    SmallFlow flow;
    constexpr int across = 12, along = 24;
    make_channel(flow, along, across, true, OpenEnd::Kind::pressure, OpenEnd::Kind::pressure);
    flow.blood.viscosity = 1e-12;   // nothing but the dissipation is left
    std::fill(flow.fluid.viscosity.begin(), flow.fluid.viscosity.end(), flow.blood.viscosity);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> any(-0.01, 0.01);
    for (Vec3& v : flow.fluid.velocity) v = {any(random), any(random), 0};
    flow.fluid.velocity_gradient[0] = {{1e-12, 0, 0}, {}, {}};   // known, and nothing
    flow.make(GetParam())->step(0, 1e-15);
    std::array<double, across> power{}, energy{};
    for (std::size_t i = 0; i < flow.fluid.size(); ++i) {
        const Vec3 &x = flow.fluid.position[i], &v = flow.fluid.velocity[i];
        if (x.x < 4 * dp || x.x > (along - 4) * dp) continue;
        const std::size_t layer = std::size_t(x.y / dp);
        power[layer] -= dot(v, flow.fluid.slow_acceleration[i]), energy[layer] += dot(v, v);
    }
    const auto rate = [&](std::size_t layer) { return power[layer] / energy[layer]; };
    EXPECT_LT(std::abs(rate(0)), 0.02 * rate(5));
    EXPECT_GT(rate(1), 0.15 * rate(5));   // half of its own, and of its neighbours those at the wall take no part
    EXPECT_LT(rate(1), 0.35 * rate(5));
    EXPECT_GT(rate(2), 0.6 * rate(5));
}

TEST_P(BothPrecisions, AStepIsNoLongerThanAsked) {
    SmallFlow flow;
    make_busy_duct(flow);
    const auto scheme = flow.make(GetParam());
    const double natural = scheme->step(0, 1).dt;
    EXPECT_GT(natural, 0);
    double time = natural;
    for (const double longest : {natural / 3, natural * 0.9, natural / 1000, 1e-30}) {
        const FlowStep step = scheme->step(time, longest);
        EXPECT_EQ(step.dt, longest);
        EXPECT_GE(step.acoustic_steps, 1);
        time += step.dt;
    }
    const FlowStep step = scheme->step(time, 1);
    const double speed = std::max(step.fastest, flow.numerics.reference_speed);
    const double acoustic = flow.numerics.acoustic_cfl * 1.3 * dp / (flow.blood.sound_speed + speed);
    EXPECT_LE(step.dt / step.acoustic_steps, acoustic * (1 + 1e-12));   // in the mean: a sum of equal ones, rounded
}

TEST_P(BothPrecisions, ANumberThatIsNoneIsNoticed) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    {
        SmallFlow flow;
        make_busy_duct(flow);
        flow.fluid.velocity[100].y = nan;
        EXPECT_THROW(run(flow, GetParam(), 1), DivergedError);
    }
    {
        SmallFlow flow;
        make_busy_duct(flow);
        flow.fluid.pressure[100] = nan;
        EXPECT_THROW(run(flow, GetParam(), 2), DivergedError);   // a step later, when it has spread
    }
    {
        SmallFlow flow;
        make_busy_duct(flow);
        flow.fluid.position[100].x = nan;
        EXPECT_THROW(run(flow, GetParam(), 1), DivergedError);
    }
}

TEST(Flow, ANumberThatIsNoneIsNoticedInAPeriodicBox) {
    SmallFlow flow;
    make_periodic_block(flow, 12, true);
    flow.fluid.pressure[5] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(run(flow, Precision::mixed, 2), DivergedError);
}

TEST_P(BothPrecisions, TheParticleThatWentWrongIsNamed) {
    SmallFlow flow;
    make_busy_duct(flow);
    const Vec3 place = flow.fluid.position[100];
    flow.fluid.velocity[100].y = std::numeric_limits<double>::quiet_NaN();
    try {
        run(flow, GetParam(), 1);
        FAIL() << "nothing was said";
    } catch (const DivergedError& error) {
        const std::string text = error.what();
        Vec3 named;
        ASSERT_EQ(std::sscanf(text.c_str() + text.find('('), "(%lf, %lf, %lf)", &named.x, &named.y, &named.z), 3)
            << text;
        EXPECT_LT(norm(named - place), 0.3 * dp) << text;   // two shifts of a tenth at most
    }
}

TEST(Flow, AParticleBesideAPeriodicBoxIsNoticed) {
    SmallFlow flow;
    make_periodic_block(flow, 12, true);
    flow.fluid.position[5].z = 12 * dp;   // across the axis that does not repeat
    EXPECT_THROW(run(flow, Precision::mixed, 1), DivergedError);
}

TEST_P(BothPrecisions, AParticleOutsideIsNoticedAndNamed) {
    SmallFlow flow;
    make_busy_duct(flow);
    flow.fluid.position[50] = {0.125, 1e-4, 1e-4};
    try {
        run(flow, GetParam(), 1);
        FAIL() << "nothing was said";
    } catch (const DivergedError& error) {
        EXPECT_NE(std::string(error.what()).find("0.125"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("1 particle"), std::string::npos) << error.what();
    }
}

TEST_P(BothPrecisions, BloodFasterThanSoundIsNoticed) {
    SmallFlow flow;
    make_busy_duct(flow);
    for (Vec3& v : flow.fluid.velocity) v = 100 * flow.blood.sound_speed * Vec3{1, 0, 0};
    EXPECT_THROW(run(flow, GetParam(), 1), DivergedError);
}

TEST(Flow, DoublePrecisionIsRefusedInAPeriodicBox) {
    SmallFlow flow;
    make_periodic_block(flow, 12, true);
    EXPECT_THROW(flow.make(Precision::double_precision), DeckError);
}

TEST_P(BothPrecisions, TheEndsAreAskedOncePerAcousticStep) {
    SmallFlow flow;
    make_busy_duct(flow);
    const auto scheme = flow.make(GetParam());
    std::vector<double> times, lengths;
    scheme->update_ends = [&](std::span<OpenEnd> ends, double time, double dt) {
        EXPECT_EQ(ends.size(), 2u);
        times.push_back(time), lengths.push_back(dt);
    };
    const FlowStep step = scheme->step(0.5, 1);
    ASSERT_EQ(times.size(), std::size_t(step.acoustic_steps));
    double elapsed = 0;   // one after another, without a gap
    for (std::size_t k = 0; k < times.size(); ++k) {
        EXPECT_NEAR(times[k], 0.5 + elapsed, 1e-14);
        elapsed += lengths[k];
    }
    EXPECT_NEAR(elapsed, step.dt, 1e-14 * step.dt * double(times.size()));
}

}   // namespace
