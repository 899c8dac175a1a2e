// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "patency/config/document.h"
#include "patency/report/figures.h"
#include "patency/report/sections.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

enum class Mark { good, look, plain };

std::string item(Mark mark, const std::string& what, const std::string& text) {
    constexpr const char* styles[] = {"good", "look", "plain"};
    constexpr const char* signs[] = {"✓", "!", "·"};
    return fmt::format("<li class=\"{}\"><span class=\"sign\" aria-hidden=\"true\">{}</span><span class=\"what\">{}</span> <span>{}</span></li>\n",
                       styles[int(mark)], signs[int(mark)], what, text);
}

std::string mass(const Figures& f, const std::string& path) {
    constexpr double bar = 0.2;   // % in a steady state
    const std::string pointer = path + "/mass_imbalance_percent";
    if (!f.has(pointer)) return {};
    return item(f.value(pointer) < bar ? Mark::good : Mark::look, "Mass balance", f.with_unit(pointer, {"%", 1, 3}) + " of the flow is out of balance");
}

std::string convergence(const Figures& f, const Json& part, const std::string& path) {
    if (!part.contains("convergence")) return item(Mark::plain, "Convergence", "not watched: the run ended at the deck's duration");
    const bool is_settled = part["convergence"].value("is_converged", false);
    return item(is_settled ? Mark::good : Mark::look, "Convergence",
                fmt::format("{}; openings last moved by {}", is_settled ? "settled" : "<b>not settled</b>", f.with_unit(path + "/convergence/change_percent", {"%", 1, 3})));
}

std::string resolution(const Figures& f, const Json& part, const std::string& path) {
    constexpr double fewest = 8;   // what the flow stage marks as under-resolved
    const std::string pointer = path + "/particles/across_narrowest";
    if (!f.has(pointer)) return {};
    std::string places;
    for (const char* kind : {"branches", "lesions"})
        if (part.contains(kind))
            for (std::size_t k = 0; k < part[kind].size(); ++k)
                if (part[kind][k].value("is_under_resolved", false)) {
                    const std::string here = path + "/" + kind + step(k);
                    const std::string name = std::string_view(kind) == "lesions" ? "lesion in " + f.text(here + "/branch") : f.text(here + "/name");
                    places += fmt::format("{}{} ({})", places.empty() ? "" : ", ", name, f.number(here + "/particles_across", as_across));
                }
    const bool is_fine = f.value(pointer) >= fewest && places.empty();
    return item(is_fine ? Mark::good : Mark::look, "Resolution",
                f.number(pointer, as_across) + " particles across the narrowest place" + (places.empty() ? "" : "; fewer than 8 at: " + places));
}

std::string estimate(const Figures& f, const std::string& lesion) {
    if (lesion.empty() || !f.has(lesion + "/estimated_drop_pa")) return {};
    std::string text = fmt::format("drop {} against {} {}", f.number(lesion + "/drop_pa", as_mmHg), f.number(lesion + "/estimated_drop_pa", as_mmHg), as_mmHg.unit);
    if (f.has(lesion + "/estimated_ffr")) text += fmt::format(", FFR {} against {}", f.number(lesion + "/ffr", as_ratio), f.number(lesion + "/estimated_ffr", as_ratio));
    return item(Mark::plain, "3-D against 1-D", text + " of a tree of tubes");
}

std::string scheme(const Figures& f, const std::string& path) {
    const std::string name = f.text(path + "/scheme");
    const char* words = name == "cells" ? "steady flow on the cells of still particles" : name == "paper" ? "moving particles, as the reference paper does" : "moving particles";
    return name.empty() ? "" : item(Mark::plain, "Method", words);
}

/// What the deck took as given, in words.
std::string assumptions(const std::string& text) {
    if (text.empty()) return {};
    deck::Mistakes mistakes;
    const deck::Node root = deck::parse_yaml(text, "case.resolved.yaml", mistakes);
    const auto at = [&](std::initializer_list<const char*> keys) -> std::string {
        const deck::Node* node = &root;
        for (const char* key : keys)
            if (node) node = node->find(key);
        return node ? escaped(node->text) : "";
    };
    std::vector<std::string> taken;
    if (const std::string motion = at({"wall", "motion"}); !motion.empty()) taken.push_back(motion + " wall");
    if (const std::string law = at({"blood", "law"}); !law.empty()) taken.push_back("blood " + law + (at({"blood", "viscosity"}).empty() ? "" : ", " + at({"blood", "viscosity"})));
    if (const std::string aorta = at({"aorta", "pressure"}); !aorta.empty()) taken.push_back("aortic pressure " + aorta);
    if (const deck::Node* openings = root.find("openings"))
        for (std::size_t k = 0; k < openings->keys.size(); ++k)
            if (const deck::Node* type = openings->items[k].find("type")) taken.push_back(escaped(openings->keys[k].text) + ": " + escaped(type->text));
    if (taken.empty()) return {};
    std::string list;
    for (const std::string& t : taken) list += (list.empty() ? "" : "; ") + t;
    return item(Mark::plain, "Taken as given", list);
}

}   // namespace

std::string quality_section(const Results& results) {
    const Figures figures(results.summary);
    const Focus focus = focus_of(results);
    std::string columns;
    for (std::size_t k = 0; k < results.flows.size(); ++k) {
        const FlowPart& flow = results.flows[k];
        const Json& part = results.part(flow);
        const std::string items = mass(figures, flow.path) + convergence(figures, part, flow.path) + resolution(figures, part, flow.path) +
                                  estimate(figures, focus.in_flow[k].value_or("")) + scheme(figures, flow.path) + (k == 0 ? assumptions(flow.deck) : "");
        columns += fmt::format("<div>{}<ul class=\"checks\">{}</ul></div>\n", results.flows.size() > 1 ? "<h3>" + flow.title + "</h3>" : "", items);
    }
    return columns.empty() ? "" : "<section id=\"quality\">\n<h2>How far to trust it</h2>\n<div class=\"columns\">" + columns + "</div>\n</section>\n";
}

}   // namespace patency
