// SPDX-License-Identifier: Apache-2.0
// The document of the cases: what was not run again stays as it was.
#include <gtest/gtest.h>

#include "patency/io/atomic_file.h"
#include "patency/verify/runner.h"
#include "tests/io/scratch_folder.h"

namespace patency {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& out, const std::string& name, double value, const char* date) {
    fs::create_directories(out / "pictures");
    CaseReport report{.name = name, .level = Level::full, .particles = 1152, .figures = {}};
    report.figures.push_back({.key = "error_percent", .value = value, .unit = "percent", .bar = Bar{1}, .reason = ""});
    write_file(out / (name + ".json"), format_report(report));
    write_file(
        out / (name + ".timing.json"),
        std::string(R"({"date": ")") + date +
            R"(", "cpu_s": 12, "runs": {"d12": {"particles": 7, "acoustic_steps": 8, "cpu_s": 9, "wall_s": 10}}})");
    write_file(out / "pictures" / (name + ".json"), R"([{"name": ")" + name + R"(_profile", "caption": "Profiles"}])");
    write_file(out / "pictures" / (name + "_profile.svg"), "<svg>" + name + "</svg>");
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST(VerificationReport, KeepsWhatWasNotRunAgain) {
    const ScratchFolder folder;
    const fs::path document = folder / "docs/VERIFICATION.md", kept = folder / "docs/verification";
    put(folder / "first", "poiseuille", 0.25, "2026-01-02"), put(folder / "first", "channel", 0.5, "2026-01-02");
    write_verification_report(folder / "first", document, {});
    const std::string before = read_file(document);
    EXPECT_PRED2(has, before, "| `error_percent` | 0.25 | percent | <= 1 | met |");
    EXPECT_PRED2(has, before, "| `error_percent` | 0.5 | percent | <= 1 | met |");
    EXPECT_PRED2(has, before, "Run on 2026-01-02.");
    EXPECT_PRED2(has, before, "![Profiles](verification/channel_profile.svg)");

    put(folder / "second", "channel", 1.5, "2026-03-04");
    fs::remove_all(folder / "first");
    write_verification_report(folder / "second", document, {});
    const std::string after = read_file(document);
    EXPECT_PRED2(has, after, "| `error_percent` | 0.25 | percent | <= 1 | met |");
    EXPECT_PRED2(has, after, "| `error_percent` | 1.5 | percent | <= 1 | **missed** |");
    EXPECT_FALSE(has(after, "| `error_percent` | 0.5 |"));
    EXPECT_PRED2(has, after, "Run on 2026-03-04.");
    EXPECT_EQ(read_file(kept / "poiseuille_profile.svg"), "<svg>poiseuille</svg>");
}

TEST(VerificationReport, SaysWhichRunStandsBesideThePapersTableSixAndHowItsStentWasOpened) {
    const ScratchFolder folder;
    const fs::path document = folder / "docs/VERIFICATION.md", run = folder / "run";
    put(folder / "out", "poiseuille", 0.25, "2026-01-02");
    const auto written = [&](const char* summary) {
        fs::create_directories(run);
        write_file(run / "summary.json", summary);
        write_verification_report(folder / "out", document, run);
        return read_file(document);
    };
    const std::string quick = written(R"({"name": "one", "deploy": {"is_mechanical": false}})");
    EXPECT_PRED2(has, quick, "`patency run cases/one.yaml`");
    EXPECT_PRED2(has, quick, "opened without mechanics");
    const std::string pushed = written(R"({"name": "two", "deploy": {"is_mechanical": true}})");
    EXPECT_PRED2(has, pushed, "`patency run cases/two.yaml`");
    EXPECT_PRED2(has, pushed, "opened by a balloon against a wall that is a solid");
    write_verification_report(folder / "out", document, {});   // and it is kept
    EXPECT_EQ(read_file(document), pushed);
}

}   // namespace
}   // namespace patency
