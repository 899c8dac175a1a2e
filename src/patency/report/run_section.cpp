// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "patency/io/encode.h"
#include "patency/report/figures.h"
#include "patency/report/sections.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

/// Hashes of what went in, as the run noted them.
std::string origin_rows(const Json& part, const std::string& title) {
    if (!part.contains("made_from")) return {};
    std::string rows;
    const Json& from = part["made_from"];
    const auto add = [&](const std::string& what, const Json& hash) {
        if (hash.is_string())
            rows += table_row({escaped(title + what), "<code>" + escaped(hash.get<std::string>()) + "</code>"});
    };
    if (from.contains("inputs") && from["inputs"].is_object())
        for (const auto& [name, hash] : from["inputs"].items()) add(name, hash);
    if (from.contains("deck")) add("the deck, resolved", from["deck"]);
    if (from.contains("program")) add("the program", from["program"]);
    return rows;
}

/// Seconds of every stage; they stand in timing.json, for they are no result.
void add_times(std::string& rows, const Figures& times, const Json& part, const std::string& path,
               const std::string& name) {
    if (part.contains("wall_s"))
        rows += table_row({escaped(name.empty() ? "run" : name), times.number(path + "/wall_s", {"s", 1, 1}),
                           times.number(path + "/cpu_s", {"s", 1, 1})});
    for (const auto& [key, value] : part.items())
        if (value.is_object()) add_times(rows, times, value, path + step(key), name.empty() ? key : name + ", " + key);
}

std::string times_table(const RunResults& results) {
    if (!results.timing) return {};
    std::string rows;
    add_times(rows, Figures(*results.timing), *results.timing, "", "");
    return rows.empty() ? ""
                        : "<div data-source=\"timing\">" +
                              table("Time on this machine", {"Stage", "Wall, s", "CPU, s"}, rows) + "</div>\n";
}

}   // namespace

std::string run_section(const RunResults& results) {
    std::string origin, decks, files;
    for (const FlowPart& flow : results.flows)
        origin += origin_rows(results.part(flow), results.flows.size() > 1 ? flow.title + ": " : "");
    for (const FlowPart& flow : results.flows) {
        const bool is_again = &flow != &results.flows.front() && flow.deck == results.flows.front().deck;
        if (!flow.deck.empty() && !is_again)
            decks += fmt::format(
                "<details class=\"deck\"><summary>Deck{}, with all defaults</summary><pre>{}</pre></details>\n",
                results.flows.size() > 1 ? " (" + flow.title + ")" : "", escaped(flow.deck));
        for (const TextFile& file : flow.tables)
            files += fmt::format("<li><a class=\"needs-script\" download=\"{0}\" data-file=\"{1}\">{1}</a></li>",
                                 escaped(file.name.substr(file.name.rfind('/') + 1)), escaped(file.name));
    }
    files =
        fmt::format("<li><a download=\"summary.json\" href=\"data:application/json;base64,{}\">summary.json</a></li>",
                    base64(results.summary_text)) +
        files;
    if (!results.deployment_deck.empty() && results.flows.empty())
        decks +=
            fmt::format("<details class=\"deck\"><summary>Deck, with all defaults</summary><pre>{}</pre></details>\n",
                        escaped(results.deployment_deck));
    if (!origin.empty()) origin = table("What this was made from (XXH64)", {"File", "Hash"}, origin);
    return "<section id=\"run\">\n<h2>This run</h2>\n<div class=\"downloads\"><h3>Files</h3><ul>" + files +
           "</ul></div>\n" + "<div class=\"small-tables\">" + times_table(results) + origin + "</div>\n" + decks +
           "</section>\n";
}

}   // namespace patency
