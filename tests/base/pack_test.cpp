// SPDX-License-Identifier: Apache-2.0
// A pack is many scalars: every operation, lane by lane, gives the bits of the scalar one.
#include "patency/base/pack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace patency;

namespace {

template <class T>
bool same_bits(T a, T b) {
    if (std::isnan(a) && std::isnan(b)) return true;   // IEEE leaves the payload of a NaN open
    return a == b && std::signbit(a) == std::signbit(b);
}

/// Numbers of all sizes and the special ones.
template <class T>
std::vector<T> numbers(std::size_t count, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> mantissa(-2, 2), exponent(-60, 60);
    using L = std::numeric_limits<T>;
    std::vector<T> values{T(0),           -T(0),           T(1),     T(-1),   L::infinity(), -L::infinity(),
                          L::quiet_NaN(), L::denorm_min(), L::max(), L::min()};
    while (values.size() < count) values.push_back(T(mantissa(random) * std::exp2(exponent(random))));
    std::shuffle(values.begin(), values.end(), random);
    return values;
}

template <class P>
struct PackLaws : testing::Test {};
using Packs = testing::Types<Pack<float>, Pack<double>, Pack<float, 4>, Pack<double, 2>>;
TYPED_TEST_SUITE(PackLaws, Packs);

TYPED_TEST(PackLaws, OperationsAreThoseOfScalarsInEveryLane) {
    using P = TypeParam;
    using T = typename P::Scalar;
    constexpr std::size_t lanes = std::size_t(P::lanes);
    const auto a = numbers<T>(40 * lanes, 1), b = numbers<T>(40 * lanes, 2), c = numbers<T>(40 * lanes, 3);
    for (std::size_t k = 0; k < a.size(); k += lanes) {
        const P x = P::load(&a[k]), y = P::load(&b[k]), z = P::load(&c[k]);
        P plus = x, minus = x, times = x;
        plus += y, minus -= y, times *= y;
        T stored[lanes];
        x.store(stored);
        for (std::size_t l = 0; l < lanes; ++l) {
            const int n = int(l);
            const T s = a[k + l], t = b[k + l], u = c[k + l];
            EXPECT_TRUE(same_bits(stored[l], s));
            EXPECT_TRUE(same_bits(P(s)[n], s));
            EXPECT_TRUE(same_bits((x + y)[n], s + t) && same_bits(plus[n], s + t)) << s << " + " << t;
            EXPECT_TRUE(same_bits((x - y)[n], s - t) && same_bits(minus[n], s - t)) << s << " - " << t;
            EXPECT_TRUE(same_bits((x * y)[n], s * t) && same_bits(times[n], s * t)) << s << " * " << t;
            EXPECT_TRUE(same_bits((x / y)[n], s / t)) << s << " / " << t;
            EXPECT_TRUE(same_bits((-x)[n], -s)) << "-" << s;
            EXPECT_TRUE(same_bits(max(x, y)[n], max(s, t))) << s << ", " << t;
            EXPECT_TRUE(same_bits(min(x, y)[n], min(s, t))) << s << ", " << t;
            EXPECT_TRUE(same_bits(sqrt(x)[n], std::sqrt(s))) << s;
            EXPECT_TRUE(same_bits(fma(x, y, z)[n], std::fma(s, t, u))) << s << " * " << t << " + " << u;
        }
    }
}

TYPED_TEST(PackLaws, FmaRoundsOnce) {
    using P = TypeParam;
    using T = typename P::Scalar;
    // (1 + e)^2 - (1 + 2e) is e^2, which two roundings lose.
    const T e = std::numeric_limits<T>::epsilon();
    EXPECT_EQ(fma(P(1 + e), P(1 + e), P(-(1 + 2 * e)))[0], e * e);
}

TYPED_TEST(PackLaws, QuadsAreThoseOfTheParticlesAsked) {
    using P = TypeParam;
    using T = typename P::Scalar;
    constexpr std::size_t lanes = std::size_t(P::lanes);
    std::vector<Quad<T>> quads(97);
    for (std::size_t q = 0; q < quads.size(); ++q) quads[q] = {T(4 * q), T(4 * q + 1), T(4 * q + 2), T(4 * q + 3)};
    std::mt19937 random(4);
    for (int k = 0; k < 200; ++k) {
        std::uint32_t index[lanes];
        for (auto& i : index) i = std::uint32_t(random() % quads.size());
        const Quads<P> got = load_quads<T, P::lanes>(quads.data(), index);
        for (std::size_t l = 0; l < lanes; ++l) {
            EXPECT_EQ(got.a[int(l)], quads[index[l]].a) << "lane " << l;
            EXPECT_EQ(got.b[int(l)], quads[index[l]].b) << "lane " << l;
            EXPECT_EQ(got.c[int(l)], quads[index[l]].c) << "lane " << l;
            EXPECT_EQ(got.d[int(l)], quads[index[l]].d) << "lane " << l;
        }
    }
}

float as_record(std::int64_t coordinate) { return std::bit_cast<float>(std::int32_t(coordinate)); }

TEST(CoordinateDifference, OfFixedPointIsExactAndWrapsAround) {
    const std::int64_t turn = std::int64_t(1) << 32;
    EXPECT_EQ(coordinate_difference(as_record(7), as_record(-5)), 12.0f);
    // Floats whose last bits a subtraction of floats would lose, and bit patterns that are NaNs.
    EXPECT_EQ(coordinate_difference(as_record(2000000001), as_record(2000000000)), 1.0f);
    EXPECT_EQ(coordinate_difference(as_record(-1), as_record(-3)), 2.0f);
    EXPECT_EQ(coordinate_difference(as_record(INT32_MIN), as_record(INT32_MAX)),
              1.0f);   // across the face of a periodic box
    EXPECT_EQ(coordinate_difference(as_record(INT32_MAX), as_record(INT32_MIN)), -1.0f);
    std::mt19937 random(5);
    for (int k = 0; k < 1000; ++k) {
        const std::int64_t a = std::int32_t(random()), d = std::int64_t(random() % (1 << 25)) - (1 << 24);
        const std::int64_t b = (a - d + turn / 2 + turn) % turn - turn / 2;   // wrapped into the 32 bits
        EXPECT_EQ(coordinate_difference(as_record(a), as_record(b)), float(d));
    }
}

TEST(CoordinateDifference, OfPacksIsThatOfScalars) {
    constexpr int lanes = native_lanes<float>;
    std::mt19937 random(6);
    for (int k = 0; k < 200; ++k) {
        std::int32_t a[lanes], b[lanes];
        for (int l = 0; l < lanes; ++l) a[l] = std::int32_t(random()), b[l] = std::int32_t(random());
        float fa[lanes], fb[lanes];
        std::memcpy(fa, a, sizeof a), std::memcpy(fb, b, sizeof b);
        const auto d = coordinate_difference(Pack<float>::load(fa), Pack<float>::load(fb));
        for (int l = 0; l < lanes; ++l)
            EXPECT_EQ(d[l], float(std::int32_t(std::uint32_t(a[l]) - std::uint32_t(b[l])))) << a[l] << " - " << b[l];
    }
    EXPECT_EQ(coordinate_difference(Pack<double>(3.5), Pack<double>(1.25))[0], 2.25);
    EXPECT_EQ(coordinate_difference(3.5, 1.25), 2.25);
}

}   // namespace
