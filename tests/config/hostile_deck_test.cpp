// SPDX-License-Identifier: Apache-2.0
// Files that are no decks, or were: read or refused, never anything else.
#include "tests/config/mistakes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace patency::deck {
namespace {

TEST(Hostile, NoFile) {
    EXPECT_THROW(read_case("no/such/file.yaml"), FileError);
    EXPECT_THROW(read_case(testing::TempDir()), FileError);
}

TEST(Hostile, NotADeck) {
    EXPECT_EQ(mistakes_in(""), only("1:1: the deck is empty; it starts with \"version: 1\""));
    EXPECT_EQ(mistakes_in("# nothing\n"), only("1:1: the deck is empty; it starts with \"version: 1\""));
    EXPECT_EQ(mistakes_in("[1, 2]"), only("1:1: a deck is a record of keys; it starts with \"version: 1\""));
    EXPECT_EQ(mistakes_in("\x89PNG\r\n\x1a\n"), only("1:1: this is not a text file in UTF-8"));
    EXPECT_EQ(mistakes_in(std::string("version: 1\0", 11)), only("1:1: this is not a text file in UTF-8"));
    EXPECT_EQ(mistakes_in(pipe_and("---\nversion: 1\n")),
              only("18:1: a second document starts here; a deck is one document"));
    for (const char* key : {"? [a]\n: b\n", "? {a: 1}\n: b\n", "? ~\n: b\n"})
        EXPECT_EQ(mistakes_in(key), only("1:3: a key must be a single word")) << key;
    EXPECT_NE(mistakes_in("? {a: 1, a: 2}\n: b\n").find("1:10: ?.a: repeated"), std::string::npos);
}

TEST(Hostile, Syntax) {
    EXPECT_EQ(mistakes_in(pipe_with("{name: pipe}", "{name: pipe")).substr(0, 12), "case.yaml:3:");
    EXPECT_NE(mistakes_in("{\"version\": 1,\n").find("end of map"), std::string::npos)
        << "an unclosed bracket is called so";
    EXPECT_NE(mistakes_in("a: *b\n").find("case.yaml:1:4: not valid YAML"), std::string::npos);
    EXPECT_NE(mistakes_in("a: b: c\n").find("case.yaml:1:5: not valid YAML"), std::string::npos);
}

TEST(Hostile, Nesting) {
    for (const std::string opening : {"[", "{a: ", "- ", "? "}) {
        std::string deck;
        for (int i = 0; i < 20000; ++i) deck += opening;
        EXPECT_NE(mistakes_in(deck).find("nested more than 32 deep"), std::string::npos) << opening;
    }
}

TEST(Hostile, Aliases) {
    std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 20; ++i)
        bomb += fmt::format("a{0}: &a{0} [*a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}]\n", i,
                            i - 1);
    EXPECT_NE(mistakes_in(bomb).find("more than 50000 values"), std::string::npos);
    EXPECT_NE(mistakes_in("a: &a [*a]\n").find("an alias stands inside what it refers to"), std::string::npos);
}

TEST(Hostile, ManyMistakesEndSomewhere) {
    std::string deck;
    for (int i = 0; i < 20000; ++i) deck += "key_" + std::to_string(i) + ": 1\n";
    EXPECT_TRUE(mistakes_in(deck).ends_with("1000 or more mistakes; nothing was run."));
}

TEST(Hostile, LargeFile) {
    const auto path = std::filesystem::path(testing::TempDir()) / "patency_large_deck.yaml";
    std::ofstream(path) << std::string(3 << 20, '#');
    EXPECT_THROW(read_case(path), DeckError);
    std::filesystem::remove(path);
}

// Decks cut anywhere, and decks with random bytes changed, are read or refused, never anything else.
TEST(Hostile, TruncatedAndDamagedDecks) {
    const std::string& whole = valid_decks[1];
    int refused = 0;
    for (std::size_t length = 0; length < whole.size(); length += 7)
        refused += mistakes_in(whole.substr(0, length)) != "accepted";
    EXPECT_GT(refused, 0);
    std::mt19937 random(1);
    const std::string signs = "{}[]:,-?&*!|>'\"%@`#\n\t \\0aZ~.";
    for (int i = 0; i < 1500; ++i) {
        std::string deck = valid_decks[i % valid_decks.size()];
        for (int k = 0; k < 3; ++k) deck[random() % deck.size()] = signs[random() % signs.size()];
        try {
            parse_runs(deck);
        } catch (const DeckError& e) {
            ASSERT_TRUE(std::string(e.what()).ends_with("nothing was run.")) << deck;
        }
    }
}

}   // namespace
}   // namespace patency::deck
