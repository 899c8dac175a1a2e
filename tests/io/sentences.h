// SPDX-License-Identifier: Apache-2.0
// What an error says to its reader.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace patency {

/// The sentence of the E that the action throws; a failure of the test if it throws none.
template <class E, class Action>
std::string sentence_of(Action&& action) {
    try {
        action();
    } catch (const E& error) {
        return error.what();
    }
    ADD_FAILURE() << "no error of the expected type";
    return {};
}

inline ::testing::AssertionResult has(const std::string& text, const std::string& part) {
    if (text.find(part) != text.npos) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "'" << part << "' is not in: " << text;
}

}   // namespace patency
