// SPDX-License-Identifier: Apache-2.0
// Loops visit every index once, reductions do not depend on the number of threads, and aligned storage is aligned.
#include "patency/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "patency/base/aligned.h"

using namespace patency;

namespace {

const std::size_t sizes[] = {0, 1, block_size - 1, block_size, block_size + 1, 5 * block_size + 17};

struct Threads : testing::Test {
    ~Threads() override { omp_set_num_threads(before_); }
    int before_ = omp_get_max_threads();
};

TEST_F(Threads, EveryIndexIsVisitedOnce) {
    for (int threads = 1; threads <= 4; ++threads) {
        omp_set_num_threads(threads);
        for (const std::size_t count : sizes) {
            std::vector<std::atomic<int>> visits(count);
            for_each_index(count, [&](std::size_t i) { ++visits[i]; });
            for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(visits[i], 1) << i << " of " << count;
        }
    }
}

TEST_F(Threads, EveryTaskIsTakenOnce) {
    for (int threads = 1; threads <= 4; ++threads)
        for (const int there : {1, threads})   // a region may get fewer than were asked for
            for (const std::size_t count : {0, 1, 3, 257}) {
                omp_set_num_threads(threads);
                std::vector<std::atomic<int>> taken(count);
                Shares shares(count);
#pragma omp parallel num_threads(there)
                for (const std::size_t task : shares.of_this_thread()) ++taken[task];
                for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(taken[i], 1) << i << " of " << count;
            }
}

TEST_F(Threads, BeginWithTheirOwnPart) {
    constexpr int threads = 4;
    omp_set_num_threads(threads);
    std::vector<std::size_t> first(threads, 999);
    Shares shares(400);
#pragma omp parallel
    {
        bool is_first = true;
        for (const std::size_t task : shares.of_this_thread()) {
            if (!is_first) continue;
            first[std::size_t(omp_get_thread_num())] = task;
            is_first = false;
#pragma omp barrier
        }
    }
    EXPECT_EQ(first, (std::vector<std::size_t>{0, 100, 200, 300}));
}

TEST_F(Threads, TakeWhatAnotherOneHasNotBegun) {
    omp_set_num_threads(2);
    constexpr std::size_t count = 100;
    std::atomic<std::size_t> done = 0;
    Shares shares(count);
    const double begin = omp_get_wtime();
#pragma omp parallel
    for (const std::size_t task : shares.of_this_thread()) {
        if (task == 0)   // this one's thread is held up until all others are done
            while (done < count - 1 && omp_get_wtime() - begin < 10) std::this_thread::yield();
        ++done;
    }
    EXPECT_EQ(done, count);
    EXPECT_LT(omp_get_wtime() - begin, 10);
}

TEST_F(Threads, SumsHaveTheSameBits) {
    const auto value = [](std::size_t i) { return 1.0 / double(i * i % 1013 + 1) - 1e-3 * double(i % 7); };
    for (const std::size_t count : sizes) {
        omp_set_num_threads(1);
        const double one = sum_of(count, value);
        for (int threads = 2; threads <= 4; ++threads) {
            omp_set_num_threads(threads);
            for (int repeat = 0; repeat < 5; ++repeat)
                EXPECT_EQ(sum_of(count, value), one) << count << " values, " << threads << " threads";
        }
    }
}

TEST_F(Threads, ReductionsCombineInOrder) {
    omp_set_num_threads(4);
    const std::size_t count = 3 * block_size + 5;
    const auto text = reduce(
        count, std::string(), [](std::size_t i) { return std::string(1, char('a' + i % 26)); },
        [](const std::string& a, const std::string& b) { return a + b; });
    ASSERT_EQ(text.size(), count);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(text[i], char('a' + i % 26)) << i;
}

TEST_F(Threads, LargestIsFoundWhereverItStands) {
    for (const std::size_t where : {std::size_t(0), block_size - 1, block_size, 3 * block_size + 4})
        EXPECT_EQ(largest_of(3 * block_size + 5, [&](std::size_t i) { return i == where ? 2.0 : 1.0; }), 2.0) << where;
    EXPECT_EQ(largest_of(0, [](std::size_t) { return 1.0; }), 0.0);
}

TEST(AlignedVector, StartsOnACacheLineAndKeepsItsStorage) {
    AlignedVector<float> v;
    EXPECT_EQ(v.size(), 0u);
    v.reset(1000, 3.0f);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(v.data()) % 64, 0u);
    ASSERT_EQ(v.size(), 1000u);
    for (std::size_t i = 0; i < v.size(); ++i) ASSERT_EQ(v[i], 3.0f);
    const float* before = v.data();
    v.reset(10);
    EXPECT_EQ(v.size(), 10u);
    EXPECT_EQ(v.data(), before);
    v.reset(1000);
    EXPECT_EQ(v.data(), before);
    v.reset(100000, 1.0f);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(v.data()) % 64, 0u);
    EXPECT_EQ(v[99999], 1.0f);
}

}   // namespace
