// SPDX-License-Identifier: Apache-2.0
#include "patency/io/stent_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patency {

namespace {

constexpr double width = 1200, margin = 40, head = 50, line_height = 20, foot = 60;   // pixels
constexpr double strip = 0.12;   // of the circumference that is drawn twice, beyond each end

// In millimetres, x along and y around upwards, the group's transform does the rest.
class Page {
public:
    Page(double length, double around, const std::string& title, const std::vector<std::string>& lines)
        : length_(1e3 * length), around_(1e3 * around), scale_((width - 2 * margin) / length_) {
        const double top = head + line_height * double(lines.size()), high = (1 + 2 * strip) * around_ * scale_;
        height_ = top + high + foot;
        svg = fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1:.0f}\" width=\"{0}\" height=\"{1:.0f}\" "
            "font-family=\"sans-serif\" font-size=\"15\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
            "<text x=\"{2}\" y=\"32\" font-size=\"20\">{3}</text>\n",
            width, height_, margin, escaped(title));
        for (std::size_t k = 0; k < lines.size(); ++k)
            svg += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", margin, head + line_height * double(k) + 8,
                               escaped(lines[k]));
        svg += fmt::format(
            "<clipPath id=\"strip\"><rect x=\"{0:.4f}\" y=\"{1:.4f}\" width=\"{2:.4f}\" "
            "height=\"{3:.4f}\"/></clipPath>\n"
            "<g transform=\"translate({4:.2f} {5:.2f}) scale({6:.4f} {7:.4f})\">\n<g clip-path=\"url(#strip)\">\n",
            -length_ / 2, -strip * around_, length_, (1 + 2 * strip) * around_, width / 2,
            top + high - strip * around_ * scale_, scale_, -scale_);
    }

    /// shape(shift): what is drawn, moved around by shift [mm]; once per turn that is seen.
    template <class Draw>
    void draw_around(double low, double high, Draw draw) {
        for (int turn = int(std::floor((-strip * around_ - high) / around_));
             turn <= int(std::ceil((1 + strip) - low / around_)); ++turn) {
            const double shift = turn * around_;
            if (high + shift > -strip * around_ && low + shift < (1 + strip) * around_) svg += draw(shift);
        }
    }

    std::string finish() {
        svg += "</g>\n";
        for (double level : {0.0, around_})
            svg += fmt::format(
                "<path d=\"M{:.4f} {:.4f} h{:.4f}\" stroke=\"#c33\" stroke-width=\"{:.4f}\" "
                "stroke-dasharray=\"{:.4f}\"/>\n",
                -length_ / 2, level, length_, 1 / scale_, 6 / scale_);
        svg += fmt::format(
            "</g>\n<path d=\"M{0} {1:.1f} v8 h{2:.1f} v-8\" fill=\"none\" stroke=\"#333\"/><text x=\"{3:.1f}\" "
            "y=\"{4:.1f}\">1 mm"
            "</text>\n<text x=\"{5}\" y=\"{4:.1f}\" text-anchor=\"end\">unrolled: axis to the right, one turn between "
            "the "
            "dashed lines</text>\n</svg>\n",
            margin, height_ - 34, scale_, margin + 10 + scale_, height_ - 25, width - margin);
        return svg;
    }

    std::string svg;

private:
    static std::string escaped(const std::string& text) {
        std::string result;
        for (char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
        return result;
    }
    double length_, around_, scale_, height_;
};

}   // namespace

std::string draw_stent(const StrutCurves& curves, const std::vector<StentCell>& cells, const std::string& title,
                       const std::vector<std::string>& lines) {
    Page page(curves.length, curves.circumference(), title, lines);
    for (const Strut& strut : curves.struts) {
        double low = Bounds::infinity, high = -Bounds::infinity;
        for (const FlatPoint& p : strut.points) low = std::min(low, p.around), high = std::max(high, p.around);
        page.draw_around(1e3 * (low - strut.half_width), 1e3 * (high + strut.half_width), [&](double shift) {
            std::string path = fmt::format(
                "<path fill=\"none\" stroke=\"#456\" stroke-linecap=\"round\" stroke-linejoin=\"round\" "
                "stroke-width=\"{:.4f}\" d=\"M",
                2e3 * strut.half_width);
            for (const FlatPoint& p : strut.points)
                path += fmt::format("{:.4f} {:.4f} ", 1e3 * p.along, 1e3 * p.around + shift);
            return path + "\"/>\n";
        });
    }
    const auto widest = std::max_element(cells.begin(), cells.end(),
                                         [](const auto& a, const auto& b) { return a.inscribed < b.inscribed; });
    if (widest != cells.end()) {
        const double radius = 500 * widest->inscribed, at = 1e3 * widest->centre.around;
        page.draw_around(at - radius, at + radius, [&](double shift) {
            return fmt::format(
                "<circle cx=\"{:.4f}\" cy=\"{:.4f}\" r=\"{:.4f}\" fill=\"#f4c27a\" fill-opacity=\"0.7\"/>\n",
                1e3 * widest->centre.along, at + shift, radius);
        });
    }
    return page.finish();
}

std::string draw_stent(const Surface& surface, double diameter, const std::string& title,
                       const std::vector<std::string>& lines) {
    const Bounds box = bounds(surface);
    const double pi = std::numbers::pi, radius = diameter / 2;
    Page page(box.high.x - box.low.x, 2 * pi * radius, title, lines);
    for (const Triangle& t : surface.triangles) {
        const Vec3 out = area_vector(surface, t), c = centroid(surface, t);
        if (out.y * c.y + out.z * c.z < 0.5 * norm(out) * std::hypot(c.y, c.z)) continue;   // the outer faces only
        const double middle = std::atan2(c.z, c.y) + pi;
        double at[3], low = Bounds::infinity, high = -Bounds::infinity;
        for (int k = 0; k < 3; ++k) {
            const Vec3& x = surface.points[t[std::size_t(k)]];
            const double off = std::atan2(x.z, x.y) + pi - middle;
            at[k] = 1e3 * radius * (middle + off - 2 * pi * std::round(off / (2 * pi)));
            low = std::min(low, at[k]), high = std::max(high, at[k]);
        }
        page.draw_around(low, high, [&](double shift) {
            std::string path = "<path fill=\"#456\" stroke=\"#456\" stroke-width=\"0.005\" d=\"M";
            for (int k = 0; k < 3; ++k)
                path += fmt::format("{:.4f} {:.4f} ", 1e3 * surface.points[t[std::size_t(k)]].x, at[k] + shift);
            return path + "z\"/>\n";
        });
    }
    return page.finish();
}

}   // namespace patency
