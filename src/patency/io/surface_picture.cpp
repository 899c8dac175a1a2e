// SPDX-License-Identifier: Apache-2.0
#include "patency/io/surface_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace patency {

namespace {

constexpr double width = 1000, height = 900, margin = 110, head = 60, foot = 40;   // pixels
constexpr double finest = 0.4;   // pixels: smaller triangles are not seen, and many of them make a large file
constexpr Vec3 light = {-0.35, 0.45, 0.82};   // from the upper left, as in drawings; about unit

/// A view along -toward; right and up span the page.
struct View {
    const char *right_name, *up_name;
    Vec3 right, up, toward;
};
constexpr View views[] = {
    {"x", "z", {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {"y", "z", {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
    {"x", "y", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
};

/// The view in which the box around the vessel is largest.
const View& best_view(const Bounds& box) {
    const Vec3 d = box.high - box.low;
    const auto spread = [&](const View& v) { return std::abs(dot(v.right, d)) * std::abs(dot(v.up, d)); };
    return *std::max_element(std::begin(views), std::end(views),
                             [&](const View& a, const View& b) { return spread(a) < spread(b); });
}

std::string escaped(const std::string& text) {
    std::string result;
    for (char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return result;
}

class Page {
public:
    Page(const View& view, const Bounds& box) : view_(view), centre_(0.5 * (box.low + box.high)) {
        const Vec3 d = box.high - box.low;
        const double wide = std::abs(dot(view.right, d)), high = std::abs(dot(view.up, d));
        scale_ = std::min((width - 2 * margin) / std::max(wide, 1e-9),
                          (height - 2 * margin - head - foot) / std::max(high, 1e-9));
    }
    double scale() const { return scale_; }   ///< pixels per metre
    double x(const Vec3& place) const { return width / 2 + scale_ * dot(view_.right, place - centre_); }
    double y(const Vec3& place) const { return (height + head - foot) / 2 - scale_ * dot(view_.up, place - centre_); }
    double depth(const Vec3& place) const { return dot(view_.toward, place); }
    Vec3 turned(const Vec3& direction) const {
        return {dot(view_.right, direction), dot(view_.up, direction), dot(view_.toward, direction)};
    }

private:
    const View& view_;
    Vec3 centre_;
    double scale_;
};

void draw_triangles(std::string& svg, const Surface& surface, const std::vector<char>& is_opening, const Page& page) {
    std::vector<std::uint32_t> order(surface.triangles.size());
    std::vector<double> depth(order.size());
    std::iota(order.begin(), order.end(), 0u);
    for (std::uint32_t t : order) depth[t] = page.depth(centroid(surface, surface.triangles[t]));
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return depth[a] < depth[b]; });
    for (std::uint32_t t : order) {
        const Triangle& corners = surface.triangles[t];
        const Vec3 area = area_vector(surface, corners), n = page.turned(normalized(area));
        const bool is_inside = n.z < 0;   // the inner face, seen through an open end
        if (is_inside && is_opening[t]) continue;
        if (std::abs(n.z) * norm(area) * page.scale() * page.scale() < finest * finest / 8) continue;
        const double shade = is_inside ? 0.30 : 0.38 + 0.62 * std::max(0.0, dot(n, light));
        const Vec3 colour = is_opening[t] ? Vec3{90, 150, 215} : is_inside ? Vec3{150, 60, 60} : Vec3{226, 106, 94};
        const auto tone = [&](double c) { return int(std::clamp(c * shade, 0.0, 255.0)); };
        const std::string fill = fmt::format("#{:02x}{:02x}{:02x}", tone(colour.x), tone(colour.y), tone(colour.z));
        svg += fmt::format("<path fill=\"{0}\" stroke=\"{0}\" d=\"M", fill);
        for (std::uint32_t point : corners)
            svg += fmt::format("{:.1f} {:.1f} ", page.x(surface.points[point]), page.y(surface.points[point]));
        svg += "z\"/>\n";
    }
}

struct Label {
    double x, y;   ///< of its text
    double tip_x, tip_y;
    std::string number, text;
    bool is_leftward;   ///< the text stands left of the number, away from the vessel
};

/// Beside the opening, away from the vessel's middle; those that would cover each other move down.
std::vector<Label> place_labels(const std::vector<SurfaceOpening>& openings, const Page& page) {
    std::vector<Label> labels;
    for (std::size_t k = 0; k < openings.size(); ++k) {
        const Opening& o = openings[k].opening;
        const Vec3 n = page.turned(o.normal);
        Label label{.x = 0,
                    .y = 0,
                    .tip_x = page.x(o.centre),
                    .tip_y = page.y(o.centre),
                    .number = std::to_string(k + 1),
                    .text = fmt::format("{}  {:.2f} mm", o.name, 2e3 * o.radius),
                    .is_leftward = n.x < -0.2};
        const double length = std::max(std::hypot(n.x, n.y), 0.3), out = 34 + page.scale() * o.radius * 0.5;
        const double beside = 190, edge = 20;   // pixels that the text needs, and that are left without it
        label.x = std::clamp(label.tip_x + out * n.x / length, label.is_leftward ? beside : edge,
                             width - (label.is_leftward ? edge : beside));
        label.y = std::clamp(label.tip_y - out * n.y / length, head + 20, height - foot - 20);
        labels.push_back(label);
    }
    std::vector<Label*> order;
    for (Label& label : labels) order.push_back(&label);
    std::stable_sort(order.begin(), order.end(), [](const Label* a, const Label* b) { return a->y < b->y; });
    for (std::size_t k = 1; k < order.size(); ++k)
        for (std::size_t j = 0; j < k; ++j)
            if (std::abs(order[k]->x - order[j]->x) < 180 && std::abs(order[k]->y - order[j]->y) < 24)
                order[k]->y = order[j]->y + 24;
    return labels;
}

void draw_label(std::string& svg, const Label& label) {
    svg += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#333\" stroke-width=\"1\"/>\n",
        label.tip_x, label.tip_y, label.x, label.y);
    svg += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"11\" fill=\"#fff\" stroke=\"#333\"/>"
        "<text x=\"{0:.1f}\" y=\"{2:.1f}\" text-anchor=\"middle\">{3}</text>"
        "<text x=\"{4:.1f}\" y=\"{2:.1f}\" text-anchor=\"{6}\" stroke=\"#fff\" stroke-width=\"4\" "
        "paint-order=\"stroke\">{5}</text>\n",
        label.x, label.y, label.y + 5, label.number, label.x + (label.is_leftward ? -17 : 17), label.text,
        label.is_leftward ? "end" : "start");
}

void draw_lines(std::string& svg, const DrawnLines& drawn, const Page& page) {
    for (const std::vector<Vec3>& line : drawn.lines) {
        std::string path;
        double x = 0, y = 0;
        for (std::size_t k = 0; k < line.size(); ++k) {
            const double next_x = page.x(line[k]), next_y = page.y(line[k]);
            if (k > 0 && k + 1 < line.size() && std::hypot(next_x - x, next_y - y) < 2) continue;   // pixels
            x = next_x, y = next_y;
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x, y);
        }
        svg += fmt::format(
            "<path fill=\"none\" stroke=\"#fff\" stroke-width=\"3.5\" d=\"{0}\"/>"
            "<path fill=\"none\" stroke=\"#111\" stroke-width=\"1.5\" d=\"{0}\"/>\n",
            path);
    }
    for (std::size_t k = 0; k < drawn.marks.size(); ++k)
        svg += fmt::format(
            "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"9\" fill=\"none\" stroke=\"#06c\" stroke-width=\"3\"/>"
            "<text x=\"{2:.1f}\" y=\"{3:.1f}\" fill=\"#06c\" stroke=\"#fff\" stroke-width=\"4\" "
            "paint-order=\"stroke\">L{4}  {5}</text>\n",
            page.x(drawn.marks[k].place), page.y(drawn.marks[k].place), page.x(drawn.marks[k].place) + 14,
            page.y(drawn.marks[k].place) + 5, k + 1, escaped(drawn.marks[k].text));
}

/// A round length of about a sixth of the page.
void draw_scale(std::string& svg, const View& view, const Page& page) {
    const double sixth = width / 6 / page.scale() * 1e3, decade = std::pow(10, std::floor(std::log10(sixth)));
    const double length = decade * (sixth >= 5 * decade   ? 5
                                    : sixth >= 2 * decade ? 2
                                                          : 1),
                 pixels = length * 1e-3 * page.scale();
    svg += fmt::format(
        "<path d=\"M30 {0} v8 h{1:.1f} v-8\" fill=\"none\" stroke=\"#333\"/><text x=\"{2:.1f}\" y=\"{3}\">{4:g} "
        "mm</text>\n",
        height - 34, pixels, 40 + pixels, height - 25, length);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{} to the right, {} up</text>\n", width - 30,
                       height - 25, view.right_name, view.up_name);
}

}   // namespace

std::string draw_surface(const Surface& surface, const std::vector<SurfaceOpening>& openings, const std::string& title,
                         const DrawnLines& drawn) {
    const Bounds box = bounds(surface);
    const View& view = best_view(box);
    const Page page(view, box);
    std::vector<char> is_opening(surface.triangles.size());
    for (const SurfaceOpening& opening : openings)
        for (std::uint32_t t : opening.triangles) is_opening[t] = 1;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"15\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        width, height);
    svg +=
        fmt::format("<text x=\"30\" y=\"38\" font-size=\"20\">{}</text>\n<g stroke-width=\"0.6\">\n", escaped(title));
    draw_triangles(svg, surface, is_opening, page);
    svg += "</g>\n";
    draw_lines(svg, drawn, page);
    for (const Label& label : place_labels(openings, page)) draw_label(svg, label);
    draw_scale(svg, view, page);
    return svg + "</svg>\n";
}

}   // namespace patency
