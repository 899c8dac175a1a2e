// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/estimate_results.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "patency/stages/outlet_summary.h"

namespace patency {

using Json = nlohmann::ordered_json;

namespace {

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }
Json band_of(const Band& band) { return {band.low, band.high}; }

Json opening_summary(const Estimate& e, std::size_t k, const std::optional<EstimateBand>& band, double area) {
    Json opening{{"flow_m3_per_s", e.opening_flows[k]},
                 {"mean_pressure_pa", e.opening_pressures[k]},
                 {"mean_velocity_m_per_s", e.opening_flows[k] / area},
                 {"area_m2", area}};
    add_outlet(opening, e.outlets[k]);
    if (band) opening["flow_band_m3_per_s"] = band_of(band->opening_flows[k]);
    return opening;
}

Json lesion_summary(const VesselAlong& along, const Estimate& e, std::size_t k,
                    const std::optional<EstimateBand>& band) {
    const EstimatedLesion& l = e.lesions[k];
    const Lesion& lesion = along.assessment.lesions[l.number];
    Json result{{"branch", along.lines.branches[lesion.branch].name},
                {"throat_arc_mm", 1e3 * lesion.throat_arc},
                {"diameter_stenosis_percent", 100 * lesion.diameter_stenosis},
                {"minimum_diameter_mm", 1e3 * lesion.minimum_diameter},
                {"flow_m3_per_s", l.flow},
                {"drop_pa", l.drop},
                {"read_arc_mm", 1e3 * l.read_arc},
                {"ffr", or_null(l.ffr)}};
    if (band && l.ffr) result["ffr_band"] = band_of(band->lesion_ffr[k]);
    return result;
}

}   // namespace

Json estimate_summary(const deck::Case& config, const Vessel& vessel, const Estimate& e,
                      const std::optional<EstimateBand>& band) {
    const VesselAlong& along = vessel.along.value();
    Json summary{{"name", config.about.name},
                 {"method", "estimate"},
                 {"pressure_datum", e.aortic_pressure ? "absolute" : "gauge"}};
    Json openings = Json::object(), branches = Json::array(), lesions = Json::array();
    for (std::size_t k = 0; k < vessel.openings.size(); ++k)
        openings[vessel.openings[k].opening.name] = opening_summary(e, k, band, vessel.openings[k].opening.area);
    for (std::size_t b = 0; b < e.tree.branches.size(); ++b) {
        const auto& pressure = e.flow.pressure[b];
        branches.push_back({{"name", e.tree.branches[b].name},
                            {"flow_m3_per_s", e.flow.flow[b]},
                            {"pressure_begin_pa", pressure.front()},
                            {"pressure_end_pa", pressure.back()},
                            {"ffr_end", or_null(e.ffr(b, pressure.size() - 1))}});
    }
    for (std::size_t k = 0; k < e.lesions.size(); ++k) lesions.push_back(lesion_summary(along, e, k, band));
    std::optional<double> worst;
    for (const EstimatedLesion& l : e.lesions)
        if (l.ffr) worst = std::min(worst.value_or(*l.ffr), *l.ffr);
    summary["openings"] = openings;
    summary["branches"] = branches;
    summary["lesions"] = lesions;
    summary["ffr"] = {{"lesion", or_null(worst)}};
    if (!worst)
        summary["ffr"]["reason"] = e.aortic_pressure ? "no lesion was found" : "the deck gives no aortic pressure";
    return summary;
}

Json estimate_after_summary(const deck::Case& before, const Vessel& vessel_before, const deck::Case& after,
                            const Vessel& vessel_after) {
    const VesselAlong& along = vessel_before.along.value();
    const Estimate estimate_before = estimate_flow(before, vessel_before),
                   estimate = estimate_flow(after, vessel_after);
    const std::vector<Vec3> places = reading_places(estimate_before, along);
    const EstimateBand band = estimate_band(after, vessel_after, places);
    Json summary = estimate_summary(after, vessel_after, estimate, band), at_lesions = Json::array();
    for (std::size_t k = 0; k < places.size(); ++k) {
        const EstimatedLesion& lesion = estimate_before.lesions[k];
        at_lesions.push_back({{"branch", along.lines.branches[along.assessment.lesions[lesion.number].branch].name},
                              {"read_arc_mm", 1e3 * lesion.read_arc},
                              {"ffr", or_null(ffr_near(estimate, *vessel_after.along, places[k]))}});
        if (!band.place_ffr.empty()) at_lesions.back()["ffr_band"] = band_of(band.place_ffr[k]);
    }
    summary["at_lesions"] = at_lesions;
    return summary;
}

Pullback estimate_pullback(const Vessel& vessel, const Estimate& e) {
    Pullback p{{"arc_m", "outlet", "area_m2", "flow_m3_per_s", "pressure_pa"}, {}};
    if (e.aortic_pressure) p.columns.push_back("ffr");
    const auto& lines = vessel.along.value().lines;
    for (std::size_t line = 0; line < lines.lines.size(); ++line) {
        const auto first = std::ptrdiff_t(p.rows.size());
        for (std::size_t b = 0; b < lines.branches.size(); ++b) {
            const auto& through = lines.branches[b].lines;
            if (std::find(through.begin(), through.end(), line) == through.end()) continue;
            const TreeBranch& branch = e.tree.branches[b];
            for (std::size_t k = 0; k < branch.arc.size(); ++k) {
                p.rows.push_back(
                    {branch.arc[k], double(line + 1), branch.area[k], e.flow.flow[b], e.flow.pressure[b][k]});
                if (e.aortic_pressure) p.rows.back().push_back(*e.ffr(b, k));
            }
        }
        std::sort(p.rows.begin() + first, p.rows.end());
    }
    return p;
}

}   // namespace patency
