// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/signed_distance.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>

namespace patency {

namespace {

Vec3 smaller(const Vec3& a, const Vec3& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 larger(const Vec3& a, const Vec3& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

}   // namespace

Bounds joined(const Bounds& a, const Bounds& b) { return {smaller(a.low, b.low), larger(a.high, b.high)}; }
Bounds common(const Bounds& a, const Bounds& b) { return {larger(a.low, b.low), smaller(a.high, b.high)}; }
Bounds grown(const Bounds& a, double margin) {
    const Vec3 m{margin, margin, margin};
    return {a.low - m, a.high + m};
}

RigidMotion motion_along(const Vec3& direction, const Vec3& origin) {
    const Vec3 ex = normalized(direction);
    // The y axis stays as near as it can to the world's, so that the x direction itself means no rotation.
    const Vec3 guide = std::abs(ex.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{-1, 0, 0};
    const Vec3 ey = normalized(guide - dot(guide, ex) * ex);
    return {transpose(Mat3{ex, ey, cross(ex, ey)}), origin};
}

Bounds moved(const Bounds& bounds, const RigidMotion& motion) {
    // Interval arithmetic per term, so that an infinite side along an axis that is not turned stays where it is.
    const auto interval = [&](const Vec3& row, double shift) {
        double low = shift, high = shift;
        const double factor[3] = {row.x, row.y, row.z};
        const double from[3] = {bounds.low.x, bounds.low.y, bounds.low.z};
        const double to[3] = {bounds.high.x, bounds.high.y, bounds.high.z};
        for (int k = 0; k < 3; ++k) {
            if (factor[k] == 0) continue;
            low += std::min(factor[k] * from[k], factor[k] * to[k]);
            high += std::max(factor[k] * from[k], factor[k] * to[k]);
        }
        return std::pair{low, high};
    };
    const auto [x0, x1] = interval(motion.rotation.x, motion.origin.x);
    const auto [y0, y1] = interval(motion.rotation.y, motion.origin.y);
    const auto [z0, z1] = interval(motion.rotation.z, motion.origin.z);
    return {{x0, y0, z0}, {x1, y1, z1}};
}

SignedDistance made_when_asked(std::function<SignedDistance()> make, const Bounds& bounds) {
    struct Later {
        std::function<SignedDistance()> make;
        std::once_flag once{};
        std::optional<SignedDistance> distance{};

        const SignedDistance& get() {
            std::call_once(once, [&] {
                distance = make();
                make = {};   // and what it holds
            });
            return *distance;
        }
    };
    const auto later = std::make_shared<Later>();
    later->make = std::move(make);
    return {[later](const Vec3& x) { return later->get().sample(x); }, bounds,
            [later](const Vec3& x, double reach) { return later->get().sample_within(x, reach); }};
}

double curvature_by_differences(const SignedDistance& distance, const Vec3& x, double step) {
    const auto slope = [&](const Vec3& e) {
        return dot(e, distance.gradient(x + step * e) - distance.gradient(x - step * e)) / (2 * step);
    };
    return slope({1, 0, 0}) + slope({0, 1, 0}) + slope({0, 0, 1});
}

SignedDistance union_of(SignedDistance a, SignedDistance b) {
    const Bounds bounds = joined(a.bounds(), b.bounds());
    return {[a = std::move(a), b = std::move(b)](const Vec3& x) {
                const DistanceSample in_a = a.sample(x), in_b = b.sample(x);
                return in_a.value <= in_b.value ? in_a : in_b;
            },
            bounds};
}

SignedDistance intersection_of(SignedDistance a, SignedDistance b) {
    const Bounds bounds = common(a.bounds(), b.bounds());
    return {[a = std::move(a), b = std::move(b)](const Vec3& x) {
                const DistanceSample in_a = a.sample(x), in_b = b.sample(x);
                return in_a.value >= in_b.value ? in_a : in_b;
            },
            bounds};
}

SignedDistance complement_of(SignedDistance a) {
    return {[a = std::move(a)](const Vec3& x) {
                const DistanceSample s = a.sample(x);
                return DistanceSample{-s.value, -s.gradient, -s.curvature};
            },
            Bounds{}};
}

SignedDistance offset_by(SignedDistance a, double distance) {
    const Bounds bounds = grown(a.bounds(), distance);
    return {[a = std::move(a), distance](const Vec3& x) {
                DistanceSample s = a.sample(x);
                s.value -= distance;
                return s;
            },
            bounds};
}

SignedDistance moved(SignedDistance a, const RigidMotion& motion) {
    const Bounds bounds = moved(a.bounds(), motion);
    return {[a = std::move(a), motion](const Vec3& x) {
                DistanceSample s = a.sample(motion.place_back(x));
                s.gradient = motion.turn(s.gradient);
                return s;
            },
            bounds};
}

}   // namespace patency
