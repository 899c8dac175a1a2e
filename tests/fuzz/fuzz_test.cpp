// SPDX-License-Identifier: Apache-2.0
// Damaged files of every format that is read end in a result or in a sentence: never in a crash, another exception or a
// long silence. PATENCY_FUZZ_FILES says how many files are tried (10000: some minutes); PATENCY_FUZZ_FIRST with which number
// they begin, to see one again. The file being tried lies in the folder that a crash leaves behind.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/io/network_file.h"
#include "patency/io/surface_file.h"
#include "patency/shape/network_lumen.h"
#include "patency/shape/surface_check.h"
#include "patency/shape/surface_openings.h"
#include "tests/fuzz/mutator.h"
#include "tests/io/scratch_folder.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> seeds() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(fs::path(PATENCY_SOURCE_DIR) / "tests/fuzz/corpus"))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

unsigned number_from(const char* variable, unsigned standard) {
    const char* text = std::getenv(variable);
    return text ? unsigned(std::strtoul(text, nullptr, 10)) : standard;
}

/// All that the program does with such a file before it computes. Throws Error for what it refuses.
void use(const fs::path& path, const std::string& contents) {
    if (path.extension() == ".yaml") {
        for (const deck::NamedCase& named : deck::parse_runs(contents, "deck", path.parent_path()))
            deck::format_case(named.resolved, path.parent_path());
        return;
    }
    put(path, contents);
    if (holds_network(path)) {
        openings_of(read_network(path, "mm"), 1e-3);
        return;
    }
    const CheckedSurface checked = check_surface(read_surface(path, "mm"));
    ASSERT_TRUE(std::isfinite(checked.volume));
    for (const SurfaceOpening& opening : find_openings(checked)) ASSERT_TRUE(opening.opening.area > 0);
}

TEST(Fuzz, seedsAreAccepted) {
    const ScratchFolder folder;
    for (const fs::path& seed : seeds()) {
        SCOPED_TRACE(seed.filename());
        EXPECT_NO_THROW(use(folder / seed.filename().string(), contents_of(seed)));
    }
}

TEST(Fuzz, damagedFilesEndInAResultOrASentence) {
    const ScratchFolder folder;
    const std::vector<fs::path> files = seeds();
    const unsigned first = number_from("PATENCY_FUZZ_FIRST", 0), count = number_from("PATENCY_FUZZ_FILES", 400);
    constexpr double longest = 20;   // s, on a machine that does other things too
    std::size_t accepted = 0;
    for (unsigned k = first; k < first + count; ++k) {
        const fs::path& seed = files[k % files.size()];
        SCOPED_TRACE(fmt::format("PATENCY_FUZZ_FIRST={} PATENCY_FUZZ_FILES=1, from {}", k, seed.filename().string()));
        const auto start = std::chrono::steady_clock::now();
        try {
            use(folder / seed.filename().string(), Mutator(k)(contents_of(seed)));
            ++accepted;
        } catch (const Error& error) {
            EXPECT_GT(std::string(error.what()).size(), 20u);   // a sentence
            EXPECT_TRUE(error.code() == ExitCode::deck || error.code() == ExitCode::geometry ||
                        error.code() == ExitCode::file_system || error.code() == ExitCode::usage)
                << error.what();
        } catch (const std::exception& error) {
            ADD_FAILURE() << "no Error of ours: " << error.what();
        }
        EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), longest);
    }
    if (count >= files.size()) {
        EXPECT_GT(accepted, count / 20);   // some damage does no harm: the mutations are not too coarse
    }
}

}   // namespace
}   // namespace patency
