// SPDX-License-Identifier: Apache-2.0
// patency run: everything that a deck asks for, one stage after the other: the flow, then with a stent its deployment and the flow
// after, and the estimate with its bands. Each stage's results are in a folder of its own in OUT, what they say together in
// OUT/summary.json and on the page.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line.h"
#include "commands.h"
#include "deck_options.h"
#include "patency/base/text.h"
#include "patency/config/deck.h"
#include "patency/io/summary.h"
#include "patency/report/page.h"
#include "patency/report/same_places.h"
#include "patency/stages/deploy_doubts.h"
#include "patency/stages/estimate_results.h"
#include "patency/stages/flow_checkpoint.h"
#include "patency/stages/materials_summary.h"
#include "patency/stages/stent_placement.h"
#include "solid_runner.h"
#include "stage_runner.h"

namespace patency::app {

namespace {

struct RunOptions {
    DeckOptions deck;
    std::string out;
    std::vector<std::string> stages;
    bool fresh = false;
};

using Json = nlohmann::ordered_json;

/// What the tree of tubes says, with the bands of its uncertain numbers.
Json estimate(const deck::Case& config, const Vessel& vessel, const Log& log) {
    const Estimate e = estimate_flow(config, vessel);
    Json summary = estimate_summary(config, vessel, e, estimate_band(config, vessel));
    for (const auto& [name, opening] : summary["openings"].items())
        log(LogLevel::info,
            fmt::format("estimate: {} {:.2f} mL/min", name, 6e7 * opening["flow_m3_per_s"].get<double>()));
    return summary;
}

constexpr std::string_view all_stages[] = {"before", "deploy", "after"};

/// The stages asked for, in their order; without a stent there is nothing to deploy and no after.
std::vector<std::string> stages_of(const deck::Case& config, const std::vector<std::string>& asked) {
    for (const std::string& name : asked)
        if (std::find(std::begin(all_stages), std::end(all_stages), name) == std::end(all_stages))
            throw UsageError(
                fmt::format("--stages: {} is none of before, deploy and after", double_quoted(shortened(name))));
    std::vector<std::string> stages;
    for (const std::string_view stage : all_stages) {
        const bool is_asked = asked.empty() || std::find(asked.begin(), asked.end(), stage) != asked.end();
        if (is_asked && (stage == "before" || config.stent)) stages.emplace_back(stage);
    }
    if (stages.empty())
        throw UsageError("--stages: the deck has no stent, so there is nothing to deploy and nothing after");
    return stages;
}

/// One run of all stages, each in its folder; those that have ended are kept.
class Run {
public:
    Run(const deck::Case& config, const OutputFolder& folder, const std::string& title, bool is_fresh)
        : config_(config), folder_(folder), interruption_(folder) {
        const Json origin = origin_summary(origin_of(config, binary_hash()));
        const std::filesystem::path known = folder.file("origin.json");
        const bool goes_on = !is_fresh && std::filesystem::exists(known);
        if (goes_on && read_summary(known) != origin)
            throw CheckpointError(
                fmt::format("'{}' holds a run of another deck, other inputs or another version of the program; --fresh "
                            "begins anew there",
                            folder.root().string()));
        if (!goes_on) {
            for (const std::string_view stage : all_stages)
                if (is_output_folder(folder.file(stage))) OutputFolder(folder.file(stage)).clear();
            folder.clear();
            write_summary(known, origin);
        }
        log_ = make_run_log(folder, goes_on);
        say(title);
    }

    ExitCode go(const std::vector<std::string>& stages) {
        const bool will_deploy = std::find(stages.begin(), stages.end(), "deploy") != stages.end();
        if (will_deploy)
            place_stent(config_, read_vessel(config_));   // a stent that cannot go there is refused before the flow
        for (const std::string& stage : stages) {
            const OutputFolder here(folder_.file(stage));
            if (has_ended(stage)) {
                say(stage + ": done before");
                continue;
            }
            if (stage == "deploy" && !here.has_checkpoint("deploy")) here.clear();
            if (stages.size() > 1 || stage != "before") say(fmt::format("--- {} ---", stage));
            const ExitCode code = stage == "deploy" ? run_deploy_stage(config_, here, interruption_, log_)
                                                    : run_flow_stage(stage == "after" ? deck_after() : config_, here,
                                                                     interruption_, log_);
            if (code != ExitCode::ok && code != ExitCode::bar_missed) return code;
        }
        return conclude();
    }

private:
    void say(const std::string& line) const { log_(LogLevel::info, line); }

    /// Its last two files are there; one that was stopped between them is ended again.
    bool has_ended(std::string_view stage) const {
        const std::filesystem::path folder = folder_.file(stage);
        return std::filesystem::exists(folder / "summary.json") && std::filesystem::exists(folder / "timing.json");
    }

    /// The flow after is that of the deck that the deployment wrote.
    deck::Case deck_after() const {
        const std::filesystem::path deck = folder_.file("deploy") / "case_after.yaml";
        if (!std::filesystem::exists(deck)) throw UsageError("--stages: the flow after needs the deployment first");
        return deck::read_case(deck);
    }

    /// Before and, once a stent is in, after; null for a shape, which has no tree.
    void add_estimates(Json& summary) const {
        summary["estimate"] = nullptr;
        if (!config_.has_vessel()) return;
        const Vessel vessel = read_vessel(config_);
        summary["estimate"] = estimate(config_, vessel, log_);
        if (!has_ended("deploy")) return;
        const deck::Case after = deck_after();
        summary["estimate_after"] = estimate_after_summary(config_, vessel, after, read_vessel(after));
    }

    /// Of a stent that is in, too.
    Json materials() const {
        deck::Case used = config_;
        if (!has_ended("deploy")) used.stent.reset();
        return materials_summary(used);
    }

    CsvTable pullback_of(std::string_view stage) const { return read_csv(folder_.file(stage) / "pullback.csv"); }

    /// All results in one summary and one page. A flow that did not settle is told by the exit code, whenever it was computed.
    ExitCode conclude() const {
        Json summary{{"name", config_.about.name}}, timing = Json::object();
        summary["materials"] = materials();
        add_estimates(summary);
        ExitCode code = ExitCode::ok;
        for (const std::string_view stage : all_stages) {
            if (!has_ended(stage)) continue;
            Json part = read_summary(folder_.file(stage) / "summary.json"),
                 times = read_summary(folder_.file(stage) / "timing.json");
            if (stage == "deploy") {
                part = Json(part["deploy"]), times = Json(times["deploy"]);
                if (!doubts_about(part).empty()) code = ExitCode::bar_missed;
            } else if (part.contains("convergence") && !part["convergence"].value("is_converged", true)) {
                code = ExitCode::bar_missed;
            }
            summary[std::string(stage)] = part;
            timing[std::string(stage)] = times;
        }
        if (summary.contains("before") && summary.contains("after"))   // an opened lesion is none any more
            add_at_lesions(summary["after"], at_lesions_of(summary["before"], pullback_of("before"), summary["after"],
                                                           pullback_of("after")));
        write_summary(folder_.file("summary.json"), summary);
        write_summary(folder_.file("timing.json"), timing);
        say(fmt::format("the page: {}", write_report(folder_.root(), PATENCY_VERSION).string()));
        return code;
    }

    const deck::Case& config_;
    const OutputFolder& folder_;
    Interruption interruption_;
    Log log_ = no_log;
};

ExitCode run(const RunOptions& options) {
    const deck::Case config = options.deck.read();
    const std::string title = options.deck.title(config);
    const OutputFolder folder(options.out);
    if (!config.solids.empty()) return run_solid_stage(config, folder, title, options.fresh);
    const std::vector<std::string> stages = stages_of(config, options.stages);
    return Run(config, folder, title, options.fresh).go(stages);
}

}   // namespace

void add_run_command(const Command& program, ExitCode& exit_code) {
    const Command command = program.add_command("run",
                                                "everything that the deck asks for: the flow, with a stent its "
                                                "deployment and the flow after, and the page; or solids");
    const auto options = std::make_shared<RunOptions>();
    options->deck.add_to(command);
    command.add_option("-o,--out", options->out, "the folder for the results; a run that was interrupted there goes on")
        .required();
    command
        .add_option("--stages", options->stages, "only these of before, deploy and after; what ended earlier is kept")
        .comma_separated();
    command.add_flag("--fresh", options->fresh, "begin anew instead of going on");
    command.when_given([options, &exit_code] { exit_code = run(*options); });
}

}   // namespace patency::app
