// SPDX-License-Identifier: Apache-2.0
// The document of all verification cases. What it is made of lies beside it, so that a case that is run again renews its part alone.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"
#include "patency/io/summary.h"
#include "patency/verify/paper_tables.h"
#include "patency/verify/runner.h"

namespace patency {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* table_six_file = "table_six.summary.json";

std::string table_of(const CaseReport& report) {
    std::string text = "| Figure | Value | Unit | Bar | |\n|---|---|---|---|---|\n";
    for (const Figure& f : report.figures)
        text += fmt::format("| `{}` | {} | {} | {} | {} |\n", f.key,
                            f.value ? fmt::format("{:.4g}", *f.value) : "none: " + f.reason, f.unit,
                            f.bar ? fmt::format("{} {:g}", word_of(f.bar->sense), f.bar->limit) : "",
                            !f.bar       ? ""
                            : f.passes() ? "met"
                                         : "**missed**");
    return text;
}

std::string runs_of(const Json& timing) {
    if (!timing.contains("runs")) return "";
    std::string text =
        timing.contains("date") ? fmt::format("\nRun on {}.\n", timing.at("date").get<std::string>()) : "";
    text += "\n| Run | Particles | Acoustic steps | CPU time [s] | Wall time [s] |\n|---|---|---|---|---|\n";
    for (const auto& [name, run] : timing.at("runs").items())
        text += fmt::format("| {} | {} | {} | {:.1f} | {:.1f} |\n", name, run.at("particles").get<std::int64_t>(),
                            run.at("acoustic_steps").get<std::int64_t>(), run.at("cpu_s").get<double>(),
                            run.at("wall_s").get<double>());
    return text;
}

void copy_if_there(const fs::path& from, const fs::path& to) {
    if (fs::exists(from)) write_file(to, read_file(from));
}

/// The results of a folder, and the summary of a run on the stented bifurcation, go to where the document's are.
void keep(const fs::path& out, const fs::path& run, const fs::path& kept) {
    std::error_code error;   // write_file says what is wrong
    fs::create_directories(kept, error);
    for (const VerifyCase& c : verification_cases()) {
        if (!fs::exists(out / (c.name + ".json"))) continue;
        for (const char* tail : {".json", ".timing.json"}) copy_if_there(out / (c.name + tail), kept / (c.name + tail));
        const fs::path captions = out / "pictures" / (c.name + ".json");
        if (!fs::exists(captions)) continue;
        copy_if_there(captions, kept / (c.name + ".pictures.json"));
        for (const Json& picture : Json::parse(read_file(captions))) {
            const std::string name = picture.at("name").get<std::string>() + ".svg";
            copy_if_there(out / "pictures" / name, kept / name);
        }
    }
    if (!run.empty()) write_file(kept / table_six_file, read_file(run / "summary.json"));
}

}   // namespace

void write_verification_report(const fs::path& out, const fs::path& document, const fs::path& run) {
    const fs::path kept = document.parent_path() / "verification";
    keep(out, run, kept);
    std::vector<CaseReport> reports;
    std::string body,
        summary = "| Case | What | Level | Particles | Bars met | CPU time [s] |\n|---|---|---|---|---|---|\n";
    for (const VerifyCase& c : verification_cases()) {
        const fs::path file = kept / (c.name + ".json");
        if (!fs::exists(file)) continue;
        const CaseReport& report = reports.emplace_back(parse_report(read_file(file), file.string()));
        Json timing = Json::object();
        if (fs::exists(kept / (c.name + ".timing.json")))
            timing = Json::parse(read_file(kept / (c.name + ".timing.json")));
        int bars = 0, met = 0;
        for (const Figure& f : report.figures)
            if (f.bar) bars += 1, met += f.passes();
        summary += fmt::format("| [{0}](#{0}) | {1} | {2} | {3} | {4} of {5} | {6:.0f} |\n", c.name, c.title,
                               word_of(report.level), report.particles, met, bars, timing.value("cpu_s", 0.0));
        body += fmt::format("\n## {}\n\n{}.\n\n", c.name, c.title) + table_of(report) + runs_of(timing);
        const fs::path captions = kept / (c.name + ".pictures.json");
        if (!fs::exists(captions)) continue;
        for (const Json& picture : Json::parse(read_file(captions))) {
            const std::string name = picture.at("name"), caption = picture.at("caption");
            body += fmt::format("\n![{0}](verification/{1}.svg)\n\n*{0}.*\n", caption, name);
        }
    }
    std::string paper =
        "\n## The reference paper's tables\n\nWhat arXiv 2511.08745 prints, what its scheme gives here (with its "
        "misprints mended), and ours.\n\n" +
        paper_figures_table(reports);
    if (fs::exists(kept / table_six_file)) {
        const Json run_summary = read_summary(kept / table_six_file);
        const bool is_mechanical = run_summary.at("deploy").value("is_mechanical", false);
        paper += fmt::format(
            "\nIts table VI, before and after the stent, beside `patency run cases/{}.yaml` (made by `--run OUT`). The "
            "stent is opened {}; what\nthe paper calls FFR is a ratio of pressures above the lowest outlet's.\n\n",
            run_summary.at("name").get<std::string>(),
            is_mechanical ? "by a balloon against a wall that is a solid" : "without mechanics");
        paper += paper_table_six(run_summary);
    }
    write_file(document,
               "# Verification\n\nEvery case below has a known answer. The tables are written by `patency verify "
               "--level full -o out` and\n"
               "`patency verify --report docs/VERIFICATION.md -o out`, which keeps what `out` does not have; decks are "
               "in `cases/verify/`, the closed forms in\n"
               "[THEORY](THEORY.md) section 12, the measures of error in section 13. Keys that begin with `paper_` "
               "belong to the\n"
               "reference paper's scheme, run here, and `paper_printed_` to the figures that the paper prints; they "
               "have no bar. Each case says\nwhen it was run, with the program of that day; times are of machines that "
               "other runs shared.\n\n" +
                   summary + paper + body);
}

}   // namespace patency
