// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/contact.h"

#include <algorithm>
#include <cmath>

#include "patency/base/parallel.h"
#include "patency/bodies/closest_point.h"
#include "patency/bodies/contact_search.h"
#include "patency/physics/solid/contact.h"

namespace patency {

namespace {

/// A vertex that is in: where it would come out.
struct Hit {
    double depth = 0;                 ///< [m]; zero: it is not in
    Vec3 normal;                      ///< of the way out
    std::uint32_t element = 0;
    std::array<double, 3> weights{};   ///< of the element's corners
};

/// A vertex of one surface against the elements of another.                                              THEORY (21.5)
Hit find_hit(const SolidSurface& own, std::size_t vertex, const SolidSurface& other, const ContactSearch& search) {
    const Vec3& x = own.position[vertex];
    const auto& mesh = other.mesh();
    double nearest = search.reach(), side = 0;
    Hit hit;
    bool is_inside = false;
    for (const std::uint32_t* e = search.candidates().begin(vertex); e < search.candidates().end(vertex); ++e) {
        const auto& [ia, ib, ic] = mesh.elements[*e];
        const Vec3 &a = other.position[ia], &b = other.position[ib], &c = other.position[ic];
        const auto weights = other.planar() ? closest_on_segment(x, a, b) : closest_on_triangle(x, a, b, c);
        const Vec3 way = weights[0] * a + weights[1] * b + weights[2] * c - x;
        const double distance = norm(way);
        const Vec3 across = other.planar() ? Vec3{b.y - a.y, a.x - b.x, 0} : cross(b - a, c - a);
        const double out = dot(way, across) / norm(across);   // positive: x lies behind the element
        // Where an edge or a corner is nearest its elements tie, and the one that x stands out of most tells the side.
        const bool is_tie = std::abs(distance - nearest) <= 1e-9 * nearest;
        if (is_tie ? std::abs(out) <= side : distance > nearest) continue;
        nearest = distance, side = std::abs(out), is_inside = out > 0;
        hit = {distance, distance > 0 ? way / distance : across / norm(across), *e, weights};
    }
    return is_inside ? hit : Hit{};
}

/// The vertices of one surface against the elements of another.
class Pass {
public:
    Pass(SolidSurface& own, SolidSurface& other, const ContactNumerics& numerics)
        : own_(own), other_(other), numerics_(numerics), search_(own, other), stick_(own.size()), hits_(own.size()), forces_(own.size()),
          losses_(own.size()), energies_(own.size()) {
        for (std::size_t v = 0; v < other.size(); ++v) lightest_ = std::min(lightest_, other.mass(v));
    }

    void add_forces(double dt) {
        search_.update();
        losses_.assign(own_.size(), 0);
        energies_.assign(own_.size(), 0);
        for_each_index(own_.size(), [&](std::size_t v) {
            hits_[v] = find_hit(own_, v, other_, search_);
            forces_[v] = hits_[v].depth > 0 ? push(v, hits_[v], dt) : Vec3{};
            if (hits_[v].depth == 0) stick_[v] = {};
        });
        total_ = {};
        for (std::size_t v = 0; v < own_.size(); ++v) {   // few, in one order: reactions meet at vertices
            const Hit& hit = hits_[v];
            if (hit.depth == 0) continue;
            own_.force[v] += forces_[v];
            for (std::size_t k = 0; k < 3; ++k)
                other_.force[other_.mesh().elements[hit.element][k]] -= hit.weights[k] * forces_[v];
            total_ += forces_[v];
            deepest_ = std::max(deepest_, hit.depth);
            friction_loss_ += losses_[v];
        }
    }

    void add_to(ContactReport& report, bool is_first) const {
        for (std::size_t v = 0; v < own_.size(); ++v) {
            report.touching += hits_[v].depth > 0;
            report.energy += energies_[v];
        }
        report.friction_loss += friction_loss_;
        report.deepest = std::max(report.deepest, deepest_);
        report.force += is_first ? total_ : -total_;
    }
    void add_to(std::vector<Contact::Push>& pushes, bool is_first) const {
        for (std::size_t v = 0; v < own_.size(); ++v) {
            const Hit& hit = hits_[v];
            if (hit.depth == 0) continue;
            if (is_first) pushes.push_back({std::uint32_t(v), forces_[v]});
            else
                for (std::size_t k = 0; k < (other_.planar() ? 2u : 3u); ++k)
                    pushes.push_back({other_.mesh().elements[hit.element][k], -hit.weights[k] * forces_[v]});
        }
    }

private:
    Vec3 push(std::size_t v, const Hit& hit, double dt) {
        const auto& corners = other_.mesh().elements[hit.element];
        Vec3 moving{};
        for (std::size_t k = 0; k < 3; ++k) moving += hit.weights[k] * other_.velocity[corners[k]];
        // The other's lightest vertex: a mass that changed with the place on it would do work.
        const double stiffness = penalty_stiffness(1 / (1 / own_.mass(v) + 1 / lightest_), numerics_.step);
        const double normal_force = stiffness * hit.depth;
        energies_[v] = 0.5 * stiffness * hit.depth * hit.depth;
        Vec3 force = normal_force * hit.normal;
        if (numerics_.friction > 0) {
            const FrictionState f =
                friction(stick_[v], dt * (own_.velocity[v] - moving), hit.normal, normal_force, stiffness, numerics_.friction);
            stick_[v] = f.stick, losses_[v] = f.loss;
            energies_[v] += 0.5 * stiffness * dot(f.stick, f.stick);
            force += f.force;
        }
        return force;
    }

    SolidSurface &own_, &other_;
    ContactNumerics numerics_;
    ContactSearch search_;
    std::vector<Vec3> stick_;
    std::vector<Hit> hits_;
    std::vector<Vec3> forces_;
    std::vector<double> losses_, energies_;
    Vec3 total_;
    double friction_loss_ = 0, deepest_ = 0, lightest_ = INFINITY;
};

class SurfaceContact final : public Contact {
public:
    SurfaceContact(SolidSurface& first, SolidSurface& second, const ContactNumerics& numerics) {
        passes_.push_back(std::make_unique<Pass>(first, second, numerics));
        if (&first != &second) passes_.push_back(std::make_unique<Pass>(second, first, numerics));
    }
    void add_forces(double dt) override {
        for (auto& pass : passes_) pass->add_forces(dt);
    }
    ContactReport report() const override {
        ContactReport report;
        for (std::size_t k = 0; k < passes_.size(); ++k) passes_[k]->add_to(report, k == 0);
        return report;
    }
    std::vector<Push> pushes() const override {
        std::vector<Push> all;
        for (std::size_t k = 0; k < passes_.size(); ++k) passes_[k]->add_to(all, k == 0);
        return all;
    }

private:
    std::vector<std::unique_ptr<Pass>> passes_;
};

class PlaneContact final : public Contact {
public:
    PlaneContact(SolidSurface& surface, const Vec3& point, const Vec3& normal, const ContactNumerics& numerics)
        : surface_(surface), point_(point), normal_(normal), numerics_(numerics), stick_(surface.size()), force_(surface.size()),
          energy_(surface.size()), loss_(surface.size()) {}

    void add_forces(double dt) override {
        for_each_index(surface_.size(), [&](std::size_t v) { push(v, dt); });
        for (std::size_t v = 0; v < surface_.size(); ++v) friction_loss_ += loss_[v];
        deepest_ = std::max(deepest_, largest_of(surface_.size(), [&](std::size_t v) { return depth(v); }));
    }
    ContactReport report() const override {
        ContactReport report{.friction_loss = friction_loss_, .deepest = deepest_};
        for (std::size_t v = 0; v < surface_.size(); ++v) {
            report.energy += energy_[v], report.force += force_[v];
            report.touching += norm(force_[v]) > 0;
        }
        return report;
    }
    std::vector<Push> pushes() const override {
        std::vector<Push> all;
        for (std::size_t v = 0; v < surface_.size(); ++v)
            if (norm(force_[v]) > 0) all.push_back({std::uint32_t(v), force_[v]});
        return all;
    }

private:
    double depth(std::size_t v) const { return std::max(0.0, dot(point_ - surface_.position[v], normal_)); }

    void push(std::size_t v, double dt) {
        const double deep = depth(v);
        force_[v] = {}, energy_[v] = loss_[v] = 0;
        if (deep == 0) {
            stick_[v] = {};
            return;
        }
        const double stiffness = penalty_stiffness(surface_.mass(v), numerics_.step), normal_force = stiffness * deep;
        force_[v] = normal_force * normal_;
        energy_[v] = 0.5 * stiffness * deep * deep;
        if (numerics_.friction > 0) {
            const FrictionState f = friction(stick_[v], dt * surface_.velocity[v], normal_, normal_force, stiffness, numerics_.friction);
            stick_[v] = f.stick, loss_[v] = f.loss;
            energy_[v] += 0.5 * stiffness * dot(f.stick, f.stick);
            force_[v] += f.force;
        }
        surface_.force[v] += force_[v];
    }

    SolidSurface& surface_;
    Vec3 point_, normal_;
    ContactNumerics numerics_;
    std::vector<Vec3> stick_, force_;
    std::vector<double> energy_, loss_;
    double friction_loss_ = 0, deepest_ = 0;
};

}   // namespace

std::unique_ptr<Contact> make_surface_contact(SolidSurface& first, SolidSurface& second, const ContactNumerics& numerics) {
    return std::make_unique<SurfaceContact>(first, second, numerics);
}

std::unique_ptr<Contact> make_plane_contact(SolidSurface& surface, const Vec3& point, const Vec3& normal, const ContactNumerics& numerics) {
    return std::make_unique<PlaneContact>(surface, point, normal, numerics);
}

}   // namespace patency
