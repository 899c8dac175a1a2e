// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "patency/base/text.h"
#include "patency/report/curve.h"
#include "patency/report/page_frame.h"
#include "patency/report/sections.h"
#include "patency/report/sweep.h"
#include "patency/report/sweep_quantities.h"

namespace patency {

namespace {

std::string with_unit(const std::string& label, std::string_view unit) {
    return unit.empty() ? label : fmt::format("{}, {}", label, unit);
}

std::string row_html(const Sweep& sweep, const SweepRow& row, const std::vector<SweepQuantity>& quantities) {
    std::string cells =
        fmt::format("<td>{}</td>", row.has_results() && sweep.command != "estimate"
                                       ? fmt::format("<a href=\"{0}/report.html\">{0}</a>", escaped(row.name))
                                       : escaped(row.name));
    for (const std::string& value : row.values) cells += fmt::format("<td>{}</td>", escaped(value));
    for (const SweepQuantity& q : quantities) {
        const std::string pointer = row.summary ? q.pointer(*row.summary) : "";
        cells += fmt::format("<td>{}</td>", pointer.empty() ? "<span class=\"none\">–</span>"
                                                            : Figures(*row.summary).number(pointer, q.measure));
    }
    const bool is_good = row.exit_code == 0;
    cells +=
        fmt::format("<td>{}</td>", is_good          ? "<span class=\"verdict good\">done</span>"
                                   : !row.exit_code ? "has not run yet"
                                                    : fmt::format("<span class=\"verdict look\">exit code {}</span> {}",
                                                                  *row.exit_code, escaped(row.reason)));
    return fmt::format("<tr data-run=\"{}\">{}</tr>\n", escaped(row.name), cells);
}

std::string table_section(const Sweep& sweep, const std::vector<SweepQuantity>& quantities) {
    std::string head = "<th>Run</th>", rows;
    for (const std::string& key : sweep.keys) head += fmt::format("<th>{}</th>", escaped(key));
    for (const SweepQuantity& q : quantities)
        head += fmt::format("<th>{}</th>", escaped(with_unit(q.label, q.measure.unit)));
    for (const SweepRow& row : sweep.rows) rows += row_html(sweep, row, quantities);
    return fmt::format(
        "<section id=\"runs\">\n<h2>Runs</h2>\n<div "
        "class=\"table\"><table>\n<thead><tr>{}<th>State</th></tr></thead>\n<tbody>\n{}</tbody></table></div>\n"
        "<p class=\"note\">Every number of every run is in <a href=\"sweep.csv\">sweep.csv</a>.</p></section>\n",
        head, rows);
}

/// What the plots' horizontal axis is: the first key with numbers that differ, else the runs in their order.
struct AcrossPlots {
    std::string label;
    std::vector<double> x;   ///< one for each row
    std::optional<std::size_t> key;
};
AcrossPlots across_plots(const Sweep& sweep) {
    for (std::size_t k = 0; k < sweep.keys.size(); ++k)
        if (auto scale = scale_of(sweep, k); scale && std::minmax_element(scale->values.begin(), scale->values.end()) !=
                                                          std::pair(scale->values.begin(), scale->values.begin()))
            return {with_unit(sweep.keys[k], scale->unit), std::move(scale->values), k};
    AcrossPlots runs{"run, as in the table", std::vector<double>(sweep.rows.size()), {}};
    std::iota(runs.x.begin(), runs.x.end(), 1);
    return runs;
}

/// One curve for each combination of the other keys.
std::vector<PlotCurve> curves_of(const Sweep& sweep, const SweepQuantity& quantity, const AcrossPlots& across) {
    std::vector<PlotCurve> curves;
    std::map<std::string, std::vector<std::pair<double, double>>> points;
    std::vector<std::string> labels;   // in the table's order: a curve has one colour in all plots
    for (std::size_t r = 0; r < sweep.rows.size(); ++r) {
        std::vector<std::string> others;
        for (std::size_t k = 0; k < sweep.keys.size(); ++k)
            if (across.key && k != *across.key) others.push_back(sweep.keys[k] + " " + sweep.rows[r].values[k]);
        const std::string label = join(others, ", ");
        if (!points.contains(label)) labels.push_back(label);
        auto& here = points[label];
        if (const auto value = value_of(sweep.rows[r], quantity)) here.emplace_back(across.x[r], *value);
    }
    for (std::size_t k = 0; k < labels.size(); ++k) {
        auto& here = points[labels[k]];
        std::sort(here.begin(), here.end());
        PlotCurve curve{labels[k], series_style(k), {}, {}};
        for (const auto& [x, y] : here) curve.x.push_back(x), curve.y.push_back(y);
        curves.push_back(std::move(curve));
    }
    return curves;
}

std::string plots_section(const Sweep& sweep, const std::vector<SweepQuantity>& quantities) {
    const AcrossPlots across = across_plots(sweep);
    std::string html;
    for (const SweepQuantity& q : quantities) {
        const CurvePlot plot{.x_label = across.label,
                             .y_label = with_unit(q.label, q.measure.unit),
                             .curves = curves_of(sweep, q, across),
                             .spans = {},
                             .levels = {},
                             .title = q.label + " over " + across.label,
                             .has_points = true};
        std::string legend;
        if (plot.curves.size() > 1)
            for (const PlotCurve& curve : plot.curves)
                legend += fmt::format("<span class=\"key {}\">{}</span> ", curve.style, escaped(curve.label));
        if (const std::string svg = draw_curves(plot); !svg.empty())
            html += fmt::format("<h3>{}</h3>\n{}{}", escaped(plot.title),
                                legend.empty() ? "" : "<p class=\"legend\">" + legend + "</p>\n", svg);
    }
    return html.empty() ? "" : "<section id=\"plots\">\n<h2>Compared</h2>\n" + html + "</section>\n";
}

}   // namespace

std::string sweep_page(const Sweep& sweep, std::string_view version) {
    const std::vector<SweepQuantity> quantities = sweep_quantities(sweep);
    const auto ended = std::count_if(sweep.rows.begin(), sweep.rows.end(),
                                     [](const SweepRow& row) { return row.exit_code.has_value(); });
    return page_head(sweep.name) + "<body>\n" +
           page_masthead(sweep.name,
                         fmt::format("{} of {} runs of patency {}", ended, sweep.rows.size(), escaped(sweep.command))) +
           "<main>\n" + table_section(sweep, quantities) + plots_section(sweep, quantities) + "</main>\n" +
           page_footer(version, "Every number here is one of a run's summary.json.") + "</body>\n</html>\n";
}

}   // namespace patency
