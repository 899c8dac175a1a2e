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

void assign(double factor, const CellVectors& a, CellVectors& to) {
    const auto f = float(factor);
    for_each_index(a.size(), [&](std::size_t i) { to[i] = f * a[i]; });
}

/// The k-th, made if it is not there, of so many cells.
CellVectors& vectors_at(std::vector<CellVectors>& all, std::size_t k, std::size_t size) {
    if (all.size() <= k) all.resize(k + 1);
    all[k].resize(size);
    return all[k];
}

}   // namespace

KrylovResult CellKrylov::solve(const CellOperator& multiply, const CellOperator& precondition, const CellVectors& right,
                               CellVectors& x, int most, double tolerance) {
    const double length = std::sqrt(product(right, right));
    x.assign(right.size(), CellVector{});
    if (!(length > 0)) return {0, 0};
    assign(1 / length, right, vectors_at(basis_, 0, right.size()));
    std::vector<std::vector<double>> columns;              // of the triangle that rotations make of Hessenberg's matrix
    std::vector<double> cosines, sines, rest(1, length);   // rest: of the right side after the rotations
    int k = 0;
    while (k < most) {
        const auto next = std::size_t(k) + 1;
        CellVectors &w = vectors_at(basis_, next, right.size()), &z = vectors_at(search_, next - 1, right.size());
        precondition(basis_[next - 1], z);
        multiply(z, w);
        std::vector<double> h;
        for (std::size_t j = 0; j < next; ++j) {
            h.push_back(product(w, basis_[j]));
            add(-h.back(), basis_[j], w);
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
        assign(1 / left, w, w);
    }
    std::vector<double> y(static_cast<std::size_t>(k));
    for (std::size_t i = y.size(); i-- > 0;) {
        double sum = rest[i];
        for (std::size_t j = i + 1; j < y.size(); ++j) sum -= columns[j][i] * y[j];
        y[i] = sum / columns[i][i];
    }
    for (std::size_t i = 0; i < y.size(); ++i) add(y[i], search_[i], x);
    return {std::abs(rest.back()) / length, k};
}

}   // namespace patency
