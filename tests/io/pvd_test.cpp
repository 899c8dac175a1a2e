// SPDX-License-Identifier: Apache-2.0
#include "patency/io/pvd.h"

#include <gtest/gtest.h>

#include "patency/base/errors.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

TEST(Pvd, ListsFramesWithTheirTimes) {
    const ScratchFolder folder;
    PvdWriter series(folder / "fluid.pvd");
    EXPECT_FALSE(has(contents_of(folder / "fluid.pvd"), "DataSet"));
    series.add(0.1, frame_file("fluid", series.size()));
    EXPECT_TRUE(
        has(contents_of(folder / "fluid.pvd"),
            "<Collection>\n<DataSet timestep=\"0.1\" part=\"0\" file=\"frames/fluid_000000.vtp\"/>\n</Collection>"));
    EXPECT_EQ(series.size(), 1u);
    EXPECT_TRUE(series.ends_at(0.1));
    EXPECT_FALSE(series.ends_at(0.2));
}

TEST(Pvd, GoesOnFromTheCheckpointAsIfNothingHadHappened) {
    const ScratchFolder folder;
    const auto add = [](PvdWriter& series, int first, int end) {
        for (int i = first; i < end; ++i) series.add(0.1 * i, frame_file("a <b> & \"c\"", series.size()));
    };
    PvdWriter uninterrupted(folder / "a.pvd");
    add(uninterrupted, 0, 6);
    PvdWriter killed(folder / "b.pvd");
    add(killed, 0, 5);
    PvdWriter resumed = PvdWriter::resumed(folder / "b.pvd", 0.1 * 3);
    EXPECT_EQ(resumed.size(), 4u);
    add(resumed, 4, 6);
    EXPECT_EQ(contents_of(folder / "b.pvd"), contents_of(folder / "a.pvd"));
    EXPECT_EQ(PvdWriter::resumed(folder / "new.pvd", 1).size(), 0u);
}

TEST(Pvd, GivesBackItsFrames) {
    const ScratchFolder folder;
    PvdWriter series(folder / "a.pvd");
    series.add(0, "frames/a & b.vtp");
    series.add(0.25, "frames/c.vtp");
    const std::vector<PvdFrame> frames = read_pvd(folder / "a.pvd");
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(frames[0].file, "frames/a & b.vtp");
    EXPECT_EQ(frames[1].time, 0.25);
}

TEST(Pvd, DoesNotContinueWhatIsNoCollection) {
    const ScratchFolder folder;
    for (std::string_view text :
         {"", "hello", "<Collection><DataSet timestep=\"soon\" file=\"f\"/></Collection>",
          "<Collection><DataSet file=\"f\"/></Collection>", "<Collection><DataSet timestep=\"1"}) {
        put(folder / "f.pvd", text);
        EXPECT_TRUE(has(sentence_of<FileError>([&] { PvdWriter::resumed(folder / "f.pvd", 1); }), "f.pvd")) << text;
    }
    EXPECT_THROW(PvdWriter(folder / "none/f.pvd"), FileError);
}

}   // namespace
}   // namespace patency
