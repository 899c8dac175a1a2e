// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_balance.h"

#include <algorithm>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"
#include "patency/physics/fluid/shear_rate.h"

namespace patency {

using namespace cell_terms;

namespace {

/// The pressure [Pa] at which the ends' flows cancel if the vessel itself resists nothing, those that are prescribed included. A
/// start from another one would fill or empty the vessel in a rush.
double level_of_ends(std::span<const CellEnd> ends) {
    double largest = 0, smallest = INFINITY, pressures = 0, conductance = 0, enters = 0;
    for (const CellEnd& end : ends)
        if (end.kind == CellEnd::Kind::pressure)
            largest = std::max(largest, end.resistance), smallest = std::min(smallest, end.resistance);
    const double least = largest > 0 ? 1e-6 * largest : 1;   // of an end without a resistance: it decides
    for (const CellEnd& end : ends) {
        if (end.kind != CellEnd::Kind::pressure) {
            if (smallest > 0) enters -= end.flow;
            continue;
        }
        const double own = 1 / (end.resistance + least);
        pressures += own * end.pressure, conductance += own;
    }
    if (conductance == 0)
        throw DeckError(
            "openings: all prescribe their flow, so that nothing tells the level of the pressure; give one a pressure "
            "or a resistance");
    return (pressures + enters) / conductance;
}

/// Across a patch of an opening, by differences: row a is the gradient of velocity a [1/s].
Mat3 gradient_over(const CellPatch& patch, const std::function<Vec3(const Vec3& x)>& velocity) {
    const double step = 0.3 * std::sqrt(norm(patch.area));
    const Vec3 first = unit_across(patch.normal), second = cross(patch.normal, first);
    Mat3 gradient{};
    for (const Vec3& e : {first, second})
        gradient += outer((velocity(patch.centroid + step * e) - velocity(patch.centroid - step * e)) / (2 * step), e);
    return gradient;
}

}   // namespace

CellBalance::CellBalance(const CellMesh& mesh, const CellFluid& fluid, std::span<const CellEnd> ends,
                         double reference_speed)
    : mesh_(mesh),
      fluid_(fluid),
      speed_(reference_speed),
      is_newtonian_(std::holds_alternative<Newtonian>(fluid.rheology)) {
    level_ = level_of_ends(ends);
    const std::size_t cells = mesh.size();
    for (const double volume : mesh.volume) width_.push_back(std::cbrt(volume));
    state_.resize(cells), grad_p_.resize(cells), grad_u_.resize(cells), lack_.resize(cells);
    p_.assign(cells, 0), u_.assign(cells, {});
    face_flux_.resize(mesh.faces.size());
    patch_flux_.resize(mesh.patches.size());
    profile_.resize(mesh.patches.size());
    profile_gradient_.resize(mesh.patches.size());
    rest_.resize(mesh.patches.size()), rest_gradient_.resize(mesh.patches.size());
    ends_.resize(ends.size());
    for (std::uint32_t k = 0; k < mesh.patches.size(); ++k)
        if (const int o = mesh.patches[k].opening; o >= 0) ends_[std::size_t(o)].patches.push_back(k);
    set_ends(ends);
    make_all_gradients();
}

void CellBalance::set_ends(std::span<const CellEnd> ends) {
    for (std::size_t k = 0; k < ends.size(); ++k) set_end(ends[k], ends_[k]);
}

void CellBalance::set_time_derivative(double rate, std::span<const Vec3> rest) {
    rate_ = rate / speed_;
    rate_rest_.assign(rest.begin(), rest.end());
    for (Vec3& r : rate_rest_) r *= 1 / (speed_ * speed_);
}

void CellBalance::make_all_gradients() {
    std::vector<char> has_velocity, has_pressure;
    for (const End& end : ends_) {
        has_velocity.push_back(end.is_imposed());
        has_pressure.push_back(end.kind == CellEnd::Kind::pressure && !end.enters);
    }
    for_pressure_ = make_gradients(mesh_, has_pressure);
    for_velocity_ =
        fluid_.free_slip ? make_gradients(mesh_, has_velocity) : make_gradients_at_rest_on_walls(mesh_, has_velocity);
}

void CellBalance::set_end(const CellEnd& said, End& end) {
    end.kind = said.kind;
    end.wanted = said.flow * mesh_.depth / speed_;
    end.response = {(said.pressure - level_) / (fluid_.density * speed_ * speed_),
                    said.resistance / mesh_.depth / (fluid_.density * speed_)};
    if (said.kind != CellEnd::Kind::pressure) end.flow = end.wanted;
    const double per_speed = 1 / speed_;
    const auto carried = [&](const std::vector<Vec3>& velocity) {
        double flow = 0;
        for (const std::uint32_t k : end.patches) flow += dot(velocity[k], mesh_.patches[k].area);
        return flow;
    };
    for (const std::uint32_t k : end.patches) {
        const CellPatch& patch = mesh_.patches[k];
        profile_[k] = said.velocity ? per_speed * said.velocity(patch.centroid) : -patch.normal;
        if (said.velocity) profile_gradient_[k] = per_speed * gradient_over(patch, said.velocity);
        rest_[k] = said.rest ? per_speed * said.rest(patch.centroid) : Vec3{};
        rest_gradient_[k] = said.rest ? per_speed * gradient_over(patch, said.rest) : Mat3{};
    }
    const double of_profile = carried(profile_), of_rest = carried(rest_);
    if (end.wanted != 0 && !(std::abs(of_profile) > 1e-3 * std::abs(end.wanted)))
        throw DeckError("openings: the velocity over an opening carries nothing of its flow");
    const double to_unit = of_profile != 0 ? -1 / of_profile : 0;
    for (const std::uint32_t k : end.patches) {
        profile_[k] *= to_unit, profile_gradient_[k] = to_unit * profile_gradient_[k];
        rest_[k] += of_rest * profile_[k], rest_gradient_[k] += of_rest * profile_gradient_[k];
    }
}

void CellBalance::set_fields(const CellFields& fields) {
    const double scale = fluid_.density * speed_ * speed_;
    for (std::size_t i = 0; i < mesh_.size(); ++i) {
        p_[i] = (fields.pressure[i] - level_) / scale;
        u_[i] = fields.velocity[i] / speed_;
    }
}

CellFields CellBalance::fields() const {
    CellFields fields;
    for (std::size_t i = 0; i < mesh_.size(); ++i) {
        fields.pressure.push_back(level_ + fluid_.density * speed_ * speed_ * p_[i]);
        fields.velocity.push_back(speed_ * u_[i]);
    }
    return fields;
}

void CellBalance::compute_gradients() {
    for_each_index(mesh_.size(), [&](std::size_t i) {
        const Vec3 u = u_[i], self = for_velocity_.self[i];
        Vec3 p{};
        Mat3 g = outer(u, self);
        for (std::size_t k = mesh_.row_start[i]; k < mesh_.row_start[i + 1]; ++k) {
            const std::uint32_t j = mesh_.row[k].cell;
            p += (p_[j] - p_[i]) * for_pressure_.row[k];
            g += outer(u_[j] - u, for_velocity_.row[k]);
        }
        for (std::size_t k = mesh_.patch_start[i]; k < mesh_.patch_start[i + 1]; ++k) {
            if (mesh_.patches[k].opening < 0) continue;
            const End& end = ends_[std::size_t(mesh_.patches[k].opening)];
            if (end.is_imposed())
                g += outer(imposed(k) - u, for_velocity_.patch[k]);
            else
                p += (end.pressure - p_[i]) * for_pressure_.patch[k];
        }
        grad_p_[i] = p;
        grad_u_[i] = g;
    });
}

void CellBalance::compute_cell_states(double kappa) {
    // A still cell beside a stream must not answer a step of the pressure by many times what passes; but the more of the stream counts, the
    // more pressure an opening pays for what its cells carry too much.
    constexpr double of_neighbours = 0.75;
    std::vector<double> speed(mesh_.size());
    for_each_index(mesh_.size(), [&](std::size_t i) { speed[i] = norm(u_[i]); });
    for_each_index(mesh_.size(), [&](std::size_t i) {
        double fastest = speed[i];
        for (const CellNeighbour& n : mesh_.neighbours(i)) fastest = std::max(fastest, of_neighbours * speed[n.cell]);
        const double nu = viscosity(fluid_.rheology, is_newtonian_ ? 0.0 : shear_rate(grad_u_[i]) * speed_) /
                          (fluid_.density * speed_);
        const double c = sound_speed(kappa, fastest, nu, width_[i]) + rate_ * width_[i];
        state_[i] = {p_[i], u_[i], grad_p_[i], grad_u_[i], nu, c};
    });
}

Face CellBalance::face_of(const CellFace& face) const {
    return {face.area, norm(face.area), face.conductance, face.centroid - mesh_.point[face.a],
            face.centroid - mesh_.point[face.b]};
}

void CellBalance::compute_open_pressures() {
    for (End& end : ends_) {
        if (end.kind == CellEnd::Kind::velocity) continue;
        double free = 0;
        end.conductance = 0;
        for (const std::uint32_t k : end.patches) {
            const CellPatch& patch = mesh_.patches[k];
            const CellState& cell = state_[patch.cell];
            free += free_volume(cell, patch.area, way_to(patch));
            end.conductance += norm(patch.area) / cell.c;
        }
        // A flow that is prescribed is an endless resistance.
        const bool is_flow = end.kind == CellEnd::Kind::flow;
        end.pressure = is_flow ? (free - end.wanted) / end.conductance : end.response.pressure(free, end.conductance);
        end.flow = free - end.conductance * end.pressure;
        end.slope = is_flow ? 1 / end.conductance : end.response.slope(end.conductance);
    }
}

double CellBalance::wall_viscosity(const CellState& cell, const CellPatch& patch) const {
    if (is_newtonian_) return cell.nu;
    const double rate = norm(wall_slope(cell, way_to(patch), patch.distance)) * speed_;
    return viscosity(fluid_.rheology, rate) / (fluid_.density * speed_);
}

void CellBalance::compute_patch_fluxes() {
    for_each_index(mesh_.patches.size(), [&](std::size_t k) {
        const CellPatch& patch = mesh_.patches[k];
        const CellState& cell = state_[patch.cell];
        const Vec3 d = way_to(patch);
        if (patch.opening == CellPatch::symmetry || (patch.opening == CellPatch::wall && fluid_.free_slip))
            patch_flux_[k] = into_slip(cell, patch.area, d);
        else if (patch.opening == CellPatch::wall)
            patch_flux_[k] = into_wall(cell, patch.area, d, patch.distance, wall_viscosity(cell, patch));
        else if (is_open(patch))
            patch_flux_[k] = through_open(cell, patch.area, d, ends_[std::size_t(patch.opening)].pressure,
                                          ends_[std::size_t(patch.opening)].flow < 0 ? imposed(k) : Vec3{}, transport_);
        else
            patch_flux_[k] =
                through_imposed(cell, patch.area, d, patch.distance, imposed(k), imposed_gradient(k), transport_);
    });
}

void CellBalance::sum_fluxes() {
    for_each_index(mesh_.size(), [&](std::size_t i) {
        Flux sum{0, {}};
        for (const CellNeighbour& n : mesh_.neighbours(i)) {
            const double sign = mesh_.faces[n.face].a == i ? 1 : -1;
            sum.volume += sign * face_flux_[n.face].volume;
            sum.momentum += sign * face_flux_[n.face].momentum;
        }
        for (std::size_t k = mesh_.patch_start[i]; k < mesh_.patch_start[i + 1]; ++k) {
            sum.volume += patch_flux_[k].volume;
            sum.momentum += patch_flux_[k].momentum;
        }
        if (rate_ > 0) sum.momentum += mesh_.volume[i] * (rate_ * u_[i] + rate_rest_[i]);
        lack_[i] = sum;
    });
    double through = 0, force = 0;
    for (End& end : ends_) {
        end.flow = 0;
        for (const std::uint32_t k : end.patches) {
            end.flow += patch_flux_[k].volume;
            force += std::abs(patch_flux_[k].volume) * norm(state_[mesh_.patches[k].cell].u);
        }
        through += 0.5 * std::abs(end.flow);
    }
    force += sum_of(mesh_.patches.size(), [&](std::size_t k) {
        const CellPatch& patch = mesh_.patches[k];
        if (patch.opening != CellPatch::wall || fluid_.free_slip) return 0.0;
        const CellState& cell = state_[patch.cell];
        return wall_viscosity(cell, patch) * norm(patch.area) * norm(wall_slope(cell, way_to(patch), patch.distance));
    });
    if (rate_ > 0)
        force +=
            sum_of(mesh_.size(), [&](std::size_t i) { return mesh_.volume[i] * norm(rate_ * u_[i] + rate_rest_[i]); });
    const double none = 1e-300;
    scales_ = {std::max({through, least_scales_.flow, none}), std::max({force, least_scales_.force, none})};
    volume_residual_ = sum_of(mesh_.size(), [&](std::size_t i) { return std::abs(lack_[i].volume); }) / scales_.flow;
    momentum_residual_ = sum_of(mesh_.size(), [&](std::size_t i) { return norm(lack_[i].momentum); }) / scales_.force;
}

void CellBalance::compute_residual(double kappa) {
    compute_gradients();   // with the openings' pressures of the last time
    compute_cell_states(kappa);
    compute_open_pressures();
    for_each_index(mesh_.faces.size(), [&](std::size_t f) {
        const CellFace& face = mesh_.faces[f];
        face_flux_[f] = through_face(face_of(face), state_[face.a], state_[face.b], transport_, is_newtonian_);
    });
    compute_patch_fluxes();
    sum_fluxes();
}

void CellBalance::fill(const PseudoStep& step, CellMatrix& matrix, CellVectors& right) const {
    CellLevel& level = matrix.finest();
    right.resize(mesh_.size());
    const auto quad = [](double first, const Vec3& v) {
        return CellVector{float(first), float(v.x), float(v.y), float(v.z)};
    };
    for_each_index(mesh_.size(), [&](std::size_t i) {
        const CellState& cell = state_[i];
        double p_diagonal = 0, m_diagonal = 0, signals = 0;
        Vec3 gradient{}, divergence{};
        CellRow row(level, i);
        for (std::size_t k = mesh_.row_start[i]; k < mesh_.row_start[i + 1]; ++k) {
            const CellNeighbour& n = mesh_.row[k];
            const CellFace& face = mesh_.faces[n.face];
            const double sign = face.a == i ? 1 : -1, size = norm(face.area), volume = sign * face_flux_[n.face].volume;
            const double both = cell.c + state_[n.cell].c, nu = 0.5 * (cell.nu + state_[n.cell].nu),
                         viscous = nu * face.conductance;
            const double coupling = size / both, transport = std::min(volume, 0.0) - viscous;
            const Vec3 half = 0.5 * sign * face.area;
            CellMatrixEntry& entry = row.next(n.cell);
            entry = {{float(-coupling), float(half.x), float(half.y), float(half.z)}, float(transport), n.cell};
            p_diagonal += coupling;
            m_diagonal -= transport;
            gradient += half;
            divergence += half;
            signals += 0.5 * size * both + 0.5 * std::abs(volume) + 2 * viscous;
        }
        for (std::size_t k = mesh_.patch_start[i]; k < mesh_.patch_start[i + 1]; ++k) {
            const CellPatch& patch = mesh_.patches[k];
            const double size = norm(patch.area), viscous = cell.nu * size / patch.distance;
            if (patch.opening >= 0) m_diagonal += std::max(0.0, -patch_flux_[k].volume);   // what comes in is held
            if (is_open(patch)) {
                divergence += patch.area;
                p_diagonal += size / cell.c;
                continue;
            }
            gradient += patch.area;
            if (patch.opening >= 0)
                m_diagonal += viscous;
            else if (patch.opening == CellPatch::wall && !fluid_.free_slip)
                m_diagonal += 1.5 * viscous;
        }
        const double slowness = signals / (2 * step.courant);
        m_diagonal += slowness + rate_ * mesh_.volume[i];
        p_diagonal += step.pressure_share * slowness / (cell.c * cell.c);
        level.diagonal[i] = {.p_diagonal = float(p_diagonal),
                             .m_diagonal = float(m_diagonal),
                             .gradient = quad(0, gradient),
                             .divergence = quad(0, divergence)};
        right[i] = quad(-lack_[i].volume, -1.0 * lack_[i].momentum);
    });
    matrix.make_coarse();
}

double CellBalance::free_change(const End& end, const CellVectors& x) const {
    double free = 0;
    for (const std::uint32_t k : end.patches) {
        const CellPatch& patch = mesh_.patches[k];
        const CellVector& z = x[patch.cell];
        free += dot(patch.area, Vec3{z[1], z[2], z[3]}) + norm(patch.area) / state_[patch.cell].c * double(z[0]);
    }
    return free;
}

void CellBalance::add_openings(const CellVectors& x, CellVectors& y) const {
    for (const End& end : ends_) {
        if (end.kind == CellEnd::Kind::velocity || !(end.slope > 0 || end.enters)) continue;
        const double free = free_change(end, x), pressure = end.slope * free, flow = free - end.conductance * pressure;
        for (const std::uint32_t k : end.patches) {
            const CellPatch& patch = mesh_.patches[k];
            const Vec3 force = pressure * patch.area;
            const double conductance = norm(patch.area) / state_[patch.cell].c;
            if (end.enters) {
                y[patch.cell][0] += float(share_of(k) * flow);
                continue;
            }
            const double volume = -pressure * conductance;
            y[patch.cell] += CellVector{float(volume), float(force.x), float(force.y), float(force.z)};
        }
    }
}

void CellBalance::apply(const CellVectors& change) {
    // The gradients of the next residual must see the openings' pressures and flows that belong to the fields: behind a stiff
    // outlet a pressure that lags would push the blood back by all that the level moved.
    for (End& end : ends_) {
        if (end.kind == CellEnd::Kind::velocity) continue;
        const double free = free_change(end, change), rise = end.slope * free;
        end.pressure += rise;
        end.flow += free - end.conductance * rise;
    }
    for_each_index(mesh_.size(), [&](std::size_t i) {
        p_[i] += double(change[i][0]);
        u_[i] += Vec3{change[i][1], change[i][2], change[i][3]};
    });
}

void CellBalance::raise_end_pressures(std::span<const double> rise) {
    for (std::size_t k = 0; k < ends_.size(); ++k) ends_[k].pressure += rise[k] / (fluid_.density * speed_ * speed_);
}

void CellBalance::turn_ends() {
    constexpr double enough = 1e-3;   // of all that passes: less may turn again the next time
    double through = 0;
    for (const End& end : ends_) through += 0.5 * std::abs(end.flow);
    bool turned = false;
    for (End& end : ends_) {
        if (end.kind != CellEnd::Kind::pressure || std::abs(end.flow) < enough * through) continue;
        turned = turned || end.enters != (end.flow < 0);
        end.enters = end.flow < 0;
    }
    if (turned) make_all_gradients();
}

std::vector<double> CellBalance::end_memory() const {
    std::vector<double> memory;
    for (const End& end : ends_) memory.insert(memory.end(), {end.flow, end.pressure, double(end.enters)});
    return memory;
}

void CellBalance::restore_end_memory(std::span<const double> memory) {
    for (std::size_t k = 0; k < ends_.size(); ++k)
        ends_[k].flow = memory[3 * k], ends_[k].pressure = memory[3 * k + 1], ends_[k].enters = memory[3 * k + 2] != 0;
    make_all_gradients();
}

void CellBalance::start_ends_as(const CellBalance& other) {
    const double speeds = other.speed_ / speed_;
    for (std::size_t k = 0; k < ends_.size(); ++k) {
        const End& from = other.ends_[k];
        End& end = ends_[k];
        if (end.kind == CellEnd::Kind::velocity) continue;
        end.pressure = speeds * speeds * from.pressure + (other.level_ - level_) / (fluid_.density * speed_ * speed_);
        if (end.kind != CellEnd::Kind::pressure) continue;   // its flow is prescribed
        end.enters = from.enters, end.flow = speeds * mesh_.depth / other.mesh_.depth * from.flow;
    }
    make_all_gradients();
}

}   // namespace patency
