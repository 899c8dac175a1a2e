// SPDX-License-Identifier: Apache-2.0
#include "patency/bodies/solid_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/base/weighted_sum.h"
#include "patency/search/cells.h"

namespace patency {

namespace {

struct Box {
    Vec3 low, high;
};
Box box_of(const std::vector<Vec3>& a, const Field<Vec3>& b) {
    Box box{b[0], b[0]};
    const auto add = [&](const Vec3& x) {
        box.low = {std::min(box.low.x, x.x), std::min(box.low.y, x.y), std::min(box.low.z, x.z)};
        box.high = {std::max(box.high.x, x.x), std::max(box.high.y, x.y), std::max(box.high.z, x.z)};
    };
    for (const Vec3& x : a) add(x);
    for (const Vec3& x : b) add(x);
    return box;
}

}   // namespace

SolidSurface::SolidSurface(SurfaceElements mesh, const SolidParticles& particles, double support, bool planar)
    : mesh_(std::move(mesh)), planar_(planar) {
    const std::size_t n = mesh_.vertices.size();
    position = mesh_.vertices;
    force.assign(n, {});
    find_elements_at();
    find_carriers(particles, support);
    transpose_carriers(particles);
    area_.assign(n, 0);
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
        for (int k = 0; k < (planar_ ? 2 : 3); ++k)
            area_[mesh_.elements[e][std::size_t(k)]] += norm(area_vector(e)) / (planar_ ? 2 : 3);
}

/// N_j = w_j [1/sum w + (X - X_mean) . M^-1 (X_j - X_mean)] reproduces every linear function.            THEORY (21.2)
void SolidSurface::find_carriers(const SolidParticles& particles, double support) {
    const Box box = box_of(mesh_.vertices, particles.reference);
    const Vec3 margin = support * Vec3{1, 1, 1};
    const Frame frame(box.low - margin, box.high + margin, support);
    Cells cells;
    const auto found = cells.find_order(frame, support / 2, {particles.reference.data(), particles.size()});
    const std::vector<std::uint32_t> order(found.begin(), found.end());
    std::vector<Vec3> sorted(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = particles.reference[order[i]];
    cells.index(frame, support / 2, sorted);
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
        const Vec3& X = mesh_.vertices[v];
        const auto fixed = frame.fixed(X);
        std::array<std::int64_t, 3> at;
        for (std::size_t k = 0; k < 3; ++k) at[k] = fixed[std::size_t(frame.axes()[k])];
        std::vector<Share> shares;
        double sum = 0;
        Vec3 mean{};
        Mat3 M{};
        const auto gather = [&](double within) {
            shares.clear(), sum = 0, mean = {}, M = {};
            cells.for_each_run(at, at, std::int64_t(within / frame.quantum()) + 2,
                               [&](std::uint32_t begin, std::uint32_t end) {
                                   for (std::uint32_t k = begin; k < end; ++k) {
                                       const double t = 1 - norm(sorted[k] - X) / within;
                                       if (t <= 0) continue;
                                       const double w = particles.volume[order[k]] * t * t * t;
                                       shares.push_back({order[k], w});
                                       sum += w;
                                       mean += w * sorted[k];
                                   }
                               });
            mean = sum > 0 ? mean / sum : X;
            for (const Share& s : shares) {
                const Vec3 d = particles.reference[s.index] - mean;
                M += s.weight * outer(d, d);
            }
            const double size = trace(M) / (planar_ ? 2 : 3);
            if (planar_) M.z.z = size;
            return determinant(M) > 1e-3 * size * size * size;   // they lie in no plane
        };
        // The sharp edges of a file's surface may stand farther from the particles than those that particles were made with.
        constexpr double wider = 1.25, widest = 2;
        double within = support;
        while (!gather(within)) {
            within *= wider;
            if (within > widest * support)
                throw GeometryError(fmt::format(
                    "the surface at ({:.4g}, {:.4g}, {:.4g}) m has too few particles of the solid near it to be "
                    "carried: use a finer spacing",
                    X.x, X.y, X.z));
        }
        const Vec3 slope = inverse(M) * (X - mean);
        for (Share& s : shares) s.weight *= 1 / sum + dot(slope, particles.reference[s.index] - mean);
        double softness = 0;
        for (const Share& s : shares) softness += s.weight * s.weight / particles.mass[s.index];
        mass_.push_back(1 / softness);
        carriers_.items.insert(carriers_.items.end(), shares.begin(), shares.end());
        carriers_.start.push_back(std::uint32_t(carriers_.items.size()));
    }
}

void SolidSurface::transpose_carriers(const SolidParticles& particles) {
    std::vector<std::vector<Share>> carried(particles.size());
    for (std::size_t v = 0; v < carriers_.rows(); ++v)
        for (const Share* s = carriers_.begin(v); s < carriers_.end(v); ++s)
            carried[s->index].push_back({std::uint32_t(v), s->weight});
    for (std::size_t i = 0; i < carried.size(); ++i) {
        if (carried[i].empty()) continue;
        carrier_particles_.push_back(std::uint32_t(i));
        carried_.items.insert(carried_.items.end(), carried[i].begin(), carried[i].end());
        carried_.start.push_back(std::uint32_t(carried_.items.size()));
    }
}

void SolidSurface::find_elements_at() {
    std::vector<std::vector<std::uint32_t>> at(mesh_.vertices.size());
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
        for (int k = 0; k < (planar_ ? 2 : 3); ++k) at[mesh_.elements[e][std::size_t(k)]].push_back(std::uint32_t(e));
    for (const auto& list : at) {
        elements_at_.items.insert(elements_at_.items.end(), list.begin(), list.end());
        elements_at_.start.push_back(std::uint32_t(elements_at_.items.size()));
    }
}

void SolidSurface::follow(const SolidParticles& particles) {
    followed_ = &particles;
    for_each_index(size(), [&](std::size_t k) { position[k] = carried_at(k, particles.position), force[k] = {}; });
}

Vec3 SolidSurface::velocity(std::size_t vertex) const {
    return followed_ ? carried_at(vertex, followed_->velocity) : Vec3{};
}

Vec3 SolidSurface::carried_at(std::size_t vertex, const Field<Vec3>& field) const {
    const Vec3* values = field.data();
    WeightedSum sum;
    for (const Share* s = carriers_.begin(vertex); s < carriers_.end(vertex); ++s) sum.add(s->weight, values[s->index]);
    return sum.value();
}

void SolidSurface::add_pressure(std::uint16_t face, double pressure) {
    const double share = pressure / (planar_ ? 2 : 3);
    for_each_index(size(), [&](std::size_t v) {
        for (const std::uint32_t* e = elements_at_.begin(v); e < elements_at_.end(v); ++e)
            if (mesh_.face[*e] == face) force[v] -= share * area_vector(*e);
    });
}

void SolidSurface::push(SolidParticles& particles) const {
    for_each_index(carrier_particles_.size(), [&](std::size_t k) {
        WeightedSum sum;
        for (const Share* s = carried_.begin(k); s < carried_.end(k); ++s) sum.add(s->weight, force[s->index]);
        particles.load[carrier_particles_[k]] += sum.value();
    });
}

std::vector<double> SolidSurface::carried(const std::vector<double>& by_particle) const {
    std::vector<double> values(size());
    for_each_index(size(), [&](std::size_t v) {
        for (const Share* s = carriers_.begin(v); s < carriers_.end(v); ++s)
            values[v] += s->weight * by_particle[s->index];
    });
    return values;
}

}   // namespace patency
