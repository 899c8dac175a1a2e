// SPDX-License-Identifier: Apache-2.0
// Damages the seeds of tests/fuzz/corpus, each file in its own way and in the same way each time, and says how the program
// takes them. Exit code: 0 nothing found; 1 something found, or nearly all refused; 2 usage.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>

#include "tests/fuzz/program/campaign.h"

namespace {

using namespace patency;
namespace fs = std::filesystem;

constexpr const char* usage =
    "usage: fuzz_files [--count N] [--first NUMBER] [--kinds stl,vtp,yaml] [--at-once N] [--keep FOLDER]\n"
    "       fuzz_files --try FILE...   how the program takes these files\n";

std::vector<fs::path> find_seeds(std::string_view kinds) {
    std::set<fs::path> wanted;
    while (!kinds.empty()) {
        const std::size_t end = std::min(kinds.find(','), kinds.size());
        wanted.insert(fmt::format(".{}", kinds.substr(0, end)));
        kinds.remove_prefix(std::min(end + 1, kinds.size()));
    }
    std::vector<fs::path> seeds;
    for (const auto& entry : fs::directory_iterator(fs::path(PATENCY_SOURCE_DIR) / "tests/fuzz/corpus"))
        if (wanted.empty() || wanted.contains(entry.path().extension())) seeds.push_back(entry.path());
    std::sort(seeds.begin(), seeds.end());
    return seeds;
}

constexpr const char* words[endings] = {"accepted", "usage", "deck", "geometry", "file", "FOUND"};

int try_files(const std::vector<fs::path>& paths) {
    bool is_found = false;
    for (const fs::path& path : paths) {
        const fs::path copy =
            fs::temp_directory_path() / ("patency_fuzz_" + path.filename().string());   // it is written again
        std::ifstream file(path, std::ios::binary);
        std::string sentence;
        const Ending ending = end_of(copy, {std::istreambuf_iterator<char>(file), {}}, sentence);
        fs::remove(copy);
        is_found = is_found || ending == Ending::found;
        fmt::print("{}: {} {}\n", path.string(), words[int(ending)], sentence);
    }
    return is_found;
}

void print_row(std::string_view name, const std::array<unsigned, endings>& counts) {
    unsigned sum = 0;
    for (const unsigned n : counts) sum += n;
    fmt::print("{:<20} {:>6}", name, sum);
    for (const unsigned n : counts) fmt::print(" {:>9}", n);
    fmt::print("\n");
}

int judge(const Campaign& campaign, const Tally& tally) {
    fmt::print("{:<20} {:>6}", "seed", "files");
    for (const char* word : words) fmt::print(" {:>9}", word);
    fmt::print("\n");
    std::array<unsigned, endings> all{};
    for (std::size_t s = 0; s < tally.of_seed.size(); ++s) {
        print_row(campaign.seeds[s].filename().string(), tally.of_seed[s]);
        for (std::size_t e = 0; e < endings; ++e) all[e] += tally.of_seed[s][e];
    }
    print_row("all", all);
    fmt::print("{:.1f} s; the slowest file, number {}, took {:.2f} s\n", tally.time, tally.slowest, tally.slowest_time);
    if (all[int(Ending::found)] > 0) return 1;
    if (all[int(Ending::accepted)] >= campaign.count / 20) return 0;
    fmt::print("Of 20 files not one was accepted: some damage does no harm, so something else is wrong.\n");
    return 1;
}

int run(int count, char** arguments) {
    Campaign campaign{.keep = fs::temp_directory_path() / "patency_fuzz_found"};
    std::string_view kinds;
    if (count > 2 && std::string_view(arguments[1]) == "--try") return try_files({arguments + 2, arguments + count});
    for (int k = 1; k < count; k += 2) {
        const std::string_view key = arguments[k];
        if (k + 1 == count) return fmt::print(stderr, "{}", usage), 2;
        const char* value = arguments[k + 1];
        const auto number = unsigned(std::strtoul(value, nullptr, 10));
        if (key == "--count")
            campaign.count = number;
        else if (key == "--first")
            campaign.first = number;
        else if (key == "--kinds")
            kinds = value;
        else if (key == "--at-once")
            campaign.at_once = int(number);
        else if (key == "--keep")
            campaign.keep = value;
        else
            return fmt::print(stderr, "{}", usage), 2;
    }
    campaign.seeds = find_seeds(kinds);
    return judge(campaign, run_campaign(campaign));
}

}   // namespace

int main(int count, char** arguments) {
    try {
        return run(count, arguments);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
}
