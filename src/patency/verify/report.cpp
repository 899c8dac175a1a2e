// SPDX-License-Identifier: Apache-2.0
// The document of all verification cases that lie in a folder.
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

std::string table_of(const CaseReport& report) {
    std::string text = "| Figure | Value | Unit | Bar | |\n|---|---|---|---|---|\n";
    for (const Figure& f : report.figures)
        text += fmt::format("| `{}` | {} | {} | {} | {} |\n", f.key, f.value ? fmt::format("{:.4g}", *f.value) : "none: " + f.reason, f.unit,
                            f.bar ? fmt::format("{} {:g}", word_of(f.bar->sense), f.bar->limit) : "",
                            !f.bar ? "" : f.passes() ? "met" : "**missed**");
    return text;
}

std::string runs_of(const Json& timing) {
    if (!timing.contains("runs")) return "";
    std::string text = "\n| Run | Particles | Acoustic steps | CPU time [s] | Wall time [s] |\n|---|---|---|---|---|\n";
    for (const auto& [name, run] : timing.at("runs").items())
        text += fmt::format("| {} | {} | {} | {:.1f} | {:.1f} |\n", name, run.at("particles").get<std::int64_t>(),
                            run.at("acoustic_steps").get<std::int64_t>(), run.at("cpu_s").get<double>(), run.at("wall_s").get<double>());
    return text;
}

}  // namespace

void write_verification_report(const fs::path& out, const fs::path& document, const fs::path& run) {
    std::vector<CaseReport> reports;
    std::string body, summary = "| Case | What | Level | Particles | Bars met | CPU time [s] |\n|---|---|---|---|---|---|\n";
    const fs::path pictures = document.parent_path() / "verification";
    for (const VerifyCase& c : verification_cases()) {
        const fs::path file = out / (c.name + ".json");
        if (!fs::exists(file)) continue;
        const CaseReport& report = reports.emplace_back(parse_report(read_file(file), file.string()));
        Json timing = Json::object();
        if (fs::exists(out / (c.name + ".timing.json"))) timing = Json::parse(read_file(out / (c.name + ".timing.json")));
        int bars = 0, met = 0;
        for (const Figure& f : report.figures)
            if (f.bar) bars += 1, met += f.passes();
        summary += fmt::format("| [{0}](#{0}) | {1} | {2} | {3} | {4} of {5} | {6:.0f} |\n", c.name, c.title, word_of(report.level),
                               report.particles, met, bars, timing.value("cpu_s", 0.0));
        body += fmt::format("\n## {}\n\n{}.\n\n", c.name, c.title) + table_of(report) + runs_of(timing);
        const fs::path captions = out / "pictures" / (c.name + ".json");
        if (!fs::exists(captions)) continue;
        const Json list = Json::parse(read_file(captions));
        for (const Json& picture : list) {
            const std::string name = picture.at("name"), caption = picture.at("caption");
            std::error_code error;   // write_file says what is wrong
            fs::create_directories(pictures, error);
            write_file(pictures / (name + ".svg"), read_file(out / "pictures" / (name + ".svg")));
            body += fmt::format("\n![{0}](verification/{1}.svg)\n\n*{0}.*\n", caption, name);
        }
    }
    std::string paper = "\n## The reference paper's tables\n\nWhat arXiv 2511.08745 prints, what its scheme gives here (with its misprints mended), and ours.\n\n" + paper_figures_table(reports);
    if (!run.empty())
        paper += "\nIts table VI, before and after the stent, beside `patency run cases/stented_bifurcation.yaml` (made by `--run OUT`). The stent is opened without mechanics; what\n"
                 "the paper calls FFR is a ratio of pressures above the lowest outlet's.\n\n" + paper_table_six(read_summary(run / "summary.json"));
    write_file(document,
               "# Verification\n\nEvery case below has a known answer. The tables are written by `patency verify --level full -o out` and\n"
               "`patency verify --report docs/VERIFICATION.md -o out`; decks are in `cases/verify/`, the closed forms in\n"
               "[THEORY](THEORY.md) section 12, the measures of error in section 13. Keys that begin with `paper_` belong to the\n"
               "reference paper's scheme, run here, and `paper_printed_` to the figures that the paper prints; they have no bar.\n\n" +
                   summary + paper + body);
}

}  // namespace patency
