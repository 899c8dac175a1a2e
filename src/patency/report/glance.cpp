// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/analysis/stent_metrics.h"
#include "patency/report/figures.h"
#include "patency/report/sections.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;
using Pointers = std::vector<std::optional<std::string>>;

Pointers with_key(const Focus& focus, const std::string& key) {
    Pointers pointers = focus.in_flow;
    for (auto& pointer : pointers)
        if (pointer) *pointer += key;
    return pointers;
}

/// The same; where the last flow has no such number of the lesion, the deployment's of the lumen.
Pointers or_of_lumen(const RunResults& results, Pointers pointers, const std::string& key) {
    const Figures figures(*results.summary);
    if (pointers.size() > 1 && !(pointers.back() && figures.has(*pointers.back())) &&
        figures.has("/deploy/lumen" + key))
        pointers.back() = "/deploy/lumen" + key;
    return pointers;
}

std::string card(const std::string& label, const std::string& figure, const std::string& more, const char* style = "") {
    return fmt::format("<article class=\"card {}\"><h3>{}</h3><p class=\"figure\">{}</p>{}</article>\n", style, label,
                       figure, more);
}

std::string note(const std::string& text) { return text.empty() ? text : "<p class=\"note\">" + text + "</p>"; }

/// The estimate's band of FFR behind the lesion for each flow, as pointers; empty without one.
std::vector<std::string> ffr_bands(const RunResults& results, const Focus& focus) {
    std::vector<std::string> bands(results.flows.size());
    const Json& summary = *results.summary;
    if (!summary.contains("estimate")) return bands;
    const auto k = find_lesion(summary["estimate"], summary.at(Json::json_pointer(focus.lesion)));
    if (!k) return bands;
    const Figures figures(summary);
    for (std::size_t n = 0; n < bands.size(); ++n) {
        const std::string band =
            (results.flows[n].key == "after" ? "/estimate_after/at_lesions" : "/estimate/lesions") + step(*k) +
            "/ffr_band";
        if (figures.has(band + "/0") && figures.has(band + "/1")) bands[n] = band;
    }
    return bands;
}

/// FFR on a scale from 0.5 to 1, the same in every report: bands, a mark for every flow, and how uncertain it is: before above the scale,
/// after below.
std::string ffr_scale(const RunResults& results, const Pointers& pointers, const std::vector<std::string>& bands) {
    constexpr double low = 0.5, width = 300, left = 10;
    const Figures figures(*results.summary);
    const auto x = [&](double ffr) { return left + (std::min(std::max(ffr, low), 1.0) - low) / (1 - low) * width; };
    std::string svg =
        "<svg class=\"ffr-scale\" viewBox=\"-4 0 328 66\" role=\"img\" aria-label=\"FFR on a scale from 0.5 to 1\">";
    for (const auto& [from, to, style] : {std::tuple{0.5, 0.75, "low"}, {0.75, 0.8, "grey"}, {0.8, 1.0, "high"}})
        svg += fmt::format("<rect class=\"band {}\" x=\"{:.1f}\" y=\"22\" width=\"{:.1f}\" height=\"10\"/>", style,
                           x(from), x(to) - x(from));
    for (const double tick : {0.5, 0.6, 0.7, 0.8, 0.9, 1.0})
        svg += fmt::format(
            "<path class=\"tick\" d=\"M{0:.1f} 32 v16\"/><text x=\"{0:.1f}\" y=\"60\" "
            "text-anchor=\"middle\">{1:.2f}</text>",
            x(tick), tick);
    for (std::size_t k = 0; k < bands.size(); ++k)
        if (!bands[k].empty())
            svg += fmt::format(
                "<path class=\"whisker {0}\" d=\"M{1:.1f} {3} v-6 M{1:.1f} {4} H{2:.1f} M{2:.1f} {3} v-6\"/>",
                results.flows[k].key, x(figures.value(bands[k] + "/0")), x(figures.value(bands[k] + "/1")),
                results.flows[k].key == "after" ? 49 : 8, results.flows[k].key == "after" ? 46 : 5);
    for (std::size_t k = 0; k < pointers.size(); ++k)
        if (pointers[k] && figures.has(*pointers[k]))
            svg += fmt::format("<path class=\"mark {}\" d=\"M{:.1f} {}\"/>", results.flows[k].key,
                               x(figures.value(*pointers[k])),
                               results.flows[k].key == "after" ? "30 l-6 14 h12 z"
                                                               : "25 l-6 -14 h12 z");   // above the bar, and below it
    return svg + "</svg>";
}

/// What the number is usually taken for; a band, no verdict.                    conventions: Norgaard et al. 2019; FFR-SEARCH 2021
std::string ffr_words(double ffr, bool is_after) {
    if (std::isnan(ffr)) return {};
    if (is_after)
        return ffr >= 0.9  ? "after: at least 0.90, the usual aim"
               : ffr > 0.8 ? "after: below 0.90, the usual aim"
                           : "after: still at most 0.80";
    return ffr > 0.8    ? "above 0.80: not taken as flow-limiting"
           : ffr > 0.75 ? "0.76 to 0.80: the grey zone"
                        : "at most 0.75: taken as flow-limiting";
}

std::string ffr_card(const RunResults& results, const Focus& focus) {
    const Figures figures(*results.summary);
    const Pointers pointers = with_key(focus, "/ffr");
    const bool has_ffr =
        std::any_of(pointers.begin(), pointers.end(), [&](const auto& p) { return p && figures.has(*p); });
    if (!has_ffr) {
        const std::string reason =
            results.flows.empty() ? "" : figures.text(results.flows.front().path + "/ffr/reason");
        return card("FFR", "<span class=\"none\">–</span>", note(reason.empty() ? "" : "No FFR: " + reason + "."),
                    "wide");
    }
    std::string words;
    const std::vector<std::string> bands = ffr_bands(results, focus);
    for (std::size_t k = 0; k < pointers.size(); ++k) {
        const std::string here =
            pointers[k] ? ffr_words(figures.value(*pointers[k]), results.flows[k].key == "after") : "";
        words += here.empty() || words.empty() ? here : "; " + here;
    }
    std::string more = ffr_scale(results, pointers, bands) + note(words), ranges;
    for (std::size_t k = 0; k < bands.size(); ++k)
        if (!bands[k].empty())
            ranges += fmt::format("{}{}{} to {}", ranges.empty() ? "" : ", ",
                                  results.flows[k].key == "flow" ? "" : results.flows[k].key + " ",
                                  figures.number(bands[k] + "/0", as_ratio), figures.number(bands[k] + "/1", as_ratio));
    if (!ranges.empty())
        more += note(fmt::format("The estimate for an uncertain flow, diameter and split: {}.", ranges));
    return card("FFR behind the lesion", change(results, pointers, {"", 1, 2}), more, "wide");
}

/// A number of the deployment; some have a criterion, most have none that is agreed on.
struct StentFact {
    const char *pointer, *label;   ///< within the part "deploy"
    bool (*is_met)(double) = nullptr;
    const char *met = "", *missed = "";
};
// Expansion: ILUMIEN III's rule against the reference. A gap from 0.4 mm on: EAPCI's consensus on intracoronary imaging (2018).
// Kinetic to internal energy: the usual bar of a deployment that is slow enough. For the others no number is agreed on.
constexpr StentFact stent_facts[] = {
    {"/minimum_diameter_mm", "Minimum diameter"},
    {"/minimum_stent_area_mm2", "Minimum stent area"},
    {"/expansion_index", "Expansion", [](double v) { return v >= 0.9; }, "at least 0.9 of the reference area",
     "below 0.9 of the reference area"},
    {"/opened_over_wanted", "Opened over wanted diameter", [](double v) { return v >= least_opened; },
     "as wide as wanted", "not as wide as wanted"},
    {"/lumen/residual_stenosis_percent", "Residual stenosis"},
    {"/malapposed_percent", "Struts off the wall"},
    {"/largest_gap_mm", "Largest gap", [](double v) { return v < 0.4; }, "below 0.4 mm", "0.4 mm or more"},
    {"/recoil_percent", "Acute recoil"},
    {"/foreshortening_percent", "Foreshortening"},
    {"/dogboning_percent", "Dogboning"},
    {"/penetration_over_spacing", "Overlap over spacing", [](double v) { return v < 0.1; }, "metal and wall keep apart",
     "metal sinks into the wall"},
    {"/kinetic_to_internal", "Kinetic over internal energy", [](double v) { return v < most_kinetic_to_internal; },
     "deployed slowly enough", "deployed too fast to be trusted"},
    {"/drift_percent", "Last change of diameter", [](double v) { return v < most_drift_percent; }, "it came to rest",
     "it was still moving"},
};

std::string stent_card(const RunResults& results) {
    if (!results.has_deployment) return {};
    const Figures figures(*results.summary);
    std::string items;
    for (const StentFact& fact : stent_facts) {
        const std::string pointer = std::string("/deploy") + fact.pointer;
        if (!figures.has(pointer)) continue;
        const bool is_met = fact.is_met && fact.is_met(figures.value(pointer));
        const std::string verdict = fact.is_met ? fmt::format("<span class=\"verdict {}\">{}</span>",
                                                              is_met ? "good" : "look", is_met ? fact.met : fact.missed)
                                                : "";
        items += fmt::format("<li><span class=\"what\">{}</span> <b>{}</b> {}</li>", fact.label,
                             figures.with_unit(pointer, measure_of(fact.pointer)), verdict);
    }
    return "<article class=\"card wide stent\"><h3>Stent</h3><ul class=\"facts\">" + items + "</ul>" +
           note(figures.text("/deploy/note")) + "</article>\n";
}

std::string lead(const RunResults& results, const Focus& focus) {
    const Figures f(*results.summary);
    if (focus.lesion.empty()) {
        if (results.flows.empty())
            return "<p class=\"lead\">A stent was opened in the vessel; no flow was computed.</p>";
        const bool has_vessel = results.part(results.flows.front()).contains("lesions");
        return has_vessel ? "<p class=\"lead\">No lesion was found in this vessel.</p>"
                          : "<p class=\"lead\">A flow without a vessel: openings and waveforms only.</p>";
    }
    return fmt::format(
        "<p class=\"lead\">Lesion in <b>{}</b>, {} from the inlet, {} long; the lumen narrows to {}.</p>\n",
        f.text(focus.lesion + "/branch"), f.with_unit(focus.lesion + "/throat_arc_mm", as_mm),
        f.with_unit(focus.lesion + "/length_mm", as_mm), f.with_unit(focus.lesion + "/minimum_diameter_mm", as_mm));
}

}   // namespace

Focus focus_of(const RunResults& results) {
    Focus focus{.lesion = {}, .in_flow = std::vector<std::optional<std::string>>(results.flows.size())};
    if (results.flows.empty()) return focus;
    const Json& first = results.part(results.flows.front());
    const auto worst = worst_lesion(first);
    if (!worst) return focus;
    for (std::size_t k = 0; k < results.flows.size(); ++k)
        if (const auto found = find_lesion(results.part(results.flows[k]), first["lesions"][*worst]))
            focus.in_flow[k] = results.flows[k].path + "/lesions" + step(*found);
        else if (const Json& part = results.part(results.flows[k]);
                 part.contains("at_lesions") && *worst < part["at_lesions"].size())
            focus.in_flow[k] =
                results.flows[k].path + "/at_lesions" + step(*worst);   // the lesion is gone; this is where it was
    focus.lesion = *focus.in_flow.front();
    return focus;
}

std::string change(const RunResults& results, const Pointers& pointers, const Measure& measure) {
    const Figures figures(*results.summary);
    std::string text;
    for (std::size_t k = 0; k < pointers.size(); ++k)
        text += fmt::format("{}<span class=\"{}\">{}</span>", k ? "<span class=\"arrow\"> → </span>" : "",
                            results.flows[k].key, figures.number(pointers[k].value_or("/none"), measure));
    return text + (measure.unit.empty() ? "" : fmt::format("<span class=\"unit\"> {}</span>", measure.unit));
}

std::string glance_section(const RunResults& results) {
    const Focus focus = focus_of(results);
    std::string cards;
    if (!focus.lesion.empty()) {
        cards += ffr_card(results, focus);
        cards += card("Pressure drop", change(results, with_key(focus, "/drop_pa"), as_mmHg),
                      note("from the lesion's start to where FFR is read"));
        cards +=
            card("Minimum lumen",
                 change(results, or_of_lumen(results, with_key(focus, "/minimum_diameter_mm"), "/minimum_diameter_mm"),
                        as_mm),
                 note("diameter of the largest sphere that fits"));
        cards += card(
            "Diameter stenosis",
            change(results,
                   or_of_lumen(results, with_key(focus, "/diameter_stenosis_percent"), "/residual_stenosis_percent"),
                   as_percent),
            note("against the lumen on both sides"));
        cards += card("Flow through it", change(results, with_key(focus, "/flow_m3_per_s"), as_mL_per_min), "");
        const bool is_gone = results.flows.size() > 1 && !focus.in_flow.back();
        if (is_gone)
            cards += card("After", "no lesion",
                          note("The lumen no longer narrows by a quarter there, so there is no place behind a lesion "
                               "to read FFR at; the table of branches has the FFR at each branch's end."),
                          "wide stent");
    }
    cards += stent_card(results);
    return "<section id=\"glance\">\n" + lead(results, focus) +
           (cards.empty() ? "" : "<div class=\"cards\">\n" + cards + "</div>\n") + quality_strip(results) +
           "</section>\n";
}

}   // namespace patency
