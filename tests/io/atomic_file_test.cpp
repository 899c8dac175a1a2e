// SPDX-License-Identifier: Apache-2.0
#include "patency/io/atomic_file.h"

#include <gtest/gtest.h>

#include "patency/base/errors.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

TEST(AtomicFile, ReadsBackWhatItWrote) {
    const ScratchFolder folder;
    const std::string bytes("a\0\n\xff", 4);
    write_file(folder / "f", {bytes, "", "end"});
    EXPECT_EQ(read_file(folder / "f"), bytes + "end");
    EXPECT_FALSE(std::filesystem::exists(folder / "f.tmp"));
}

TEST(AtomicFile, KeepsTheOldFileWhenTheDiskIsFull) {
    const ScratchFolder folder;
    write_file(folder / "f", "old");
    {
        const FileSizeLimit limit(1000);
        const std::string sentence = sentence_of<FileError>([&] {
            write_file(folder / "f", {std::string(600, 'x'), std::string(600, 'x')});
        });
        EXPECT_TRUE(has(sentence, "f'"));
        EXPECT_TRUE(has(sentence, "File too large"));   // the limit's name for a full disk
    }
    EXPECT_EQ(read_file(folder / "f"), "old");
    EXPECT_FALSE(std::filesystem::exists(folder / "f.tmp"));
}

TEST(AtomicFile, SaysPathAndReason) {
    const ScratchFolder folder;
    put(folder / "file", "");
    EXPECT_TRUE(has(sentence_of<FileError>([&] { write_file(folder / "file/inside", "x"); }), "Not a directory"));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { write_file(folder / "none/inside", "x"); }), "No such file"));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { write_file(folder.path(), "x"); }), "Is a directory"));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { read_file(folder / "none"); }), "none"));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { read_file(folder.path()); }), "Is a directory"));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { read_file("/dev/null"); }), "not a regular file"));
    EXPECT_TRUE(
        has(file_error_sentence("write", "out/f", ENOSPC), "cannot write 'out/f': No space left on device. Free"));
}

}   // namespace
}   // namespace patency
