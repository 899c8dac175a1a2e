// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/contact.h"

#include <algorithm>
#include <cmath>

#include "patency/base/parallel.h"
#include "patency/bodies/contact_hit.h"
#include "patency/bodies/contact_search.h"

namespace patency {

namespace {

/// What a vertex feels that is in, and what that costs.
struct Touch {
    Vec3 force;                                                // [N]
    double push = 0, unsprung = 0, approach = 0, energy = 0;   // N, N, m/s before the step, J
    double friction_loss = 0;                                  // in this step [J]
};

/// What a damper and what is held took in the step before, at the mean of the velocities before and after it, as they did. [J]
double damping_loss(const Touch& then, double approach_now, double step) {
    return 0.5 * step * then.unsprung * (then.approach + approach_now);
}

/// held: of the push, beside the spring's [N]; velocity: against what it touches [m/s]; stick: before the step, then after it [m].
///                                                                                     THEORY (21.8), (21.9), (21.11)
Touch touch(const ContactNumerics& numerics, double stiffness, double depth, double held, const Vec3& normal,
            const Vec3& velocity, double dt, Vec3& stick) {
    const double approach = -dot(velocity, normal);
    const NormalPush push = normal_push(stiffness, depth, held, approach, numerics.damping, numerics.step);
    Touch result{
        push.force * normal, push.force, push.unsprung, approach, 0.5 * stiffness * std::max(0.0, depth) * depth, 0};
    if (numerics.friction > 0) {
        const FrictionState f = friction(stick, dt * velocity, normal, push.force, stiffness, numerics.friction);
        stick = f.stick;
        result.force += f.force;
        result.energy += 0.5 * stiffness * dot(f.stick, f.stick);
        result.friction_loss = f.loss;
    }
    return result;
}

/// Numbers one after another, and back.
class StateWriter {
public:
    void add(double x) { numbers_.push_back(x); }
    void add(const Vec3& v) { numbers_.insert(numbers_.end(), {v.x, v.y, v.z}); }
    std::vector<double> take() { return std::move(numbers_); }

private:
    std::vector<double> numbers_;
};
class StateReader {
public:
    explicit StateReader(std::span<const double> numbers) : numbers_(numbers) {}
    double next() { return numbers_[at_++]; }
    Vec3 next_vector() {
        const double x = next(), y = next(), z = next();
        return {x, y, z};
    }

private:
    std::span<const double> numbers_;
    std::size_t at_ = 0;
};

/// The vertices of one surface against the elements of another.
class Pass {
public:
    Pass(SolidSurface& own, SolidSurface& other, const ContactNumerics& numerics)
        : own_(own),
          other_(other),
          numerics_(numerics),
          search_(own, other),
          stick_(own.size()),
          held_(own.size()),
          hits_(own.size()),
          is_in_(own.size()),
          free_(own.size()),
          touches_(own.size()),
          losses_(own.size()) {
        for (std::size_t v = 0; v < other.size(); ++v) lightest_ = std::min(lightest_, other.mass(v));
    }

    void add_forces(double dt) {
        if (search_.update()) free_.assign(own_.size(), {});
        for_each_index(own_.size(), [&](std::size_t v) {
            if (is_in_[v] && touches_[v].unsprung != 0) losses_[v] = damping_loss(touches_[v], approach(v), last_step_);
        });
        for (std::size_t v = 0; v < own_.size(); ++v)
            if (is_in_[v] && touches_[v].unsprung != 0) damping_loss_ += losses_[v];
        last_step_ = dt;
        for_each_index(own_.size(), [&](std::size_t v) {
            constexpr std::size_t soon = 16;   // vertices: waiting for memory took half of finding hits
            search_.prefetch(v + soon);
            ContactHit hit;
            if (is_in_[v] || !is_free(v)) {
                hit = find_contact_hit(own_.position[v], v, other_, search_, free_[v].clearance);
                free_[v].moved = search_.moved();
            }
            const bool is_in = hit.depth > 0 || (hit.depth < 0 && stiffness(v) * hit.depth + held_[v] > 0);
            if (!is_in && !is_in_[v]) return;   // most of them: nothing changes
            is_in_[v] = is_in;
            if (is_in)
                hits_[v] = hit, touches_[v] = touch_at(v, dt);
            else
                hits_[v] = {}, touches_[v] = {}, stick_[v] = {}, held_[v] = 0;
        });
        for (std::size_t v = 0; v < own_.size(); ++v) {   // few, in one order: reactions meet at vertices
            if (!is_in_[v]) continue;
            const ContactHit& hit = hits_[v];
            own_.force[v] += touches_[v].force;
            for (std::size_t k = 0; k < 3; ++k)
                other_.force[other_.mesh().elements[hit.element][k]] -= hit.weights[k] * touches_[v].force;
            deepest_ = std::max(deepest_, hit.depth);
            friction_loss_ += touches_[v].friction_loss;
        }
    }

    void add_to(ContactReport& report, bool is_first) const {
        for (std::size_t v = 0; v < own_.size(); ++v) {
            report.touching += hits_[v].depth != 0;
            report.energy += touches_[v].energy;
            report.normal_force += touches_[v].push;
            report.force += is_first ? touches_[v].force : -touches_[v].force;
        }
        report.friction_loss += friction_loss_;
        report.damping_loss += damping_loss_;
        report.deepest = std::max(report.deepest, deepest_);
    }
    void add_to(std::vector<Contact::Push>& pushes, bool is_first) const {
        for (std::size_t v = 0; v < own_.size(); ++v) {
            const ContactHit& hit = hits_[v];
            if (hit.depth == 0) continue;
            if (is_first)
                pushes.push_back({std::uint32_t(v), touches_[v].force});
            else
                for (std::size_t k = 0; k < (other_.planar() ? 2u : 3u); ++k)
                    pushes.push_back({other_.mesh().elements[hit.element][k], -hit.weights[k] * touches_[v].force});
        }
    }

    void add_state(StateWriter& state) const {
        for (const double x : {friction_loss_, damping_loss_, deepest_, last_step_}) state.add(x);
        for (std::size_t v = 0; v < own_.size(); ++v) {
            const ContactHit& hit = hits_[v];
            state.add(stick_[v]), state.add(held_[v]), state.add(hit.depth), state.add(hit.normal),
                state.add(double(hit.element));
            for (const double w : hit.weights) state.add(w);
            const Touch& t = touches_[v];
            state.add(t.force);
            for (const double x : {t.push, t.unsprung, t.approach, t.energy}) state.add(x);
        }
    }
    void restore(StateReader& state) {
        for (double* x : {&friction_loss_, &damping_loss_, &deepest_, &last_step_}) *x = state.next();
        for (std::size_t v = 0; v < own_.size(); ++v) {
            ContactHit& hit = hits_[v];
            stick_[v] = state.next_vector(), held_[v] = state.next(), hit.depth = state.next(),
            hit.normal = state.next_vector(), hit.element = std::uint32_t(state.next());
            for (double& w : hit.weights) w = state.next();
            is_in_[v] = hit.depth != 0;
            Touch& t = touches_[v];
            t.force = state.next_vector();
            for (double* x : {&t.push, &t.unsprung, &t.approach, &t.energy}) *x = state.next();
        }
    }

private:
    /// How far a vertex was from all elements, and how far either may have moved then, as counted from the last search [m].
    struct Free {
        double clearance = 0, moved = 0;
    };
    bool is_free(std::size_t v) const { return free_[v].clearance * (1 - 1e-9) > free_[v].moved + search_.moved(); }

    /// Against the place of the other surface that it hit.
    Vec3 velocity(std::size_t v) const {
        const ContactHit& hit = hits_[v];
        const auto& corners = other_.mesh().elements[hit.element];
        Vec3 moving{};
        for (std::size_t k = 0; k < 3; ++k) moving += hit.weights[k] * other_.velocity(corners[k]);
        return own_.velocity(v) - moving;
    }
    double approach(std::size_t v) const { return -dot(velocity(v), hits_[v].normal); }

    /// With the other's lightest vertex: a mass that changed with the place on it would do work. [kg]
    double joint_mass(std::size_t v) const { return 1 / (1 / own_.mass(v) + 1 / lightest_); }
    double stiffness(std::size_t v) const { return penalty_stiffness(joint_mass(v), numerics_.step); }

    Touch touch_at(std::size_t v, double dt) {
        const ContactHit& hit = hits_[v];
        const double k = stiffness(v), heavier = lightest_ / joint_mass(v);   // what is pushed moves so much slower
        held_[v] = held_push(held_[v], numerics_.hold, k, hit.depth, dt, heavier * numerics_.step);
        return touch(numerics_, k, hit.depth, held_[v], hit.normal, velocity(v), dt, stick_[v]);
    }

    SolidSurface &own_, &other_;
    ContactNumerics numerics_;
    ContactSearch search_;
    std::vector<Vec3> stick_;
    std::vector<double> held_;   // of the pushes [N]
    std::vector<ContactHit> hits_;
    std::vector<std::uint8_t> is_in_;   // whether it is pushed: in, or held
    std::vector<Free> free_;
    std::vector<Touch> touches_;
    std::vector<double> losses_;
    double friction_loss_ = 0, damping_loss_ = 0, deepest_ = 0, last_step_ = 0, lightest_ = INFINITY;
};

class SurfaceContact final : public Contact {
public:
    SurfaceContact(SolidSurface& first, SolidSurface& second, const ContactNumerics& numerics) {
        passes_.push_back(std::make_unique<Pass>(first, second, numerics));
        if (&first != &second) passes_.push_back(std::make_unique<Pass>(second, first, numerics));
    }
    void add_forces(double, double dt) override {
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
    std::vector<double> state() const override {
        StateWriter state;
        for (const auto& pass : passes_) pass->add_state(state);
        return state.take();
    }
    void restore(std::span<const double> numbers) override {
        StateReader state(numbers);
        for (auto& pass : passes_) pass->restore(state);
    }

private:
    std::vector<std::unique_ptr<Pass>> passes_;
};

}   // namespace

std::unique_ptr<Contact> make_surface_contact(SolidSurface& first, SolidSurface& second,
                                              const ContactNumerics& numerics) {
    return std::make_unique<SurfaceContact>(first, second, numerics);
}

RigidContact::RigidContact(SolidSurface& surface, HitOf hit_of, const ContactNumerics& numerics)
    : surface_(surface),
      hit_of_(std::move(hit_of)),
      numerics_(numerics),
      stick_(surface.size()),
      touches_(surface.size()) {}

void RigidContact::add_forces(double time, double dt) {
    const auto is_nothing = [](const Touch& t) { return t.depth == 0 && t.damping_loss == 0; };
    for_each_index(surface_.size(), [&](std::size_t v) {
        const Touch now = touch_at(v, time, dt);
        if (is_nothing(now) && is_nothing(touches_[v])) return;   // most of them
        touches_[v] = now;
        surface_.force[v] += now.force;
    });
    for (const Touch& t : touches_) {
        if (is_nothing(t)) continue;
        friction_loss_ += t.friction_loss, damping_loss_ += t.damping_loss, work_ += t.work;
        deepest_ = std::max(deepest_, t.depth);
    }
    last_step_ = dt;
}

RigidContact::Touch RigidContact::touch_at(std::size_t v, double time, double dt) {
    const Touch& then = touches_[v];
    const double loss = then.unsprung == 0
                            ? 0.0
                            : 0.5 * last_step_ * then.unsprung *
                                  (then.approach + then.tool_speed - dot(surface_.velocity(v), then.normal));
    const RigidHit hit = hit_of_(v, surface_.position[v], time);
    if (!(hit.depth > 0)) {
        if (then.depth > 0) stick_[v] = {};
        return {.damping_loss = loss};
    }
    const double stiffness = penalty_stiffness(surface_.mass(v), numerics_.step);
    const auto t =
        touch(numerics_, stiffness, hit.depth, 0, hit.normal, surface_.velocity(v) - hit.velocity, dt, stick_[v]);
    return {t.force,
            hit.normal,
            t.push,
            t.unsprung,
            hit.depth,
            t.energy,
            t.approach,
            dot(hit.velocity, hit.normal),
            t.friction_loss,
            loss,
            dt * dot(t.force, hit.velocity)};
}

ContactReport RigidContact::report() const {
    ContactReport report{
        .friction_loss = friction_loss_, .damping_loss = damping_loss_, .work = work_, .deepest = deepest_};
    for (const Touch& t : touches_) {
        report.energy += t.energy, report.force += t.force, report.normal_force += t.push;
        report.touching += t.depth > 0;
    }
    return report;
}

std::vector<Contact::Push> RigidContact::pushes() const {
    std::vector<Push> all;
    for (std::size_t v = 0; v < touches_.size(); ++v)
        if (touches_[v].depth > 0) all.push_back({std::uint32_t(v), touches_[v].force});
    return all;
}

std::vector<double> RigidContact::state() const {
    StateWriter state;
    for (const double x : {friction_loss_, damping_loss_, work_, deepest_, last_step_}) state.add(x);
    for (std::size_t v = 0; v < touches_.size(); ++v) {
        const Touch& t = touches_[v];
        state.add(stick_[v]), state.add(t.force), state.add(t.normal);
        for (const double x : {t.push, t.unsprung, t.depth, t.energy, t.approach, t.tool_speed}) state.add(x);
    }
    return state.take();
}

void RigidContact::restore(std::span<const double> numbers) {
    StateReader state(numbers);
    for (double* x : {&friction_loss_, &damping_loss_, &work_, &deepest_, &last_step_}) *x = state.next();
    for (std::size_t v = 0; v < touches_.size(); ++v) {
        Touch& t = touches_[v];
        stick_[v] = state.next_vector(), t.force = state.next_vector(), t.normal = state.next_vector();
        for (double* x : {&t.push, &t.unsprung, &t.depth, &t.energy, &t.approach, &t.tool_speed}) *x = state.next();
    }
}

std::unique_ptr<Contact> make_plane_contact(SolidSurface& surface, const Vec3& point, const Vec3& normal,
                                            const ContactNumerics& numerics) {
    return std::make_unique<RigidContact>(
        surface,
        [=](std::size_t, const Vec3& x, double) {
            return RigidHit{dot(point - x, normal), normal, {}};
        },
        numerics);
}

}   // namespace patency
