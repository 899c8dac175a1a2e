// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/opening_names.h"

#include "patency/shape/network_lumen.h"
#include "patency/stages/lumen_of_case.h"

namespace patency {

std::optional<std::vector<std::string>> find_opening_names(const deck::Case& config) {
    const deck::Geometry& g = config.geometry;
    std::vector<std::string> names;
    try {
        if (g.shape) {
            for (const Opening& o : make_lumen_of_shape(config).openings) names.push_back(o.name);
        } else if (g.network) {
            for (const Opening& o : openings_of(read_network_of(config), 0)) names.push_back(o.name);
        } else {
            deck::Case whole = config;
            whole.geometry.cut_back.clear();   // openings keep their names
            for (const SurfaceOpening& o : open_vessel(whole).openings) names.push_back(o.opening.name);
        }
    } catch (const std::exception&) {
        return {};
    }
    return names;
}

}   // namespace patency
