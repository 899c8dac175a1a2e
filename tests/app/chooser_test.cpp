// SPDX-License-Identifier: Apache-2.0
// A package's `patency` becomes the program for the processor, or the one that is asked for; stand-ins say which it was.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "app/chooser/instruction_set.h"
#include "tests/app/program.h"

namespace patency {
namespace {

namespace fs = std::filesystem;
using chooser::choose_set;

constexpr chooser::Processor plain{}, with_avx2{.bears_avx2 = true},
    with_avx512{.bears_avx2 = true, .bears_avx512 = true};

TEST(ChooseSet, TakesTheWidestThatTheProcessorBears) {
    EXPECT_EQ(choose_set(plain, ""), "baseline");
    EXPECT_EQ(choose_set(with_avx2, ""), "avx2");
    EXPECT_EQ(choose_set(with_avx512, ""), "avx512");
    EXPECT_EQ(choose_set({.bears_avx512 = true}, ""), "baseline") << "avx512's program uses avx2's instructions too";
}

TEST(ChooseSet, TakesWhatIsAskedForWhereTheProcessorBearsIt) {
    const chooser::Processor processors[] = {plain, with_avx2, with_avx512};   // in the order of the sets
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t s = 0; s < 3; ++s) {
            const std::string wanted(chooser::instruction_sets[s]);
            if (s <= p)
                EXPECT_EQ(choose_set(processors[p], wanted), wanted);
            else
                EXPECT_THROW(choose_set(processors[p], wanted), UsageError) << p << wanted;
        }
}

std::string sentence(const chooser::Processor& processor, const std::string& wanted) {
    try {
        return choose_set(processor, wanted);
    } catch (const UsageError& error) {
        return error.what();
    }
}

TEST(ChooseSet, SaysWhatThereIsInstead) {
    const std::string unknown = sentence(with_avx512, "avx3");
    for (const char* part : {"PATENCY_ISA", "'avx3'", "baseline, avx2 or avx512"})
        EXPECT_NE(unknown.find(part), unknown.npos) << unknown;
    const std::string too_wide = sentence(with_avx2, "avx512");
    EXPECT_NE(too_wide.find("the widest here is avx2"), too_wide.npos) << too_wide;
}

/// An installed package whose programs are scripts that print their names and arguments, and end with exit code 5.
class Chooser : public ::testing::Test {
protected:
    void SetUp() override {
        root_ = fs::temp_directory_path() /
                fmt::format("patency chooser {}", ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(root_);
        fs::create_directories(root_ / "bin");
        fs::create_directories(root_ / "libexec/patency");
        fs::copy_file(PATENCY_CHOOSER, root_ / "bin/patency");
        for (const std::string_view set : chooser::instruction_sets) {
            std::ofstream(program(set)) << "#!/bin/sh\necho \"${0##*/}|$*|\"\nexit 5\n";
            fs::permissions(program(set), fs::perms::owner_all);
        }
    }
    void TearDown() override { fs::remove_all(root_); }
    fs::path program(std::string_view set) const { return root_ / "libexec/patency" / fmt::format("patency-{}", set); }
    Result run(const std::string& environment) const {
        return run_command(fmt::format("{} '{}/bin/patency' check 'a b'", environment, root_.string()));
    }
    fs::path root_;
};

TEST_F(Chooser, BecomesTheProgramThatIsAskedFor) {
    const Result result = run("PATENCY_ISA=baseline");
    EXPECT_EQ(result.output, "patency-baseline|check a b|\n");
    EXPECT_EQ(result.exit_code, 5) << "the program's";
}

#if defined(__x86_64__)
// The C library hides instructions from those who ask it; all of those that matter but F16C.
TEST_F(Chooser, NeedsEveryInstructionThatTheProgramMayUse) {
    for (const char* feature : {"AVX", "AVX2", "BMI1", "BMI2", "FMA", "LZCNT", "MOVBE"})
        EXPECT_EQ(run(fmt::format("PATENCY_ISA= GLIBC_TUNABLES=glibc.cpu.hwcaps=-{}", feature)).output,
                  "patency-baseline|check a b|\n")
            << feature;
    for (const char* feature : {"AVX512F", "AVX512BW", "AVX512CD", "AVX512DQ", "AVX512VL"}) {
        const std::string chosen = run(fmt::format("PATENCY_ISA= GLIBC_TUNABLES=glibc.cpu.hwcaps=-{}", feature)).output;
        EXPECT_NE(chosen, "patency-avx512|check a b|\n") << feature;
    }
}
#endif

TEST_F(Chooser, IsOfOneMindWithTheCompiler) {
    const std::string best = run("PATENCY_ISA=").output;
#if defined(__x86_64__)
    __builtin_cpu_init();
    EXPECT_EQ(best.starts_with("patency-baseline|"), !__builtin_cpu_supports("avx2")) << best;
    EXPECT_EQ(best.starts_with("patency-avx512|"),
              __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw"))
        << best;
#else
    EXPECT_TRUE(best.starts_with("patency-baseline|")) << best;
#endif
}

TEST_F(Chooser, EndsWithASentenceWhereThereIsNothingToRun) {
    const Result unknown = run("PATENCY_ISA=sse9");
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_NE(unknown.output.find("patency: PATENCY_ISA is 'sse9'"), unknown.output.npos) << unknown.output;
    fs::remove(program("baseline"));
    const Result missing = run("PATENCY_ISA=baseline");
    EXPECT_EQ(missing.exit_code, 7);
    EXPECT_NE(missing.output.find((root_ / "libexec/patency/patency-baseline").string()), missing.output.npos)
        << missing.output;
}

}   // namespace
}   // namespace patency
