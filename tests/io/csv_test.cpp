// SPDX-License-Identifier: Apache-2.0
#include "patency/io/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "patency/base/errors.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

const std::vector<std::string> columns = {"time_s", "flow_inlet_m3_per_s"};

TEST(CsvWriter, ReadsBackTheSameDoubles) {
    const ScratchFolder folder;
    const std::vector<double> values = {0.1, 1.0 / 3, -0.0, 5e-324, 1.7976931348623157e308, 1e22, 123456789.0};
    CsvWriter writer(folder / "t.csv", columns);
    for (double value : values) writer.write_row({value, -value});
    const CsvTable table = read_csv(folder / "t.csv");
    EXPECT_EQ(table.names, columns);
    ASSERT_EQ(table.row_count(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(table.columns[0][i], values[i]);
        EXPECT_EQ(std::signbit(table.columns[0][i]), std::signbit(values[i]));
        EXPECT_EQ((*table.find("flow_inlet_m3_per_s"))[i], -values[i]);
    }
    EXPECT_EQ(table.find("none"), nullptr);
}

TEST(CsvWriter, HasEachRowInTheFileAtOnceAndInFewDigits) {
    const ScratchFolder folder;
    CsvWriter writer(folder / "t.csv", columns);
    EXPECT_EQ(contents_of(folder / "t.csv"), "time_s,flow_inlet_m3_per_s\n");
    writer.write_row({0.1, 2.5e-6});
    EXPECT_EQ(contents_of(folder / "t.csv"), "time_s,flow_inlet_m3_per_s\n0.1,2.5e-06\n");
}

TEST(CsvWriter, GoesOnFromTheCheckpointAsIfNothingHadHappened) {
    const ScratchFolder folder;
    const auto write = [](CsvWriter& writer, int first, int end) {
        for (int i = first; i < end; ++i) writer.write_row({0.1 * i, 1.0 * i});
    };
    CsvWriter uninterrupted(folder / "a.csv", columns);
    write(uninterrupted, 0, 10);
    {
        CsvWriter killed(folder / "b.csv", columns);
        write(killed, 0, 7);
    }
    std::ofstream(folder / "b.csv", std::ios::app) << "0.7,";   // cut off in a row
    const double last_time = 0.1 * 3;                           // the checkpoint holds the same bits
    CsvWriter resumed = CsvWriter::resumed(folder / "b.csv", columns, last_time);
    write(resumed, 4, 10);
    EXPECT_EQ(contents_of(folder / "b.csv"), contents_of(folder / "a.csv"));
}

TEST(CsvWriter, ResumesWhatHasNoRows) {
    const ScratchFolder folder;
    for (std::string_view before :
         {"", "time_s,flo", "time_s,flow_inlet_m3_per_s\n", "time_s,flow_inlet_m3_per_s\n0.5,1\n",
          "time_s,flow_inlet_m3_per_s\n0.2", "time_s,flow_inlet_m3_per_s\n0.2,1"}) {
        put(folder / "t.csv", before);
        CsvWriter::resumed(folder / "t.csv", columns, 0.25).write_row({0.5, 2});
        EXPECT_EQ(contents_of(folder / "t.csv"), "time_s,flow_inlet_m3_per_s\n0.5,2\n") << before;
    }
    CsvWriter::resumed(folder / "new.csv", columns, 0.25);
    EXPECT_EQ(contents_of(folder / "new.csv"), "time_s,flow_inlet_m3_per_s\n");
}

TEST(CsvWriter, DoesNotContinueAnotherTable) {
    const ScratchFolder folder;
    for (std::string_view other : {"time_s,flow_outlet_m3_per_s\n0,1\n", "time_s,flow_inlet_m3_per_s\n0,1,2\n",
                                   "time_s,flow_inlet_m3_per_s\nzero,1\n"}) {
        put(folder / "t.csv", other);
        EXPECT_TRUE(
            has(sentence_of<FileError>([&] { CsvWriter::resumed(folder / "t.csv", columns, 1); }), "cannot continue"));
        EXPECT_EQ(contents_of(folder / "t.csv"), other);
    }
}

TEST(CsvWriter, RefusesWhatIsNotFinite) {
    const ScratchFolder folder;
    CsvWriter writer(folder / "t.csv", columns);
    for (double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_TRUE(has(sentence_of<DivergedError>([&] { writer.write_row({0.5, bad}); }), "flow_inlet_m3_per_s"));
    EXPECT_EQ(contents_of(folder / "t.csv"), "time_s,flow_inlet_m3_per_s\n");
}

TEST(CsvWriter, SaysThatTheDiskIsFull) {
    const ScratchFolder folder;
    EXPECT_TRUE(has(sentence_of<FileError>([&] { CsvWriter(folder / "none/t.csv", columns); }), "none/t.csv"));
    CsvWriter writer(folder / "t.csv", columns);
    const FileSizeLimit limit(40);
    EXPECT_TRUE(has(sentence_of<FileError>([&] {
                        for (int i = 0; i < 10; ++i) writer.write_row({1.0 * i, 1});
                    }),
                    "t.csv"));
}

TEST(ReadCsv, TakesTheTablesPeopleHave) {
    const ScratchFolder folder;
    for (std::string_view text :
         {"time_s,flow\n0,1.5\n1,-2e-3\n", "\xEF\xBB\xBFtime_s ; flow\r\n0;1.5\r\n+1;-2E-3\r\n",
          "# measured\n\n  time_s\tflow\n0   1.5\n\n# late\n 1 -.002\n", "time_s,flow\n0,1.5\n1,-2e-3"}) {
        put(folder / "t.csv", text);
        const CsvTable table = read_csv(folder / "t.csv");
        EXPECT_EQ(table.names, (std::vector<std::string>{"time_s", "flow"})) << text;
        EXPECT_EQ(table.columns, (std::vector<std::vector<double>>{{0, 1}, {1.5, -2e-3}})) << text;
    }
}

TEST(ReadCsv, SaysWhereItIsWrong) {
    const ScratchFolder folder;
    const std::pair<std::string_view, std::string_view> cases[] = {
        {"time_s,flow\n0,1\n1\n", "t.csv:3: 1 value where the first line names 2 columns"},
        {"time_s,flow\n0,1,2\n", "t.csv:2: 3 values"},
        {"time_s,flow\n0,1\n\n1,fast\n", "t.csv:4: \"fast\" in column \"flow\""},
        {"time_s,flow\n0,nan\n", "t.csv:2: \"nan\""},
        {"time_s,flow\n0,inf\n", "t.csv:2: \"inf\""},
        {"time_s,flow\n0,1e999\n", "t.csv:2: \"1e999\""},
        {"time_s,flow\n0,\n", "t.csv:2: \"\""},
        {"time_s;flow\n0;1,5\n", "t.csv:2: \"1,5\""},
        {"0,1\n1,2\n", "t.csv:1: \"0\" stands where a column's name"},
        {"time_s,\n1,2\n", "t.csv:1: \"\" stands where"},
        {"flow,flow\n1,2\n", "t.csv:1: two columns are called \"flow\""},
        {"", "t.csv: there are no rows"},
        {"time_s,flow\n", "t.csv: there are no rows"},
        {std::string_view("t\n\0\0\n", 5), "t.csv:2: "},
    };
    for (const auto& [text, expected] : cases) {
        put(folder / "t.csv", text);
        EXPECT_TRUE(has(sentence_of<DeckError>([&] { read_csv(folder / "t.csv"); }), std::string(expected)));
    }
    EXPECT_TRUE(has(sentence_of<FileError>([&] { read_csv(folder / "none.csv"); }), "none.csv"));
}

}   // namespace
}   // namespace patency
