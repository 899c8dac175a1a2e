// SPDX-License-Identifier: Apache-2.0
// Many damaged files, each tried in a process that may crash or never end. What a file is good for is target.h's.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/fuzz/target.h"

namespace patency {

struct Campaign {
    std::vector<std::filesystem::path> seeds{};   ///< file k is made of seed k modulo their number
    unsigned first = 0, count = 400;              ///< numbers of the files
    int at_once = 2;                              ///< processes
    double longest = 20;            ///< s of processor time per file, for the machine may do other things too
    std::filesystem::path keep{};   ///< a folder for the files of findings
};

struct Tally {
    std::vector<std::array<unsigned, endings>> of_seed{};   ///< files by their seed and how they ended
    unsigned slowest = 0;                                   ///< number of the file that took longest
    double slowest_time = 0;                                ///< s of processor time
    double time = 0;                                        ///< s, of all
};

/// The damaged file of that number.
std::string damaged(const Campaign& campaign, unsigned number);

/// Tries them all. Prints where it is and each finding as it comes; the file of a finding is in `keep` as NUMBER_SEED.
Tally run_campaign(const Campaign& campaign);

}   // namespace patency
