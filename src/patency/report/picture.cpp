// SPDX-License-Identifier: Apache-2.0
#include "patency/report/picture.h"

#include <algorithm>
#include <cmath>

#include "patency/report/colours.h"

namespace patency {

namespace {

constexpr int finer = 2;        // pixels are drawn so much finer and averaged: smooth edges
constexpr double margin = 12;   // pixels
constexpr Vec3 grey{0.62, 0.62, 0.62};

struct Corner {
    double x, y, depth;
    Vec3 colour;   ///< 0 to 1
    Vec3 normal;   ///< in the view's axes
};

/// Where points fall on the page: x right, y down, in fine pixels.
struct Projection {
    const View& view;
    double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY, scale = 1;
    std::size_t width = 0, height = 0;

    Projection(const SurfaceScene& scene) : view(scene.view) {
        for (const Vec3& x : scene.frame.points) {
            low_x = std::min(low_x, dot(view.right, x)), high_x = std::max(high_x, dot(view.right, x));
            low_y = std::min(low_y, dot(view.up, x)), high_y = std::max(high_y, dot(view.up, x));
        }
        const double wide = std::max(high_x - low_x, 1e-9), high = std::max(high_y - low_y, 1e-9);
        scale = std::min((double(scene.width) - 2 * margin) / wide, (double(scene.most_height) - 2 * margin) / high);
        width = std::size_t(std::ceil(scale * wide + 2 * margin)) * finer;
        height = std::size_t(std::ceil(scale * high + 2 * margin)) * finer;
    }
    double x(const Vec3& p) const { return finer * (margin + scale * (dot(view.right, p) - low_x)); }
    double y(const Vec3& p) const { return finer * (margin + scale * (high_y - dot(view.up, p))); }
    double depth(const Vec3& p) const { return dot(view.toward, p); }
};

Vec3 as_vec(const std::array<std::uint8_t, 3>& c) { return {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0}; }

std::vector<Vec3> point_normals(const PolyData& surface) {
    std::vector<Vec3> normals(surface.points.size());
    for (const auto& t : surface.triangles) {
        const Vec3 n = cross(surface.points[t[1]] - surface.points[t[0]], surface.points[t[2]] - surface.points[t[0]]);
        for (std::uint32_t corner : t) normals[corner] += n;
    }
    for (Vec3& n : normals) n = norm(n) > 0 ? normalized(n) : Vec3{};
    return normals;
}

std::vector<Vec3> point_colours(const SurfaceScene& scene) {
    std::vector<Vec3> colours(scene.surface.points.size(), grey);
    const PointArray *field = nullptr, *resolved = nullptr;
    for (const PointArray& array : scene.surface.arrays) {
        if (array.name == scene.array) field = &array;
        if (array.name == "IsResolved") resolved = &array;
    }
    if (!field) return colours;
    for (std::size_t k = 0; k < colours.size(); ++k) {
        if (resolved && resolved->values[k] == 0) continue;
        double sum = 0;
        for (int c = 0; c < field->components; ++c)
            sum += std::pow(field->values[k * std::size_t(field->components) + std::size_t(c)], 2);
        const double value = field->components == 1 ? field->values[k] : std::sqrt(sum);
        colours[k] =
            as_vec(colour_of((value - scene.range.low) / std::max(scene.range.high - scene.range.low, 1e-300)));
    }
    return colours;
}

class Canvas {
public:
    Canvas(std::size_t across, std::size_t down)
        : width_(across), height_(down), depth_(across * down, -INFINITY), colour_(across * down) {}

    void fill(const Corner& a, const Corner& b, const Corner& c) {
        const double twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if (std::abs(twice_area) < 1e-12) return;
        const auto first = [](double p, double q, double r) {
            return std::max(0.0, std::ceil(std::min({p, q, r}) - 0.5));
        };
        const auto last = [](double p, double q, double r, std::size_t end) {
            return std::min(double(end) - 1, std::floor(std::max({p, q, r}) - 0.5));
        };
        for (double y = first(a.y, b.y, c.y); y <= last(a.y, b.y, c.y, height_); ++y)
            for (double x = first(a.x, b.x, c.x); x <= last(a.x, b.x, c.x, width_); ++x) {
                const double px = x + 0.5, py = y + 0.5;
                const double share_b = ((px - a.x) * (c.y - a.y) - (py - a.y) * (c.x - a.x)) / twice_area;
                const double share_c = ((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x)) / twice_area,
                             share_a = 1 - share_b - share_c;
                if (share_a < 0 || share_b < 0 || share_c < 0) continue;
                const std::size_t at = std::size_t(y) * width_ + std::size_t(x);
                const double depth = share_a * a.depth + share_b * b.depth + share_c * c.depth;
                if (depth <= depth_[at]) continue;
                depth_[at] = depth;
                const Vec3 normal = share_a * a.normal + share_b * b.normal + share_c * c.normal;
                const double lit = 0.55 + 0.45 * std::abs(normal.z) /
                                              std::max(norm(normal), 1e-12);   // as if lit from where one looks
                colour_[at] = lit * (share_a * a.colour + share_b * b.colour + share_c * c.colour);
            }
    }

    Bitmap averaged() const {
        Bitmap image{.width = width_ / finer, .height = height_ / finer};
        for (std::size_t y = 0; y < image.height; ++y)
            for (std::size_t x = 0; x < image.width; ++x) {
                Vec3 sum{};
                int hit = 0;
                for (std::size_t k = 0; k < std::size_t(finer) * finer; ++k) {
                    const std::size_t at = (y * finer + k / finer) * width_ + x * finer + k % finer;
                    if (depth_[at] == -INFINITY) continue;
                    sum += colour_[at], ++hit;
                }
                const auto byte = [](double share) { return std::uint8_t(std::clamp(255 * share + 0.5, 0.0, 255.0)); };
                for (const double c : {sum.x, sum.y, sum.z}) image.rgba.push_back(hit ? byte(c / hit) : 0);
                image.rgba.push_back(byte(double(hit) / (finer * finer)));
            }
        return image;
    }

private:
    std::size_t width_, height_;
    std::vector<double> depth_;
    std::vector<Vec3> colour_;
};

}   // namespace

Bitmap draw_field(const SurfaceScene& scene) {
    const Projection page(scene);
    Canvas canvas(page.width, page.height);
    const std::vector<Vec3> normals = point_normals(scene.surface), colours = point_colours(scene);
    const auto corner = [&](std::uint32_t p) {
        const Vec3& x = scene.surface.points[p];
        const Vec3 n{dot(scene.view.right, normals[p]), dot(scene.view.up, normals[p]),
                     dot(scene.view.toward, normals[p])};
        return Corner{page.x(x), page.y(x), page.depth(x), colours[p], n};
    };
    for (const auto& t : scene.surface.triangles) canvas.fill(corner(t[0]), corner(t[1]), corner(t[2]));
    return canvas.averaged();
}

}   // namespace patency
