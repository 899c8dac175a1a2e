// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/tree/tree_flow.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/physics/open_ends/bed.h"

namespace patency {

namespace {

constexpr double pi = std::numbers::pi;
// Young & Tsai 1973: the share of the jet's dynamic pressure that is lost behind a lesion.          THEORY.md (15.3)
constexpr double expansion_loss = 1.52;
// Blood that turns into a branch brings part of its parent's profile: half of the excess of a flat one. Between none and
// all of it lies the pressure drop of the large branch of the reference bifurcation (tests/physics/tree_flow_test.cpp).
constexpr double branch_entrance = 0.5;

double diameter(double area) { return std::sqrt(4 * area / pi); }

struct Topology {
    std::vector<std::vector<std::size_t>> children;
    std::vector<std::size_t> leaves;   // branches without children
};

Topology topology_of(const TreeCase& tree) {
    const std::size_t n = tree.branches.size();
    if (n == 0) throw GeometryError("a tree needs a branch");
    if (tree.outlets.size() != n) throw GeometryError("a tree needs one end for every branch");
    Topology t;
    t.children.resize(n);
    for (std::size_t b = 0; b < n; ++b) {
        const TreeBranch& branch = tree.branches[b];
        if (b == 0 ? branch.parent != -1 : branch.parent < 0 || std::size_t(branch.parent) >= b)
            throw GeometryError(fmt::format("branch {} must come after its parent", branch.name));
        if (branch.arc.size() < 2 || branch.arc.size() != branch.area.size())
            throw GeometryError(fmt::format("branch {} needs two stations or more", branch.name));
        for (std::size_t k = 0; k < branch.arc.size(); ++k)
            if (!(branch.area[k] > 0) || (k > 0 && !(branch.arc[k] > branch.arc[k - 1])))
                throw GeometryError(fmt::format("branch {}: the arc must rise and the area be positive", branch.name));
        if (b > 0) t.children[std::size_t(branch.parent)].push_back(b);
    }
    for (std::size_t b = 0; b < n; ++b)
        if (t.children[b].empty()) t.leaves.push_back(b);
    return t;
}

/// Flow of every branch from those of the leaves.
std::vector<double> summed(const TreeCase& tree, const Topology& t, const Eigen::VectorXd& leaf_flows) {
    std::vector<double> flow(tree.branches.size(), 0.0);
    for (std::size_t k = 0; k < t.leaves.size(); ++k) flow[t.leaves[k]] = leaf_flows[Eigen::Index(k)];
    for (std::size_t b = flow.size(); b-- > 1;) flow[std::size_t(tree.branches[b].parent)] += flow[b];
    return flow;
}

double dynamic_pressure(double density, double speed) { return 0.5 * density * speed * std::abs(speed); }

/// What is lost between the parent's end and the branch's beginning (Hager 1984: momentum along the turned stream).
double junction_loss(double density, double parent_speed, double speed, double turn) {
    if (parent_speed == 0) return 0;
    const double ratio = speed / parent_speed;
    const double share = 1 + ratio * ratio - 2 * ratio * std::cos(0.75 * turn);   // THEORY.md (15.4)
    return share * dynamic_pressure(density, parent_speed);
}

/// Loss of total pressure up to every station of a branch.
std::vector<double> branch_losses(const TreeCase& tree, const TreeBranch& branch, double flow, double entrance) {
    const double density = tree.blood.density;
    std::vector<double> loss(branch.arc.size(), 0.0);
    const auto viscosity = [&](double area) {
        return tree.blood.viscosity_at(8 * std::abs(flow) / (area * diameter(area)));   // at the wall of a parabola
    };
    const auto friction = [&](std::size_t k) {   // THEORY.md (15.1)
        return 8 * pi * viscosity(branch.area[k]) * flow / (branch.area[k] * branch.area[k]);
    };
    const double begin = branch.area.front(), speed = flow / begin;
    const double reynolds = density * std::abs(speed) * diameter(begin) / viscosity(begin);
    for (std::size_t k = 1; k < loss.size(); ++k)
        loss[k] = loss[k - 1] + 0.5 * (friction(k - 1) + friction(k)) * (branch.arc[k] - branch.arc[k - 1]);
    for (std::size_t k = 1; k < loss.size(); ++k) {
        const double arc = branch.arc[k];
        if (reynolds > 0)
            loss[k] += entrance * dynamic_pressure(density, speed) *
                       entrance_excess((arc - branch.arc.front()) / (diameter(begin) * reynolds));
        for (const TreeLesion& lesion : branch.lesions) {   // THEORY.md (15.3)
            const double widening = std::max(lesion.end_arc - lesion.throat_arc, 1e-12);
            const double reached = std::clamp((arc - lesion.throat_arc) / widening, 0.0, 1.0);
            const double jet = std::max(0.0, lesion.reference_area / lesion.throat_area - 1);
            loss[k] += reached * expansion_loss * jet * jet * dynamic_pressure(density, flow / lesion.reference_area);
        }
    }
    return loss;
}

/// Pressure over flow of a leaf that must be: residual of its end's law.
double mismatch(const TreeEnd& end, double pressure, double flow) {
    if (const auto* p = std::get_if<TreePressure>(&end)) return pressure - p->pressure;
    const auto& r = std::get<TreeResistance>(end);
    return pressure - r.distal_pressure - r.resistance * flow;
}

}   // namespace

double entrance_excess(double x) {
    if (!(x > 0)) return 0;
    const double root = std::sqrt(x);
    const double apparent = (16 + 0.3125 / x - 3.44 / root) / (1 + 0.00021 / (x * x)) + 3.44 / root;   // f Re
    return 4 * (apparent - 16) * x;
}

std::vector<std::vector<double>> tree_pressures(const TreeCase& tree, const std::vector<double>& flows,
                                                double inlet_pressure) {
    const double density = tree.blood.density;
    std::vector<std::vector<double>> pressure(tree.branches.size());
    std::vector<double> total_at_end(tree.branches.size());
    for (std::size_t b = 0; b < tree.branches.size(); ++b) {
        const TreeBranch& branch = tree.branches[b];
        const double speed = flows[b] / branch.area.front();
        double total = inlet_pressure + dynamic_pressure(density, speed);
        if (branch.parent >= 0) {
            const auto p = std::size_t(branch.parent);
            const double parent_speed = flows[p] / tree.branches[p].area.back();
            total = total_at_end[p] - junction_loss(density, parent_speed, speed, branch.turn);
        }
        const auto loss =
            branch_losses(tree, branch, flows[b], branch.parent < 0 ? tree.inlet_entrance : branch_entrance);
        for (std::size_t k = 0; k < loss.size(); ++k)
            pressure[b].push_back(total - loss[k] - dynamic_pressure(density, flows[b] / branch.area[k]));
        total_at_end[b] = total - loss.back();
    }
    return pressure;
}

TreeFlow solve_tree(const TreeCase& tree) {
    const Topology t = topology_of(tree);
    if (std::holds_alternative<TreeResistance>(tree.inlet)) throw DeckError("a resistance cannot stand at the inlet");
    const auto* inlet_flow = std::get_if<TreeFlowRate>(&tree.inlet);
    const auto* inlet_pressure = std::get_if<TreePressure>(&tree.inlet);
    const auto leaves = Eigen::Index(t.leaves.size());
    std::vector<double> diameters;
    bool is_level_open = inlet_pressure == nullptr;
    for (std::size_t leaf : t.leaves) {
        diameters.push_back(diameter(tree.branches[leaf].area.back()));
        if (!std::holds_alternative<TreeFlowRate>(tree.outlets[leaf])) is_level_open = false;
    }
    if (is_level_open)
        throw DeckError("all openings impose a flow, so nothing tells the pressure; give one of them a pressure");

    // Unknown: the leaves' flows and the pressure at the inlet.
    const auto residual = [&](const Eigen::VectorXd& x) {
        const auto flows = summed(tree, t, x.head(leaves));
        const auto pressures = tree_pressures(tree, flows, x[leaves]);
        Eigen::VectorXd r(leaves + 1);
        for (Eigen::Index k = 0; k < leaves; ++k) {
            const std::size_t leaf = t.leaves[std::size_t(k)];
            const TreeEnd& end = tree.outlets[leaf];
            const auto* given = std::get_if<TreeFlowRate>(&end);
            r[k] = given ? x[k] - given->flow : mismatch(end, pressures[leaf].back(), flows[leaf]);
        }
        r[leaves] = inlet_flow ? flows[0] - inlet_flow->flow : x[leaves] - inlet_pressure->pressure;
        return r;
    };
    // Sizes that make the equations comparable: a flow at which the inlet's Reynolds number is 200, and what it costs there.
    const double d0 = diameter(tree.branches[0].area.front()), mu = tree.blood.viscosity_at(100.0);
    const double flow_size =
        inlet_flow && inlet_flow->flow != 0 ? std::abs(inlet_flow->flow) : 50 * pi * d0 * mu / tree.blood.density;
    double pressure_size = tree.blood.density * std::pow(flow_size / tree.branches[0].area.front(), 2);
    const auto shares = murray_shares(diameters, 3);
    Eigen::VectorXd x(leaves + 1);
    for (Eigen::Index k = 0; k < leaves; ++k) x[k] = shares[std::size_t(k)] * flow_size;
    x[leaves] = inlet_pressure ? inlet_pressure->pressure : 0;

    Eigen::VectorXd row_size(leaves + 1);
    for (Eigen::Index k = 0; k < leaves; ++k) {
        const TreeEnd& end = tree.outlets[t.leaves[std::size_t(k)]];
        if (const auto* r = std::get_if<TreeResistance>(&end))
            pressure_size = std::max(pressure_size, r->resistance * shares[std::size_t(k)] * flow_size);
    }
    for (Eigen::Index k = 0; k < leaves; ++k)
        row_size[k] =
            std::holds_alternative<TreeFlowRate>(tree.outlets[t.leaves[std::size_t(k)]]) ? flow_size : pressure_size;
    row_size[leaves] = inlet_flow ? flow_size : pressure_size;

    TreeFlow answer;
    const auto scaled = [&](const Eigen::VectorXd& r) { return Eigen::VectorXd(r.cwiseQuotient(row_size)); };
    Eigen::VectorXd r = scaled(residual(x));
    constexpr int most = 200;
    constexpr double tolerance = 1e-11;
    for (; r.lpNorm<Eigen::Infinity>() > tolerance && answer.iterations < most; ++answer.iterations) {
        Eigen::MatrixXd jacobian(leaves + 1, leaves + 1);
        for (Eigen::Index k = 0; k <= leaves; ++k) {
            const double step = 1e-6 * (k < leaves ? flow_size : pressure_size);
            Eigen::VectorXd more = x, less = x;
            more[k] += step, less[k] -= step;
            jacobian.col(k) = (scaled(residual(more)) - scaled(residual(less))) / (2 * step);
        }
        const Eigen::VectorXd change = jacobian.fullPivLu().solve(-r);
        double share = 1;
        Eigen::VectorXd next = x + change, next_r = scaled(residual(next));
        while (!(next_r.norm() < r.norm()) && share > 1e-6) {
            share *= 0.5;
            next = x + share * change;
            next_r = scaled(residual(next));
        }
        if (!(next_r.norm() < r.norm())) break;   // round-off, or stuck: judged below
        x = next, r = next_r;
    }
    if (!(r.lpNorm<Eigen::Infinity>() < 1e-6))
        throw GeometryError(
            "no steady flow through the tree agrees with its ends; look for a branch that is nearly closed");
    answer.flow = summed(tree, t, x.head(leaves));
    answer.inlet_pressure = x[leaves];
    answer.pressure = tree_pressures(tree, answer.flow, answer.inlet_pressure);
    return answer;
}

}   // namespace patency
