// SPDX-License-Identifier: Apache-2.0
// patency verify from outside: cases at once say and write what they do in turn.
#include <gtest/gtest.h>

#include <filesystem>

#include "patency/io/atomic_file.h"
#include "tests/app/program.h"
#include "tests/io/scratch_folder.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

class Verify : public ::testing::Test {
protected:
    Result verify(const std::string& out, const std::string& more) const {
        return patency(fmt::format("verify {} -o {}", more, (folder_ / out).string()));
    }

    ScratchFolder folder_;
};

TEST_F(Verify, CasesAtOnceAreTheCasesInTurn) {
    const Result in_turn = verify("in_turn", "cells_poiseuille lattice_operators patch --jobs 1");
    const Result at_once = verify("at_once", "cells_poiseuille lattice_operators patch --jobs 3");
    ASSERT_EQ(in_turn.exit_code, 0) << in_turn.output;
    ASSERT_EQ(at_once.exit_code, 0) << at_once.output;
    for (const char* name : {"cells_poiseuille", "lattice_operators", "patch"}) {
        const std::string report = std::string(name) + ".json";
        EXPECT_EQ(read_file(folder_ / "in_turn" / report), read_file(folder_ / "at_once" / report));
        EXPECT_NE(at_once.output.find(std::string(name) + " (quick,"), std::string::npos) << at_once.output;
    }
}

TEST_F(Verify, OneCaseThatMissesItsBarOrCannotBeReadDecides) {
    const std::string two = "cells_poiseuille lattice_operators --jobs 2 ";   // the second one has no deck
    EXPECT_EQ(verify("plug", two + "--set openings.inlet.profile=plug").exit_code, 6);
    const Result wrong = verify("wrong", two + "--set 'blood.viscosity=3 mm'");
    EXPECT_EQ(wrong.exit_code, 3) << wrong.output;
    EXPECT_NE(wrong.output.find("viscosity"), std::string::npos) << wrong.output;
    EXPECT_TRUE(fs::exists(folder_ / "wrong" / "lattice_operators.json")) << "the other case has its answer";
    EXPECT_EQ(verify("none", "lattice_operator patch").exit_code, 2);
}

}   // namespace
}   // namespace patency
