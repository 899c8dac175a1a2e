// SPDX-License-Identifier: Apache-2.0
#include "patency/config/opening_names.h"

#include <algorithm>

#include "patency/base/text.h"

namespace patency::deck {

namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// As surfaces call their openings, whose outlets are counted from one on, or as the deck does.
bool is_usual_name(const Case& c, const std::string& name) {
    if (name == "inlet") return true;
    for (const auto& [found, own] : c.geometry.names)
        if (own == name) return true;
    for (std::size_t k = 1; k < c.openings.size(); ++k)
        if (name == "outlet_" + std::to_string(k)) return true;
    return false;
}

}   // namespace

void check_opening_names(const Case& c, const Node& root, const FindOpeningNames& find, Mistakes& mistakes) {
    const Geometry& g = c.geometry;
    const Node* openings = root.find("openings");
    if (!find || !openings || openings->kind != Node::Kind::map || c.openings.empty()) return;
    if (!(g.surface || g.network || g.shape) || mistakes.touch("geometry")) return;
    const bool is_doubtful =
        !g.surface || !mistakes.empty() ||
        !std::all_of(c.openings.begin(), c.openings.end(), [&](const auto& o) { return is_usual_name(c, o.first); });
    const std::optional<std::vector<std::string>> names = is_doubtful ? find(c) : std::nullopt;
    if (!names) return;
    std::vector<std::string> missing, meant;
    for (const std::string& name : *names)
        if (!c.openings.contains(name)) missing.push_back(name);
    const std::string all = names->empty() ? "none" : join(*names, ", ", " and ");
    for (const Node& key : openings->keys) {
        if (!c.openings.contains(key.text) || holds(*names, key.text)) continue;
        std::string nearest = nearest_name(key.text, missing);   // one that is there already was hardly meant
        if (nearest.empty()) nearest = nearest_name(key.text, *names);
        meant.push_back(nearest);
        mistakes.add(
            key.place, "openings." + shortened(key.text),
            "the lumen has no such opening" +
                (nearest.empty() ? "; it has " + all : ". Did you mean " + double_quoted(nearest) + "? It has " + all));
    }
    for (const std::string& name : missing)
        if (!holds(meant, name))
            mistakes.add_missing(openings->place, "openings." + name,
                                 "what happens at this opening; the lumen has " + all);
}

}   // namespace patency::deck
