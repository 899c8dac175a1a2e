// SPDX-License-Identifier: Apache-2.0
// A folder of results as the page needs it: what is there is read, what is not is left empty. Computes nothing.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "patency/io/csv.h"
#include "patency/io/vtp.h"

namespace patency {

/// A text file that the page offers for download.
struct TextFile {
    std::string name;   ///< relative to the folder, "before/pullback.csv"
    std::string text;
};

/// One flow: of a run before or after the stent, or alone.
struct FlowPart {
    std::string key;      ///< "before", "after", or "flow" of a flow alone
    std::string title;    ///< "Before"
    std::string path;     ///< of its part in summary.json, a JSON pointer: "/before", or empty
    std::string prefix;   ///< of its files: "before/", or empty
    std::string deck;     ///< case.resolved.yaml
    std::vector<TextFile> tables{};
    std::optional<CsvTable> pullback{}, waveforms{};
    std::optional<PolyData> wall{}, cut{}, streamlines{};
};

/// A body while a stent is deployed.
struct DeployedBody {
    std::string name;
    std::vector<double> times;   ///< of the frames [s]
    std::vector<PolyData> frames;
};

struct RunResults {
    std::filesystem::path root;
    std::string name;                                                ///< of the case
    std::shared_ptr<const nlohmann::ordered_json> summary, timing;   ///< timing is null without timing.json
    std::string summary_text;                                        ///< summary.json as it is
    std::vector<FlowPart> flows;
    bool has_deployment = false;   ///< summary.json has a part "deploy"
    std::string deployment_deck{};
    std::vector<DeployedBody> bodies{};

    const nlohmann::ordered_json& part(const FlowPart& flow) const;   ///< of summary.json
};

/// Throws FileError: no summary.json, a damaged file, or results that have no page (solids, verification).
RunResults read_results(const std::filesystem::path& folder);

/// Arcs from the inlet along the line that the stent lies on [mm].
struct StentSpan {
    double start, end;
};
std::optional<StentSpan> stent_span(const nlohmann::ordered_json& summary);

/// Outlets in the order of pullback.csv's numbers (1: the first).
std::vector<std::string> outlet_names(const nlohmann::ordered_json& flow);

/// The lesion of `flow` at the place of another one; none if there is none within its length.
std::optional<std::size_t> find_lesion(const nlohmann::ordered_json& flow, const nlohmann::ordered_json& lesion);

/// The lesion of a flow that lowers FFR most, or the tightest one without an aortic pressure.
std::optional<std::size_t> worst_lesion(const nlohmann::ordered_json& flow);

}   // namespace patency
