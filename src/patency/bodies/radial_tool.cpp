// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/radial_tool.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/smooth_rise.h"

namespace patency {

namespace {

/// How deep a place is in the tool, and which way is out.                                               THEORY (21.12)
class ToolShape {
public:
    ToolShape(RadialTool tool, std::size_t vertices)
        : tool_(std::move(tool)), along_(vertices), piece_(vertices, StentAxis::unseen), free_(vertices) {}

    void move(double time, double dt) {
        radius_ = tool_.radius(time);
        speed_ = dt > 0 ? (radius_ - tool_.radius(time - dt)) / dt : 0.0;
    }
    RigidHit hit(std::size_t vertex, const Vec3& x) {
        Free& free = free_[vertex];
        if (free.clearance > 0 && norm(x - free.place) + std::abs(radius_ - free.radius) < free.clearance) return {};
        const RigidHit found = look(vertex, x);
        free = {x, radius_, -share_trusted * std::min(0.0, found.depth)};
        return found;
    }
    double radius() const { return radius_; }
    double along(std::size_t vertex) const { return along_[vertex]; }

private:
    /// Where a vertex was found to be free, and how far it or the tool may move until it is looked at again.
    struct Free {
        Vec3 place;
        double radius = 0, clearance = 0;   // [m]
    };
    static constexpr double share_trusted =
        0.5;   // of the distance: an axis that bends changes it a little faster than x

    RigidHit look(std::size_t vertex, const Vec3& x) {
        const StentAxis::Sight at = tool_.axis.sight(x, piece_[vertex]);   // a vertex stays near where it was
        along_[vertex] = at.along;
        const double past = std::abs(at.along) - tool_.length / 2;
        if (tool_.kind == RadialTool::Kind::crimper) {
            if (past > 0) return {.depth = -past};
            if (at.radius <= radius_) return {.depth = at.radius - radius_};
            return {at.radius - radius_, -at.outward, speed_ * at.outward};
        }
        const double distance = past > 0 ? std::sqrt(at.radius * at.radius + past * past) : at.radius;
        if (distance >= radius_ || distance == 0) return {.depth = std::min(0.0, radius_ - distance)};
        Vec3 out = at.outward;
        if (past > 0) out = (at.radius / distance) * out + (std::copysign(past, at.along) / distance) * at.tangent;
        return {radius_ - distance, out, speed_ * out};
    }
    RadialTool tool_;
    std::vector<double> along_;
    std::vector<std::size_t> piece_;   // of the axis, where each vertex was seen
    std::vector<Free> free_;
    double radius_ = 0, speed_ = 0;
};

class ToolContact final : public Contact {
public:
    ToolContact(SolidSurface& surface, RadialTool tool, const ContactNumerics& numerics)
        : shape_(std::move(tool), surface.size()),
          contact_(
              surface, [this](std::size_t v, const Vec3& x, double) { return shape_.hit(v, x); }, numerics) {}

    void add_forces(double time, double dt) override {
        shape_.move(time, dt);
        contact_.add_forces(time, dt);
    }
    std::vector<Push> pushes() const override { return contact_.pushes(); }
    std::vector<double> state() const override { return contact_.state(); }
    void restore(std::span<const double> state) override { contact_.restore(state); }

    /// The pressure that would push as much on the cylinder between the outermost vertices that it touches.  THEORY (21.13)
    ContactReport report() const override {
        ContactReport report = contact_.report();
        double low = INFINITY, high = -INFINITY;
        for (const Push& p : contact_.pushes())
            low = std::min(low, shape_.along(p.vertex)), high = std::max(high, shape_.along(p.vertex));
        if (high > low) report.pressure = report.normal_force / (2 * std::numbers::pi * shape_.radius() * (high - low));
        return report;
    }

private:
    ToolShape shape_;
    RigidContact contact_;
};

}   // namespace

std::function<double(double)> ramped_radius(std::vector<double> times, std::vector<double> radii) {
    return [times = std::move(times), radii = std::move(radii)](double t) {
        const auto after = std::size_t(std::upper_bound(times.begin(), times.end(), t) - times.begin());
        if (after == 0) return radii.front();
        if (after == times.size()) return radii.back();
        return radii[after - 1] + (radii[after] - radii[after - 1]) *
                                      growing_rise((t - times[after - 1]) / (times[after] - times[after - 1]));
    };
}

std::unique_ptr<Contact> make_tool_contact(SolidSurface& surface, RadialTool tool, const ContactNumerics& numerics) {
    return std::make_unique<ToolContact>(surface, std::move(tool), numerics);
}

}   // namespace patency
