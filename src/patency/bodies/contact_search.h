// SPDX-License-Identifier: Apache-2.0
// Which elements of a surface may be near which vertices of another (or of itself) until either has moved a little.
#pragma once

#include "patency/bodies/solid_surface.h"

namespace patency {

class ContactSearch {
public:
    /// vertices, elements: may be one surface; then elements nearer than `apart` [m] along the surface are never near.
    ContactSearch(const SolidSurface& vertices, const SolidSurface& elements);

    /// Looks again where something has moved far enough to matter.
    void update();
    /// Elements that may come within reach() of a vertex before the next update.
    const Ragged<std::uint32_t>& candidates() const { return candidates_; }
    /// How deep a vertex may be in, and how far an element is looked for [m].
    double reach() const { return reach_; }

private:
    bool is_stale() const;
    void find();
    void exclude_near();

    const SolidSurface &vertices_, &elements_;
    double size_ = 0, reach_ = 0, margin_ = 0;   // of the largest element; [m]
    std::vector<Vec3> vertices_then_, elements_then_;
    Ragged<std::uint32_t> candidates_, excluded_;
};

}   // namespace patency
