// SPDX-License-Identifier: Apache-2.0
// Which elements of a surface may be near which vertices of another (or of itself) until either has moved a little.
#pragma once

#include "patency/bodies/solid_surface.h"

namespace patency {

class ContactSearch {
public:
    /// vertices, elements: may be one surface; then elements nearer than `apart` [m] along the surface are never near.
    ContactSearch(const SolidSurface& vertices, const SolidSurface& elements);

    /// Looks again where something has moved far enough to matter; returns whether it did.
    bool update();
    /// An element that may come within reach() of a vertex before the next update, and how far away it was when it was looked for [m].
    struct Candidate {
        std::uint32_t element;
        double distance;
    };
    /// Per vertex, the nearest first.
    const Ragged<Candidate>& candidates() const { return candidates_; }
    /// Asks for the nearest candidates of a vertex that will be looked at soon: they lie far apart in memory.
    void prefetch(std::size_t vertex) const {
        if (vertex < candidates_.rows()) __builtin_prefetch(candidates_.begin(vertex));
    }
    /// How far vertices and elements together have moved at most since then, as of the last update [m].
    double moved() const { return moved_; }
    /// The element whose normal tells where the outside of this one is: itself, or, where it is so thin that a bending of what carries it may
    /// turn it over, a neighbour that faced most nearly the same way in the reference configuration.
    std::uint32_t facing(std::uint32_t element) const { return facing_[element]; }
    /// Height over the longest side below which an element is thin.
    static constexpr double thin = 0.05;
    /// How deep a vertex may be in, and how far an element is looked for [m].
    double reach() const { return reach_; }

private:
    void find();
    void exclude_near();
    void find_facing();

    const SolidSurface &vertices_, &elements_;
    double size_ = 0, reach_ = 0, margin_ = 0, moved_ = 0;   // size: of the largest element; [m]
    std::vector<Vec3> vertices_then_, elements_then_;
    Ragged<Candidate> candidates_;
    Ragged<std::uint32_t> excluded_;
    std::vector<std::uint32_t> facing_;
};

}   // namespace patency
