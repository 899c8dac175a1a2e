// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/solid_stress.h"

#include <algorithm>

#include "patency/base/parallel.h"
#include "patency/physics/solid/plastic_lanes.h"

namespace patency {

namespace {

template <class P>
Mat<P> symmetric(const std::array<P, 6>& s) {
    return {{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}};
}

template <class T>
struct Lanes {
    using P = Pack<T>;
    static constexpr std::size_t width = std::size_t(P::lanes);
    const std::uint32_t* members;
    std::size_t count;   // 1 .. width; the last is repeated

    std::uint32_t member(std::size_t lane) const { return members[std::min(lane, count - 1)]; }
    template <class Value>
    P gather(Value value) const {
        alignas(64) T lanes[width];
        for (std::size_t l = 0; l < width; ++l) lanes[l] = value(member(l));
        return P::load(lanes);
    }
    P gather(const AlignedVector<T>& column) const {
        return gather([&](std::uint32_t i) { return column[i]; });
    }
    Vec<P> gather(const Field<Vec3>& field) const {
        return {gather([&](std::uint32_t i) { return T(field[i].x); }), gather([&](std::uint32_t i) { return T(field[i].y); }),
                gather([&](std::uint32_t i) { return T(field[i].z); })};
    }
};

/// F - 1 of a pack of particles.
template <class T>
Mat<Pack<T>> displacement_gradient(const StressInput<T>& input, const Lanes<T>& lanes, const Mat<Pack<T>>& B) {
    using P = Pack<T>;
    std::array<P, 9> s;
    for (std::size_t k = 0; k < 9; ++k) s[k] = number<P>(input.displacement_scale) * lanes.gather(input.sums[k]);
    return Mat<P>{{s[0], s[1], s[2]}, {s[3], s[4], s[5]}, {s[6], s[7], s[8]}} * B;
}

/// An elastic law's P for all lanes at once.
template <class T, class Law>
Mat<Pack<T>> stress_of(const Law& law, const Mat<Pack<T>>& F, const Lanes<T>& lanes, SolidParticles& particles) {
    if constexpr (std::is_same_v<Law, FibreArtery>)
        return law.pk1(F, Fibres<Pack<T>>{lanes.gather(particles.first_fibre), lanes.gather(particles.second_fibre)});
    else
        return law.pk1(F);
}

template <class P>
Mat3 lane_of(const Mat<P>& m, std::size_t lane) {
    const int l = int(lane);
    return {{m.x.x[l], m.x.y[l], m.x.z[l]}, {m.y.x[l], m.y.y[l], m.y.z[l]}, {m.z.x[l], m.z.y[l], m.z.z[l]}};
}

template <class T>
void put_lane(Mat<Pack<T>>& m, std::size_t l, const Mat3& from) {
    const auto put = [&](Vec<Pack<T>>& row, const Vec3& r) { row.x.v[l] = T(r.x), row.y.v[l] = T(r.y), row.z.v[l] = T(r.z); };
    put(m.x, from.x), put(m.y, from.y), put(m.z, from.z);
}

/// A metal's P and its state after the step, in double whatever T is: what flows adds up over many steps.
template <class T>
Mat<Pack<T>> stress_of(const J2Plastic& law, const Mat<Pack<T>>& F, const Lanes<T>& lanes, SolidParticles& particles) {
    using D = Pack<double>;
    constexpr std::size_t width = std::size_t(D::lanes);
    Mat<Pack<T>> result{};
    for (std::size_t first = 0; first < lanes.count; first += width) {
        Mat<D> deformation, inverse_plastic;
        D strain;
        for (std::size_t l = 0; l < width; ++l) {   // lanes past the last repeat it
            const std::uint32_t i = lanes.member(first + l);
            put_lane<double>(deformation, l, lane_of(F, std::min(first + l, lanes.count - 1)));
            put_lane<double>(inverse_plastic, l, particles.inverse_plastic[i]);
            strain.v[l] = particles.plastic_strain[i];
        }
        const PlasticLanes<D> s = stress_by_series(law, deformation, inverse_plastic, strain);
        const Mat<D> pk1 = s.kirchhoff * transpose(s.inverse);
        const D J = determinant(deformation);
        for (std::size_t l = 0; l < width && first + l < lanes.count; ++l) {
            const std::uint32_t i = lanes.members[first + l];
            if (!(J[int(l)] > 0)) continue;   // its logarithm does not exist; the caller sees the determinant
            if (s.distance[int(l)] < furthest_series) {
                if (s.strain[int(l)] > particles.plastic_strain[i]) particles.inverse_plastic[i] = lane_of(s.inverse_plastic, l);
                particles.plastic_strain[i] = s.strain[int(l)];
                put_lane<T>(result, first + l, lane_of(pk1, l));
                continue;
            }
            const Mat3 Fi = lane_of(deformation, l);
            const PlasticStress alone = law.stress(Fi, {particles.inverse_plastic[i], particles.plastic_strain[i]});
            particles.inverse_plastic[i] = alone.state.inverse_plastic;
            particles.plastic_strain[i] = alone.state.strain;
            put_lane<T>(result, first + l, pk1_of_kirchhoff(alone.kirchhoff, Fi));
        }
    }
    return result;
}

/// A pack of particles of one law; returns the first of them that is inside out.
template <class T, class Law>
std::uint32_t compute_pack(const Law& law, const Lanes<T>& lanes, const StressInput<T>& input, SolidParticles& particles,
                           std::array<AlignedVector<Quad<T>>, 3>& stress) {
    using P = Pack<T>;
    std::array<P, 6> b;
    for (std::size_t k = 0; k < 6; ++k) b[k] = lanes.gather(input.correction[k]);
    const Mat<P> B = symmetric(b), H = displacement_gradient(input, lanes, B), F = H + identity<P>();
    const P J = determinant(F);
    const Mat<P> A = lanes.gather(input.hourglass) * H - stress_of(law, F, lanes, particles) * B;
    alignas(64) T value[9][Lanes<T>::width];
    const std::array<const P*, 9> from = {&A.x.x, &A.x.y, &A.x.z, &A.y.x, &A.y.y, &A.y.z, &A.z.x, &A.z.y, &A.z.z};
    for (std::size_t k = 0; k < 9; ++k) from[k]->store(value[k]);
    std::uint32_t worst = no_particle;
    for (std::size_t l = 0; l < lanes.count; ++l) {
        const std::uint32_t i = lanes.members[l];
        for (std::size_t row = 0; row < 3; ++row) {
            Quad<T>& q = stress[row][i];
            q.a = value[3 * row][l], q.b = value[3 * row + 1][l], q.c = value[3 * row + 2][l];
        }
        if (!(J[int(l)] > 0)) worst = std::min(worst, i);
    }
    return worst;
}

}   // namespace

template <class T>
std::uint32_t compute_stress(const SolidMaterial& material, const std::vector<std::uint32_t>& members,
                             const StressInput<T>& input, SolidParticles& particles,
                             std::array<AlignedVector<Quad<T>>, 3>& stress) {
    constexpr std::size_t width = Lanes<T>::width;
    std::vector<std::uint32_t> worst((members.size() + block_size - 1) / block_size, no_particle);
    std::visit(
        [&](const auto& law) {
            for_each_block(members.size(), [&](std::size_t begin, std::size_t end) {
                for (std::size_t k = begin; k < end; k += width) {
                    const Lanes<T> lanes{&members[k], std::min(width, end - k)};
                    std::uint32_t& first = worst[begin / block_size];
                    first = std::min(first, compute_pack(law, lanes, input, particles, stress));
                }
            });
        },
        material.law);
    return worst.empty() ? no_particle : *std::min_element(worst.begin(), worst.end());
}

template <class T>
Mat3 deformation_gradient(const StressInput<T>& input, std::size_t i) {
    std::array<double, 9> s;
    std::array<double, 6> b;
    for (std::size_t k = 0; k < 9; ++k) s[k] = input.displacement_scale * double(input.sums[k][i]);
    for (std::size_t k = 0; k < 6; ++k) b[k] = double(input.correction[k][i]);
    return identity<double>() + Mat3{{s[0], s[1], s[2]}, {s[3], s[4], s[5]}, {s[6], s[7], s[8]}} * symmetric(b);
}

template std::uint32_t compute_stress<float>(const SolidMaterial&, const std::vector<std::uint32_t>&, const StressInput<float>&,
                                             SolidParticles&, std::array<AlignedVector<Quad<float>>, 3>&);
template std::uint32_t compute_stress<double>(const SolidMaterial&, const std::vector<std::uint32_t>&, const StressInput<double>&,
                                              SolidParticles&, std::array<AlignedVector<Quad<double>>, 3>&);
template Mat3 deformation_gradient<float>(const StressInput<float>&, std::size_t);
template Mat3 deformation_gradient<double>(const StressInput<double>&, std::size_t);

}   // namespace patency
