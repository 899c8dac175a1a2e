// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_march.h"

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

constexpr int most_iterations = 60;   // of a step; a good one takes less than ten
constexpr double krylov_tolerance =
    0.01;   // where a stiff outlet is most of what is lacking, a tenth would leave the vessel as it is
constexpr double first_courant = 1e4, courant = 1e6;   // of cells, beside the step's own time

double place_of(const OpenEnd& end, double radius, const Vec3& x) {
    const Vec3 d = x - end.centre;
    return norm(d - dot(d, end.normal) * end.normal) / radius;
}

}   // namespace

CellMarch::CellMarch(CellMarchDomain domain)
    : domain_(std::move(domain)),
      matrix_(domain_.mesh),
      velocity_before_(domain_.fluid.velocity.begin(), domain_.fluid.velocity.end()),
      pressure_before_(domain_.fluid.pressure.begin(), domain_.fluid.pressure.end()),
      offset_(domain_.ends.size(), 0) {
    for (const OpenEnd& end : domain_.ends) end_pressure_before_.push_back(end.mean_pressure);
    for (std::size_t k = 0; k < domain_.ends.size(); ++k) {
        const MarchedEnd& marched = domain_.marched[k];
        feeding_.emplace_back(marched.section, marched.radius, marched.viscosity);
    }
    start_feeding();
    balance_ = std::make_unique<CellBalance>(domain_.mesh, domain_.material, ends_at(0), domain_.reference_speed);
}

void CellMarch::start_feeding() {
    constexpr double behind = 1, reach = 0.15;   // in radii: places that tell the profile, and how far each speaks
    for (std::size_t k = 0; k < domain_.ends.size(); ++k) {
        const OpenEnd& end = domain_.ends[k];
        const double radius = domain_.marched[k].radius;
        std::vector<double> places, speeds;
        for (std::size_t i = 0; i < domain_.fluid.size(); ++i) {
            const Vec3 x = domain_.fluid.position[i];
            if (!end.in_reach(x) || end.axial(x) < -behind * radius) continue;
            places.push_back(place_of(end, radius, x));
            speeds.push_back(-dot(domain_.fluid.velocity[i], end.normal));
        }
        feeding_[k].start_from(places, speeds, reach);
    }
}

FlowStep CellMarch::step(double time, double longest) {
    constexpr double growth = 2,
                     shortest =
                         1e-3;   // of steps from one to the next (2.4 is where (18.16) grows by itself); of the longest
    const double allowed = std::min(domain_.longest_step, dt_before_ > 0 ? growth * dt_before_ : domain_.first_step);
    const bool fits = longest <= allowed * (1 + 1e-6);   // no crumb of round-off is left behind
    const auto before = state();
    for (double dt = fits ? longest : allowed;; dt *= 0.5) {
        try {
            return step_of(time, dt);
        } catch (const DivergedError&) {   // a jolt: nearer to now it is a smaller one
            if (dt < shortest * domain_.longest_step) throw;
            restore(before);
        }
    }
}

FlowStep CellMarch::step_of(double time, double dt) {
    const TimeRate rate = TimeRate::of_steps(dt, dt_before_);
    update_wanted_pressures(domain_.ends, time, dt);
    for (DevelopedFlow& feeding : feeding_) feeding.begin_step(rate);
    balance_->set_ends(ends_at(time + dt));
    start_from_extrapolation(rate, dt);
    const int iterations = solve();
    const double fastest = hand_over();
    dt_before_ = dt;
    return {dt, iterations, fastest};
}

std::vector<CellEnd> CellMarch::ends_at(double time) {
    std::vector<CellEnd> ends;
    for (std::size_t k = 0; k < domain_.ends.size(); ++k) {
        const OpenEnd& end = domain_.ends[k];
        const MarchedEnd& marched = domain_.marched[k];
        const DevelopedFlow& feeding = feeding_[k];
        const auto inwards = [&](double (DevelopedFlow::*speed)(double) const) {
            return [&end, &feeding, speed, radius = marched.radius](const Vec3& x) {
                return -(feeding.*speed)(place_of(end, radius, x)) * end.normal;
            };
        };
        CellEnd now{.kind = marched.kind, .pressure = end.pressure + offset_[k], .resistance = end.resistance};
        now.velocity = inwards(&DevelopedFlow::unit);
        now.rest = inwards(&DevelopedFlow::rest);
        if (end.kind == OpenEnd::Kind::velocity) {
            now.flow = end.imposed_flow(time);
            if (marched.kind == CellEnd::Kind::velocity) now.rest = end.velocity(time);
        }
        ends.push_back(std::move(now));
    }
    return ends;
}

void CellMarch::start_from_extrapolation(const TimeRate& rate, double dt) {
    FluidParticles& fluid = domain_.fluid;
    const double ahead = dt_before_ > 0 ? dt / dt_before_ : 0;
    std::vector<Vec3> rest(fluid.size());
    CellFields start{std::vector<double>(fluid.size()), std::vector<Vec3>(fluid.size())};
    for_each_index(fluid.size(), [&](std::size_t i) {
        const Vec3 now = fluid.velocity[i];
        rest[i] = rate.last * now + rate.before * velocity_before_[i];
        start.velocity[i] = now + ahead * (now - velocity_before_[i]);
        start.pressure[i] = fluid.pressure[i] + ahead * (fluid.pressure[i] - pressure_before_[i]);
        velocity_before_[i] = now, pressure_before_[i] = fluid.pressure[i];
    });
    balance_->set_time_derivative(rate.now, rest);
    balance_->set_fields(start);
    std::vector<double> rise;
    for (std::size_t k = 0; k < domain_.ends.size(); ++k) {
        rise.push_back(ahead * (domain_.ends[k].mean_pressure - end_pressure_before_[k]));
        end_pressure_before_[k] = domain_.ends[k].mean_pressure;
    }
    balance_->raise_end_pressures(rise);
    balance_->set_least_scales(scales_);
    balance_->turn_ends();
}

int CellMarch::solve() {
    CellSolverSettings settings{.tolerance = domain_.each_step.tolerance,
                                .imbalance_share = 1,   // no more than all cells may lack together
                                .least_iterations = domain_.each_step.least,
                                .most_iterations = most_iterations,
                                .first_courant = first_courant,
                                .courant = courant,
                                .krylov_tolerance = krylov_tolerance,
                                .mixes_below = INFINITY,
                                .ends_may_turn = false};
    const CellFields start = balance_->fields();
    balance_->set_transport(cell_terms::sharp);
    try {
        return int(solve_instant(*balance_, matrix_, settings).history.size());
    } catch (
        const DivergedError&) {   // a start from rest, a jolt: the damped transport goes on in smaller steps where the sharp one does not
        const CellSolverSettings careful;
        settings.most_iterations = careful.most_iterations, settings.first_courant = careful.first_courant,
        settings.courant = careful.courant;
        settings.mixes_below = 0;
        balance_->set_fields(start);
        balance_->set_transport(cell_terms::damped);
        return int(solve_instant(*balance_, matrix_, settings).history.size()) + most_iterations;
    }
}

double CellMarch::hand_over() {
    const CellFields fields = balance_->fields();
    FluidParticles& fluid = domain_.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.velocity[i] = fields.velocity[i];
        fluid.pressure[i] = fields.pressure[i];
    }
    const auto states = balance_->end_states();
    const auto at_patch = balance_->patch_pressure();
    for (std::size_t k = 0; k < states.size(); ++k) {
        OpenEnd& end = domain_.ends[k];
        double of_cells = 0, area = 0;
        for (std::size_t n = 0; n < at_patch.size(); ++n)
            if (const CellPatch& patch = domain_.mesh.patches[n]; patch.opening == int(k))
                of_cells += norm(patch.area) * at_patch[n], area += norm(patch.area);
        of_cells /= area;
        end.flow = states[k].flow;
        const bool is_wanted = domain_.marched[k].kind == CellEnd::Kind::pressure;
        end.mean_pressure = is_wanted ? end.pressure + end.resistance * end.flow : of_cells;
        if (is_wanted) offset_[k] += end.mean_pressure - of_cells;
        feeding_[k].end_step(-end.flow / end.area);
    }
    scales_ = balance_->scales();
    return largest_of(fluid.size(), [&](std::size_t i) { return norm(fluid.velocity[i]); });
}

std::map<std::string, std::vector<double>> CellMarch::state() const {
    std::map<std::string, std::vector<double>> state;
    auto& before = state["velocity_before"];
    for (const Vec3& v : velocity_before_) before.insert(before.end(), {v.x, v.y, v.z});
    state["pressure_before"] = pressure_before_;
    state["end_pressure_before"] = end_pressure_before_;
    state["steps"] = {dt_before_, scales_.flow, scales_.force};
    state["ends"] = balance_->end_memory();
    state["offset"] = offset_;
    for (const DevelopedFlow& feeding : feeding_) {
        const auto own = feeding.state();
        state["feeding"].insert(state["feeding"].end(), own.begin(), own.end());
    }
    return state;
}

void CellMarch::restore(const std::map<std::string, std::vector<double>>& state) {
    const auto& before = state.at("velocity_before");
    for (std::size_t i = 0; i < velocity_before_.size(); ++i)
        velocity_before_[i] = {before[3 * i], before[3 * i + 1], before[3 * i + 2]};
    pressure_before_ = state.at("pressure_before");
    end_pressure_before_ = state.at("end_pressure_before");
    dt_before_ = state.at("steps")[0];
    scales_ = {state.at("steps")[1], state.at("steps")[2]};
    balance_->restore_end_memory(state.at("ends"));
    offset_ = state.at("offset");
    const std::span<const double> all = state.at("feeding");
    const std::size_t each = all.size() / feeding_.size();
    for (std::size_t k = 0; k < feeding_.size(); ++k) feeding_[k].restore(all.subspan(k * each, each));
}

}   // namespace patency
