// SPDX-License-Identifier: Apache-2.0
#include "patency/io/hash.h"

#include <gtest/gtest.h>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"
#include "tests/io/scratch_folder.h"
#include "tests/io/sentences.h"

namespace patency {
namespace {

std::string some_bytes(std::size_t count) {
    std::string bytes(count, '\0');
    for (std::size_t i = 0; i < count; ++i) bytes[i] = char(i % 251);
    return bytes;
}

TEST(Hash, IsXxh64) {
    // Printed by xxhsum -H64, for texts that reach every branch of the end.
    EXPECT_EQ(hash_bytes(""), 0xef46db3751d8e999u);
    EXPECT_EQ(hash_bytes("a"), 0xd24ec4f1a98c6e5bu);
    EXPECT_EQ(hash_bytes("abc"), 0x44bc2cf5ad770999u);
    EXPECT_EQ(hash_bytes(some_bytes(32)), 0xcbf59c5116ff32b4u);
    EXPECT_EQ(hash_bytes(some_bytes(45)), 0x10fdd84d6409abdfu);
    EXPECT_EQ(hash_bytes(some_bytes(1000)), 0xf306f04aa88b54d3u);
}

TEST(Hash, DoesNotDependOnHowBytesAreCut) {
    const std::string bytes = some_bytes(200);
    for (std::size_t piece = 1; piece < 80; ++piece) {
        Hash hash;
        for (std::size_t at = 0; at < bytes.size(); at += piece) hash.add(std::string_view(bytes).substr(at, piece));
        EXPECT_EQ(hash.value(), hash_bytes(bytes)) << piece;
    }
}

TEST(Hash, OfAFileIsThatOfItsBytes) {
    const ScratchFolder folder;
    const std::string bytes = some_bytes((1 << 20) + 77);   // more than one piece of reading
    write_file(folder / "f", bytes);
    EXPECT_EQ(hash_file(folder / "f"), hash_bytes(bytes));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { hash_file(folder / "none"); }), "none"));
    EXPECT_TRUE(has(sentence_of<FileError>([&] { hash_file(folder.path()); }), "Is a directory"));
}

TEST(Hash, HasSixteenDigits) { EXPECT_EQ(hex_text(0xabc), "0000000000000abc"); }

}   // namespace
}   // namespace patency
