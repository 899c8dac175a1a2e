// SPDX-License-Identifier: Apache-2.0
// Fields follow their set: one declaration, and resizing, sorting, removal and copies reach every column.
#include "patency/particles/particle_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

using namespace patency;

namespace {

struct Marbles : ParticleSet {
    Field<Vec3> place{*this, "place", "m", Keep::state};
    Field<double> weight{*this, "weight", "kg", Keep::state};
    Field<Mat3> stress{*this, "stress", "Pa", Keep::state};
    Field<std::int32_t> number{*this, "number", "1", Keep::state};
    Field<double> passing{*this, "passing", "1", Keep::scratch};
};

void number_all(Marbles& m, std::size_t count) {
    m.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = double(i);
        m.place[i] = {x, x + 0.25, x + 0.5};
        m.weight[i] = 10 * x;
        m.stress[i] = {{x, 1, 2}, {3, x, 5}, {6, 7, x}};
        m.number[i] = std::int32_t(i);
        m.passing[i] = x;
    }
}

void expect_is(const Marbles& m, std::size_t i, std::uint32_t was) {
    const double x = was;
    EXPECT_EQ(m.number[i], std::int32_t(was));
    EXPECT_EQ(m.weight[i], 10 * x);
    EXPECT_EQ(m.place[i], (Vec3{x, x + 0.25, x + 0.5}));
    EXPECT_EQ(m.stress[i], (Mat3{{x, 1, 2}, {3, x, 5}, {6, 7, x}}));
}

TEST(ParticleSet, KnowsItsFieldsInTheOrderOfTheirDeclaration) {
    const Marbles m;
    const char* names[] = {"place", "weight", "stress", "number", "passing"};
    const char* units[] = {"m", "kg", "Pa", "1", "1"};
    const int components[] = {3, 1, 9, 1, 1};
    ASSERT_EQ(m.fields().size(), 5u);
    for (std::size_t f = 0; f < 5; ++f) {
        const FieldBase& field = *m.fields()[f];
        EXPECT_EQ(field.name(), names[f]);
        EXPECT_EQ(field.unit(), units[f]);
        EXPECT_EQ(field.components(), components[f]);
        EXPECT_EQ(field.is_integer(), f == 3);
        EXPECT_EQ(field.keep(), f == 4 ? Keep::scratch : Keep::state);
        EXPECT_EQ(m.find(names[f]), &field);
    }
    EXPECT_EQ(m.find("places"), nullptr);
    EXPECT_EQ(m.find(""), nullptr);
}

TEST(ParticleSet, GrowsWithZerosAndKeepsWhatIsThere) {
    Marbles m;
    EXPECT_EQ(m.size(), 0u);
    number_all(m, 5);
    m.resize(8);
    EXPECT_EQ(m.size(), 8u);
    for (std::uint32_t i = 0; i < 5; ++i) expect_is(m, i, i);
    for (std::size_t i = 5; i < 8; ++i) {
        EXPECT_EQ(m.place[i], Vec3{});
        EXPECT_EQ(m.number[i], 0);
    }
    m.resize(2);
    for (const FieldBase* field : m.fields())
        EXPECT_EQ(field->bytes().size(), 2 * std::size_t(field->components()) * (field->is_integer() ? 4 : 8))
            << field->name();
    expect_is(m, 1, 1);
}

TEST(ParticleSet, BytesAreTheValues) {
    Marbles m;
    number_all(m, 4);
    double place[12];
    ASSERT_EQ(m.place.bytes().size(), sizeof place);
    std::memcpy(place, m.place.bytes().data(), sizeof place);
    EXPECT_EQ(place[9], 3.0);
    EXPECT_EQ(place[11], 3.5);
    const double heavy = 7;
    FieldBase& weight = *m.find("weight");
    std::memcpy(weight.bytes().data() + sizeof heavy, &heavy, sizeof heavy);
    EXPECT_EQ(m.weight[1], 7.0);
}

TEST(ParticleSet, TakePermutes) {
    Marbles m;
    number_all(m, 10000);   // enough for several threads
    std::vector<std::uint32_t> order(m.size()), back(m.size());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    m.take(order);
    for (std::size_t i = 0; i < m.size(); ++i) expect_is(m, i, order[i]);
    for (std::uint32_t i = 0; i < order.size(); ++i) back[order[i]] = i;
    m.take(back);
    for (std::uint32_t i = 0; i < m.size(); ++i) expect_is(m, i, i);
}

TEST(ParticleSet, TakeRemovesAndCopies) {
    Marbles m;
    number_all(m, 6);
    const std::vector<std::uint32_t> order{5, 0, 0, 3, 5, 1, 1, 1};
    m.take(order);
    ASSERT_EQ(m.size(), order.size());
    for (std::size_t i = 0; i < order.size(); ++i) expect_is(m, i, order[i]);
    EXPECT_EQ(m.passing.size(), order.size());
    m.take(std::vector<std::uint32_t>{4});
    ASSERT_EQ(m.size(), 1u);
    expect_is(m, 0, 5);
    m.take({});
    EXPECT_EQ(m.size(), 0u);
    for (const FieldBase* field : m.fields()) EXPECT_TRUE(field->bytes().empty()) << field->name();
}

TEST(ParticleSet, ScratchChangesItsLengthOnly) {
    Marbles m;
    number_all(m, 3);
    m.take(std::vector<std::uint32_t>{2, 1, 0, 0});
    ASSERT_EQ(m.passing.size(), 4u);
    EXPECT_EQ(m.passing[0], 0.0);   // where it was, not where its particle went
    EXPECT_EQ(m.passing[2], 2.0);
}

TEST(ParticleSetDeathTest, TwoFieldsOfOneNameAreAMistake) {
#ifdef NDEBUG
    GTEST_SKIP() << "asserted in debug builds only";
#else
    EXPECT_DEATH(
        {
            Marbles m;
            Field<double> twin(m, "weight", "kg", Keep::state);
        },
        "share a name");
#endif
}

}   // namespace
