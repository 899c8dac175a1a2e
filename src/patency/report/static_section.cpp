// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "patency/base/units.h"
#include "patency/report/colours.h"
#include "patency/report/curve.h"
#include "patency/report/figures.h"
#include "patency/report/picture.h"
#include "patency/report/same_places.h"
#include "patency/report/sections.h"

namespace patency {

namespace {

const PointArray* find(const PolyData& data, std::string_view name) {
    for (const PointArray& array : data.arrays)
        if (array.name == name) return &array;
    return nullptr;
}

/// Of a scalar field over all flows, without the outermost hundredths: single points do not set the scale.
ColourRange common_range(const RunResults& results, const char* field) {
    std::vector<double> values;
    for (const FlowPart& flow : results.flows)
        if (flow.wall)
            if (const PointArray* array = find(*flow.wall, field)) {
                const PointArray* resolved = find(*flow.wall, "IsResolved");
                for (std::size_t k = 0; k < array->values.size(); ++k)
                    if (array->components == 1 && (!resolved || resolved->values[k] != 0))
                        values.push_back(array->values[k]);
            }
    if (values.empty()) return {0, 1};
    std::sort(values.begin(), values.end());
    return {values[values.size() / 100], values[values.size() - 1 - values.size() / 100]};
}

/// The colours in a row, with the values at both ends and in the middle.
std::string colour_bar(const ColourRange& range, double scale, const std::string& label) {
    std::string svg = fmt::format(
        "<svg class=\"colour-bar\" viewBox=\"0 0 360 40\" role=\"img\" aria-label=\"colour scale of {}\">", label);
    constexpr int steps = 60;
    for (int k = 0; k < steps; ++k) {
        const auto c = colour_of((k + 0.5) / steps);
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"4\" width=\"4.6\" height=\"12\" fill=\"#{:02x}{:02x}{:02x}\"/>",
                           30 + 5.0 * k * 60 / steps, c[0], c[1], c[2]);
    }
    for (const double share : {0.0, 0.5, 1.0})
        svg += fmt::format("<text x=\"{:.0f}\" y=\"31\" text-anchor=\"middle\">{:.2f}</text>", 30 + 300 * share,
                           scale * (range.low + share * (range.high - range.low)));
    return svg + "</svg><p class=\"bar-label\">" + label + "</p>";
}

std::string pictures(const RunResults& results) {
    const PolyData* frame = nullptr;
    for (const FlowPart& flow : results.flows)
        if (flow.wall && !frame) frame = &*flow.wall;
    if (!frame) return {};
    const View view = broad_view(frame->points);
    const ColourRange range = common_range(results, "Pressure");
    std::string html;
    for (const FlowPart& flow : results.flows)
        if (flow.wall) {
            const Bitmap image =
                draw_field({.surface = *flow.wall, .array = "Pressure", .range = range, .view = view, .frame = *frame});
            html += fmt::format(
                "<figure><img alt=\"The vessel's wall coloured by pressure, {}\" width=\"{}\" height=\"{}\" "
                "src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
                flow.title, image.width, image.height, base64(png(image)), flow.title);
        }
    return "<div class=\"pictures\">" + html + "</div>" +
           colour_bar(range, as_mmHg.scale, "Pressure at the wall, mmHg, as the deck counts it");
}

/// The numbers of a column along the line to one outlet.
PlotCurve curve_of(const CsvTable& table, double outlet, const char* column, double scale) {
    PlotCurve curve;
    const auto *arc = table.find("arc_m"), *line = table.find("outlet"), *values = table.find(column);
    if (arc && line && values)
        for (std::size_t k = 0; k < arc->size(); ++k)
            if ((*line)[k] == outlet) curve.x.push_back(1e3 * (*arc)[k]), curve.y.push_back(scale * (*values)[k]);
    return curve;
}

std::string curves(const RunResults& results) {
    const FlowPart& first = results.flows.front();
    if (!first.pullback) return {};
    const auto& part = results.part(first);
    const auto worst = worst_lesion(part);
    const double outlet = worst ? outlet_through(*first.pullback, part["lesions"][*worst]) : 1;
    CurvePlot pressure{.x_label = "Distance from the inlet, mm",
                       .y_label = "Pressure, mmHg",
                       .curves = {},
                       .spans = {},
                       .least = {},
                       .levels = {}},
        ffr = pressure;
    ffr.y_label = "FFR", ffr.levels = {0.8}, ffr.least = 0.7;
    std::string legend;
    for (const FlowPart& flow : results.flows) {
        if (!flow.pullback) continue;
        for (auto& [plot, column, scale] : {std::tuple{&pressure, "pressure_pa", as_mmHg.scale}, {&ffr, "ffr", 1.0}}) {
            const double own = outlet_of_other(part, results.part(flow), outlet);
            plot->curves.push_back(curve_of(*flow.pullback, own, column, scale));
            plot->curves.back().style = flow.key;
        }
        legend += fmt::format("<span class=\"key {}\">{}</span> ", flow.key, flow.title);
    }
    pressure.curves.push_back(curve_of(*first.pullback, outlet, "estimated_pressure_pa", as_mmHg.scale));
    pressure.curves.back().style = "estimate";
    legend += "<span class=\"key estimate\">1-D estimate</span>";
    if (worst) {
        const auto& lesion = part["lesions"][*worst];
        const double throat = lesion.value("throat_arc_mm", 0.0), half = 0.5 * lesion.value("length_mm", 0.0);
        pressure.spans = ffr.spans = {{throat - half, throat + half, "lesion"}};
    }
    const auto names = outlet_names(part);
    const std::size_t number = std::size_t(outlet) - 1;
    if (const auto span = stent_span(*results.summary)) {
        for (CurvePlot* plot : {&pressure, &ffr}) plot->spans.push_back({span->start, span->end, "stent"});
        legend += " <span class=\"key stent\">stent</span>";
    }
    return fmt::format(
        "<div class=\"still-curves\"><h3>Along the vessel to {}</h3>\n<p class=\"legend\">{}{}</p>\n{}{}</div>\n",
        number < names.size() ? escaped(names[number]) : "the outlet", legend,
        worst ? " <span class=\"key lesion\">lesion</span>" : "", draw_curves(pressure), draw_curves(ffr));
}

}   // namespace

std::string static_section(const RunResults& results) {
    if (results.flows.empty()) return {};
    const std::string content = pictures(results) + curves(results);
    return content.empty() ? "" : "<section id=\"still\">\n<h2>The vessel</h2>\n" + content + "</section>\n";
}

}   // namespace patency
