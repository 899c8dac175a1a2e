// SPDX-License-Identifier: Apache-2.0
#include "patency/report/curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/report/figures.h"

namespace patency {

namespace {

constexpr double width = 760, height = 260, left = 64, right = 14, top = 14, bottom = 42;   // pixels

struct Axis {
    double low = INFINITY, high = -INFINITY, begin, end;   ///< begin and end on the page
    void include(double v) { low = std::min(low, v), high = std::max(high, v); }
    /// What differs by rounding alone is one value: no step between marks could be told from it.
    bool is_one_value() const { return !(high - low > 1e-9 * std::max(std::abs(low), std::abs(high))); }
    void widen(double share) {
        const double margin = is_one_value() ? std::max(share * std::abs(high), 1e-9) : share * (high - low);
        low -= margin, high += margin;
    }
    double at(double v) const { return begin + (v - low) / (high - low) * (end - begin); }
    bool has(double v) const { return v >= low && v <= high; }
    /// 1, 2 or 5 times a power of ten, so that about five marks fit.
    double step() const {
        const double raw = (high - low) / 5, power = std::pow(10, std::floor(std::log10(raw)));
        for (const double factor : {1.0, 2.0, 5.0})
            if (factor * power >= raw) return factor * power;
        return 10 * power;
    }
    template <class Draw>
    void for_each_mark(Draw draw) const {   // draw(value, its label)
        constexpr double rounding = 1e-9;
        const double gap = step();
        const int digits = std::max(0, int(-std::floor(std::log10(gap) + rounding)));
        for (double n = std::ceil(low / gap - rounding); n * gap <= high + rounding * gap; ++n)
            draw(n * gap, fmt::format("{:.{}f}", n * gap + 0.0, digits));   // no sign on a zero
    }
};

std::string marks(const Axis& x, const Axis& y) {
    std::string svg;
    x.for_each_mark([&](double v, const std::string& label) {
        svg += fmt::format(
            "<path class=\"grid\" d=\"M{0:.1f} {1} V{2}\"/><text x=\"{0:.1f}\" y=\"{3}\" "
            "text-anchor=\"middle\">{4}</text>\n",
            x.at(v), top, height - bottom, height - bottom + 16, label);
    });
    y.for_each_mark([&](double v, const std::string& label) {
        svg += fmt::format(
            "<path class=\"grid\" d=\"M{1} {0:.1f} H{2}\"/><text x=\"{3}\" y=\"{4:.1f}\" "
            "text-anchor=\"end\">{5}</text>\n",
            y.at(v), left, width - right, left - 7, y.at(v) + 4, label);
    });
    return svg;
}

std::string line(const PlotCurve& curve, const Axis& x, const Axis& y) {
    std::string path;
    for (std::size_t k = 0; k < curve.x.size(); ++k)
        path += fmt::format("{}{:.1f} {:.1f}", k ? " L" : "M", x.at(curve.x[k]), y.at(curve.y[k]));
    return fmt::format("<path class=\"curve {}\" d=\"{}\"/>\n", curve.style, path);
}

}   // namespace

std::string series_style(std::size_t number) {
    constexpr std::size_t styles = 8;
    return fmt::format("series-{}", number % styles);
}

std::string draw_curves(const CurvePlot& plot) {
    Axis x{.begin = left, .end = width - right}, y{.begin = height - bottom, .end = top};
    for (const PlotCurve& curve : plot.curves)
        for (std::size_t k = 0; k < curve.x.size(); ++k) x.include(curve.x[k]), y.include(curve.y[k]);
    if (!(x.high > x.low) || x.is_one_value()) return {};
    if (plot.least) y.include(*plot.least);
    y.widen(0.06);
    if (plot.has_points) x.widen(0.03);   // none on the edge
    std::string svg =
        fmt::format("<svg class=\"pullback\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", width, height,
                    escaped(plot.title.empty() ? plot.y_label + " along the vessel" : plot.title));
    for (const Span& span : plot.spans)
        if (span.to > x.low && span.from < x.high) {
            const double from = x.at(std::max(span.from, x.low)), to = x.at(std::min(span.to, x.high));
            svg += fmt::format("<rect class=\"span {}\" x=\"{:.1f}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\"/>\n",
                               span.style, from, top, to - from, height - top - bottom);
        }
    svg += marks(x, y);
    for (const double level : plot.levels)
        if (y.has(level))
            svg += fmt::format("<path class=\"level\" d=\"M{} {:.1f} H{}\"/>\n", left, y.at(level), width - right);
    for (const PlotCurve& curve : plot.curves) {
        if (curve.x.size() > 1) svg += line(curve, x, y);
        for (std::size_t k = 0; plot.has_points && k < curve.x.size(); ++k)
            svg += fmt::format("<circle class=\"point {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>\n", curve.style,
                               x.at(curve.x[k]), y.at(curve.y[k]));
    }
    svg += fmt::format("<text x=\"{:.0f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", 0.5 * (left + width - right),
                       height - 6, escaped(plot.x_label));
    svg += fmt::format("<text transform=\"translate(15 {:.0f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                       0.5 * (top + height - bottom), escaped(plot.y_label));
    return svg + "</svg>\n";
}

}   // namespace patency
