// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

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
    return fmt::format(
        "<li class=\"{}\"><span class=\"sign\" aria-hidden=\"true\">{}</span><span class=\"what\">{}</span> "
        "<span>{}</span></li>\n",
        styles[int(mark)], signs[int(mark)], what, text);
}

constexpr double most_imbalance = 0.2;   // % in a steady state
constexpr double fewest_across = 8;      // what the flow stage marks as under-resolved

Mark mark_of_mass(const Figures& f, const std::string& path) {
    const std::string pointer = path + "/mass_imbalance_percent";
    return !f.has(pointer) ? Mark::plain : f.value(pointer) < most_imbalance ? Mark::good : Mark::look;
}

Mark mark_of_convergence(const Json& part) {
    return !part.contains("convergence")                      ? Mark::plain
           : part["convergence"].value("is_converged", false) ? Mark::good
                                                              : Mark::look;
}

/// Pointers of the branches and lesions with too few particles across.
std::vector<std::string> coarse_places(const Json& part, const std::string& path) {
    std::vector<std::string> places;
    for (const char* kind : {"branches", "lesions"})
        if (part.contains(kind))
            for (std::size_t k = 0; k < part[kind].size(); ++k)
                if (part[kind][k].value("is_under_resolved", false)) places.push_back(path + "/" + kind + step(k));
    return places;
}

Mark mark_of_resolution(const Figures& f, const Json& part, const std::string& path) {
    const std::string pointer = path + "/particles/across_narrowest";
    if (!f.has(pointer)) return Mark::plain;
    return f.value(pointer) >= fewest_across && coarse_places(part, path).empty() ? Mark::good : Mark::look;
}

std::string mass(const Figures& f, const std::string& path) {
    const std::string pointer = path + "/mass_imbalance_percent";
    if (!f.has(pointer)) return {};
    return item(mark_of_mass(f, path), "Mass balance",
                f.with_unit(pointer, {"%", 1, 3}) + " of the flow is out of balance");
}

/// Whether a flow that has no rest was followed in time.
bool is_mean_over_time(const Json& part) {
    return part.contains("convergence") && part["convergence"].value("is_mean_over_time", false);
}

std::string convergence(const Figures& f, const Json& part, const std::string& path) {
    const Mark mark = mark_of_convergence(part);
    if (mark == Mark::plain) return item(mark, "Convergence", "not watched: the run ended at the deck's duration");
    const std::string verdict = mark == Mark::good ? "settled" : "<b>not settled</b>",
                      change = path + "/convergence/change_percent";
    return item(mark, "Convergence",
                fmt::format("{}; {} last moved by {}", verdict,
                            is_mean_over_time(part) ? "a jet has no rest: means over time at the openings" : "openings",
                            f.with_unit(change, {"%", 1, 3})));
}

std::string resolution(const Figures& f, const Json& part, const std::string& path) {
    const std::string pointer = path + "/particles/across_narrowest";
    if (!f.has(pointer)) return {};
    std::string places;
    for (const std::string& here : coarse_places(part, path)) {
        const std::string name =
            f.has(here + "/drop_pa") ? "lesion in " + f.text(here + "/branch") : f.text(here + "/name");
        places +=
            fmt::format("{}{} ({})", places.empty() ? "" : ", ", name, f.number(here + "/particles_across", as_across));
    }
    return item(mark_of_resolution(f, part, path), "Resolution",
                f.number(pointer, as_across) + " particles across the narrowest place" +
                    (places.empty() ? "" : "; fewer than 8 at: " + places));
}

std::string estimate(const Figures& f, const std::string& lesion) {
    if (lesion.empty() || !f.has(lesion + "/estimated_drop_pa")) return {};
    std::string text = fmt::format("drop {} against {} {}", f.number(lesion + "/drop_pa", as_mmHg),
                                   f.number(lesion + "/estimated_drop_pa", as_mmHg), as_mmHg.unit);
    if (f.has(lesion + "/estimated_ffr"))
        text += fmt::format(", FFR {} against {}", f.number(lesion + "/ffr", as_ratio),
                            f.number(lesion + "/estimated_ffr", as_ratio));
    return item(Mark::plain, "3-D against 1-D", text + " of a tree of tubes");
}

std::string scheme(const Figures& f, const Json& part, const std::string& path) {
    const std::string name = f.text(path + "/scheme");
    const char* in_time = is_mean_over_time(part)
                              ? "flow without rest, followed in time on the cells of still particles"
                              : "periodic flow on the cells of still particles";
    const char* words = name == "cells"
                            ? (f.has(path + "/time_steps") ? in_time : "steady flow on the cells of still particles")
                        : name == "paper" ? "moving particles, as the reference paper does"
                                          : "moving particles";
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
    if (const std::string law = at({"blood", "law"}); !law.empty())
        taken.push_back("blood " + law + (at({"blood", "viscosity"}).empty() ? "" : ", " + at({"blood", "viscosity"})));
    if (const std::string aorta = at({"aorta", "pressure"}); !aorta.empty())
        taken.push_back("aortic pressure " + aorta);
    if (const deck::Node* openings = root.find("openings"))
        for (std::size_t k = 0; k < openings->keys.size(); ++k)
            if (const deck::Node* type = openings->items[k].find("type"))
                taken.push_back(escaped(openings->keys[k].text) + ": " + escaped(type->text));
    if (taken.empty()) return {};
    std::string list;
    for (const std::string& t : taken) list += (list.empty() ? "" : "; ") + t;
    return item(Mark::plain, "Taken as given", list);
}

/// The worse of two.
Mark worse(Mark a, Mark b) {
    return a == Mark::look || b == Mark::look   ? Mark::look
           : a == Mark::good || b == Mark::good ? Mark::good
                                                : Mark::plain;
}

}   // namespace

std::string quality_strip(const RunResults& results) {
    const Figures figures(*results.summary);
    Mark mass = Mark::plain, convergence = Mark::plain, resolution = Mark::plain;
    for (const FlowPart& flow : results.flows) {
        mass = worse(mass, mark_of_mass(figures, flow.path));
        convergence = worse(convergence, mark_of_convergence(results.part(flow)));
        resolution = worse(resolution, mark_of_resolution(figures, results.part(flow), flow.path));
    }
    const auto entry = [](Mark mark, const char* good, const char* look) {
        return mark == Mark::plain
                   ? ""
                   : fmt::format("<li class=\"{}\"><span class=\"sign\" aria-hidden=\"true\">{}</span>{}</li>",
                                 mark == Mark::good ? "good" : "look", mark == Mark::good ? "✓" : "!",
                                 mark == Mark::good ? good : look);
    };
    const std::string items = entry(mass, "mass is in balance", "mass is out of balance") +
                              entry(convergence, "the flow has settled", "the flow has not settled") +
                              entry(resolution, "fine enough everywhere", "some places are under-resolved");
    return items.empty() ? ""
                         : "<ul class=\"strip-of-checks\">" + items +
                               "<li><a href=\"#quality\">How far to trust it</a></li></ul>\n";
}

std::string quality_section(const RunResults& results) {
    const Figures figures(*results.summary);
    const Focus focus = focus_of(results);
    std::string columns;
    for (std::size_t k = 0; k < results.flows.size(); ++k) {
        const FlowPart& flow = results.flows[k];
        const Json& part = results.part(flow);
        const std::string items = mass(figures, flow.path) + convergence(figures, part, flow.path) +
                                  resolution(figures, part, flow.path) +
                                  estimate(figures, focus.in_flow[k].value_or("")) + scheme(figures, part, flow.path) +
                                  (k == 0 ? assumptions(flow.deck) : "");
        columns += fmt::format("<div>{}<ul class=\"checks\">{}</ul></div>\n",
                               results.flows.size() > 1 ? "<h3>" + flow.title + "</h3>" : "", items);
    }
    return columns.empty() ? ""
                           : "<section id=\"quality\">\n<h2>How far to trust it</h2>\n<div class=\"columns\">" +
                                 columns + "</div>\n</section>\n";
}

}   // namespace patency
