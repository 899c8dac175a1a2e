// SPDX-License-Identifier: Apache-2.0
// Eigenvalues and eigenvectors of a symmetric 3x3 matrix, by Jacobi's rotations: exact to round-off of the largest
// element also where eigenvalues meet, which closed forms are not.
#pragma once

#include <cmath>

#include "patency/base/vec.h"

namespace patency {

struct SymmetricEigen {
    Vec3 values;    ///< in no order
    Mat3 vectors;   ///< rows: the unit vector of each value
};

/// a is symmetric; only finite numbers.
inline SymmetricEigen symmetric_eigen(const Mat3& a) {
    double m[3][3] = {{a.x.x, a.x.y, a.x.z}, {a.y.x, a.y.y, a.y.z}, {a.z.x, a.z.y, a.z.z}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    constexpr int most_sweeps = 30;   // it converges quadratically; four are usual
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        const double off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
        const double on = m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2];
        if (off <= 1e-36 * on) break;
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (m[p][q] == 0) continue;
                const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                const int r = 3 - p - q;
                const double mpq = m[p][q], mrp = m[r][p], mrq = m[r][q];
                m[p][p] -= t * mpq, m[q][q] += t * mpq;
                m[p][q] = m[q][p] = 0;
                m[r][p] = m[p][r] = c * mrp - s * mrq;
                m[r][q] = m[q][r] = s * mrp + c * mrq;
                for (int k = 0; k < 3; ++k) {
                    const double vp = v[p][k], vq = v[q][k];
                    v[p][k] = c * vp - s * vq, v[q][k] = s * vp + c * vq;
                }
            }
    }
    return {{m[0][0], m[1][1], m[2][2]},
            {{v[0][0], v[0][1], v[0][2]}, {v[1][0], v[1][1], v[1][2]}, {v[2][0], v[2][1], v[2][2]}}};
}

/// sum_k f(value_k) n_k n_k^T: a function of a symmetric matrix, such as its logarithm.
inline Mat3 from_eigen(const Vec3& values, const Mat3& vectors) {
    return values.x * outer(vectors.x, vectors.x) + values.y * outer(vectors.y, vectors.y) +
           values.z * outer(vectors.z, vectors.z);
}

}   // namespace patency
