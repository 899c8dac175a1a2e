// SPDX-License-Identifier: Apache-2.0
// Where tests of stages put results: a folder of the test's own, gone with it.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace patency {

inline std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() /
        fmt::format("patency_stages_{}_{}", ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name(),
                    ::testing::UnitTest::GetInstance()->current_test_info()->name());
    Folder() { std::filesystem::remove_all(path); }
    ~Folder() { std::filesystem::remove_all(path); }
};

}   // namespace patency
