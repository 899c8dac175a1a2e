// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "patency/base/errors.h"

namespace patency {

namespace {

constexpr double width = 640, height = 400, left = 64, right = 16, top = 16, bottom = 48;
// Distinguishable without colour vision (Okabe and Ito's palette).
constexpr std::array colours = {"#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

struct Range {
    double low = 1e300, high = -1e300;
    void include(double v) { low = std::min(low, v), high = std::max(high, v); }
    void widen() {
        if (high == low) low -= 0.5, high += 0.5;
    }
};

/// 1, 2 or 5 times a power of ten, so that about five marks fit.
double step_of(const Range& range) {
    const double raw = (range.high - range.low) / 5, power = std::pow(10, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= raw) return factor * power;
    return 10 * power;
}

std::string head(double w, double h) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        w, h, w, h);
}
std::string text(double x, double y, const std::string& words, const std::string& anchor = "middle",
                 const std::string& more = "") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more, words);
}

/// Blue over white to red through lightness that rises and falls evenly.
std::string colour_of(double share) {
    const double q = std::clamp(share, 0.0, 1.0);
    const std::array<std::array<double, 3>, 5> stops = {
        {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
    const double place = q * 4;
    const std::size_t k = std::min<std::size_t>(3, std::size_t(place));
    const double f = place - double(k);
    std::array<int, 3> c{};
    for (std::size_t a = 0; a < 3; ++a) c[a] = int(std::lround(stops[k][a] + f * (stops[k + 1][a] - stops[k][a])));
    return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

}   // namespace

std::string format_plot(const Plot& plot) {
    Range rx, ry;
    for (const Curve& curve : plot.curves) {
        for (const double v : curve.x) rx.include(v);
        for (const double v : curve.y) ry.include(v);
    }
    if (rx.low > rx.high) throw UsageError("a plot needs at least one point");
    rx.widen(), ry.widen();
    const auto px = [&](double v) { return left + (width - left - right) * (v - rx.low) / (rx.high - rx.low); };
    const auto py = [&](double v) {
        return height - bottom - (height - top - bottom) * (v - ry.low) / (ry.high - ry.low);
    };
    std::string out = head(width, height);
    out += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888\"/>\n", left,
                       top, width - left - right, height - top - bottom);
    const double sx = step_of(rx), sy = step_of(ry);
    for (double v = std::ceil(rx.low / sx - 1e-9) * sx; v <= rx.high + 1e-9 * sx; v += sx)
        out += text(px(v), height - bottom + 16, fmt::format("{:.4g}", std::abs(v) < 1e-9 * sx ? 0.0 : v));
    for (double v = std::ceil(ry.low / sy - 1e-9) * sy; v <= ry.high + 1e-9 * sy; v += sy)
        out += text(left - 6, py(v) + 4, fmt::format("{:.4g}", std::abs(v) < 1e-9 * sy ? 0.0 : v), "end");
    out += text((left + width - right) / 2, height - 10, plot.x_label);
    out += text(14, (top + height - bottom) / 2, plot.y_label, "middle",
                fmt::format(" transform=\"rotate(-90 14 {:.1f})\"", (top + height - bottom) / 2));
    std::size_t named = 0;
    for (const Curve& curve : plot.curves) {
        if (!curve.label.empty()) ++named;
        const std::size_t k = named > 0 ? named - 1 : 0;
        const char* colour = colours[k % colours.size()];
        if (curve.is_dotted) {
            for (std::size_t i = 0; i < curve.x.size(); ++i)
                out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"none\" stroke=\"{}\"/>\n",
                                   px(curve.x[i]), py(curve.y[i]), colour);
        } else {
            out += "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"" + std::string(colour) + "\" points=\"";
            for (std::size_t i = 0; i < curve.x.size(); ++i)
                out += fmt::format("{:.1f},{:.1f} ", px(curve.x[i]), py(curve.y[i]));
            out += "\"/>\n";
        }
        if (curve.label.empty()) continue;
        const double y = top + 16 + 16 * double(k);
        out += fmt::format("<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"10\" height=\"10\" fill=\"{}\"/>\n", left + 8,
                           y - 9, colour);
        out += text(left + 24, y, curve.label, "start");
    }
    return out + "</svg>\n";
}

std::string format_field(const FieldMap& map) {
    Range rx, ry;
    for (const double v : map.x) rx.include(v);
    for (const double v : map.y) ry.include(v);
    if (rx.low > rx.high) throw UsageError("a picture of a field needs at least one particle");
    rx.low -= map.side / 2, rx.high += map.side / 2, ry.low -= map.side / 2, ry.high += map.side / 2;
    const double scale = (width - 32) / (rx.high - rx.low), depth = scale * (ry.high - ry.low),
                 side = 1.15 * scale * map.side;
    std::string out = head(width, depth + 72);
    for (std::size_t i = 0; i < map.x.size(); ++i)
        out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                           16 + scale * (map.x[i] - rx.low) - side / 2, 16 + scale * (ry.high - map.y[i]) - side / 2,
                           side, side, colour_of((map.value[i] - map.low) / (map.high - map.low)));
    const double y = depth + 30;
    for (int k = 0; k < 64; ++k)
        out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"5\" height=\"12\" fill=\"{}\"/>\n", 160 + 5.0 * k,
                           y, colour_of(k / 63.0));
    out += text(152, y + 11, fmt::format("{:.3g}", map.low), "end") +
           text(488, y + 11, fmt::format("{:.3g}", map.high), "start");
    return out + text(width / 2, y + 30, map.label) + "</svg>\n";
}

}   // namespace patency
