// SPDX-License-Identifier: Apache-2.0
// What is said of a wrong deck, for the tests of mistakes.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "tests/config/decks.h"

namespace patency::deck {

inline std::string mistakes_in(const std::string& deck, const Settings& settings = {}) {
    try {
        parse_case(deck, "case.yaml", "", settings);
    } catch (const DeckError& e) {
        EXPECT_EQ(e.code(), ExitCode::deck);
        return e.what();
    }
    return "accepted";
}

inline std::string run_mistakes_in(const std::string& deck) {
    try {
        parse_runs(deck, "case.yaml");
    } catch (const DeckError& e) {
        return e.what();
    }
    return "accepted";
}

/// The report of exactly this one mistake.
inline std::string only(const std::string& mistake) { return "case.yaml:" + mistake + "\n1 mistake; nothing was run."; }

/// pipe_deck, lines 1-17, with lines behind it.
inline std::string pipe_and(const std::string& lines) { return pipe_deck + lines; }

}   // namespace patency::deck
