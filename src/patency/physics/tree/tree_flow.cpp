// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/tree/tree_flow.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/physics/open_ends/bed.h"

namespace patency {

namespace {

constexpr double pi = std::numbers::pi;
// A branch begins between plug and parabola: the carina cuts its parent's stream where it is fast, and a new boundary layer
// grows from there. Half of each loses most nearly what finite volumes do in two trees (tests/stages/estimate_test.cpp).
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

/// Blood begins with `first` where it runs on; where it runs back it comes from the other end, as a parabola.
ProfileAlong branch_along(const TreeBlood& blood, const TreeBranch& branch, double flow, const TreeProfile& first) {
    if (flow >= 0) return march_profile(blood, branch.arc, branch.area, flow, first);
    std::vector<double> arc(branch.arc.rbegin(), branch.arc.rend()), area(branch.area.rbegin(), branch.area.rend());
    for (double& s : arc) s = branch.arc.back() - s;
    ProfileAlong along = march_profile(blood, arc, area, -flow, TreeProfile::between(0));
    std::reverse(along.pressure.begin(), along.pressure.end());
    std::reverse(along.profile.begin(), along.profile.end());
    const double begin = along.pressure.front();
    for (double& p : along.pressure) p -= begin;
    return along;
}

/// What a branch begins with at its parent's end: the pressure that momentum along the turned stream leaves (Hager 1984), and a
/// profile. A branch that takes its stream slower than it comes begins with a jet, whose pressure comes back as it spreads.
///                                                                                                  THEORY.md (15.4)
struct BranchBegin {
    double pressure;
    TreeProfile profile;
};
BranchBegin branch_begin(double density, double pressure, double parent_speed, double speed, double turn) {
    const TreeProfile profile = TreeProfile::between(branch_entrance);
    const double stream = parent_speed * std::cos(0.75 * turn);
    if (!(speed > 0)) return {pressure, profile};   // runs back into its parent
    if (speed < stream) return {pressure, profile.as_jet(speed / stream)};
    return {pressure - density * speed * (speed - stream), profile};
}

/// Static pressures and profiles of all branches for flows that are given.
std::vector<ProfileAlong> march_tree(const TreeCase& tree, const std::vector<double>& flows, double inlet_pressure) {
    std::vector<ProfileAlong> along;
    for (std::size_t b = 0; b < tree.branches.size(); ++b) {
        const TreeBranch& branch = tree.branches[b];
        BranchBegin begin{inlet_pressure, TreeProfile::between(tree.inlet_entrance)};
        if (branch.parent >= 0) {
            const auto p = std::size_t(branch.parent);
            begin = branch_begin(tree.blood.density, along[p].pressure.back(), flows[p] / tree.branches[p].area.back(),
                                 flows[b] / branch.area.front(), branch.turn);
        }
        along.push_back(branch_along(tree.blood, branch, flows[b], begin.profile));
        for (double& p : along.back().pressure) p += begin.pressure;
    }
    return along;
}

/// Pressure over flow of a leaf that must be: residual of its end's law.
double mismatch(const TreeEnd& end, double pressure, double flow) {
    if (const auto* p = std::get_if<TreePressure>(&end)) return pressure - p->pressure;
    const auto& r = std::get<TreeResistance>(end);
    return pressure - r.distal_pressure - r.resistance * flow;
}

/// How the equations of leaves and inlet answer to the leaves' flows and the inlet's pressure, if every branch answers to its own
/// flow as it does when all flows grow in proportion: exact for one branch, near enough for a tree to begin with.
Eigen::MatrixXd end_slopes(const TreeCase& tree, const Topology& t, const std::vector<double>& flows) {
    constexpr double more = 1e-4;
    std::vector<double> raised = flows;
    for (double& q : raised) q *= 1 + more;
    const auto at = march_tree(tree, flows, 0), above = march_tree(tree, raised, 0);
    std::vector<double> resistance(flows.size(), 0.0);   // d drop / d flow of a branch, its junction with it
    const auto n = Eigen::Index(t.leaves.size());
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(n + 1, n + 1);
    for (std::size_t b = 0; b < flows.size(); ++b) {
        const int parent = tree.branches[b].parent;
        const auto drop_grows = [&](std::size_t k) { return at[k].pressure.back() - above[k].pressure.back(); };
        const double own = drop_grows(b) - (parent < 0 ? 0 : drop_grows(std::size_t(parent)));
        if (flows[b] != 0) resistance[b] = own / (more * flows[b]);
    }
    const auto path_of = [&](std::size_t b) {
        std::vector<std::size_t> path{b};
        while (tree.branches[path.back()].parent >= 0) path.push_back(std::size_t(tree.branches[path.back()].parent));
        return path;
    };
    for (Eigen::Index k = 0; k < n; ++k) {
        const std::size_t leaf = t.leaves[std::size_t(k)];
        const TreeEnd& end = tree.outlets[leaf];
        if (std::holds_alternative<TreeFlowRate>(end)) {
            slopes(k, k) = 1;
            continue;
        }
        const auto path = path_of(leaf);
        for (Eigen::Index j = 0; j < n; ++j)
            for (std::size_t b : path_of(t.leaves[std::size_t(j)]))
                if (std::find(path.begin(), path.end(), b) != path.end()) slopes(k, j) -= resistance[b];
        if (const auto* r = std::get_if<TreeResistance>(&end)) slopes(k, k) -= r->resistance;
        slopes(k, n) = 1;
    }
    if (std::holds_alternative<TreeFlowRate>(tree.inlet))
        slopes.row(n).head(n).setOnes();
    else
        slopes(n, n) = 1;
    return slopes;
}

}   // namespace

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
        const auto along = march_tree(tree, flows, x[leaves]);
        Eigen::VectorXd r(leaves + 1);
        for (Eigen::Index k = 0; k < leaves; ++k) {
            const std::size_t leaf = t.leaves[std::size_t(k)];
            const TreeEnd& end = tree.outlets[leaf];
            const auto* given = std::get_if<TreeFlowRate>(&end);
            const double pressure = along[leaf].pressure.back();
            r[k] = given ? x[k] - given->flow : mismatch(end, pressure, flows[leaf]);
            if (!std::isfinite(pressure)) r[k] = NAN;   // a flow that is given does not pass either
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

    // Broyden's method: slopes from the branches once, then from the steps themselves. A march is dear, a small system is not.
    const auto scaled = [&](const Eigen::VectorXd& r) { return Eigen::VectorXd(r.cwiseQuotient(row_size)); };
    const auto slopes = [&](const Eigen::VectorXd& at) {
        return Eigen::MatrixXd(row_size.cwiseInverse().asDiagonal() *
                               end_slopes(tree, t, summed(tree, t, at.head(leaves))));
    };
    TreeFlow answer;
    Eigen::VectorXd r = scaled(residual(x));
    Eigen::MatrixXd jacobian = slopes(x);
    // Too much for a throat: less.
    for (int halvings = 0; !(r.allFinite() && jacobian.allFinite()) && halvings < 60; ++halvings) {
        x.head(leaves) *= 0.5;
        r = scaled(residual(x)), jacobian = slopes(x);
    }
    bool is_fresh = true;
    constexpr int most = 200;
    constexpr double tolerance = 1e-10;
    for (; r.lpNorm<Eigen::Infinity>() > tolerance && answer.iterations < most; ++answer.iterations) {
        const Eigen::VectorXd change = jacobian.fullPivLu().solve(-r);
        double share = 1;
        Eigen::VectorXd next = x + change, next_r = scaled(residual(next));
        while (!(next_r.norm() < r.norm()) && share > (is_fresh ? 1e-6 : 0.2)) {
            share *= 0.5;
            next = x + share * change;
            next_r = scaled(residual(next));
        }
        if (next_r.norm() < r.norm()) {
            const Eigen::VectorXd step = share * change;
            jacobian += (next_r - (1 - share) * r) * step.transpose() / step.squaredNorm();
            x = next, r = next_r, is_fresh = false;
        } else {
            if (is_fresh) break;   // round-off, or stuck: judged below
            jacobian = slopes(x), is_fresh = true;
        }
    }
    if (!(r.lpNorm<Eigen::Infinity>() < 1e-6))
        throw GeometryError(
            "no steady flow through the tree agrees with its ends; look for a branch that is nearly closed");
    answer.flow = summed(tree, t, x.head(leaves));
    answer.inlet_pressure = x[leaves];
    for (ProfileAlong& along : march_tree(tree, answer.flow, answer.inlet_pressure)) {
        answer.pressure.push_back(std::move(along.pressure));
        answer.profile.push_back(std::move(along.profile));
    }
    return answer;
}

}   // namespace patency
