// SPDX-License-Identifier: Apache-2.0
#include "patency/io/output_folder.h"

#include <gtest/gtest.h>

#include "patency/base/errors.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

TEST(OutputFolder, IsMadeAndOpenedAgain) {
    const ScratchFolder scratch;
    EXPECT_FALSE(is_output_folder(scratch / "a/b"));
    for (int time = 0; time < 2; ++time) {
        const OutputFolder folder(scratch / "a/b");
        EXPECT_EQ(folder.file("summary.json"), scratch / "a/b/summary.json");
        EXPECT_TRUE(std::filesystem::is_directory(scratch / "a/b/frames"));
        EXPECT_TRUE(std::filesystem::is_directory(scratch / "a/b/checkpoint"));
        EXPECT_TRUE(is_output_folder(scratch / "a/b"));
        put(scratch / "a/b/frames/fluid_000000.vtp", "");
    }
    EXPECT_TRUE(std::filesystem::exists(scratch / "a/b/frames/fluid_000000.vtp"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "a/b/checkpoint")) << "nothing was in it";
}

TEST(OutputFolder, TakesAnEmptyFolderAndNoForeignOne) {
    const ScratchFolder empty, foreign;
    EXPECT_NO_THROW(OutputFolder{empty.path()});
    put(foreign / "thesis.txt", "years of work");
    EXPECT_TRUE(has(sentence_of<FileError>([&] { OutputFolder folder(foreign.path()); }), foreign.path().string()));
    EXPECT_EQ(contents_of(foreign / "thesis.txt"), "years of work");
    EXPECT_FALSE(is_output_folder(foreign.path()));
    EXPECT_THROW(OutputFolder(foreign / "thesis.txt"), FileError);
    EXPECT_THROW(OutputFolder(foreign / "thesis.txt/out"), FileError);
}

TEST(OutputFolder, BelongsToOneRunAtATime) {
    const ScratchFolder scratch;
    {
        OutputFolder first(scratch / "out");
        const OutputFolder moved = std::move(first);
        EXPECT_TRUE(has(sentence_of<FileError>([&] { OutputFolder second(scratch / "out"); }), "another run"));
    }
    EXPECT_NO_THROW(OutputFolder(scratch / "out"));
}

TEST(OutputFolder, KnowsItsCheckpoints) {
    const ScratchFolder scratch;
    const OutputFolder folder(scratch / "out");
    EXPECT_FALSE(folder.has_checkpoint());
    put(folder.root() / "checkpoint/flow.h5.tmp", "");   // cut off
    EXPECT_FALSE(folder.has_checkpoint());
    put(folder.checkpoint("flow"), "");
    EXPECT_TRUE(folder.has_checkpoint());
    EXPECT_TRUE(folder.has_checkpoint("flow"));
    EXPECT_FALSE(folder.has_checkpoint("deploy"));
}

TEST(OutputFolder, ClearsResultsAndNothingElse) {
    const ScratchFolder scratch;
    const OutputFolder folder(scratch / "out");
    for (std::string_view result : {"summary.json", "fluid.pvd", "checkpoint/flow.h5", "frames/fluid_000000.vtp",
                                    "probes.csv", "profile_middle.csv"})
        put(folder.file(result), "");
    put(folder.file("notes.txt"), "mine");
    folder.clear();
    EXPECT_FALSE(folder.has_checkpoint());
    for (std::string_view result :
         {"summary.json", "fluid.pvd", "frames/fluid_000000.vtp", "probes.csv", "profile_middle.csv"})
        EXPECT_FALSE(std::filesystem::exists(folder.file(result))) << result;
    EXPECT_EQ(contents_of(folder.file("notes.txt")), "mine");
    EXPECT_TRUE(is_output_folder(folder.root()));
}

}   // namespace
}   // namespace patency
