// SPDX-License-Identifier: Apache-2.0
// From where a vessel is looked at, the same for the page's pictures and its first view.
#pragma once

#include <span>

#include "patency/base/vec.h"

namespace patency {

/// Directions of the page; right-handed, unit length.
struct View {
    Vec3 right{1, 0, 0}, up{0, 1, 0}, toward{0, 0, 1};
};

/// The view in which the points spread widest: along the direction of their least spread, the widest across. Signs are those of the
/// coordinates: what grows mostly goes right and up.
View broad_view(std::span<const Vec3> points);

}   // namespace patency
