// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/stent_metal.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace patency {

namespace {

// The metal is a body with sharp edges, grown by the edges' radius: this is that inner body.
class StentMetal {
public:
    StentMetal(const StrutCurves& curves, const StentAxis& axis)
        : map_(curves),
          axis_(axis),
          middle_(curves.middle_radius),
          half_(curves.thickness / 2 - curves.edge_radius),
          edge_(curves.edge_radius) {}

    DistanceSample sample(const Vec3& x) const {
        const StentPoint at = axis_.coordinates(x);
        const StrutSample strut = map_.sample({middle_ * at.angle, at.along});
        const double half_width = strut.half_width - edge_, away = strut.value + strut.half_width;
        const double over = at.radius - middle_;   // the wall's middle
        const bool beside = away > half_width, is_past_face = std::abs(over) > half_;
        const double radius = middle_ + std::clamp(over, -half_, half_);
        if (is_past_face && !beside) {
            const double value = std::abs(over) - half_, side = over > 0 ? 1 : -1;
            return {value - edge_, side * axis_.outward(at), side / at.radius};
        }
        const auto place_beside = [&](double way) {   // so far from the strut's centreline, in the plan
            return axis_.place({radius, (strut.foot.around + way * strut.direction.around) / middle_,
                                strut.foot.along + way * strut.direction.along});
        };
        const Vec3 foot = place_beside(half_width);
        const Vec3 to_foot = foot - x;
        const double distance = norm(to_foot);
        if (distance == 0) return {-edge_, normalized(place_beside(half_width + 0.01 * half_) - foot), 0};
        if (beside) return {distance - edge_, -to_foot / distance, is_past_face ? 1 / distance : 0};
        const double depth = half_ - std::abs(over);
        if (depth <= distance) {
            const double side = over >= 0 ? 1 : -1;
            return {-depth - edge_, side * axis_.outward(at), side / at.radius};
        }
        return {-distance - edge_, to_foot / distance, 0};
    }

private:
    StrutMap map_;
    StentAxis axis_;
    double middle_, half_, edge_;
};

}   // namespace

SignedDistance make_stent_metal(const StrutCurves& curves, const StentAxis& axis) {
    const auto metal = std::make_shared<const StentMetal>(curves, axis);
    const double r = outer_radius(curves);
    Bounds box{{Bounds::infinity, Bounds::infinity, Bounds::infinity},
               {-Bounds::infinity, -Bounds::infinity, -Bounds::infinity}};
    const int steps = 256;   // a sphere around each of many places of the axis holds the tube between them
    for (int k = 0; k <= steps; ++k) {
        const Vec3 at = axis.place({0, 0, curves.length * (double(k) / steps - 0.5)});
        box = joined(box, grown({at, at}, std::hypot(r, curves.length / steps)));
    }
    return {[metal](const Vec3& x) { return metal->sample(x); }, box};
}

double thickness_at(const StrutCurves& curves, double depth) {
    const double e = curves.edge_radius;
    if (depth <= 0) return 0;
    if (depth >= e) return curves.thickness;
    return curves.thickness - 2 * (e - std::sqrt(e * e - (e - depth) * (e - depth)));
}

}   // namespace patency
