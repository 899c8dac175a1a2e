// SPDX-License-Identifier: Apache-2.0
// The seeds are sound and small, and damage is the same each time. What damaged files do is seen by program/main.cpp.
#include <gtest/gtest.h>

#include "tests/fuzz/mutator.h"
#include "tests/fuzz/target.h"
#include "tests/io/scratch_folder.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

TEST(Fuzz, seedsAreAccepted) {
    const ScratchFolder folder;
    std::uintmax_t size = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(PATENCY_SOURCE_DIR) / "tests/fuzz/corpus")) {
        const std::string name = entry.path().filename().string();
        std::string sentence;
        EXPECT_EQ(end_of(folder / name, contents_of(entry.path()), sentence), Ending::accepted)
            << name << ": " << sentence;
        size += entry.file_size();
    }
    EXPECT_LT(size, 100'000u);   // bytes: small files find as much, and sooner
}

TEST(Fuzz, damageIsTheSameForTheSameNumber) {
    std::string sound;
    for (int k = 0; k < 40; ++k) sound += "vertex " + std::to_string(k) + " 12.5 -0.75\n";
    std::size_t changed = 0;
    for (unsigned k = 0; k < 200; ++k) {
        EXPECT_EQ(Mutator(k)(sound, sound), Mutator(k)(sound, sound));
        changed += Mutator(k)(sound, sound) != sound;
    }
    EXPECT_GT(changed, 190u);   // a blow may hit nothing, or write what stood there
}

TEST(Fuzz, refusalsAreToldApart) {
    const ScratchFolder folder;
    std::string sentence;
    EXPECT_EQ(end_of(folder / "missing" / "x.stl", "solid", sentence),
              Ending::file);   // it cannot be written, so not read
    EXPECT_EQ(end_of(folder / "x.yaml", "version: 2\n", sentence), Ending::deck);
    EXPECT_EQ(end_of(folder / "x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", sentence), Ending::geometry);
}

}   // namespace
}   // namespace patency
