// SPDX-License-Identifier: Apache-2.0
#include "patency/cells/polyhedron.h"

#include <algorithm>
#include <limits>

namespace patency {

namespace {

constexpr double touching = 1e-12;   // of the unit: round-off of a few cuts
constexpr std::uint16_t none = std::numeric_limits<std::uint16_t>::max();

}   // namespace

void Polyhedron::reset(double half, int label) {
    corner_.clear();
    for (int k = 0; k < 8; ++k) corner_.push_back({k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half});
    loop_ = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    start_ = {0, 4, 8, 12, 16, 20, 24};
    label_.assign(6, label);
}

double Polyhedron::square_radius() const {
    double largest = 0;
    for (const Vec3& x : corner_) largest = std::max(largest, dot(x, x));
    return largest;
}

std::uint16_t Polyhedron::corner_between(std::uint16_t from, std::uint16_t to) {
    if (height_[from] >= 0) return from;   // on the plane
    for (const Edge& edge : edges_)
        if (edge.from == from && edge.to == to) return edge.corner;
    const double share = height_[from] / (height_[from] - height_[to]);
    const auto corner = std::uint16_t(corner_.size());
    corner_.push_back(corner_[from] + share * (corner_[to] - corner_[from]));
    edges_.push_back({from, to, corner});
    return corner;
}

bool Polyhedron::clip(const Vec3& normal, double offset, int label) {
    height_.resize(corner_.size());
    bool is_cut = false;
    for (std::size_t k = 0; k < corner_.size(); ++k) {
        height_[k] = dot(normal, corner_[k]) - offset;
        is_cut = is_cut || height_[k] > touching;
    }
    if (!is_cut) return false;

    edges_.clear();
    sides_.clear();
    new_loop_.clear();
    new_start_.assign(1, 0);
    new_label_.clear();
    const auto stays = [&](std::uint16_t corner) { return height_[corner] <= touching; };
    for (std::size_t f = 0; f < label_.size(); ++f) {
        const std::size_t begin = start_[f], end = start_[f + 1], first = new_loop_.size();
        std::uint16_t out = none, in = none;   // where the face leaves and enters again
        const auto put = [&](std::uint16_t corner) {
            if (new_loop_.size() == first || new_loop_.back() != corner) new_loop_.push_back(corner);
        };
        std::uint16_t last = loop_[end - 1];
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint16_t here = loop_[k];
            if (stays(last) && !stays(here)) put(out = corner_between(last, here));
            if (!stays(last) && stays(here)) put(in = corner_between(here, last));
            if (stays(here)) put(here);
            last = here;
        }
        if (out != none && in != none && out != in) sides_.push_back({in, out});
        if (new_loop_.size() > first + 1 && new_loop_.back() == new_loop_[first]) new_loop_.pop_back();
        if (new_loop_.size() < first + 3) {
            new_loop_.resize(first);
            continue;
        }
        new_start_.push_back(std::uint32_t(new_loop_.size()));
        new_label_.push_back(label_[f]);
    }
    // The new face goes along the sides that the cut faces leave open, against their sense.
    if (sides_.size() >= 3) {
        const std::uint16_t begin = sides_[0].from;
        std::uint16_t at = begin;
        std::size_t count = 0;
        do {
            new_loop_.push_back(at);
            const auto next = std::find_if(sides_.begin(), sides_.end(), [&](const Side& s) { return s.from == at; });
            if (next == sides_.end()) break;
            at = next->to;
        } while (at != begin && ++count < sides_.size());
        new_start_.push_back(std::uint32_t(new_loop_.size()));
        new_label_.push_back(label);
    }
    loop_.swap(new_loop_);
    start_.swap(new_start_);
    label_.swap(new_label_);
    drop_unused_corners();
    return true;
}

void Polyhedron::drop_unused_corners() {
    kept_.assign(corner_.size(), none);
    std::uint16_t count = 0;
    for (const std::uint16_t corner : loop_) kept_[corner] = 0;
    for (std::size_t k = 0; k < corner_.size(); ++k)
        if (kept_[k] != none) {
            corner_[count] = corner_[k];
            kept_[k] = count++;
        }
    corner_.resize(count);
    for (std::uint16_t& corner : loop_) corner = kept_[corner];
}

PolyhedronFace Polyhedron::face(std::size_t f) const {
    const std::size_t begin = start_[f], end = start_[f + 1];
    const Vec3 o = corner_[loop_[begin]];
    Vec3 area{}, moment{};
    for (std::size_t k = begin + 1; k + 1 < end; ++k)
        area += 0.5 * cross(corner_[loop_[k]] - o, corner_[loop_[k + 1]] - o);
    double sum = 0;
    for (std::size_t k = begin + 1; k + 1 < end; ++k) {
        const Vec3 a = corner_[loop_[k]] - o, b = corner_[loop_[k + 1]] - o;
        const double weight = 0.5 * dot(cross(a, b), area);
        sum += weight;
        moment += (weight / 3) * (a + b);
    }
    return {label_[f], area, sum > 0 ? o + moment / sum : o};
}

PolyhedronVolume Polyhedron::volume() const {
    double sum = 0;
    Vec3 moment{};
    for (std::size_t f = 0; f < label_.size(); ++f) {
        const Vec3& o = corner_[loop_[start_[f]]];
        for (std::size_t k = start_[f] + 1; k + 1 < start_[f + 1]; ++k) {
            const Vec3 &a = corner_[loop_[k]], &b = corner_[loop_[k + 1]];
            const double part = dot(o, cross(a, b)) / 6;
            sum += part;
            moment += (part / 4) * (o + a + b);
        }
    }
    return {sum, sum > 0 ? moment / sum : Vec3{}};
}

}   // namespace patency
