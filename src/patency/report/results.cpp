// SPDX-License-Identifier: Apache-2.0
#include "patency/report/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/io/atomic_file.h"
#include "patency/io/polydata_file.h"
#include "patency/io/pvd.h"
#include "patency/io/summary.h"

namespace patency {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_frames =
    10;   // of the deployment: enough to see it move; more made the page of a real coronary tree larger than 5 MB

std::string text_or_empty(const fs::path& path) { return fs::exists(path) ? read_file(path) : std::string(); }

std::optional<PolyData> polydata_if_there(const fs::path& path) {
    if (!fs::exists(path)) return {};
    return read_polydata(path);
}

FlowPart read_flow(const fs::path& root, const std::string& key, const std::string& title) {
    const bool is_alone = key == "flow";
    FlowPart flow{
        .key = key, .title = title, .path = is_alone ? "" : "/" + key, .prefix = is_alone ? "" : key + "/", .deck = {}};
    const fs::path folder = root / flow.prefix;
    flow.deck = text_or_empty(folder / "case.resolved.yaml");
    for (const char* name : {"pullback.csv", "sections.csv", "waveforms.csv"})
        if (fs::exists(folder / name)) flow.tables.push_back({flow.prefix + name, read_file(folder / name)});
    if (fs::exists(folder / "pullback.csv")) flow.pullback = read_csv(folder / "pullback.csv");
    if (fs::exists(folder / "waveforms.csv")) flow.waveforms = read_csv(folder / "waveforms.csv");
    flow.wall = polydata_if_there(folder / "wall.vtp");
    flow.cut = polydata_if_there(folder / "cut.vtp");
    flow.streamlines = polydata_if_there(folder / "streamlines.vtp");
    return flow;
}

/// The first, the last, and those evenly between them.
std::vector<PvdFrame> chosen(const std::vector<PvdFrame>& frames) {
    const std::size_t count = std::min(frames.size(), most_frames);
    std::vector<PvdFrame> result;
    for (std::size_t k = 0; k < count; ++k)
        result.push_back(frames[count > 1 ? k * (frames.size() - 1) / (count - 1) : 0]);
    return result;
}

std::vector<DeployedBody> read_bodies(const fs::path& folder) {
    std::vector<fs::path> series;
    if (fs::is_directory(folder))
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ".pvd") series.push_back(entry.path());
    std::sort(series.begin(), series.end());   // the order of a folder is none
    std::vector<DeployedBody> bodies;
    for (const fs::path& path : series) {
        DeployedBody body{path.stem().string(), {}, {}};
        for (const PvdFrame& frame : chosen(read_pvd(path))) {
            body.times.push_back(frame.time);
            body.frames.push_back(read_polydata(folder / frame.file));
        }
        if (!body.frames.empty()) bodies.push_back(std::move(body));
    }
    // A stent that was opened without mechanics has one shape and no series.
    if (bodies.empty())
        for (const char* name : {"stent", "lumen_after"})
            if (const fs::path path = folder / fmt::format("{}.vtp", name); fs::exists(path))
                bodies.push_back({name, {0}, {read_polydata(path)}});
    return bodies;
}

}   // namespace

const Json& RunResults::part(const FlowPart& flow) const { return summary->at(Json::json_pointer(flow.path)); }

RunResults read_results(const fs::path& folder) {
    const auto summary = std::make_shared<const Json>(read_summary(folder / "summary.json"));
    RunResults results{.root = folder,
                       .name = {},
                       .summary = summary,
                       .timing = {},
                       .summary_text = read_file(folder / "summary.json"),
                       .flows = {}};
    if (fs::exists(folder / "timing.json"))
        results.timing = std::make_shared<const Json>(read_summary(folder / "timing.json"));
    const auto has = [&](const char* key) {
        return summary->is_object() && summary->contains(key) && summary->at(key).is_object();
    };
    if (has("before")) results.flows.push_back(read_flow(folder, "before", "Before"));
    if (has("after")) results.flows.push_back(read_flow(folder, "after", "After"));
    if (results.flows.empty() && has("openings")) results.flows.push_back(read_flow(folder, "flow", "Flow"));
    results.has_deployment = has("deploy");
    if (results.flows.empty() && !results.has_deployment)
        throw FileError(
            fmt::format("'{}' holds no flow and no deployment, so there is no page to make. Give the OUT of patency "
                        "flow or patency run.",
                        folder.string()));
    if (results.has_deployment) {
        const fs::path deployment =
            fs::is_directory(folder / "deploy") ? folder / "deploy" : folder;   // patency deploy writes into OUT itself
        results.bodies = read_bodies(deployment);
        results.deployment_deck = text_or_empty(deployment / "case.resolved.yaml");
    }
    results.name = summary->value("name", folder.filename().string());
    return results;
}

std::optional<StentSpan> stent_span(const Json& summary) {
    if (!summary.contains("deploy") || !summary["deploy"].contains("arc_length_mm") ||
        !summary["deploy"].contains("length_mm"))
        return {};
    const Json &middle = summary["deploy"]["arc_length_mm"], &length = summary["deploy"]["length_mm"];
    if (!middle.is_number() || !length.is_number()) return {};
    return StentSpan{middle.get<double>() - 0.5 * length.get<double>(),
                     middle.get<double>() + 0.5 * length.get<double>()};
}

std::vector<std::string> outlet_names(const Json& flow) {
    std::vector<std::string> names;
    if (flow.contains("openings"))
        for (const auto& [name, opening] : flow["openings"].items())
            if (name != "inlet") names.push_back(name);
    return names;
}

std::optional<std::size_t> find_lesion(const Json& flow, const Json& lesion) {
    const Json none = Json::array();
    const Json& lesions = flow.contains("lesions") ? flow["lesions"] : none;
    for (std::size_t k = 0; k < lesions.size(); ++k) {
        const double apart = std::abs(lesions[k].value("throat_arc_mm", 0.0) - lesion.value("throat_arc_mm", 0.0));
        if (lesions[k].value("branch", "") == lesion.value("branch", "") && apart <= lesion.value("length_mm", 10.0))
            return k;
    }
    return {};
}

std::optional<std::size_t> worst_lesion(const Json& flow) {
    std::optional<std::size_t> worst;
    double least = INFINITY;
    if (!flow.contains("lesions")) return worst;
    for (std::size_t k = 0; k < flow["lesions"].size(); ++k) {
        const Json& lesion = flow["lesions"][k];
        const bool has_ffr = lesion.contains("ffr") && lesion["ffr"].is_number();
        const double badness =
            has_ffr ? lesion["ffr"].get<double>() : 1e3 - lesion.value("diameter_stenosis_percent", 0.0);
        if (badness < least) least = badness, worst = k;
    }
    return worst;
}

}   // namespace patency
