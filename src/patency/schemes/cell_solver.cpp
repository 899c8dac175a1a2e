// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/schemes/cell_krylov.h"
#include "patency/schemes/cell_mixing.h"

namespace patency {

namespace {

// A linear solve that leaves more than this of the residual gets nowhere: the step is too long for it.
constexpr double stagnant = 0.5;
constexpr int most_cures = 6;
constexpr double unsteady = 0.05, first_limit = 100;   // of the forces lacked; of the steps until then
constexpr double runaway = 100;   // growth of the residual over the least so far that is no detour any more

constexpr std::size_t mixed_steps =
    30;   // fewer do not quieten the jet behind a lesion of 0.6 mm (a real left coronary tree at hyperaemia)
constexpr double rising = 1.5, shrink = 0.5;   // where more is lacked by that than a step ago, the next step is shorter

/// Of the pressure's own term in a step. With little of it a step is nearly Newton's, which finds the pressure behind a
/// lesion at once instead of letting it drain; but far from the answer that throws the blood about.   THEORY.md (18.12)
double pressure_share(double momentum_residual) {
    constexpr double most = 1e-3, least = 1e-5, near = 0.1;
    return std::clamp(most * std::pow(momentum_residual / near, 3), least, most);
}

/// Tells a jet that goes on swinging behind a lesion, where no steady flow is or none can be found, from a solution on its way.
class StallWatch {
public:
    static constexpr std::size_t window = 60;   // steps
    static constexpr double progress = 0.5;     // of the residual in a window, or nothing is gained
    static constexpr double standing =
        5e-3;   // swing of the openings in a window that is none, as numerics.convergence has it
    static constexpr double bearable = 0.05;   // swing around means that are still an answer, marked

    void add(double residual, const std::vector<CellEndState>& ends) {
        residuals_.push_back(residual);
        ends_.push_back(ends);
    }
    /// Whether the residual of the last window was no better than that of the one before.
    bool is_stalled() const {
        if (residuals_.size() < 2 * window) return false;
        const auto least = [&](std::size_t back) {
            return *std::min_element(residuals_.end() - std::ptrdiff_t(back + window),
                                     residuals_.end() - std::ptrdiff_t(back));
        };
        return least(0) > progress * least(window);
    }
    double swing() const {
        double low = INFINITY, high = -INFINITY, through = 0, pressure = 0, flow = 0;
        for (std::size_t k = 0; k < ends_.back().size(); ++k) {
            low = std::min(low, ends_.back()[k].pressure), high = std::max(high, ends_.back()[k].pressure);
            through += 0.5 * std::abs(ends_.back()[k].flow);
            const auto range = [&](double CellEndState::*value) {
                double least = INFINITY, most = -INFINITY;
                for (std::size_t n = ends_.size() - window; n < ends_.size(); ++n)
                    least = std::min(least, ends_[n][k].*value), most = std::max(most, ends_[n][k].*value);
                return most - least;
            };
            flow = std::max(flow, range(&CellEndState::flow)),
            pressure = std::max(pressure, range(&CellEndState::pressure));
        }
        return std::max(flow / through, high > low ? pressure / (high - low) : 0.0);
    }
    bool is_standing() const { return swing() < standing; }
    bool is_bearable() const { return swing() < bearable; }

private:
    std::vector<double> residuals_;
    std::vector<std::vector<CellEndState>> ends_;
};

/// Whether no more than so much stays in the vessel.
bool is_balanced(const std::vector<CellEndState>& ends, double most) {
    double sum = 0;
    for (const CellEndState& end : ends) sum += end.flow;
    return std::abs(sum) <= most;
}

/// Of fields, one step after the other.
class FieldMean {
public:
    void add(const CellFields& fields) {
        sum_.pressure.resize(fields.pressure.size()), sum_.velocity.resize(fields.velocity.size());
        for (std::size_t i = 0; i < fields.pressure.size(); ++i)
            sum_.pressure[i] += fields.pressure[i], sum_.velocity[i] += fields.velocity[i];
        ++count_;
    }
    int count() const { return count_; }
    CellFields mean() const {
        CellFields mean = sum_;
        for (double& p : mean.pressure) p /= count_;
        for (Vec3& u : mean.velocity) u = u / double(count_);
        return mean;
    }

private:
    CellFields sum_;
    int count_ = 0;
};

}   // namespace

namespace {

/// By the transport that the balance has.
CellSolution iterate(CellBalance& balance, CellMatrix& matrix, const CellSolverSettings& settings) {
    CellSolution solution;
    double courant = settings.first_courant, limit = settings.courant, kappa = settings.kappa;
    double least = INFINITY;
    CellFields best;   // those that lacked least, with the ends' memory
    std::vector<double> best_ends;
    double before = INFINITY;   // what was lacked a step ago
    int cures = 0;
    StallWatch watch;
    CellMixing mixing(mixed_steps);
    FieldMean mean;   // once it is stalled and stands
    CellVectors right, change;
    const auto apply = [&](const CellVectors& v, CellVectors& z, CellVectors& w) {
        matrix.precondition(v, z, w);
        balance.add_openings(z, w);
    };
    const auto fail = [&](const std::string& why) {
        return DivergedError(fmt::format(
            "the flow on cells {} after {} steps: the cells lack {:.2g} of the flow and {:.2g} of the forces, "
            "where {:.2g} is asked for",
            why, solution.history.size(), balance.volume_residual(), balance.momentum_residual(), settings.tolerance));
    };
    for (int step = 0; step <= settings.most_iterations; ++step) {
        balance.compute_residual(kappa);
        const double volume = balance.volume_residual(), momentum = balance.momentum_residual(),
                     worst = std::max(volume, momentum);
        const bool is_lost = !std::isfinite(worst);
        if (is_lost && best.pressure.empty()) throw fail("lost its numbers");
        if (step >= settings.least_iterations && worst < settings.tolerance &&
            is_balanced(balance.end_states(), settings.imbalance_share * settings.tolerance * balance.scales().flow)) {
            solution.is_converged = true;
            solution.history.push_back({volume, momentum, 0, 0, courant});
            return solution;
        }
        if (settings.interrupted && settings.interrupted()) return solution;
        if (is_lost || worst > runaway * least) {   // back, and on in shorter steps
            if (++cures > most_cures) throw fail("ran away");
            limit = std::max(1.0, 0.25 * courant);
            courant = std::min(settings.first_courant, limit);
            balance.set_fields(best), balance.restore_end_memory(best_ends);
            mixing.forget(), watch = {}, mean = {};
            continue;
        }
        if (step > 0 && worst < least) least = worst, best = balance.fields(), best_ends = balance.end_memory();
        watch.add(worst, balance.end_states());
        if (watch.is_stalled() &&
            limit > first_limit) {   // long steps by a matrix of first order may go round in circles
            limit = first_limit, courant = std::min(courant, limit);
            watch = {};
        }
        if (settings.gives_up && (step == settings.most_iterations || (watch.is_stalled() && watch.is_standing()))) {
            balance.set_fields(best), balance.restore_end_memory(best_ends);
            balance.compute_residual(kappa);
            solution.is_given_up = true;
            solution.history.push_back({balance.volume_residual(), balance.momentum_residual(), 0, 0, courant});
            return solution;
        }
        const bool is_late = step + int(StallWatch::window) > settings.most_iterations;   // the last chance
        if (mean.count() > 0 || (watch.is_stalled() && (watch.is_standing() || (is_late && watch.is_bearable()))))
            mean.add(balance.fields());
        if (mean.count() >= int(StallWatch::window) && watch.is_bearable()) {
            balance.set_fields(mean.mean());
            balance.compute_residual(kappa);
            solution.is_settled = true, solution.swing = watch.swing();
            solution.history.push_back({balance.volume_residual(), balance.momentum_residual(), 0, 0, courant});
            return solution;
        }
        balance.fill({courant, pressure_share(momentum)}, matrix, right);
        const KrylovResult linear =
            solve_by_krylov(apply, right, change, settings.krylov_steps, settings.krylov_tolerance);
        solution.history.push_back({volume, momentum, linear.residual, linear.steps, courant});
        solution.linear_steps += linear.steps;
        if (!(linear.residual < stagnant)) {
            if (++cures > most_cures) throw fail("has a matrix that cannot be solved");
            limit = std::max(1.0, 0.5 * courant);
            courant = limit;
            kappa *= 0.7;
            mixing.forget();
            continue;
        }
        if (momentum < settings.mixes_below)
            mixing.mix(change, worst);
        else
            mixing.forget();
        balance.apply(change);
        if (settings.ends_may_turn) balance.turn_ends();
        const double change_of_step = worst > rising * before ? shrink : settings.growth;
        courant = std::min({limit, change_of_step * courant, momentum > unsteady ? first_limit : INFINITY});
        before = worst;
    }
    throw fail("has not converged");
}

/// What was spent before counts too.
void append(CellSolution& solution, const CellSolution& before) {
    solution.history.insert(solution.history.begin(), before.history.begin(), before.history.end());
    solution.linear_steps += before.linear_steps;
}

/// By the sharp transport, from the balance's fields. False where it finds no rest that would be an answer: then the fields are again
/// those of the start, and `solution` is only what was spent.
bool solve_sharply(CellBalance& balance, CellMatrix& matrix, CellSolverSettings settings, CellSolution& solution) {
    constexpr double enough =
        1e-5;   // of what cells lack: means of the sharp one are nearer to the truth than the damped one's rest
    // The fields are near the answer: short first steps would go through every swing on the way there, sixty steps instead of
    // forty behind a lesion on 760,000 cells.
    constexpr double first_courant = 50, growth = 2;
    settings.most_iterations = std::min(settings.most_iterations, settings.most_sharp_iterations);
    settings.first_courant = std::min(std::max(settings.first_courant, first_courant), settings.courant);
    settings.growth = std::max(settings.growth, growth);
    const CellFields start = balance.fields();
    const std::vector<double> ends = balance.end_memory();
    balance.set_transport(cell_terms::sharp);
    try {
        CellSolution sharp = iterate(balance, matrix, settings);
        append(sharp, solution);
        solution = sharp;
        const double lacking = std::max(balance.volume_residual(), balance.momentum_residual());
        if (solution.is_converged || is_interrupted(solution) || lacking < enough) return true;
    } catch (const DivergedError&) {   // the damped one may stand where the sharp one runs away
    }
    balance.set_fields(start), balance.restore_end_memory(ends);
    return false;
}

}   // namespace

CellSolution solve_instant(CellBalance& balance, CellMatrix& matrix, const CellSolverSettings& settings) {
    CellSolution solution = iterate(balance, matrix, settings);
    if (solution.is_settled)
        throw DivergedError(
            "an instant of the flow on cells only stands at its openings, and the cells are not in balance");
    return solution;
}

CellSolution solve_steady(CellBalance& balance, CellMatrix& matrix, const CellSolverSettings& settings) {
    constexpr double sharp_from = 1e-3;   // of what cells lack: the way there is the damped transport's
    CellSolution spent;
    if (settings.starts_sharp && solve_sharply(balance, matrix, settings, spent)) return spent;
    const auto solve_damped = [&](double tolerance) {
        CellSolverSettings own = settings;
        own.tolerance = tolerance;
        balance.set_transport(cell_terms::damped);
        CellSolution damped = iterate(balance, matrix, own);
        damped.is_damped = true;
        append(damped, spent);
        return damped;
    };
    CellSolution damped = solve_damped(std::max(settings.tolerance, sharp_from));
    if (!damped.is_converged) return damped;
    spent = damped;
    if (solve_sharply(balance, matrix, settings, spent)) return spent;
    return solve_damped(settings.tolerance);
}

}   // namespace patency
