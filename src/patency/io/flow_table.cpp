// SPDX-License-Identifier: Apache-2.0
#include "patency/io/flow_table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "patency/base/units.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

double mL_per_min(const Json& flow) { return in_unit(flow.get<double>(), "mL/min"); }
double mmHg(const Json& pressure) { return in_unit(pressure.get<double>(), "mmHg"); }

std::string shown(const Json& json, const char* key, int digits) {
    return json.contains(key) && json[key].is_number() ? fmt::format("{:.{}f}", json[key].get<double>(), digits) : "-";
}

std::string mark(const Json& json) { return json.value("is_under_resolved", false) ? "  under-resolved" : ""; }

}   // namespace

std::string flow_table(const Json& summary) {
    std::string text;
    if (summary.contains("openings") && !summary.value("planar", false)) {
        text += fmt::format("{:<18} {:>12} {:>14} {:>14}\n", "opening", "flow mL/min", "pressure mmHg", "velocity m/s");
        for (const auto& [name, o] : summary["openings"].items())
            text += fmt::format("{:<18} {:>12.2f} {:>14.3f} {:>14.4f}\n", name, mL_per_min(o["flow_m3_per_s"]),
                                mmHg(o["mean_pressure_pa"]), o["mean_velocity_m_per_s"].get<double>());
    }
    if (summary.contains("branches")) {
        text += fmt::format("{:<18} {:>12} {:>14} {:>14} {:>7} {:>7}\n", "branch", "flow mL/min", "begin mmHg",
                            "end mmHg", "FFR", "across");
        for (const Json& b : summary["branches"])
            if (b.contains("flow_m3_per_s"))
                text += fmt::format("{:<18} {:>12.2f} {:>14.3f} {:>14.3f} {:>7} {:>7}{}\n",
                                    b["name"].get<std::string>(), mL_per_min(b["flow_m3_per_s"]),
                                    mmHg(b["pressure_begin_pa"]), mmHg(b["pressure_end_pa"]), shown(b, "ffr_end", 3),
                                    shown(b, "particles_across", 1), mark(b));
    }
    if (summary.contains("lesions")) {
        int number = 0;
        for (const Json& l : summary["lesions"])
            text += fmt::format(
                "lesion {} in {} at {} mm, {} % of the diameter: {:.2f} mL/min, drop {:.3f} mmHg (estimate {:.3f}), "
                "FFR {}, gauge pressure ratio {}, {} across{}\n",
                ++number, l["branch"].get<std::string>(), shown(l, "throat_arc_mm", 1),
                shown(l, "diameter_stenosis_percent", 1), mL_per_min(l["flow_m3_per_s"]), mmHg(l["drop_pa"]),
                mmHg(l["estimated_drop_pa"]), shown(l, "ffr", 3), shown(l, "gauge_pressure_ratio", 3),
                shown(l, "particles_across", 1), mark(l));
    }
    if (summary.contains("mass_imbalance_percent"))
        text += fmt::format("mass imbalance {} %\n", shown(summary, "mass_imbalance_percent", 3));
    return text;
}

}   // namespace patency
