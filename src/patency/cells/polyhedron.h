// SPDX-License-Identifier: Apache-2.0
// A convex polyhedron that is cut down by planes. Its faces share their corners, so its area vectors sum to nothing to
// round-off whatever the cuts. Numbers are in a unit of about its own size; knows no particles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patency/base/vec.h"

namespace patency {

/// One face: area vector out of the polyhedron and centroid, and the label of the plane that made it.
struct PolyhedronFace {
    int label;
    Vec3 area, centroid;
};

struct PolyhedronVolume {
    double volume;
    Vec3 centroid;
};

class Polyhedron {
public:
    /// The cube |x|, |y|, |z| <= half, all faces labelled `label`.
    void reset(double half, int label);

    /// Keeps the part with normal . x <= offset (normal: unit). Returns whether anything was cut off; the new face has
    /// the label. What a plane merely touches, to 1e-12, stays.
    bool clip(const Vec3& normal, double offset, int label);

    bool is_empty() const { return start_.size() < 2; }
    double square_radius() const;   ///< of the farthest corner from the origin
    std::span<const Vec3> corners() const { return corner_; }
    std::size_t face_count() const { return label_.size(); }
    int label(std::size_t face) const { return label_[face]; }
    PolyhedronFace face(std::size_t f) const;
    /// The origin must be inside or on it.
    PolyhedronVolume volume() const;

private:
    // Face f: corners loop_[start_[f]] .. loop_[start_[f + 1]], counter-clockwise from outside.
    std::vector<Vec3> corner_;
    std::vector<std::uint16_t> loop_;
    std::vector<std::uint32_t> start_;
    std::vector<int> label_;

    struct Edge {   // a new corner between one that stays and one that goes
        std::uint16_t from, to, corner;
    };
    struct Side {   // of the new face
        std::uint16_t from, to;
    };
    std::uint16_t corner_between(std::uint16_t from, std::uint16_t to);
    void drop_unused_corners();

    std::vector<double> height_;
    std::vector<Edge> edges_;
    std::vector<Side> sides_;
    std::vector<std::uint16_t> new_loop_, kept_;
    std::vector<std::uint32_t> new_start_;
    std::vector<int> new_label_;
};

}   // namespace patency
