// SPDX-License-Identifier: Apache-2.0
#include "patency/analysis/sample.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "patency/analysis/buckets.h"
#include "patency/base/parallel.h"
#include "patency/physics/fluid/shear_rate.h"

namespace patency {

namespace {

// A fit needs half as many points again as unknowns, or it follows their noise.
constexpr double surplus = 1.5;
constexpr double tangent_step = 1e-3;   // of a shear rate, for the slope of the stress over it

/// One point of a fit.
struct Datum {
    Vec3 d;   // from the place, in units of the reach
    double weight;
    Vec3 velocity;
    double pressure;
    bool has_pressure;
};

/// 1, x, y, (z), and the products of two, by rising degree.
int fill_basis(const Vec3& d, bool planar, int terms, double* b) {
    const double all[10] = {1, d.x, d.y, d.z, d.x * d.x, d.x * d.y, d.y * d.y, d.x * d.z, d.y * d.z, d.z * d.z};
    const double flat[6] = {1, d.x, d.y, d.x * d.x, d.x * d.y, d.y * d.y};
    for (int k = 0; k < terms; ++k) b[k] = planar ? flat[k] : all[k];
    return terms;
}

double kernel_weight(double q) {   // Wendland C2 over its reach
    const double t = 1 - q;
    return t > 0 ? t * t * t * t * (1 + 4 * q) : 0.0;
}

/// Value and gradient at the place of one or several columns of numbers. Rows: terms; columns: as `values`.
Eigen::MatrixXd fit(const std::vector<Datum>& data, bool planar, bool pressure, int terms) {
    const int columns = pressure ? 1 : 3;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms), right = Eigen::MatrixXd::Zero(terms, columns);
    double b[10];
    for (const Datum& datum : data) {
        if (pressure && !datum.has_pressure) continue;
        fill_basis(datum.d, planar, terms, b);
        const double values[3] = {pressure ? datum.pressure : datum.velocity.x, datum.velocity.y, datum.velocity.z};
        for (int r = 0; r < terms; ++r) {
            for (int c = 0; c < terms; ++c) normal(r, c) += datum.weight * b[r] * b[c];
            for (int c = 0; c < columns; ++c) right(r, c) += datum.weight * b[r] * values[c];
        }
    }
    return normal.ldlt().solve(right);
}

int count_terms(std::size_t points, bool planar) {
    const int quadratic = planar ? 6 : 10, linear = planar ? 3 : 4;
    return double(points) >= surplus * quadratic ? quadratic : double(points) >= surplus * linear ? linear : 1;
}

struct Evaluated {
    FlowSample sample;
    Vec3 pressure_gradient;   // [Pa/m]
    bool is_quadratic;        // both fits are
};

Evaluated evaluate(const std::vector<Datum>& data, bool planar, double reach) {
    std::size_t with_pressure = 0;
    for (const Datum& datum : data) with_pressure += datum.has_pressure;
    FlowSample sample{{NAN, NAN, NAN}, NAN, {}, int(with_pressure)};
    if (with_pressure == 0) return {sample, {}, false};
    const int terms = count_terms(data.size(), planar);
    const Eigen::MatrixXd v = fit(data, planar, false, terms);
    const int pressure_terms = count_terms(with_pressure, planar), quadratic = planar ? 6 : 10;
    const Eigen::MatrixXd p = fit(data, planar, true, pressure_terms);
    sample.velocity = {v(0, 0), v(0, 1), v(0, 2)};
    sample.pressure = p(0, 0);
    const auto slope = [&](const Eigen::MatrixXd& f, int c) {
        return f.rows() < 3 ? Vec3{} : Vec3{f(1, c) / reach, f(2, c) / reach, planar ? 0.0 : f(3, c) / reach};
    };
    sample.velocity_gradient = {slope(v, 0), slope(v, 1), slope(v, 2)};
    return {sample, slope(p, 0), terms == quadratic && pressure_terms == quadratic};
}

/// Points of the wall's surface near a place, a third of the reach apart around its foot.
void add_wall(std::vector<Datum>& data, const Vec3& place, double reach, bool planar, const WallHint& wall) {
    const double distance = wall.distance(place);
    if (!(std::abs(distance) < reach)) return;
    const Vec3 n = wall.normal(place);
    const Vec3 a = planar ? Vec3{-n.y, n.x, 0} : unit_across(n), b = planar ? Vec3{} : cross(n, a);
    const Vec3 foot = place - distance * n;
    const double step = reach / 3;
    for (int i = -2; i <= 2; ++i)
        for (int j = planar ? 0 : -2; j <= (planar ? 0 : 2); ++j) {
            Vec3 x = foot + step * (double(i) * a + double(j) * b);
            x -= wall.distance(x) * wall.normal(x);   // back to the surface, where it is curved
            const Vec3 d = (x - place) / reach;
            const double weight = kernel_weight(norm(d));
            if (weight > 0) data.push_back({d, weight, wall.velocity ? wall.velocity(x) : Vec3{}, 0, false});
        }
}

/// finish(k, the points of the fit of place k, its reach): of different places on different threads.
template <class Finish>
void for_each_place(const FluidParticles& fluid, const Frame& frame, std::span<const Vec3> places,
                    const LocalLength& reach, bool planar, const WallHint* wall, const Finish& finish) {
    std::vector<double> own(places.size());
    for_each_index(places.size(), [&](std::size_t k) { own[k] = reach(places[k]); });
    // Places of about one reach together: buckets of the widest would hold a host of the finest particles.
    std::map<int, std::vector<std::size_t>> octaves;
    for (std::size_t k = 0; k < places.size(); ++k) octaves[std::ilogb(own[k] / own[0])].push_back(k);
    const std::span<const Vec3> wall_points = wall ? std::span<const Vec3>(wall->points) : std::span<const Vec3>();
    for (const auto& octave : octaves) {
        const std::vector<std::size_t>& members = octave.second;
        std::vector<Vec3> here;
        double widest = 0;
        for (const std::size_t k : members) here.push_back(places[k]), widest = std::max(widest, own[k]);
        const Buckets buckets(std::span(fluid.position.begin(), fluid.size()), frame, here, widest);
        const Buckets surface(wall_points, frame, here, widest);
#pragma omp parallel for schedule(dynamic, 4)
        for (std::size_t n = 0; n < members.size(); ++n) {
            const std::size_t k = members[n];
            std::vector<Datum> data;
            buckets.for_each_near(places[k], [&](std::uint32_t i) {
                const Vec3 d = shortest(fluid.position[i] - places[k], frame) / own[k];
                const double q2 = dot(d, d);
                if (q2 < 1)
                    data.push_back({d, kernel_weight(std::sqrt(q2)), fluid.velocity[i], fluid.pressure[i], true});
            });
            if (!wall_points.empty() && !data.empty())
                surface.for_each_near(places[k], [&](std::uint32_t i) {
                    const Vec3 d = shortest(wall_points[i] - places[k], frame) / own[k];
                    const double weight = kernel_weight(norm(d));
                    if (weight > 0)
                        data.push_back({d, weight, wall->velocity ? wall->velocity(wall_points[i]) : Vec3{}, 0, false});
                });
            else if (wall && !data.empty())
                add_wall(data, places[k], own[k], planar, *wall);
            finish(k, data, own[k]);
        }
    }
}

/// Viscosity mu and the slope of the stress over the shear rate, mu_t, both [Pa s].
struct Friction {
    double mu, tangent;
};
Friction friction_at(double rate, const std::function<double(double)>& viscosity_at) {
    const double mu = viscosity_at(rate), above = viscosity_at((1 + tangent_step) * rate),
                 below = viscosity_at((1 - tangent_step) * rate);
    return {mu, mu + (above - below) / (2 * tangent_step)};   // the same to the last bit where the viscosity is one
}

/// The gradient of a part of the velocity at a place of a wall whose second derivative along the normal n is known: `curvature`
/// [1/(m s)] less `share` times those along the wall. Left to be fitted are values, slopes, what bends along the wall, and how the
/// curvature changes across the layer.                                                             THEORY.md (5.7)
template <class Part>
Mat3 fit_of_resting(const std::vector<Datum>& data, const Vec3& n, const Vec3& curvature, double share, double reach,
                    const Part& part) {
    const Vec3 known = 0.5 * reach * reach * curvature;   // by the squared depth in reaches
    const Vec3 a = unit_across(n), b = cross(n, a);
    constexpr int terms = 10;
    Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
    Eigen::Matrix<double, terms, 3> right = Eigen::Matrix<double, terms, 3>::Zero();
    for (const Datum& datum : data) {
        const double x = dot(datum.d, a), y = dot(datum.d, b), z = dot(datum.d, n), zz = share * z * z;
        const Eigen::Matrix<double, terms, 1> basis{1, x, y, z, x * y, x * z, y * z, x * x - zz, y * y - zz, z * z * z};
        const Vec3 v = part(datum.velocity) - (z * z) * known;
        normal += datum.weight * basis * basis.transpose();
        right += datum.weight * basis * Eigen::RowVector3d(v.x, v.y, v.z);
    }
    const Eigen::Matrix<double, terms, 3> fit = normal.ldlt().solve(right);
    const auto slope = [&](int c) { return (1 / reach) * (fit(1, c) * a + fit(2, c) * b + fit(3, c) * n); };
    return {slope(0), slope(1), slope(2)};
}

/// All of it, where push = div (2 mu D) is all there is. Along the shear at the wall friction grows with mu_t, across it with mu. first:
/// the gradient as far as it is known.
Mat3 gradient_of_resting(const std::vector<Datum>& data, const Mat3& first, const Vec3& n, const Vec3& push,
                         const Friction& friction, double reach) {
    const Vec3 slope = first * n, shear = slope - dot(slope, n) * n;
    if (friction.tangent == friction.mu || !(dot(shear, shear) > 0))
        return fit_of_resting(data, n, push / friction.mu, 1, reach, [](const Vec3& v) { return v; });
    const Vec3 t = normalized(shear);
    const auto along = [&](const Vec3& v) { return dot(v, t) * t; };
    const auto across = [&](const Vec3& v) { return v - dot(v, t) * t; };
    return fit_of_resting(data, n, along(push) / friction.tangent, friction.mu / friction.tangent, reach, along) +
           fit_of_resting(data, n, across(push) / friction.mu, 1, reach, across);
}

}   // namespace

std::vector<FlowSample> sample_flow(const FluidParticles& fluid, const Frame& frame, std::span<const Vec3> places,
                                    const LocalLength& reach, bool planar, const WallHint* wall) {
    std::vector<FlowSample> samples(places.size());
    for_each_place(fluid, frame, places, reach, planar, wall,
                   [&](std::size_t k, const std::vector<Datum>& data, double own) {
                       samples[k] = evaluate(data, planar, own).sample;
                   });
    return samples;
}

std::vector<FlowSample> sample_at_wall(const FluidParticles& fluid, const Frame& frame, std::span<const Vec3> places,
                                       std::span<const Vec3> normals, const LocalLength& reach, const WallHint& wall,
                                       const std::function<double(double)>& viscosity_at, const Vec3& force) {
    std::vector<FlowSample> samples(places.size());
    for_each_place(
        fluid, frame, places, reach, false, &wall, [&](std::size_t k, const std::vector<Datum>& data, double own) {
            const Evaluated e = evaluate(data, false, own);
            samples[k] = e.sample;
            const Vec3& n = normals[k];
            if (!e.is_quadratic || !(dot(n, n) > 0)) return;   // a folded surface has places without a normal
            Mat3& gradient = samples[k].velocity_gradient;
            for (int pass = 0; pass < 2; ++pass) {   // the second with the viscosity at the first one's shear rate
                const Friction friction = friction_at(shear_rate(gradient), viscosity_at);
                gradient = gradient_of_resting(data, gradient, n, e.pressure_gradient - force, friction, own);
                if (friction.tangent == friction.mu) return;
            }
        });
    return samples;
}

std::vector<Vec3> places_along(const Vec3& from, const Vec3& to, int count) {
    std::vector<Vec3> places;
    for (int k = 0; k < count; ++k) places.push_back(from + (count > 1 ? double(k) / (count - 1) : 0.0) * (to - from));
    return places;
}

}   // namespace patency
