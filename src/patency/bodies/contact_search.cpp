// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/contact_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <unordered_map>

#include "patency/base/parallel.h"
#include "patency/bodies/cell_hash.h"
#include "patency/bodies/closest_point.h"

namespace patency {

namespace {

// In sizes of the largest element.
constexpr double reach_in_elements = 1.0;    // deeper than this is no contact but the other side
constexpr double margin_in_elements = 0.5;   // to move before it is looked again
constexpr double apart_in_elements = 4.0;    // along the surface, for parts of one surface to touch

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return std::sqrt(largest_of(a.size(), [&](std::size_t i) { return dot(a[i] - b[i], a[i] - b[i]); }));
}

struct Box {
    Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    explicit Box(const std::vector<Vec3>& points) {
        for (const Vec3& x : points) {
            low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
            high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
        }
    }
    bool contains(const Vec3& x, double more) const {
        return x.x >= low.x - more && x.y >= low.y - more && x.z >= low.z - more && x.x <= high.x + more &&
               x.y <= high.y + more && x.z <= high.z + more;
    }
};

}   // namespace

ContactSearch::ContactSearch(const SolidSurface& vertices, const SolidSurface& elements)
    : vertices_(vertices), elements_(elements) {
    const auto side = [](const SolidSurface& s) {
        double largest = 0;
        for (const auto& [a, b, c] : s.mesh().elements) {
            const auto& x = s.mesh().vertices;
            largest = std::max({largest, norm(x[a] - x[b]), norm(x[b] - x[c]), norm(x[c] - x[a])});
        }
        return largest;
    };
    size_ = side(elements);
    reach_ = reach_in_elements * size_;
    margin_ = margin_in_elements * size_;
    if (&vertices_ == &elements_) exclude_near();
    find_facing();
    find();
}

void ContactSearch::find_facing() {
    const auto& mesh = elements_.mesh();
    facing_.resize(mesh.elements.size());
    std::iota(facing_.begin(), facing_.end(), 0u);
    if (elements_.planar()) return;
    std::vector<Vec3> normal(mesh.elements.size());
    std::vector<char> is_thin(mesh.elements.size());
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
        const auto& [ia, ib, ic] = mesh.elements[e];
        const Vec3 ab = mesh.vertices[ib] - mesh.vertices[ia], ac = mesh.vertices[ic] - mesh.vertices[ia], bc = ac - ab,
                   across = cross(ab, ac);
        is_thin[e] = norm(across) < thin * std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
        normal[e] = norm(across) > 0 ? normalized(across) : Vec3{};
    }
    const auto& at = elements_.elements_at();
    for (std::uint32_t e = 0; e < facing_.size(); ++e) {
        if (!is_thin[e]) continue;
        double nearest = -2;
        for (const std::uint32_t v : mesh.elements[e])
            for (const std::uint32_t* other = at.begin(v); other < at.end(v); ++other)
                if (const double alike = dot(normal[e], normal[*other]); !is_thin[*other] && alike > nearest)
                    nearest = alike, facing_[e] = *other;
    }
}

/// Elements that a vertex reaches on a way of less than `apart` along the edges of the reference configuration.
void ContactSearch::exclude_near() {
    const auto& mesh = vertices_.mesh();
    const double apart = apart_in_elements * size_;
    const auto& at = vertices_.elements_at();
    std::vector<double> way(mesh.vertices.size(), INFINITY);
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
        std::vector<std::uint32_t> visited, near;
        std::priority_queue<std::pair<double, std::uint32_t>, std::vector<std::pair<double, std::uint32_t>>,
                            std::greater<>>
            open;
        open.push({0, v}), way[v] = 0, visited.push_back(v);
        while (!open.empty()) {
            const auto [length, from] = open.top();
            open.pop();
            if (length > way[from]) continue;
            for (const std::uint32_t* e = at.begin(from); e < at.end(from); ++e) {
                near.push_back(*e);
                for (const std::uint32_t to : mesh.elements[*e]) {
                    const double longer = length + norm(mesh.vertices[to] - mesh.vertices[from]);
                    if (longer >= apart || longer >= way[to]) continue;
                    if (way[to] == INFINITY) visited.push_back(to);
                    way[to] = longer;
                    open.push({longer, to});
                }
            }
        }
        for (const std::uint32_t u : visited) way[u] = INFINITY;
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        excluded_.items.insert(excluded_.items.end(), near.begin(), near.end());
        excluded_.start.push_back(std::uint32_t(excluded_.items.size()));
    }
}

bool ContactSearch::update() {
    moved_ = farthest(vertices_.position, vertices_then_) + farthest(elements_.position, elements_then_);
    if (moved_ <= margin_) return false;
    find();
    return true;
}

void ContactSearch::find() {
    vertices_then_ = vertices_.position, elements_then_ = elements_.position;
    moved_ = 0;
    const auto& mesh = elements_.mesh();
    const double away = reach_ + margin_;
    candidates_.start.assign(1, 0), candidates_.items.clear();
    const Box around(elements_.position);
    // Every element stands in the cell of its first corner; the others are at most its present size away.
    double size = 0;
    for (const auto& [a, b, c] : mesh.elements)
        size = std::max({size, norm(elements_.position[a] - elements_.position[b]),
                         norm(elements_.position[a] - elements_.position[c])});
    const CellHash hash{away + size};
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
    const auto distance_to = [&](std::uint32_t e, const Vec3& x) {
        const auto& [ia, ib, ic] = mesh.elements[e];
        const Vec3 &a = elements_.position[ia], &b = elements_.position[ib], &c = elements_.position[ic];
        const auto w = elements_.planar() ? closest_on_segment(x, a, b) : closest_on_triangle(x, a, b, c);
        return norm(w[0] * a + w[1] * b + w[2] * c - x);
    };
    const Box near_vertices(vertices_.position);
    for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
        const Vec3& x = elements_.position[mesh.elements[e][0]];
        if (near_vertices.contains(x, away + size)) cells[hash(x)].push_back(e);
    }
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        const Vec3& x = vertices_.position[v];
        if (!cells.empty() && around.contains(x, away)) {
            const std::size_t first = candidates_.items.size();
            const std::int64_t i = hash.index(x.x), j = hash.index(x.y), k = hash.index(x.z);
            for (std::int64_t c = k - 1; c <= k + 1; ++c)
                for (std::int64_t b = j - 1; b <= j + 1; ++b)
                    for (std::int64_t a = i - 1; a <= i + 1; ++a) {
                        const auto found = cells.find(CellHash::key(a, b, c));
                        if (found == cells.end()) continue;
                        for (const std::uint32_t e : found->second) {
                            if (norm(elements_.position[mesh.elements[e][0]] - x) > away + size) continue;
                            if (excluded_.rows() > 0 && std::binary_search(excluded_.begin(v), excluded_.end(v), e))
                                continue;
                            if (const double distance = distance_to(e, x); distance <= away)
                                candidates_.items.push_back({e, distance});
                        }
                    }
            std::sort(candidates_.items.begin() + std::ptrdiff_t(first), candidates_.items.end(),
                      [](const Candidate& a, const Candidate& b) {
                          return a.distance != b.distance ? a.distance < b.distance : a.element < b.element;
                      });
        }
        candidates_.start.push_back(std::uint32_t(candidates_.items.size()));
    }
}

}   // namespace patency
