// SPDX-License-Identifier: Apache-2.0
// Choosing lanes and turning rows is only moving numbers about: every choice, every lane, every shape.
#include "patency/base/select.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "patency/base/aligned.h"

using namespace patency;

namespace {

template <class Lanes>
struct SelectLaws : testing::Test {};
using Widths = testing::Types<std::integral_constant<int, native_lanes<float>>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SelectLaws, Widths);

TYPED_TEST(SelectLaws, LanesBelowAreThoseOfScalars) {
    constexpr int lanes = TypeParam::value;
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const float values[] = {0, -0.0f, 1, std::nextafter(1.0f, 2.0f), -1, infinity, -infinity, nan};
    std::mt19937 random(1);
    for (int k = 0; k < 2000; ++k) {
        float a[lanes], b[lanes];
        std::uint32_t expected = 0;
        for (int l = 0; l < lanes; ++l) {
            a[l] = values[random() % 8], b[l] = values[random() % 8];
            expected |= std::uint32_t(a[l] < b[l]) << l;
        }
        EXPECT_EQ(lanes_below(Pack<float, lanes>::load(a), Pack<float, lanes>::load(b)), expected);
    }
}

TYPED_TEST(SelectLaws, ChosenLanesAreStoredSideBySideForEveryChoice) {
    constexpr int lanes = TypeParam::value;
    constexpr std::uint32_t untouched = 77;
    std::uint32_t index[lanes];
    float value[lanes];
    for (int l = 0; l < lanes; ++l) index[l] = UINT32_MAX - std::uint32_t(l), value[l] = 0.5f - float(l);
    for (std::uint32_t chosen = 0; chosen < 1u << lanes; ++chosen) {
        std::vector<std::uint32_t> expected;
        std::vector<float> expected_value;
        for (int l = 0; l < lanes; ++l)
            if (chosen >> l & 1) expected.push_back(index[l]), expected_value.push_back(value[l]);
        std::vector<std::uint32_t> stored(lanes + 1, untouched);
        std::vector<float> stored_value(lanes + 1, float(untouched));
        ASSERT_EQ(store_chosen(Pack<std::uint32_t, lanes>::load(index), chosen, stored.data()), expected.size());
        ASSERT_EQ(store_chosen(Pack<float, lanes>::load(value), chosen, stored_value.data()), expected.size());
        EXPECT_EQ(stored[lanes], untouched) << "more than a pack written";
        EXPECT_EQ(stored_value[lanes], float(untouched)) << "more than a pack written";
        stored.resize(expected.size()), stored_value.resize(expected.size());
        ASSERT_EQ(stored, expected) << "choice " << chosen;
        ASSERT_EQ(stored_value, expected_value) << "choice " << chosen;
    }
}

TYPED_TEST(SelectLaws, CountsFromAnyNumber) {
    constexpr int lanes = TypeParam::value;
    for (const std::uint32_t first : {0u, 5u, 123456789u, UINT32_MAX - 2}) {
        std::uint32_t counted[lanes];
        count_from<lanes>(first).store(counted);
        for (int l = 0; l < lanes; ++l) EXPECT_EQ(counted[l], first + std::uint32_t(l));
    }
}

TYPED_TEST(SelectLaws, DifferencesWrapAround) {
    constexpr int lanes = TypeParam::value;
    std::mt19937 random(2);
    for (int k = 0; k < 200; ++k) {
        std::int32_t a[lanes];
        for (auto& x : a) x = std::int32_t(random());
        if (k == 0) a[0] = INT32_MIN, a[1] = INT32_MAX;
        const std::int32_t b = k == 0 ? INT32_MAX : std::int32_t(random());
        const auto d = load_difference<lanes>(a, b);
        for (int l = 0; l < lanes; ++l)
            EXPECT_EQ(d[l], float(std::int32_t(std::uint32_t(a[l]) - std::uint32_t(b)))) << a[l] << " - " << b;
    }
}

TEST(FirstLanes, AreAsManyAsAskedAndAllOfThemBeyond) {
    std::uint32_t expected = 0;
    for (std::size_t n = 0; n < 32; ++n) {
        EXPECT_EQ(first_lanes(n), expected) << n;
        expected |= 1u << n;
    }
    for (const std::size_t n : {32, 33, 1000}) EXPECT_EQ(first_lanes(n), UINT32_MAX) << n;
}

TEST(StoreSideBySide, TurnsRowsOfAnyNumberAndLength) {
    constexpr std::uint32_t untouched = UINT32_MAX;
    for (const std::size_t lanes : {1, 2, 3, 4, 6, 8, 16})
        for (std::size_t count = 0; count <= 9; ++count) {
            const std::size_t room = (count + 3) / 4 * 4;
            std::vector<std::vector<std::uint32_t>> rows(lanes);
            for (std::size_t l = 0; l < lanes; ++l)
                for (std::size_t k = 0; k < room; ++k) rows[l].push_back(std::uint32_t(1000 * l + k));
            std::vector<std::uint32_t> out(room * lanes + 1, untouched);
            store_side_by_side(rows, count, out.data());
            for (std::size_t l = 0; l < lanes; ++l)
                for (std::size_t k = 0; k < count; ++k)
                    ASSERT_EQ(out[k * lanes + l], rows[l][k])
                        << lanes << " lanes, " << count << " long: " << l << ", " << k;
            EXPECT_EQ(out.back(), untouched) << "beyond the next multiple of four";
        }
}

TEST(AlignedVector, ExtendKeepsWhatWasThere) {
    AlignedVector<std::uint32_t> vector;
    for (std::uint32_t n = 0; n < 1000; n += 7) {
        vector.extend(n + 7);
        ASSERT_EQ(vector.size(), n + 7);
        for (std::uint32_t k = n; k < n + 7; ++k) vector[k] = k;
    }
    for (std::uint32_t k = 0; k < vector.size(); ++k) ASSERT_EQ(vector[k], k);
    vector.extend(3);   // shorter: storage stays
    EXPECT_EQ(vector.size(), 3u);
    EXPECT_EQ(vector[2], 2u);
}

}   // namespace
