// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <tuple>

#include "patency/report/curve.h"
#include "patency/report/figures.h"
#include "patency/report/sections.h"

namespace patency {

namespace {

/// A column of the openings' waveforms over the last beat, from its begin on.
PlotCurve over_beat(const CsvTable& waves, const std::string& column, double begin, double end, double scale) {
    PlotCurve curve;
    const auto *times = waves.find("time_s"), *values = waves.find(column);
    if (times && values)
        for (std::size_t k = 0; k < times->size(); ++k)
            if ((*times)[k] >= begin && (*times)[k] <= end)
                curve.x.push_back((*times)[k] - begin), curve.y.push_back(scale * (*values)[k]);
    return curve;
}

std::string beat_of(const RunResults& results, const FlowPart& flow) {
    const auto& part = results.part(flow);
    if (!flow.waveforms || !part.contains("period_s") || !part.contains("time_s") || !part.contains("openings"))
        return {};
    const double end = part["time_s"].get<double>(), begin = end - part["period_s"].get<double>();
    CurvePlot flows{.x_label = "Time in the beat, s",
                    .y_label = "Flow, mL/min (in at the inlet)",
                    .curves = {},
                    .spans = {},
                    .levels = {0},
                    .title = "Flow at the openings over a beat"},
        pressures = flows;
    pressures.y_label = "Pressure, mmHg", pressures.title = "Pressure at the openings over a beat",
    pressures.levels = {};
    std::string legend;
    std::size_t number = 0;
    for (const auto& [name, opening] : part["openings"].items()) {
        const std::string style = series_style(number++);
        const double sign = opening.value("flow_m3_per_s", 0.0) < 0 ? -1 : 1;   // as the blood goes
        for (auto& [plot, column, scale] : {std::tuple{&flows, "_flow_m3_per_s", sign * as_mL_per_min.scale},
                                            {&pressures, "_mean_pressure_pa", as_mmHg.scale}}) {
            plot->curves.push_back(over_beat(*flow.waveforms, name + column, begin, end, scale));
            plot->curves.back().style = style;
        }
        legend += fmt::format("<span class=\"key {}\">{}</span> ", style, escaped(name));
    }
    const std::string drawn = draw_curves(flows) + draw_curves(pressures);
    if (drawn.empty()) return {};
    const std::string heading = results.flows.size() > 1 ? "<h3>" + flow.title + "</h3>\n" : "";
    return fmt::format("<div>\n{}<p class=\"legend\">{}</p>\n{}</div>\n", heading, legend, drawn);
}

}   // namespace

std::string beat_section(const RunResults& results) {
    std::string content;
    for (const FlowPart& flow : results.flows) content += beat_of(results, flow);
    return content.empty() ? "" : "<section id=\"beat\">\n<h2>Over a beat</h2>\n" + content + "</section>\n";
}

}   // namespace patency
