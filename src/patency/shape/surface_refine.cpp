// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/surface_refine.h"

#include <cstdint>
#include <unordered_map>

#include "patency/base/errors.h"

namespace patency {

namespace {

class Round {
public:
    Round(Surface& surface, const std::function<double(const Vec3&)>& longest) : surface_(surface), longest_(longest) {}

    /// Whether an edge was too long.
    bool refine() {
        const std::vector<Triangle> old = std::move(surface_.triangles);
        const std::vector<std::int32_t> ids = std::move(surface_.face_ids);
        surface_.triangles.clear();
        surface_.face_ids.clear();
        for (std::size_t t = 0; t < old.size(); ++t) {
            split(old[t]);
            if (!ids.empty()) surface_.face_ids.resize(surface_.triangles.size(), ids[t]);
        }
        return surface_.triangles.size() > old.size();
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t(0);

    /// The point in the middle of an edge that is too long; asked by both its triangles.
    std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
        const std::uint64_t key = (std::uint64_t(std::min(a, b)) << 32) | std::max(a, b);
        if (const auto known = middles_.find(key); known != middles_.end()) return known->second;
        const Vec3 place = 0.5 * (surface_.points[a] + surface_.points[b]);
        std::uint32_t point = none;
        if (norm(surface_.points[a] - surface_.points[b]) > longest_(place)) {
            point = std::uint32_t(surface_.points.size());
            surface_.points.push_back(place);
        }
        return middles_[key] = point;
    }

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { surface_.triangles.push_back({a, b, c}); }
    double length(std::uint32_t a, std::uint32_t b) const { return norm(surface_.points[a] - surface_.points[b]); }

    void split(const Triangle& t) {
        std::array<std::uint32_t, 3> m;   // of the edge after each corner
        int count = 0;
        for (int k = 0; k < 3; ++k) count += (m[k] = middle(t[k], t[(k + 1) % 3])) != none;
        if (count == 0) return add(t[0], t[1], t[2]);
        if (count == 3) {
            for (int k = 0; k < 3; ++k) add(t[k], m[k], m[(k + 2) % 3]);
            return add(m[0], m[1], m[2]);
        }
        int k = 0;   // turned so that the first edge is cut; of two, the last is not
        while (m[k] == none || (count == 2 && m[(k + 1) % 3] == none)) ++k;
        const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], ab = m[k], bc = m[(k + 1) % 3];
        if (count == 1) return add(a, ab, c), add(ab, b, c);
        add(ab, b, bc);
        if (length(a, bc) < length(ab, c)) return add(a, ab, bc), add(a, bc, c);   // the shorter diagonal
        add(a, ab, c), add(ab, bc, c);
    }

    Surface& surface_;
    const std::function<double(const Vec3&)>& longest_;
    std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

}   // namespace

void refine_surface(Surface& surface, const std::function<double(const Vec3&)>& longest) {
    constexpr int most_rounds = 20;   // each halves: a million parts of an edge
    for (int round = 0; round < most_rounds; ++round)
        if (!Round(surface, longest).refine()) return;
    throw GeometryError("The surface cannot have triangles that small, or sizes that change that fast.");
}

}   // namespace patency
