// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/image_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/base/text.h"
#include "patency/shape/flat_loop.h"
#include "patency/shape/level_surface.h"
#include "patency/shape/surface_cut.h"

namespace patency {

namespace {

/// Numbers on a lattice in units of its steps, going on beyond its border as they are there.
struct Lattice3 {
    std::array<int, 3> size;
    std::vector<float> values;

    float at(int i, int j, int k) const {
        i = std::clamp(i, 0, size[0] - 1), j = std::clamp(j, 0, size[1] - 1), k = std::clamp(k, 0, size[2] - 1);
        return values[(std::size_t(k) * size[1] + j) * size[0] + i];
    }
};

/// Weights of four points for a place t in 0..1 between the middle two: cubic, with continuous slope (Catmull-Rom).
std::array<double, 4> cubic_weights(double t) {
    return {t * (t * (1 - 0.5 * t) - 0.5), 1 + t * t * (1.5 * t - 2.5), t * (0.5 + t * (2 - 1.5 * t)),
            t * t * (0.5 * t - 0.5)};
}

double interpolated(const Lattice3& lattice, const Vec3& x) {
    const Vec3 low{std::floor(x.x), std::floor(x.y), std::floor(x.z)};
    const auto wx = cubic_weights(x.x - low.x), wy = cubic_weights(x.y - low.y), wz = cubic_weights(x.z - low.z);
    double sum = 0;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) {
            if (wy[j] * wz[k] == 0) continue;
            double row = 0;
            for (int i = 0; i < 4; ++i)
                if (wx[i] != 0) row += wx[i] * lattice.at(int(low.x) + i - 1, int(low.y) + j - 1, int(low.z) + k - 1);
            sum += wy[j] * wz[k] * row;
        }
    return sum;
}

/// A Gaussian along every axis.
Lattice3 blurred(Lattice3 lattice) {
    constexpr float width = 1.5f;   // steps, the standard deviation
    constexpr int reach = 6;
    std::array<float, 2 * reach + 1> weight;
    float total = 0;
    for (int k = -reach; k <= reach; ++k) total += weight[k + reach] = std::exp(-0.5f * float(k * k) / (width * width));
    for (int axis = 0; axis < 3; ++axis) {
        const Lattice3 from = lattice;
        for_each_index(lattice.values.size(), [&](std::size_t n) {
            std::array<int, 3> at{int(n % lattice.size[0]), int(n / lattice.size[0] % lattice.size[1]),
                                  int(n / lattice.size[0] / lattice.size[1])};
            const int middle = at[axis];
            float sum = 0;
            for (int k = -reach; k <= reach; ++k) {
                at[axis] = middle + k;
                sum += weight[k + reach] * from.at(at[0], at[1], at[2]);
            }
            lattice.values[n] = sum / total;
        });
    }
    return lattice;
}

/// The part of a lattice that is below a level, in steps^3: every point's cell as if the level were flat in it.
double volume_below(const Lattice3& lattice, double level) {
    return sum_of(lattice.values.size(), [&](std::size_t n) {
        const int i = int(n % lattice.size[0]), j = int(n / lattice.size[0] % lattice.size[1]),
                  k = int(n / lattice.size[0] / lattice.size[1]);
        const double slope = 0.5 * (std::abs(lattice.at(i + 1, j, k) - lattice.at(i - 1, j, k)) +
                                    std::abs(lattice.at(i, j + 1, k) - lattice.at(i, j - 1, k)) +
                                    std::abs(lattice.at(i, j, k + 1) - lattice.at(i, j, k - 1)));
        const double above = lattice.values[n] - level;
        return std::abs(above) >= 0.5 * slope ? double(above < 0) : 0.5 - above / slope;
    });
}

struct Region {
    std::array<int, 3> low, size;   ///< of the image, in points
};

/// The box of the points that are wanted, and some more around where the image has them.
template <class Wanted>
Region region_of(const Image& image, Wanted wanted) {
    constexpr int margin = 6;
    std::array<int, 3> low = image.size, high{-1, -1, -1};
    for (std::size_t n = 0; n < image.values.size(); ++n) {
        if (!wanted(image.values[n])) continue;
        const std::array<int, 3> at{int(n % image.size[0]), int(n / image.size[0] % image.size[1]),
                                    int(n / image.size[0] / image.size[1])};
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    }
    Region region{};
    for (int k = 0; k < 3; ++k) {
        region.low[k] = std::max(low[k] - margin, 0);
        region.size[k] = std::min(high[k] + margin, image.size[k] - 1) + 1 - region.low[k];
    }
    return region;
}

template <class Value>
Lattice3 lattice_of(const Image& image, const Region& region, Value value) {
    Lattice3 lattice{region.size, {}};
    for (int k = 0; k < region.size[2]; ++k)
        for (int j = 0; j < region.size[1]; ++j)
            for (int i = 0; i < region.size[0]; ++i)
                lattice.values.push_back(value(
                    image.values[(std::size_t(region.low[2] + k) * image.size[1] + region.low[1] + j) * image.size[0] +
                                 region.low[0] + i]));
    return lattice;
}

/// Cut at the outer faces of the lattice's cells; with a free end there.
void cut_at_border(Surface& surface, const Lattice3& lattice, double snap) {
    const Vec3 last{lattice.size[0] - 0.5, lattice.size[1] - 0.5, lattice.size[2] - 0.5};
    for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        cut_flat(surface, {{-0.5, -0.5, -0.5}, -axis}, snap);
        cut_flat(surface, {last, axis}, snap);
    }
}

/// The zero level of a lattice that is part of the image; moved evenly, in steps, to have that volume if one is given.
Surface level_surface(const Image& image, const Region& region, const Lattice3& lattice,
                      std::optional<double> wanted_volume) {
    constexpr double cell = 0.5;   // steps: the flatness of triangles costs little beside the voxels
    constexpr int beyond = 2;      // steps past the image's border, to be cut there
    const auto may_cross = [&](const Bounds& box) {
        bool is_inside = false, is_outside = false;
        const auto range = [](double low, double high, int size) {
            return std::array{std::clamp(int(std::floor(low)) - 1, 0, size - 1),
                              std::clamp(int(std::ceil(high)) + 1, 0, size - 1)};
        };
        const auto [i0, i1] = range(box.low.x, box.high.x, lattice.size[0]);
        const auto [j0, j1] = range(box.low.y, box.high.y, lattice.size[1]);
        const auto [k0, k1] = range(box.low.z, box.high.z, lattice.size[2]);
        for (int k = k0; k <= k1; ++k)
            for (int j = j0; j <= j1; ++j)
                for (int i = i0; i <= i1; ++i) {
                    (lattice.at(i, j, k) < 0 ? is_inside : is_outside) = true;
                    if (is_inside && is_outside) return true;
                }
        return false;
    };
    const auto cells = [&](int k) { return int((lattice.size[k] - 1 + 2 * beyond) / cell); };
    const LevelField field = [&](const Vec3& x) { return interpolated(lattice, x); };
    Surface surface = make_level_surface(
        field, {{-beyond, -beyond, -beyond}, {cell, cell, cell}, {cells(0), cells(1), cells(2)}}, may_cross);
    if (wanted_volume) {
        Surface part = surface;
        cut_at_border(part, lattice, 0.3 * cell);
        const double has = closed_volume(part, find_loops(part, boundary_edges(edge_uses(part))));
        const double shift = std::clamp((*wanted_volume - has) / std::max(area(part), 1e-9), -0.25, 0.25);
        for_each_index(surface.points.size(), [&](std::size_t k) {
            const Vec3 slope = gradient(field, surface.points[k], 0.1);
            surface.points[k] += (shift / std::max(norm(slope), 1e-12)) * slope;
        });
    }
    cut_at_border(surface, lattice, 0.3 * cell);
    const Vec3 low{double(region.low[0]), double(region.low[1]), double(region.low[2])};
    for (Vec3& x : surface.points) x = image.place(low + x);
    if (determinant(image.step) < 0)
        for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
    surface.space = image.space;
    return surface;
}

int choose_label(const Image& image, std::optional<int> wanted) {
    constexpr std::size_t most_labels = 1000;
    std::set<int> labels;
    for (float value : image.values)
        if (value != 0 && labels.size() < most_labels && labels.find(int(value)) == labels.end())
            labels.insert(int(value));
    std::vector<std::string> names;
    for (int label : labels)
        if (names.size() < 30) names.push_back(std::to_string(label));
    if (names.size() < labels.size()) names.push_back("others");
    if (labels.empty()) throw GeometryError("The label map is 0 everywhere: there is no vessel in it.");
    if (wanted && !labels.contains(*wanted))
        throw GeometryError(
            fmt::format("The label map has no label {}; it has {}.", *wanted, join(names, ", ", " and ")));
    if (!wanted && labels.size() > 1)
        throw GeometryError(
            fmt::format("The label map has several labels: {}. Say which one is the vessel: --label N, or label in the "
                        "geometry of a deck.",
                        join(names, ", ", " and ")));
    return wanted.value_or(*labels.begin());
}

Surface surface_of_label(const Image& image, int label) {
    const auto is_label = [&](float value) { return int(value) == label; };
    const Region region = region_of(image, is_label);
    const Lattice3 inside = lattice_of(image, region, [&](float value) { return float(is_label(value)); });
    // Smoothing and taking every point back to its own side of the wall by turns comes near to the smoothest field that has
    // just these labels. 1 - (1 - G)^3 leaves polynomials up to the fifth degree as they are, while a Gaussian G alone would
    // shrink a tube by half the square of its width over the radius.
    constexpr int rounds = 4;
    Lattice3 field = inside;
    for (float& value : field.values) value = 0.5f - value;
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t n = 0; n < field.values.size(); ++n)
            field.values[n] = inside.values[n] > 0 ? std::min(field.values[n], 0.0f) : std::max(field.values[n], 0.0f);
        const Lattice3 once = blurred(field), twice = blurred(once), thrice = blurred(twice);
        for (std::size_t n = 0; n < field.values.size(); ++n)
            field.values[n] = 3 * once.values[n] - 3 * twice.values[n] + thrice.values[n];
    }
    const double volume = sum_of(inside.values.size(), [&](std::size_t n) { return double(inside.values[n]); });
    // The level with the volume of the voxels, roughly; the surface is moved to have it exactly.
    double low = -0.25, high = 0.25;
    for (int n = 0; n < 20; ++n) {
        const double level = 0.5 * (low + high);
        (volume_below(field, level) < volume ? low : high) = level;
    }
    for (float& value : field.values) value -= float(0.5 * (low + high));
    return level_surface(image, region, field, volume);
}

Surface surface_of_level_set(const Image& image) {
    std::size_t below = 0, all = 0;   // on the border
    for (std::size_t n = 0; n < image.values.size(); ++n) {
        const std::array<int, 3> at{int(n % image.size[0]), int(n / image.size[0] % image.size[1]),
                                    int(n / image.size[0] / image.size[1])};
        bool is_border = false;
        for (int k = 0; k < 3; ++k) is_border |= at[k] == 0 || at[k] == image.size[k] - 1;
        all += is_border, below += is_border && image.values[n] < 0;
    }
    const float sign = 2 * below > all ? -1 : 1;
    const Region region = region_of(image, [&](float value) { return sign * value < 0; });
    return level_surface(image, region, lattice_of(image, region, [&](float value) { return sign * value; }), {});
}

}   // namespace

Surface make_image_surface(const Image& image, std::optional<int> label) {
    bool is_whole = true, has_negative = false, has_positive = false;
    constexpr float largest_label = 1e9f;
    for (float value : image.values) {
        is_whole = is_whole && value == std::floor(value) && value <= largest_label;
        has_negative |= value<0, has_positive |= value> 0;
    }
    Surface surface;
    if (has_negative && has_positive && !label)
        surface = surface_of_level_set(image);
    else if (is_whole && !has_negative)
        surface = surface_of_label(image, choose_label(image, label));
    else
        throw GeometryError(
            "The image is neither a label map (whole numbers from 0 on) nor a level set (numbers with both signs). "
            "Segment the "
            "vessel first.");
    if (surface.triangles.empty())
        throw GeometryError("What the image marks is too small for a surface: there is no vessel in it.");
    return surface;
}

}   // namespace patency
