// SPDX-License-Identifier: Apache-2.0
// Six numbers do what nine do.
#include "patency/base/symmetric_matrix.h"

#include <gtest/gtest.h>

#include "patency/physics/solid/strain.h"

using namespace patency;

namespace {

Mat3 full(const Sym<double>& s) { return {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}; }
void expect_near(const Mat3& a, const Mat3& b) {
    EXPECT_LT(std::sqrt(double_dot(a - b, a - b)), 1e-13 * std::sqrt(double_dot(b, b)));
}

const Sym<double> a{2.0, 3.5, 1.25, 0.5, -0.25, 0.75};
const Mat3 m{{1, 0.2, -0.3}, {0.4, 0.9, 0.1}, {-0.7, 0.6, 1.1}};

TEST(Sym, ProductsInversesAndTracesAreThoseOfMatrices) {
    const Mat3 A = full(a), AA = A * A;
    const Sym<double> square = commuting_product(a, a);
    expect_near(full(square), AA);
    expect_near(full(commuting_product(square, a)), AA * A);
    expect_near(full(inverse(a)), inverse(A));
    expect_near(full(congruent(m, a)), m * A * transpose(m));
    expect_near(full(plus_unit(a, 0.5)), A + 0.5 * identity<double>());
    expect_near(full(a + 2.0 * square), A + 2.0 * AA);
    EXPECT_NEAR(trace(a), trace(A), 1e-14);
    EXPECT_NEAR(double_dot(a, square), double_dot(A, AA), 1e-12);
    const Vec3 v{1, -2, 0.5};
    EXPECT_LT(norm(a * v - A * v), 1e-14);
}

}   // namespace
