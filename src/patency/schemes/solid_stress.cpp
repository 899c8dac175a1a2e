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

/// A pack of particles: one after the other in memory, or anywhere.
template <class T, bool is_run>
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
        if constexpr (is_run) return P::load(&column[members[0]]);
        return gather([&](std::uint32_t i) { return column[i]; });
    }
    Vec<P> gather(const Field<Vec3>& field) const {
        return {gather([&](std::uint32_t i) { return T(field[i].x); }),
                gather([&](std::uint32_t i) { return T(field[i].y); }),
                gather([&](std::uint32_t i) { return T(field[i].z); })};
    }
};

/// A matrix of columns, by rows.
template <class T, bool is_run>
Mat<Pack<T>> gather(const std::array<AlignedVector<T>, 9>& columns, const Lanes<T, is_run>& lanes) {
    const auto at = [&](std::size_t k) { return lanes.gather(columns[k]); };
    return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}};
}

/// F - 1 of a pack of particles, as it fits.
template <class T, bool is_run>
Mat<Pack<T>> displacement_gradient(const StressInput<T>& input, const Lanes<T, is_run>& lanes, const Mat<Pack<T>>& B) {
    return (number<Pack<T>>(input.displacement_scale) * gather(input.sums, lanes)) * B;
}

/// An elastic law's P for all lanes at once.
template <class T, bool is_run, class Law>
Mat<Pack<T>> stress_of(const Law& law, const Mat<Pack<T>>& F, const Lanes<T, is_run>& lanes,
                       SolidParticles& particles) {
    if constexpr (std::is_same_v<Law, FibreArtery>)
        return law.pk1(F, Fibres<Pack<T>>{lanes.gather(particles.first_fibre), lanes.gather(particles.second_fibre)});
    else
        return law.pk1(F);
}

std::array<double*, 9> places_of(Mat3& m) {
    return {&m.x.x, &m.x.y, &m.x.z, &m.y.x, &m.y.y, &m.y.z, &m.z.x, &m.z.y, &m.z.z};
}
/// Where the series end, a particle by itself.
[[gnu::noinline]] Mat3 stress_alone(const J2Plastic& law, const Mat3& F, SolidParticles& particles, std::uint32_t i) {
    const PlasticStress alone = law.stress(F, {particles.inverse_plastic[i], particles.plastic_strain[i]});
    particles.inverse_plastic[i] = alone.state.inverse_plastic;
    particles.plastic_strain[i] = alone.state.strain;
    return pk1_of_kirchhoff(alone.kirchhoff, F);
}

/// A metal's P and its state after the step, in double whatever T is: what flows adds up over many steps.
template <class T, bool is_run>
Mat<Pack<T>> stress_of(const J2Plastic& law, const Mat<Pack<T>>& F, const Lanes<T, is_run>& lanes,
                       SolidParticles& particles) {
    using D = Pack<double>;
    constexpr std::size_t width = std::size_t(D::lanes);
    constexpr std::size_t all = std::size_t(Pack<T>::lanes);
    alignas(64) T from[9][all], to[9][all];
    F.x.x.store(from[0]), F.x.y.store(from[1]), F.x.z.store(from[2]), F.y.x.store(from[3]), F.y.y.store(from[4]),
        F.y.z.store(from[5]);
    F.z.x.store(from[6]), F.z.y.store(from[7]), F.z.z.store(from[8]);
    for (std::size_t first = 0; first < all; first += width) {   // lanes past the last repeat it
        D f[9]{}, c[6]{}, strain{};
        for (std::size_t k = 0; k < 9; ++k)
            for (std::size_t l = 0; l < width; ++l) f[k].v[l] = double(from[k][first + l]);
        for (std::size_t l = 0; l < width; ++l) {
            const std::uint32_t i = lanes.member(first + l);
            const Mat3& C = particles.inverse_plastic[i];
            c[0].v[l] = C.x.x, c[1].v[l] = C.y.y, c[2].v[l] = C.z.z, c[3].v[l] = C.x.y, c[4].v[l] = C.x.z,
            c[5].v[l] = C.y.z;
            strain.v[l] = particles.plastic_strain[i];
        }
        const PlasticLanes<D> s =
            stress_by_series(law, Mat<D>{{f[0], f[1], f[2]}, {f[3], f[4], f[5]}, {f[6], f[7], f[8]}},
                             Sym<D>{c[0], c[1], c[2], c[3], c[4], c[5]}, strain);
        const Mat<D>& G = s.inverse;   // P = tau F^-T
        const Sym<D>& t = s.kirchhoff;
        const auto row = [&](const Vec<D>& r) __attribute__((always_inline)) {
            return Vec<D>{dot(r, G.x), dot(r, G.y), dot(r, G.z)};
        };
        const Mat<D> pk1{row({t.xx, t.xy, t.xz}), row({t.xy, t.yy, t.yz}), row({t.xz, t.yz, t.zz})};
        const std::array<D, 9> stress = {pk1.x.x, pk1.x.y, pk1.x.z, pk1.y.x, pk1.y.y,
                                         pk1.y.z, pk1.z.x, pk1.z.y, pk1.z.z};
        for (std::size_t k = 0; k < 9; ++k)
            for (std::size_t l = 0; l < width; ++l) to[k][first + l] = T(stress[k].v[l]);
        for (std::size_t l = 0; l < width && first + l < lanes.count; ++l) {
            const std::uint32_t i = lanes.members[first + l];
            const Sym<D>& after = s.inverse_plastic;
            const int lane = int(l);
            if (!(s.determinant[lane] > 0)) continue;   // its logarithm does not exist; the caller sees the determinant
            if (s.distance[lane] < furthest_series) {
                if (!(s.strain[lane] > particles.plastic_strain[i])) continue;
                particles.plastic_strain[i] = s.strain[lane];
                particles.inverse_plastic[i] = {{after.xx[lane], after.xy[lane], after.xz[lane]},
                                                {after.xy[lane], after.yy[lane], after.yz[lane]},
                                                {after.xz[lane], after.yz[lane], after.zz[lane]}};
                continue;
            }
            Mat3 deformation, alone;
            for (std::size_t k = 0; k < 9; ++k) *places_of(deformation)[k] = double(from[k][first + l]);
            alone = stress_alone(law, deformation, particles, i);
            for (std::size_t k = 0; k < 9; ++k) to[k][first + l] = T(*places_of(alone)[k]);
        }
    }
    const auto at = [&](std::size_t k) { return Pack<T>::load(to[k]); };
    return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}};
}

/// A pack of particles of one law; returns the first of them that is inside out.
template <class T, bool is_run, class Law>
[[gnu::flatten]] std::uint32_t compute_pack(const Law& law, const Lanes<T, is_run>& lanes, const StressInput<T>& input,
                                            SolidParticles& particles, StressOutput<T>& stress) {
    using P = Pack<T>;
    constexpr std::size_t width = std::size_t(P::lanes);
    const auto& b = input.correction;
    const Mat<P> B = symmetric<P>({lanes.gather(b[0]), lanes.gather(b[1]), lanes.gather(b[2]), lanes.gather(b[3]),
                                   lanes.gather(b[4]), lanes.gather(b[5])});
    const Mat<P> H = displacement_gradient(input, lanes, B);
    const bool is_second_order = input.is_second_order();
    const Mat<P> F =
        identity<P>() + (is_second_order ? number<P>(1.5) * H - number<P>(0.5) * (gather(input.around, lanes) * B) : H);
    const P J = determinant(F);
    const Mat<P> PB = stress_of(law, F, lanes, particles) * B;
    const Mat<P> A = lanes.gather(input.share) * (is_second_order ? PB : lanes.gather(input.hourglass) * H - PB);
    const auto put_row = [&](const Vec<P>& row, std::size_t k) {
        alignas(64) T x[width], y[width], z[width];
        row.x.store(x), row.y.store(y), row.z.store(z);
        for (std::size_t l = 0; l < lanes.count; ++l) {
            const std::uint32_t i = is_run ? lanes.members[0] + std::uint32_t(l) : lanes.members[l];
            Quad<T>& q = stress.rows[k][i];
            q = {x[l], y[l], z[l], q.d};
        }
    };
    put_row(A.x, 0), put_row(A.y, 1), put_row(A.z, 2);
    for (std::size_t l = 0; l < lanes.count; ++l)
        if (!(J[int(l)] > 0)) return lanes.members[l];   // members rise
    return no_particle;
}

}   // namespace

template <class T>
std::uint32_t compute_stress(const SolidMaterial& material, const std::vector<std::uint32_t>& members,
                             const StressInput<T>& input, SolidParticles& particles, StressOutput<T>& stress) {
    constexpr std::size_t width = std::size_t(Pack<T>::lanes);
    std::vector<std::uint32_t> worst((members.size() + block_size - 1) / block_size, no_particle);
    std::visit(
        [&](const auto& law) {
            for_each_block(members.size(), [&](std::size_t begin, std::size_t end) {
                std::uint32_t& worst_here = worst[begin / block_size];
                for (std::size_t k = begin; k < end; k += width) {
                    const std::uint32_t* first = &members[k];
                    const bool is_run = end - k >= width && first[width - 1] - first[0] == width - 1;   // members rise
                    worst_here = std::min(
                        worst_here, is_run ? compute_pack(law, Lanes<T, true>{first, width}, input, particles, stress)
                                           : compute_pack(law, Lanes<T, false>{first, std::min(width, end - k)}, input,
                                                          particles, stress));
                }
            });
        },
        material.law);
    return worst.empty() ? no_particle : *std::min_element(worst.begin(), worst.end());
}

template <class T>
Mat3 fitted_gradient(const StressInput<T>& input, std::size_t i) {
    return identity<double>() + input.displacement_scale * (matrix_at(input.sums, i) * correction_at(input, i));
}

template <class T>
Mat3 deformation_gradient(const StressInput<T>& input, std::size_t i) {
    const Mat3 fitted = fitted_gradient(input, i);
    if (!input.is_second_order()) return fitted;
    return 1.5 * fitted - 0.5 * (identity<double>() + matrix_at(input.around, i) * correction_at(input, i));
}

template std::uint32_t compute_stress<float>(const SolidMaterial&, const std::vector<std::uint32_t>&,
                                             const StressInput<float>&, SolidParticles&, StressOutput<float>&);
template std::uint32_t compute_stress<double>(const SolidMaterial&, const std::vector<std::uint32_t>&,
                                              const StressInput<double>&, SolidParticles&, StressOutput<double>&);
template Mat3 fitted_gradient<float>(const StressInput<float>&, std::size_t);
template Mat3 fitted_gradient<double>(const StressInput<double>&, std::size_t);
template Mat3 deformation_gradient<float>(const StressInput<float>&, std::size_t);
template Mat3 deformation_gradient<double>(const StressInput<double>&, std::size_t);

}   // namespace patency
