// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_krylov.h"

#include <cmath>

#include "patency/base/parallel.h"

namespace patency {

namespace {

void add(double factor, const CellVectors& a, CellVectors& to) {
    const auto f = float(factor);
    for_each_index(a.size(), [&](std::size_t i) { to[i] += f * a[i]; });
}

void scale(double factor, CellVectors& a) {
    const auto f = float(factor);
    for_each_index(a.size(), [&](std::size_t i) { a[i] *= f; });
}

}   // namespace

KrylovResult solve_by_krylov(const PreconditionedOperator& apply, const CellVectors& right, CellVectors& x, int most,
                             double tolerance) {
    const double length = std::sqrt(product(right, right));
    x.assign(right.size(), CellVector{});
    if (!(length > 0)) return {0, 0};
    std::vector<CellVectors> basis(1, right), search;
    scale(1 / length, basis[0]);
    std::vector<std::vector<double>> columns;              // of the triangle that rotations make of Hessenberg's matrix
    std::vector<double> cosines, sines, rest(1, length);   // rest: of the right side after the rotations
    int k = 0;
    while (k < most) {
        CellVectors z(right.size()), w(right.size());
        apply(basis[std::size_t(k)], z, w);
        search.push_back(std::move(z));
        std::vector<double> h;
        for (const CellVectors& v : basis) {
            h.push_back(product(w, v));
            add(-h.back(), v, w);
        }
        const double left = std::sqrt(product(w, w));
        for (std::size_t i = 0; i < std::size_t(k); ++i) {
            const double upper = cosines[i] * h[i] + sines[i] * h[i + 1];
            h[i + 1] = cosines[i] * h[i + 1] - sines[i] * h[i];
            h[i] = upper;
        }
        const double both = std::hypot(h.back(), left);
        if (!(both > 0)) break;
        cosines.push_back(h.back() / both);
        sines.push_back(left / both);
        h.back() = both;
        columns.push_back(std::move(h));
        rest.push_back(-sines.back() * rest.back());
        rest[std::size_t(k)] *= cosines.back();
        ++k;
        if (!(std::abs(rest.back()) > tolerance * length) || !(left > 0)) break;
        scale(1 / left, w);
        basis.push_back(std::move(w));
    }
    std::vector<double> y(static_cast<std::size_t>(k));
    for (std::size_t i = y.size(); i-- > 0;) {
        double sum = rest[i];
        for (std::size_t j = i + 1; j < y.size(); ++j) sum -= columns[j][i] * y[j];
        y[i] = sum / columns[i][i];
    }
    for (std::size_t i = 0; i < y.size(); ++i) add(y[i], search[i], x);
    return {std::abs(rest.back()) / length, k};
}

}   // namespace patency
